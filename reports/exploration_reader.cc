#include "reports/exploration_reader.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "config/plan.h"
#include "studies/exploration/stored_exploration.h"

namespace softland {
namespace {

using nlohmann::json;

constexpr std::size_t most_waveforms = 400;  // largest number of waveforms that are shown for a Pareto front

Plan plan_of(const StudyReader& store) { return Plan(exploration_in(store)); }

}  // namespace

ExplorationReport read_exploration(const StudyReader& store, const std::string& pareto) {
  const StoredPlan& stored = store.plan();
  const Plan plan = plan_of(store);
  ExplorationReport report{.title = plan.base().json().value("title", ""), .study = plan.study()};
  report.columns = explored_columns(stored);
  report.planned = stored.shard.size(stored.points);
  store.read([&](const StoredRow& row) {
    report.points.push_back({.number = row.point, .status = row.status, .reason = row.reason, .values = row.values});
    if (row.extra.empty()) return;
    const json extra = json::parse(row.extra, nullptr, false);
    if (!extra.is_object() || !extra.contains("waveforms")) return;
    try {
      extra.at("waveforms").get_to(report.waveforms[row.point]);
    } catch (const json::exception&) {
      report.waveforms.erase(row.point);  // leave out a waveform in the format of another version of the program
    }
  });
  if (!pareto.empty() || plan.is_search()) report.aims = explored_aims(report.columns, pareto.empty() ? plan.pareto() : pareto);
  report.plan = stored.text;
  if (const std::vector<StoredSession> sessions = store.sessions(); !sessions.empty()) {
    report.command = sessions.back().command;
    report.made_with = fmt::format("{} on {}", sessions.back().program, sessions.back().processor);
  }
  return report;
}

void add_front_waveforms(ExplorationReport& report, const StudyReader& store, const Progress& progress) {
  if (report.aims.empty()) return;
  const ExploredFront front = explored_front(report);
  if (front.members.size() > most_waveforms) return;
  const Plan plan = plan_of(store);
  std::optional<Exploration> exploration;
  for (std::size_t i = 0; i < front.members.size(); ++i) {
    const ExploredPoint& point = report.points[front.members[i]];
    if (report.waveforms.contains(point.number)) continue;
    if (!exploration) exploration.emplace(plan, progress);
    progress.tell("waveforms of the front", static_cast<double>(i) / static_cast<double>(front.members.size()));
    const std::vector<double> values(point.values.begin(),
                                     point.values.begin() + static_cast<std::ptrdiff_t>(plan.variables().size()));
    for (auto& [drive, line] : exploration->waveforms(plan.scene(values), progress)) {
      Points& points = report.waveforms[point.number][drive];
      for (const auto& [time, level] : line) points.push_back({time, level});
    }
  }
}

}  // namespace softland
