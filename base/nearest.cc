#include "base/nearest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace softland {
namespace {

/// Returns the number of edits (insertion, deletion, substitution, swap of neighbours) from `a` to `b`.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  std::iota(d[0].begin(), d[0].end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

}  // namespace

std::string did_you_mean(std::string_view word, const std::vector<std::string_view>& known) {
  if (known.empty()) return {};
  constexpr std::size_t longest_word =
      64;  // no suggestion for a longer word: the time of edit_distance() is proportional to the product of both lengths
  if (word.size() <= longest_word) {
    const auto distance = [&](std::string_view name) { return edit_distance(word, name); };
    const auto nearest = *std::min_element(known.begin(), known.end(), [&](auto a, auto b) { return distance(a) < distance(b); });
    if (distance(nearest) <= std::max<std::size_t>(2, nearest.size() / 3)) return fmt::format(" (did you mean '{}'?)", nearest);
    // Least length of a word that may be the beginning of the intended name: "poisson" suggests poissons_ratio.
    constexpr std::size_t shortest_beginning = 4;
    const auto is_begun = [&](std::string_view name) { return word.size() >= shortest_beginning && name.starts_with(word); };
    if (std::ranges::count_if(known, is_begun) == 1)
      return fmt::format(" (did you mean '{}'?)", *std::ranges::find_if(known, is_begun));
  }
  return {};
}

}  // namespace softland
