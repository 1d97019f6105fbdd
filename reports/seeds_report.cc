#include "reports/seeds_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include "document/quantity.h"
#include "reports/closing_prose.h"
#include "reports/study_members.h"
#include "sampling/statistics.h"

namespace softland {
namespace internal {

/// Least value, quartiles and largest value of a sample.
struct FiveNumbers {
  double least = Metrics::unset, lower_quartile = Metrics::unset, median = Metrics::unset, upper_quartile = Metrics::unset,
         most = Metrics::unset;
};
void members(Archive& a, FiveNumbers& numbers) {
  a("least", numbers.least, "least value");
  a("lower_quartile", numbers.lower_quartile, "lower quartile");
  a("median", numbers.median, "median");
  a("upper_quartile", numbers.upper_quartile, "upper quartile");
  a("most", numbers.most, "largest value");
}
struct FailedSeed {
  std::uint64_t seed = 0;
  std::string reason;
};
void members(Archive& a, FailedSeed& failed) {
  a("seed", failed.seed, "seed of the search");
  a("reason", failed.reason, "why it failed");
}
/// The common outcome of searches with several seeds.
struct SeedsSummary {
  std::int64_t goal_met = 0, confirmed = 0;  ///< numbers of searches
  std::vector<FailedSeed> failed;
  FiveNumbers cost;
  std::map<std::string, FiveNumbers> figures;
};

}  // namespace internal

namespace {

using namespace internal;
using nlohmann::json;

constexpr double worst = std::numeric_limits<double>::infinity();
constexpr std::array shown_figures{figure_of(&Metrics::initial_contact_time), figure_of(&Metrics::permanent_contact_time),
                                   figure_of(&Metrics::bounce_count), figure_of(&Metrics::major_bounce_height),
                                   figure_of(&Metrics::impact_velocity)};

double or_none(double value) { return std::isfinite(value) ? value : worst; }

FiveNumbers five_numbers(const std::vector<double>& sample) {
  if (sample.empty()) return {};
  const auto at = [&](double probability) { return sample_quantile(sample, probability); };
  return {.least = at(0), .lower_quartile = at(0.25), .median = at(0.5), .upper_quartile = at(0.75), .most = at(1)};
}

FiveNumbers spread_of_cost(const SeedsFindings& seeds) {
  std::vector<double> costs;
  for (const SearchOfSeed& one : seeds.searches) costs.push_back(or_none(one.cost));
  return five_numbers(costs);
}

FiveNumbers spread_of(const SeedsFindings& seeds, const Figure& figure) {
  std::vector<double> values;
  for (const SearchOfSeed& one : seeds.searches) {
    if (const double value = one.figures[figure]; std::isfinite(value)) values.push_back(value);
  }
  return five_numbers(values);
}

// Returns the reason why the search with one of the seeds failed; empty if the search succeeded.
std::string failure(const SearchOfSeed& one) {
  if (!std::isfinite(one.cost)) return "no feasible waveform";
  if (!one.better_than_baseline && !one.goal_met) return "no better than the plain step";
  return one.goal_met ? "" : "goal not met";
}

SeedsSummary seeds_summary(const SeedsFindings& seeds) {
  SeedsSummary all{.goal_met = std::ranges::count_if(seeds.searches, &SearchOfSeed::goal_met),
                   .confirmed = std::ranges::count_if(seeds.searches, &SearchOfSeed::confirmed),
                   .failed = {},
                   .cost = spread_of_cost(seeds),
                   .figures = {}};
  for (const SearchOfSeed& one : seeds.searches) {
    if (std::string why = failure(one); !why.empty()) all.failed.push_back({one.seed, std::move(why)});
  }
  for (const Figure& f : shown_figures) all.figures[std::string(f.key)] = spread_of(seeds, f);
  return all;
}

std::string outcome(const SearchOfSeed& one) {
  const std::string failed = failure(one);
  return !failed.empty() ? failed : one.confirmed ? "goal met, confirmed" : "goal met";
}

std::vector<std::string> search_cells(const SearchOfSeed& one) {
  std::vector<std::string> all{std::to_string(one.seed), outcome(one), quantity(one.cost, "", 4)};
  for (const Figure& f : shown_figures) all.push_back(figure_text(f, one.figures[f], Metrics::unset, Metrics::unset));
  all.push_back(std::isfinite(one.evaluations) ? internal::whole(one.evaluations) : "—");
  std::string ended = one.termination;
  std::replace(ended.begin(), ended.end(), '_', ' ');
  all.push_back(ended);
  return all;
}

std::vector<std::string> heads() {
  std::vector<std::string> all{"Seed", "Outcome", "Cost"};
  for (const Figure& f : shown_figures) all.emplace_back(f.name);
  all.insert(all.end(), {"Evaluations", "Stopped by"});
  return all;
}

}  // namespace

void rank(SeedsFindings& seeds, const Aim& target, double significant, bool over_devices) {
  const bool by_figure = !over_devices && !target.is_sum();
  const Figure& own = figure_of(target.parts()[0].target);
  const bool is_height = target.is_about(Target::bounce) || target.is_about(Target::rebound);
  const auto key = [&](const SearchOfSeed& one) {
    const double settled = one.figures[figure_of(&Metrics::settled)];
    const int belief = over_devices ? (one.goal_met ? 1 : 0) : one.confirmed ? 3 : one.goal_met ? 2 : settled == 1 ? 1 : 0;
    double figure = by_figure ? or_none(one.figures[own]) : 0;
    if (is_height && by_figure) figure = std::max(figure, significant);
    return std::tuple(-belief, figure, or_none(one.cost), one.seed);
  };
  const auto best = std::min_element(seeds.searches.begin(), seeds.searches.end(),
                                     [&](const auto& a, const auto& b) { return key(a) < key(b); });
  seeds.best = static_cast<std::size_t>(best - seeds.searches.begin());
}

void members(internal::Archive& a, SearchOfSeed& search) {
  a("seed", search.seed, "seed of the search");
  a("status", search.status, "outcome of the search");
  a("cost", search.cost, "its lowest cost");
  a("evaluations", search.evaluations, "number of evaluations");
  a("termination", search.termination, "why the search ended");
  a("goal_met", search.goal_met, "whether the goal of the target is met");
  a("confirmed", search.confirmed, "whether the confirmations agree");
  a("better_than_baseline", search.better_than_baseline, "whether the waveform is better than the plain step");
  a.object(
      "metrics", [&](auto& metrics) { metrics.figures(search.figures, internal::every_figure); },
      "figures under the found waveform");
}

void members(internal::Archive& a, SeedsFindings& seeds) {
  a("planned", seeds.planned, "planned number of searches");
  a("searches", seeds.searches, "completed searches, by seed");
  const auto seed_of = [&](std::size_t k) {
    return k < seeds.searches.size() ? nlohmann::json(seeds.searches[k].seed) : nlohmann::json();
  };
  a.custom(
      "best_seed", seeds.best, seed_of,
      [&](const nlohmann::json& seed) {
        std::size_t best = seeds.searches.size();
        while (best > 0 && seed_of(--best) != seed) {
        }
        return best;
      },
      internal::Like<std::uint64_t>{"seed of the best search"});
  if (!a.reads()) {
    const SeedsSummary summary = seeds_summary(seeds);
    a("goal_met", summary.goal_met, "number of searches that met the goal");
    a("confirmed", summary.confirmed, "number of searches that were confirmed");
    a("failed", summary.failed, "searches that failed");
    a("cost", summary.cost, "costs of the searches");
    a("metrics", summary.figures, "figures of the searches, by key");
  }
}

void members(internal::Archive& a, SeedsRecord& record) {
  members(a, record.origin);
  a.derived("status", std::string("interrupted"), "`interrupted`: a complete study has the JSON of its best search");
  a("seeds", record.seeds, "searches so far");
}

json json_of(const SeedsRecord& record) { return internal::record_json(record); }

SeedsRecord read_seeds(const json& from) { return internal::whole_record<SeedsRecord>(from); }

std::string text_of(const SeedsRecord& record) { return terminal_text({.sections = {seeds_section(record.seeds)}}); }

namespace internal {

std::string seeds_caption(const SeedsFindings& seeds) {
  const std::size_t count = seeds.searches.size();
  if (count == 0) return fmt::format("None of {} searches is done.", seeds.planned);
  std::string words = count < seeds.planned ? fmt::format("{} of {} searches are done.", count, seeds.planned)
                                            : fmt::format("{} searches, each with its own seed.", count);
  const SearchOfSeed& best = seeds.searches.at(seeds.best);
  if (!std::isfinite(best.cost)) return words + " None of them found a feasible waveform.";
  words += fmt::format(" The best is that of seed {}, with cost {}.", best.seed, quantity(best.cost, "", 4));
  const FiveNumbers cost = spread_of_cost(seeds);
  const auto number = [](double value) { return value == worst ? std::string("none") : quantity(value, "", 4); };
  words += fmt::format(" Cost: median {}, quartiles {} and {}, from {} to {}.", number(cost.median), number(cost.lower_quartile),
                       number(cost.upper_quartile), number(cost.least), number(cost.most));
  std::string failed;
  std::size_t failures = 0;
  constexpr std::size_t most_named = 12;
  for (const SearchOfSeed& one : seeds.searches) {
    const std::string why = failure(one);
    if (why.empty()) continue;
    if (++failures <= most_named) failed += fmt::format("{}{} ({})", failed.empty() ? "" : ", ", one.seed, why);
  }
  if (failures == 0) return words + (count == 1 ? " It meets the goal." : " All of them meet the goal.");
  if (failures > most_named) failed += fmt::format(" and {} more", failures - most_named);
  return words + fmt::format(" {} of {} fail; their seeds are {}.", failures, count, failed);
}

ReportSection seeds_section(const SeedsFindings& seeds) {
  ReportTable table;
  for (const std::string& name : heads()) table.head.emplace_back(name);
  table.head[1].style = table.head.back().style = "words";
  for (std::size_t k = 0; k < seeds.searches.size(); ++k) {
    TableRow& row = table.rows.emplace_back();
    for (const std::string& word : search_cells(seeds.searches[k])) row.emplace_back(word, k == seeds.best ? "own" : "");
  }
  return {.id = "seeds", .heading = "Searches with other seeds", .parts = {Paragraph{seeds_caption(seeds)}, std::move(table)}};
}

}  // namespace internal

}  // namespace softland
