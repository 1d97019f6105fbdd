#include "reports/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/printable.h"
#include "reports/findings.h"
#include "reports/quantity.h"
#include "reports/result_view.h"

namespace softland {
namespace {

using nlohmann::json;

// Columns on a terminal: UTF-8 continuation bytes take no room.
std::size_t columns_of(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string padded(const std::string& text, std::size_t columns) {
  return text + std::string(columns > columns_of(text) ? columns - columns_of(text) : 0, ' ');
}

}  // namespace

std::string wrapped(std::string_view paragraph, std::size_t columns) {
  const std::string clean = printable_line(paragraph);
  std::string_view text = clean;
  std::string out;
  std::size_t used = 0;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(text.size(), word.size() + 1));
    if (used > 0) {
      const bool fits = used + 1 + columns_of(word) <= columns;
      out += fits ? ' ' : '\n';
      used = fits ? used + 1 : 0;
    }
    out += word;
    used += columns_of(word);
  }
  return out;
}

std::string text_report(const json& result) {
  std::string out = wrapped(internal::headline(result).whole()) + "\n\n";
  const bool compares = internal::is_optimize(result);
  const json& best = internal::best_metrics(result);
  const json& baseline = internal::baseline_metrics(result);
  const json& errors = internal::at(result, {"errors"});
  const json& baseline_errors = internal::at(result, {"baseline", "errors"});
  out += compares ? fmt::format("{:<36}{:>16}{:>16}   {}\n", "", "plain step", "found", "change")
                  : fmt::format("{:<36}{:>16}   {}\n", "", "value", internal::error_heading(result));
  for (const Figure& f : all_figures) {
    if (internal::at(best, {f.key}).is_null() && internal::at(baseline, {f.key}).is_null()) continue;  // as on the page
    const auto right = [](const std::string& text) {
      return std::string(columns_of(text) < 16 ? 16 - columns_of(text) : 0, ' ') + text;
    };
    if (compares) {
      const internal::Change change = internal::figure_change(baseline, best, f);
      out += padded(f.label(), 36) + right(internal::figure_text(baseline, baseline_errors, best, f)) +
             right(internal::figure_text(best, errors, baseline, f)) + "   " + change.words;
    } else {
      const bool known = std::isfinite(internal::number(errors, {f.key}));
      const std::string cloud = internal::cloud_text(result, f);
      const std::string shown = !cloud.empty() ? cloud : known ? internal::error_text(best, errors, f) : std::string();
      out += padded(f.label(), 36) + right(internal::figure_text(best, errors, json::object(), f)) + "   " + shown;
    }
    while (!out.empty() && out.back() == ' ') out.pop_back();
    out += "\n";
  }
  // Of a winner that bounces there is nothing to confirm.
  const bool lands_softly = compares && internal::number(best, {"bounce_count"}) == 0;
  if (const std::string checks = internal::checks_caption(result); lands_softly && !checks.empty())
    out += "\n" + wrapped(checks) + "\n";
  if (const std::string words = internal::certificate_caption(result); !words.empty()) out += "\n" + wrapped(words) + "\n";
  for (const json& warning : internal::at(result, {"warnings"})) {
    if (warning.is_string()) out += "\n" + wrapped("warning: " + warning.get<std::string>()) + "\n";
  }
  return out;
}

}  // namespace softland
