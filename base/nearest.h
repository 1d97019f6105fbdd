// The nearest of several names to a misspelt word.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace softland {

/// Returns advice for an unknown word: " (did you mean 'thickness'?)" for a word close to a known name, or for the beginning of
/// one; otherwise an empty text.
[[nodiscard]] std::string did_you_mean(std::string_view word, const std::vector<std::string_view>& known);

}  // namespace softland
