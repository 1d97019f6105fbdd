#include "reports/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/printable.h"
#include "reports/closing_clauses.h"
#include "reports/devices_report.h"
#include "reports/figure_text.h"
#include "reports/findings.h"
#include "reports/seeds_report.h"

namespace softland {

std::size_t internal::columns_of(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string internal::left_aligned(const std::string& text, std::size_t columns) {
  return text + std::string(columns - std::min(columns, columns_of(text)), ' ');
}

std::string internal::right_aligned(const std::string& text, std::size_t columns) {
  return std::string(columns - std::min(columns, columns_of(text)), ' ') + text;
}

std::string wrapped(std::string_view paragraph, std::size_t columns) {
  const std::string clean = printable_line(paragraph);
  std::string_view text = clean;
  std::string out;
  std::size_t used = 0;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(text.size(), word.size() + 1));
    if (used > 0) {
      const bool fits = used + 1 + internal::columns_of(word) <= columns;
      out += fits ? ' ' : '\n';
      used = fits ? used + 1 : 0;
    }
    out += word;
    used += internal::columns_of(word);
  }
  return out;
}

std::string text_report(const Result& result) {
  std::string out = wrapped(internal::headline(result).whole()) + "\n\n";
  if (result.devices) {
    out += internal::devices_text(*result.devices) + "\n";
    out += result.devices->better_than_plain_step ? "best.toml on the drawing:\n" : "The plain step on the drawing:\n";
  }
  const ResultRun &best = result.best, &baseline = result.baseline;
  const auto aligned = [](const std::string& value) { return internal::right_aligned(value, 16); };
  out += result.is_search ? fmt::format("{:<36}{:>16}{:>16}   {}\n", "", "plain step", "found", "change")
                          : fmt::format("{:<36}{:>16}   {}\n", "", "value", internal::error_heading(result));
  for (const Figure& f : all_figures) {
    const double own = internal::figure_of_run(best, f.member), step = internal::figure_of_run(baseline, f.member);
    if (std::isnan(own) && std::isnan(step)) continue;  // as on the page
    out += internal::left_aligned(f.label(), 36);
    if (result.is_search) {
      const internal::Change change = internal::figure_change(baseline, best, f);
      out += aligned(internal::figure_text(f, step, baseline.errors[f], own)) +
             aligned(internal::figure_text(f, own, best.errors[f], step)) + "   " + change.words;
    } else {
      const std::string cloud = internal::cloud_text(result, f);
      const std::string shown = !cloud.empty()                  ? cloud
                                : std::isfinite(best.errors[f]) ? internal::error_text(f, own, best.errors[f])
                                                                : std::string();
      out += aligned(internal::figure_text(f, own, best.errors[f], Metrics::unset)) + "   " + shown;
    }
    while (!out.empty() && out.back() == ' ') out.pop_back();
    out += "\n";
  }
  // Of a winner that bounces there is nothing to confirm.
  const bool lands_softly = result.is_search && internal::figure_of_run(best, &Metrics::bounce_count) == 0;
  if (const std::string checks = internal::checks_caption(result); lands_softly && !checks.empty())
    out += "\n" + wrapped(checks) + "\n";
  if (const std::string words = internal::limit_words(result); !words.empty()) out += "\n" + wrapped(words) + "\n";
  if (const std::string words = internal::certificate_caption(result); !words.empty()) out += "\n" + wrapped(words) + "\n";
  if (const std::string words = internal::families_caption(result); !words.empty())
    out += "\n" + wrapped(fmt::format("Families searched, with the least cost of each: {}.", words)) + "\n";
  if (const std::string words = internal::robust_caption(result); !words.empty()) out += "\n" + wrapped(words) + "\n";
  if (const std::string words = internal::seeds_text(result.seeds); !words.empty()) out += "\n" + words;
  for (const std::string& warning : result.warnings) out += "\n" + wrapped("warning: " + warning) + "\n";
  return out;
}

}  // namespace softland
