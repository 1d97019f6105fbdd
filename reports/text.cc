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
#include "reports/text_table.h"

namespace softland {

namespace {

// Every figure that a run has, as on the page.
std::string figures_text(const Result& result) {
  const ResultRun &best = result.best, &baseline = result.baseline;
  std::vector<internal::TextRow> rows;
  for (const Figure& f : all_figures) {
    const double own = internal::figure_of_run(best, f.member), step = internal::figure_of_run(baseline, f.member);
    if (std::isnan(own) && std::isnan(step)) continue;
    if (result.is_search) {
      rows.push_back({f.label(), internal::figure_text(f, step, baseline.errors[f], own),
                      internal::figure_text(f, own, best.errors[f], step), internal::figure_change(baseline, best, f).words});
    } else {
      const std::string cloud = internal::cloud_text(result, f);
      rows.push_back({f.label(), internal::figure_text(f, own, best.errors[f], Metrics::unset),
                      !cloud.empty()                  ? cloud
                      : std::isfinite(best.errors[f]) ? internal::error_text(f, own, best.errors[f])
                                                      : std::string()});
    }
  }
  std::vector<internal::TextColumn> columns{{.width = 36, .is_words = true}};
  for (const char* head : {"plain step", "found"}) {
    if (result.is_search) columns.push_back({.head = head, .width = 16});
  }
  if (!result.is_search) columns.push_back({.head = "value", .width = 16});
  columns.push_back({.head = result.is_search ? "change" : internal::error_heading(result), .is_words = true, .gap = 3});
  return internal::text_table(columns, rows);
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
      const bool fits = used + 1 + internal::display_width(word) <= columns;
      out += fits ? ' ' : '\n';
      used = fits ? used + 1 : 0;
    }
    out += word;
    used += internal::display_width(word);
  }
  return out;
}

std::string text_report(const Result& result) {
  std::string out = wrapped(internal::headline(result).whole()) + "\n\n";
  if (result.devices) {
    out += internal::devices_text(*result.devices) + "\n";
    out += result.devices->better_than_plain_step ? "best.toml on the drawing:\n" : "The plain step on the drawing:\n";
  }
  out += figures_text(result);
  // Of a winner that bounces there is nothing to confirm.
  const bool lands_softly = result.is_search && internal::figure_of_run(result.best, &Metrics::bounce_count) == 0;
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
