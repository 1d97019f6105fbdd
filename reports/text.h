// The same findings for a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "reports/result.h"

namespace softland {

/// Headline, table of figures (baseline and winner side by side for optimize; value and error for simulate), confirmations and
/// warnings of a result.
[[nodiscard]] std::string text_report(const Result& result);

/// Blanks turned into line breaks so that lines have at most `columns` characters where words permit it. Line breaks, tabs and
/// what acts on a terminal are escaped: they come from names of files and folders.
[[nodiscard]] std::string wrapped(std::string_view paragraph, std::size_t columns = 100);

}  // namespace softland
