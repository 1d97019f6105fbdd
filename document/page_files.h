// The files of the report page, which embed.cmake compiles into the program.
#pragma once

#include <string_view>

namespace softland::internal {

/// Returns the text of a file below document/ in the source tree, e.g. "page/page.js". Throws std::logic_error for a file that
/// is not embedded.
[[nodiscard]] std::string_view page_file(std::string_view name);

}  // namespace softland::internal
