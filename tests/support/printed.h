// Finds numbers in texts for users that are badly written.
#pragma once

#include <array>
#include <cstdlib>
#include <regex>
#include <string>
#include <utility>

namespace softland {

/// Returns the first badly written number in `text`, with its fault: too many digits, or a format that users do not expect.
/// Empty if there is none. The caller removes paths and quoted text.
inline std::string absurd_number(const std::string& text) {
  static const std::array<std::pair<std::regex, const char*>, 6> rules{{
      {std::regex("[0-9](\u00a0| )[fazy]m\\b"), "a length below 1 pm"},
      {std::regex("[0-9](\u00a0| )[azy]s\\b"), "a time below 1 fs"},
      {std::regex("[0-9](\u00a0| )([pfazy]m/s|[azy]N|yJ|[npfazy]V)\\b"), "below what matters"},
      {std::regex("[0-9]e[+]|[0-9]e-?0"), "an exponent as machines write it"},
      {std::regex("[0-9]e-?[0-9]+(\u00a0| )?(m|s|N|J|V|Hz|Pa)\\b"), "no prefix"},
      {std::regex("(^|[\\s(>])-[.0-9]"), "a hyphen for a minus sign"},
  }};
  std::smatch found;
  for (const auto& [rule, what] : rules) {
    if (std::regex_search(text, found, rule)) return std::string(what) + ": " + found.str() + found.suffix().str().substr(0, 20);
  }
  constexpr std::size_t most_digits = 6;
  static const std::regex number("[0-9]+[.][0-9]+");
  for (auto at = std::sregex_iterator(text.begin(), text.end(), number); at != std::sregex_iterator(); ++at) {
    std::string digits = at->str();
    std::erase(digits, '.');
    digits.erase(0, digits.find_first_not_of('0'));
    if (digits.size() > most_digits) return "more than six digits: " + at->str();
  }
  constexpr double most_times = 1000;
  static const std::regex ratio("([0-9][0-9.]*) times");
  for (auto at = std::sregex_iterator(text.begin(), text.end(), ratio); at != std::sregex_iterator(); ++at) {
    if (std::atof((*at)[1].str().c_str()) > most_times) return "more than a thousand times: " + at->str();
  }
  return {};
}

}  // namespace softland
