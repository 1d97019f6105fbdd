// Lists the members of ClosingRecord (the results of a closing or a search) and of its parts, with their names in JSON, for
// writing and reading: see reports/record.h.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reports/closing_record.h"
#include "reports/record.h"
#include "reports/robustness_report.h"

namespace softland {

namespace internal {

inline bool every_figure(const Figure&) { return true; }
inline bool figure_of_no_drive(const Figure& figure) { return figure.conditioning != Conditioning::drives; }
/// Returns true if each of several contacts has its own value of this figure of merit.
inline bool figure_of_contact(const Figure& figure) {
  if (figure.key == key_of(&Metrics::drive_energy)) return false;
  const bool is_at_rest = figure.conditioning == Conditioning::rest || figure.conditioning == Conditioning::open;
  return figure_of_no_drive(figure) && (!is_at_rest || figure.key == key_of(&Metrics::hold_force) || figure.asked != nullptr);
}
inline bool figure_of_number(const Figure& figure) { return !figure.is_yes_or_no(); }

// Lists status and figures of merit of a run: in JSON, the status is a member of the object that holds the figures.
template <class A, class Asked>
void figures_and_status(A& a, FigureValues& figures, std::string& status, const Asked& asked) {
  a.object("metrics", [&](auto& metrics) {
    metrics.figures(figures, asked);
    metrics("status", status);
  });
}
template <class A, class Asked>
void figures_and_status(A& a, std::optional<FigureValues>& figures, std::string& status, const Asked& asked) {
  a.object("metrics", [&](auto& metrics) {
    if (metrics.reads) figures.emplace();
    metrics.figures(*figures, asked);
    metrics("status", status);
  });
}
template <class A>
void figure_errors(A& a, FigureValues& errors) {
  a.object("errors", [&](auto& inside) { inside.figures(errors, figure_of_number); });
}

/// Returns true if the JSON of a closing also has the members of a search.
[[nodiscard]] bool is_of_search(const nlohmann::json& record);
[[nodiscard]] nlohmann::json rebounds_json(const std::vector<Rebound>& rebounds);
[[nodiscard]] std::vector<Rebound> read_rebounds(const nlohmann::json& rows);
[[nodiscard]] nlohmann::json closed_json(const std::optional<std::vector<ClosedStretch>>& closed);
[[nodiscard]] std::optional<std::vector<ClosedStretch>> read_closed(const nlohmann::json& rows);
[[nodiscard]] nlohmann::json closed_contacts_json(const std::map<std::string, std::vector<ClosedStretch>>& closed);
[[nodiscard]] std::map<std::string, std::vector<ClosedStretch>> read_closed_contacts(const nlohmann::json& closed);
[[nodiscard]] nlohmann::json counted_json(const Points& points);
[[nodiscard]] Points read_points(const nlohmann::json& points);
[[nodiscard]] nlohmann::json pull_in_json(const std::map<std::string, PullInOfElectrode>& pull_in);
[[nodiscard]] std::map<std::string, PullInOfElectrode> read_pull_in(const nlohmann::json& pull_in);
[[nodiscard]] nlohmann::json static_by_modes_json(const std::optional<ByModes>& found);
[[nodiscard]] std::optional<ByModes> read_static_by_modes(const nlohmann::json& found);
[[nodiscard]] nlohmann::json certified_json(const std::vector<IllConditioned>& figures);
[[nodiscard]] std::vector<IllConditioned> read_certified(const nlohmann::json& figures);
[[nodiscard]] inline std::string integrator_name(Integrator integrator) { return std::string(to_string(integrator)); }
[[nodiscard]] Integrator read_integrator(const nlohmann::json& name);
/// These functions write numbers of the closed state that were computed with several numbers of modes: the least eigenvalue of
/// the stiffness, or for each electrode the voltage at which the beam collapses onto it. JSON is null if no modes could be
/// added to those of the scene.
[[nodiscard]] nlohmann::json eigenvalues_json(const std::optional<ByModes>& found);
[[nodiscard]] nlohmann::json voltages_json(const std::map<std::string, ByModes>& of_electrodes);
[[nodiscard]] std::map<std::string, ByModes> read_voltages(const nlohmann::json& of_electrodes);
[[nodiscard]] HoldWindows read_windows(const nlohmann::json& windows);
/// Writes the waveforms among which the user can choose, each with the percentiles of its figures of merit over the devices.
[[nodiscard]] nlohmann::json choices_json(const DevicesFindings& devices);
/// Writes how many searches with different seeds met their goal, were confirmed, or failed, and the spread of their costs and
/// figures of merit.
[[nodiscard]] nlohmann::json seeds_summary(const SeedsFindings& seeds);

}  // namespace internal

template <class A>
void members(A& a, MadeWith& made) {
  using internal::OrNull;
  a("program", OrNull{made.program});
  a("compiler", OrNull{made.compiler});
  a("options", OrNull{made.options});
  a("instruction_set", OrNull{made.instruction_set});
  a("vectors", OrNull{made.vectors});
  a("c_library", OrNull{made.c_library});
  a("processor", OrNull{made.processor});
}

/// Writes or reads the origin of results: verb, program, machine, command line and scene. The JSON of every verb begins with
/// it.
template <class A>
void members(A& a, Origin& origin) {
  a("kind", origin.kind);
  a("version", origin.version);
  a("made_with", origin.made_with);
  a("command", origin.command);
  if (a.has(!origin.scene.is_null())) a("scene", origin.scene);
  if (a.has(!origin.scene_toml.empty())) a("scene_toml", origin.scene_toml);
}

template <class A>
void members(A& a, ShownMotion::Contact& contact) {
  a("name", contact.name);
  a("at_m", contact.at);
  a("gap_m", contact.gap);
  a("far_side", contact.far_side);
}
template <class A>
void members(A& a, ShownMotion::Pad& pad) {
  a("electrode", pad.electrode);
  a("begin_m", pad.begin);
  a("end_m", pad.end);
  a("gap_m", pad.gap);
  a("far_side", pad.far_side);
}
template <class A>
void members(A& a, ShownMotion& motion) {
  a("time_s", motion.time);
  a("amplitudes_m", motion.amplitudes);
  a("x_m", motion.places);
  a("rest_m", motion.rest);
  a("shapes", motion.shapes);
  a("contacts", motion.contacts);
  a("electrodes", motion.electrodes);
}

template <class A>
void members(A& a, CurveRecord& curve) {
  a("time_s", curve.time);
  a("tip_gap_m", curve.gap);
  a("tip_velocity_m_s", curve.velocity);
  a("contact_force_N", curve.force);
  if (a.has(!curve.resistance.empty())) a("contact_resistance_ohm", curve.resistance);
  a.custom("rebounds", curve.rebounds, internal::rebounds_json, internal::read_rebounds);
  if (a.has(curve.closed.has_value())) a.custom("closed", curve.closed, internal::closed_json, internal::read_closed);
  if (a.has(!curve.closed_contacts.empty()))
    a.custom("closed_contacts", curve.closed_contacts, internal::closed_contacts_json, internal::read_closed_contacts);
  a("motion", curve.motion);
}

template <class A>
void members(A& a, RunRecord& run) {
  internal::figures_and_status(a, run.figures, run.status, internal::every_figure);
  a("collapse_time_s", run.collapse_time);
  a("waveforms", run.waveforms);
}

template <class A>
void members(A& a, ContactFigures& contact) {
  a("gap_m", contact.gap);
  a.figures(contact.figures, internal::figure_of_contact);
}

template <class A>
void members(A& a, ConfirmationRecord& check) {
  a("name", check.name);
  internal::figures_and_status(a, check.figures, check.status, internal::figure_of_no_drive);
}

template <class A>
void members(A& a, EffectsLeftOut::LeftOut& one) {
  a("effect", one.effect);
  a("influence", one.influence);
}
template <class A>
void members(A& a, EffectsLeftOut& effects) {
  a("left_out", effects.left_out);
  a("influence", effects.influence);
}

template <class A>
void members(A& a, Spread& spread) {
  a("median", spread.median);
  a("low", spread.low);
  a("high", spread.high);
  a("runs", spread.runs);
}

template <class A>
void members(A& a, GrazingRebound& rebound) {
  a("rebound", rebound.number);
  a("time_s", rebound.time);
  a("height_m", rebound.height);
  a(key_of(&Metrics::impact_velocity), rebound.impact_velocity);
  a("at_significant_height", rebound.at_threshold);
}

template <class A>
void members(A& a, ClosedState& state) {
  a("exists", state.exists);
  a("stable", internal::OrNull{state.stable});
  a("smallest_eigenvalue_rad2_s2", state.smallest_eigenvalue);
  a("pulled_through_V", state.pulled_through);
  a.custom("by_modes", state.by_modes, internal::eigenvalues_json, internal::read_by_modes);
  a.custom("pulled_through_by_modes_V", state.pulled_through_by_modes, internal::voltages_json, internal::read_voltages);
}

template <class A>
void members(A& a, PullInOfElectrode& volts) {
  a("static_V", volts.static_pull_in);
  a("dynamic_V", volts.dynamic_pull_in);
  a.custom("by_modes", volts.static_by_modes, internal::static_by_modes_json, internal::read_static_by_modes);
}

template <class A>
void members(A& a, Work& work) {
  a.custom("integrator", work.integrator, internal::integrator_name, internal::read_integrator);
  a("steps", work.steps);
  a("rhs_evaluations", work.rhs_evaluations);
  a("wall_s", work.wall);
}

template <class A>
void members(A& a, TouchLimit& limit) {
  a("least_time_s", limit.least_time);
  a(key_of(&Metrics::impact_velocity), limit.impact_velocity);
}

template <class A>
void members(A& a, SearchedFamilyResult& one) {
  a("family", one.family);
  a("evaluations", one.evaluations);
  a("cost", one.cost);
}

template <class A>
void members(A& a, FulfilledCondition& condition) {
  a("condition", condition.text);
  a("share", condition.share.value);
  a.pair("interval", condition.share.interval.low, condition.share.interval.high);
  a("holds", condition.holds);
}

template <class A>
void members(A& a, RobustFindings& robust) {
  a("measure", robust.measure);
  a("devices", robust.devices);
  a("fresh_devices", robust.fresh_devices);
  a("closings", robust.closings);
  a("cost_on_searched_devices", robust.cost_on_searched);
  a("failing_share", robust.failing);
  a("measure_tells", robust.is_told);
  a("yield", robust.yield);
  a("conditions", robust.conditions);
}

template <class A>
void members(A& a, DevicesFindings::Row& row) {
  a("name", row.name);
  a.object("knowledge", [&](auto& knowledge) {
    knowledge("Vdp", row.pull_in_error);
    knowledge("frequency", row.frequency_error);
    knowledge("piezo", row.piezo_error);
    knowledge("time_s", row.time_error);
  });
  a("searched_for_it", row.searched_for_it);
  a("bounce_free", row.bounce_free);
  a("does_not_close", row.open);
  a("collapsed_onto_electrode", row.collapsed);
  a("quantile_50", internal::OrInfinite{row.at_50});
  a("quantile_95", internal::OrInfinite{row.at_95});
  a("quantile_99", internal::OrInfinite{row.at_99});
  a("yield", row.yield);
}

template <class A>
void members(A& a, DevicesFindings::Choice& choice) {
  a("name", choice.name);
  a("file", choice.file);
  a("waveform", choice.waveform);
  a("tau", choice.tau);
}

template <class A>
void members(A& a, DevicesFindings::StablePath& path) {
  a("drives", path.drives);
  a("share_of_devices", path.share);
  a("reaches_V", path.reaches);
  a("limit_V", path.limit);
  a("touch_places_m", path.touch_places);
  a("rise_s", path.rise);
}

template <class A>
void members(A& a, DevicesFindings::Courses& courses) {
  a("end_s", courses.end);
  a("unit_m", courses.unit);
  a("plain_step", courses.step);
  a("best", courses.own);
}

template <class A>
void members(A& a, FrontPoint& point) {
  a(key_of(&Metrics::initial_contact_time), point.first_touch);
  a(key_of(&Metrics::largest_impact_velocity), point.impact_speed);
  a("bounce_free", point.bounce_free);
  a("candidate", point.candidate);
}

template <class A>
void members(A& a, CalibrationError& known) {
  a("error", known.error);
  a("bounce_free", known.bounce_free);
  a(key_of(&Metrics::largest_impact_velocity), internal::OrInfinite{known.impact_speed});
}

template <class A>
void members(A& a, TournamentEntry& contender) {
  a("measure", contender.measure);
  a("waveform", contender.waveform);
  a("closings", contender.closings);
  a("cost", contender.cost);
  a("bounce_free", contender.bounce_free);
}

template <class A>
void members(A& a, DevicesFindings& devices) {
  a("spread_assumed", devices.spread_assumed);
  a("spread", devices.spread);
  a("count", devices.count);
  a("seed", devices.seed);
  a("closings", devices.closings);
  a.object("chosen", [&](auto& chosen) {
    chosen("measure", devices.measure);
    chosen("waveform", devices.waveform);
  });
  a("better_than_plain_step", devices.better_than_plain_step);
  a("worse_in", devices.worse_in);
  a("rows", devices.rows);
  a.custom(
      "choices", devices.choices, [&](const auto&) { return internal::choices_json(devices); },
      internal::JsonReader::read<std::vector<DevicesFindings::Choice>>);
  a("stable_path", internal::OrNull{devices.stable_path});
  a("goal_met", devices.goal_met);
  a("missed_by_m", devices.missed_by);
  a("step_delay_s", devices.step_delay);
  a("gaps", devices.courses);
  a("front", devices.front);
  a("by_error_of_Vdp", devices.by_error);
  a.custom("hold_window_V", devices.windows, internal::windows_json, internal::read_windows);
  a("hold_window_devices", devices.windows.devices);
  a("race", devices.tournament);
  a("conditions", devices.conditions);
  a("measured", devices.measured);
  a("next_command", devices.next_command);
}

template <class A>
void members(A& a, SearchOfSeed& search) {
  a("seed", search.seed);
  a("status", search.status);
  a("cost", search.cost);
  a("evaluations", search.evaluations);
  a("termination", search.termination);
  a("goal_met", search.goal_met);
  a("confirmed", search.confirmed);
  a("better_than_baseline", search.better_than_baseline);
  a.object("metrics", [&](auto& metrics) { metrics.figures(search.figures, internal::every_figure); });
}

template <class A>
void members(A& a, SeedsFindings& seeds) {
  a("planned", seeds.planned);
  a("searches", seeds.searches);
  const auto seed_of = [&](std::size_t k) {
    return k < seeds.searches.size() ? nlohmann::json(seeds.searches[k].seed) : nlohmann::json();
  };
  a.custom("best_seed", seeds.best, seed_of, [&](const nlohmann::json& seed) {
    std::size_t best = seeds.searches.size();
    while (best > 0 && seed_of(--best) != seed) {
    }
    return best;
  });
  if constexpr (!A::reads) {
    const nlohmann::json summary = internal::seeds_summary(seeds);
    for (const auto& [key, value] : summary.items()) a(key, value);
  }
}

/// The members of a search are at the same level of the JSON as the members of the closing that the search found.
template <class A>
void members_of_search(A& a, SearchRecord& search, ClosingRecord& closing) {
  a("target", search.target);
  a("actuator", search.actuator);
  a("waveform", search.waveform);
  if (a.has(!search.families.empty())) a("families", search.families);
  a("seed", search.seed);
  a("optimizer", search.optimizer);
  a("evaluations", internal::Count{search.evaluations});
  a("termination", search.termination);
  a("termination_message", search.termination_message);
  a("goal_met", search.goal_met);
  a("better_than_baseline", search.better_than_baseline);
  a("plain_step_wins", search.plain_step_wins);
  a("harder_than_step", search.harder_than_step);
  a.object("baseline", [&](auto& baseline) {
    members(baseline, search.baseline);
    internal::figure_errors(baseline, search.baseline.errors);
    baseline("cost", search.baseline.cost);
  });
  a.object("curves", [&](auto& curves) { curves("baseline", search.baseline.curve); });
  a.object("search", [&](auto& course) {
    course("value_name", search.course.value_name);
    course.custom("best_so_far", search.course.best_so_far, internal::counted_json, internal::read_points);
    if (course.has(!search.course.evaluations.empty()))
      course.custom("evaluations", search.course.evaluations, internal::counted_json, internal::read_points);
  });
  a("reproduce", search.reproduce);
  a("robust", search.robust);
  a("devices", search.devices);
  a("seeds", search.seeds);
  if (search.devices) {
    a.object("drawing", [&](auto& nominal) {
      internal::figures_and_status(nominal, search.devices->nominal, search.devices->nominal_status, internal::every_figure);
      nominal("goal_met", search.devices->nominal_goal_met);
    });
  }
  a("limit", search.limit);
  if (!a.has(closing.best.figures.has_value())) return;
  a.object("best", [&](auto& best) {
    best("parameters", search.parameters);
    best("bounds", search.bounds);
    best("cost", closing.best.cost);
  });
  a("checks", search.checks);
  if (a.has(!search.checks.empty())) a("evaluations_with_more_modes", internal::Count{search.evaluations_of_modes});
}

/// Members that are computed from other members are written in closing_json.cc.
template <class A>
void members(A& a, ClosingRecord& record) {
  members(a, record.origin);
  a("status", record.status);
  a.custom("pull_in", record.pull_in, internal::pull_in_json, internal::read_pull_in);
  a("warnings", record.warnings);
  a("title", record.title);
  a("natural_frequencies_rad_s", record.natural_frequencies);
  a("tolerance", record.tolerance);
  if (a.has(!record.message.empty())) a("message", record.message);
  a("effects", record.effects);
  a.object("curves", [&](auto& curves) {
    if (curves.has(record.best.figures.has_value())) curves("best", record.best.curve);
  });
  if (a.has(record.best.figures.has_value())) {
    a.object("metrics", [&](auto& metrics) {
      if (metrics.reads) record.best.figures.emplace();
      metrics.figures(*record.best.figures, internal::every_figure);
    });
    a.object("best", [&](auto& best) { members(best, record.best); });
    internal::figure_errors(a, record.best.errors);
  }
  if (a.has(!record.contacts.empty())) a("contacts", record.contacts);
  a("closed_state", record.closed_state);
  a("work", record.work);
  if constexpr (A::reads) {
    if (internal::is_of_search(a.whole())) record.search.emplace();
    a.object("certified", [&](auto&) { record.certificate.emplace(); });
  }
  if (record.search) members_of_search(a, *record.search, record);
  if (!record.certificate) return;
  a.custom("certified", record.certificate->ill_conditioned, internal::certified_json, internal::read_certified);
  a.object("cloud", [&](auto& cloud) {
    cloud("runs", record.certificate->runs);
    cloud("grazing_rebound", internal::OrNull{record.certificate->grazing});
  });
}

}  // namespace softland
