// Lists the members of the record of a closing and of its parts, with their names in JSON and their meaning: see
// reports/record.h.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "objectives/figure_values.h"
#include "reports/closing_record.h"
#include "reports/devices_members.h"
#include "reports/record.h"
#include "reports/robustness_report.h"

namespace softland {

namespace internal {

inline constexpr FigureGroup every_figure{[](const Figure&) { return true; }, "every figure of one run"};
inline constexpr FigureGroup figure_of_no_drive{[](const Figure& figure) { return figure.conditioning != Conditioning::drives; },
                                                "every figure of one run, except those of the drives"};
/// The figures of which each of several contacts has its own value.
inline constexpr FigureGroup figure_of_contact{
    [](const Figure& figure) {
      if (figure.key == key_of(&Metrics::drive_energy)) return false;
      const bool is_at_rest = figure.conditioning == Conditioning::rest || figure.conditioning == Conditioning::open;
      return figure_of_no_drive.has(figure) &&
             (!is_at_rest || figure.key == key_of(&Metrics::hold_force) || figure.asked != nullptr);
    },
    "figures of one contact"};
inline constexpr FigureGroup figure_of_number{[](const Figure& figure) { return !figure.is_yes_or_no(); },
                                              "error of the figure, in its unit"};

// Lists status and figures of a run: in JSON, the status is a member of the object that holds the figures.
inline constexpr const char *figures_about = "figures of the run", *status_about = "outcome of the run";
inline void figures_and_status(Archive& a, FigureValues& figures, std::string& status, const FigureGroup& group) {
  a.object(
      "metrics",
      [&](auto& metrics) {
        metrics.figures(figures, group);
        metrics("status", status, status_about);
      },
      figures_about);
}
inline void figures_and_status(Archive& a, std::optional<FigureValues>& figures, std::string& status, const FigureGroup& group) {
  a.object(
      "metrics",
      [&](auto& metrics) {
        if (metrics.reads() || !figures) figures.emplace();
        metrics.figures(*figures, group);
        metrics("status", status, status_about);
      },
      figures_about);
}
inline void figure_errors(Archive& a, FigureValues& errors) {
  a.object(
      "errors", [&](auto& inside) { inside.figures(errors, figure_of_number); }, "errors of the figures");
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

/// Least value, quartiles and largest value of a sample.
struct FiveNumbers {
  double least = Metrics::unset, lower_quartile = Metrics::unset, median = Metrics::unset, upper_quartile = Metrics::unset,
         most = Metrics::unset;
};
inline void members(Archive& a, FiveNumbers& numbers) {
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
inline void members(Archive& a, FailedSeed& failed) {
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
[[nodiscard]] SeedsSummary seeds_summary(const SeedsFindings& seeds);

}  // namespace internal

inline void members(internal::Archive& a, MadeWith& made) {
  using internal::OrNull;
  a("program", OrNull{made.program}, "hash of the program");
  a("compiler", OrNull{made.compiler}, "compiler that built the program");
  a("options", OrNull{made.options}, "compiler options");
  a("instruction_set", OrNull{made.instruction_set}, "instructions for which the program was built");
  a("vectors", OrNull{made.vectors}, "vector instructions in use");
  a("c_library", OrNull{made.c_library}, "C library");
  a("processor", OrNull{made.processor}, "processor of the machine");
}

/// Writes or reads the origin of results: verb, program, machine, command line and scene. The JSON of every verb begins with
/// it.
inline void members(internal::Archive& a, Origin& origin) {
  a("kind", origin.kind, "verb that made the record");
  a("version", origin.version, "version of softland");
  a("made_with", origin.made_with, "what the last digits of the numbers depend on");
  a("command", origin.command, "command line");
  if (a.has(!origin.scene.is_null()))
    a("scene", origin.scene, "scene with all defaults, by section and key; quantities are texts");
  if (a.has(!origin.scene_toml.empty())) a("scene_toml", origin.scene_toml, "the same scene as the text of a scene file");
}

inline void members(internal::Archive& a, ShownMotion::Contact& contact) {
  a("name", contact.name, "name of the contact; may be empty if there is one");
  a("at_m", contact.at, "position along the structure");
  a("gap_m", contact.gap, "rest distance to its contact plane");
  a("far_side", contact.far_side, "whether the contact is on the far side");
}
inline void members(internal::Archive& a, ShownMotion::Pad& pad) {
  a("electrode", pad.electrode, "name of the electrode");
  a("begin_m", pad.begin, "begin along the structure");
  a("end_m", pad.end, "end along the structure");
  a("gap_m", pad.gap, "rest distance of its face to a straight structure");
  a("far_side", pad.far_side, "whether the electrode is on the far side");
}
inline void members(internal::Archive& a, ShownMotion& motion) {
  a("time_s", motion.time, "instants");
  a("amplitudes_m", motion.amplitudes, "largest deflection of each mode at each instant");
  a("x_m", motion.places, "positions along the structure");
  a("rest_m", motion.rest, "height of the lower face at rest at each position");
  a("shapes", motion.shapes, "shape of each mode at the positions, scaled to a largest size of 1");
  a("contacts", motion.contacts, "contacts of the structure");
  a("electrodes", motion.electrodes, "electrodes of the structure");
}

inline void members(internal::Archive& a, CurveRecord& curve) {
  a("time_s", curve.time, "time since the start of the run");
  a("tip_gap_m", curve.gap, "distance of the contact point to the contact plane");
  a("tip_velocity_m_s", curve.velocity, "velocity of the contact point towards the contact");
  a("contact_force_N", curve.force, "contact force");
  if (a.has(!curve.resistance.empty()))
    a("contact_resistance_ohm", curve.resistance,
      "resistance of the connection, null while it is open; for contacts with a resistivity");
  a.custom(
      "rebounds", curve.rebounds, internal::rebounds_json, internal::read_rebounds,
      internal::Like<std::vector<std::array<double, 4>>>{"rebounds: begin [s], end [s], height [m], time of that height [s]"});
  if (a.has(curve.closed.has_value()))
    a.custom("closed", curve.closed, internal::closed_json, internal::read_closed,
             internal::Like<std::vector<std::array<double, 3>>>{
                 "times in which the contact is closed: begin [s], end [s] (null: to the end of the run), touches"});
  if (a.has(!curve.closed_contacts.empty()))
    a.custom("closed_contacts", curve.closed_contacts, internal::closed_contacts_json, internal::read_closed_contacts,
             internal::Like<std::map<std::string, std::vector<std::array<double, 3>>>>{"the same for each of several contacts"});
  a("motion", curve.motion, "motion of the whole structure; none if the run stopped early");
}

inline void members(internal::Archive& a, RunRecord& run) {
  internal::figures_and_status(a, run.figures, run.status, internal::every_figure);
  a("collapse_time_s", run.collapse_time, "time at which the beam touched the electrode");
  a("waveforms", run.waveforms, "waveform of each drive: time [s], level [V]; of a dispersion force its factor");
}

inline void members(internal::Archive& a, ContactFigures& contact) {
  a("gap_m", contact.gap, "rest distance to its contact plane");
  a.figures(contact.figures, internal::figure_of_contact);
}

inline void members(internal::Archive& a, ConfirmationRecord& check) {
  a("name", check.name, "what differs in the repeated simulation");
  internal::figures_and_status(a, check.figures, check.status, internal::figure_of_no_drive);
}

inline void members(internal::Archive& a, EffectsLeftOut::LeftOut& one) {
  a("effect", one.effect, "name of the effect");
  a("influence", one.influence, "estimated relative influence on the figures");
}
inline void members(internal::Archive& a, EffectsLeftOut& effects) {
  a("left_out", effects.left_out, "effects that were left out");
  a("influence", effects.influence, "estimated relative influence of all of them together");
}

inline void members(internal::Archive& a, Spread& spread) {
  a("median", spread.median, "median over the perturbed runs");
  a("low", spread.low, "smallest value");
  a("high", spread.high, "largest value");
  a("runs", spread.runs, "number of runs");
}

inline void members(internal::Archive& a, GrazingRebound& rebound) {
  a("rebound", rebound.number, "number of the rebound, from 1");
  a("time_s", rebound.time, "begin of the rebound");
  a("height_m", rebound.height, "its height");
  a(key_of(&Metrics::impact_velocity), rebound.impact_velocity, "impact velocity of the touch before it");
  a("at_significant_height", rebound.at_threshold,
    "true: significant in some runs only; false: the touch before it is the slowest so far");
}

inline void members(internal::Archive& a, ClosedState& state) {
  a("exists", state.exists, "whether there is an equilibrium with a contact force");
  a("stable", internal::OrNull{state.stable}, "whether it is stable");
  a("smallest_eigenvalue_rad2_s2", state.smallest_eigenvalue, "smallest eigenvalue of the stiffness relative to the mass");
  a("pulled_through_V", state.pulled_through, "by electrode, voltage above which the closed beam collapses onto it");
  a.custom("by_modes", state.by_modes, internal::eigenvalues_json, internal::read_by_modes,
           internal::Like<std::map<std::string, double>>{"smallest eigenvalue by number of modes"});
  a.custom("pulled_through_by_modes_V", state.pulled_through_by_modes, internal::voltages_json, internal::read_voltages,
           internal::Like<std::map<std::string, std::map<std::string, double>>>{
               "by electrode, collapse voltage by number of modes; `converged`: extrapolated"});
}

inline void members(internal::Archive& a, PullInOfElectrode& volts) {
  a("static_V", volts.static_pull_in, "static pull-in voltage");
  a("dynamic_V", volts.dynamic_pull_in, "dynamic pull-in voltage");
  a.custom("by_modes", volts.static_by_modes, internal::static_by_modes_json, internal::read_static_by_modes,
           internal::Like<std::map<std::string, std::map<std::string, double>>>{
               "`static_V` by number of modes; `converged`: extrapolated"});
}

inline void members(internal::Archive& a, Work& work) {
  a.custom("integrator", work.integrator, internal::integrator_name, internal::read_integrator,
           internal::Like<std::string>{"integrator of the run"});
  a("steps", work.steps, "number of steps");
  a("rhs_evaluations", work.rhs_evaluations, "number of evaluations of the right-hand side");
  a("wall_s", work.wall, "elapsed time");
}

inline void members(internal::Archive& a, TouchLimit& limit) {
  a("least_time_s", limit.least_time, "least closing time of any waveform with at most this impact velocity");
  a(key_of(&Metrics::impact_velocity), limit.impact_velocity, "impact velocity of the best waveform");
}

inline void members(internal::Archive& a, SearchedFamilyResult& one) {
  a("family", one.family, "waveform family");
  a("evaluations", one.evaluations, "number of its evaluations");
  a("cost", one.cost, "its lowest cost");
}

inline void members(internal::Archive& a, SearchOfSeed& search) {
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

inline void members(internal::Archive& a, SeedsFindings& seeds) {
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
    const internal::SeedsSummary summary = internal::seeds_summary(seeds);
    a("goal_met", summary.goal_met, "number of searches that met the goal");
    a("confirmed", summary.confirmed, "number of searches that were confirmed");
    a("failed", summary.failed, "searches that failed");
    a("cost", summary.cost, "costs of the searches");
    a("metrics", summary.figures, "figures of the searches, by key");
  }
}

/// The members of a search are at the same level of the JSON as the members of the closing that the search found.
inline void members_of_search(internal::Archive& a, SearchRecord& search, ClosingRecord& closing) {
  a("target", search.target, "target of the search");
  a("actuator", search.actuator, "drives that were searched");
  a("waveform", search.waveform, "waveform family of the best waveform");
  if (a.has(!search.families.empty())) a("families", search.families, "results by waveform family, if several were searched");
  a("seed", search.seed, "seed of the search");
  a("optimizer", search.optimizer, "optimizer");
  a("evaluations", internal::Count{search.evaluations}, "number of evaluations");
  a("termination", search.termination, "why the search ended");
  a("termination_message", search.termination_message, "the same in words");
  a("goal_met", search.goal_met, "whether the goal of the target is met");
  a("better_than_baseline", search.better_than_baseline, "whether the best waveform is better than the plain step");
  a("plain_step_wins", search.plain_step_wins, "whether the plain step has the lower cost");
  a("harder_than_step", search.harder_than_step,
    "factor by which the waveform exceeds the plain step in voltage or slew, the larger one");
  a.object(
      "baseline",
      [&](auto& baseline) {
        members(baseline, search.baseline);
        internal::figure_errors(baseline, search.baseline.errors);
        baseline("cost", search.baseline.cost, "cost of the run");
      },
      "run under the plain step");
  a.object(
      "curves", [&](auto& curves) { curves("baseline", search.baseline.curve, "run under the plain step"); },
      "curves of the runs, in files only");
  a.object(
      "search",
      [&](auto& course) {
        course("value_name", search.course.value_name, "name of the minimised value");
        course.custom("best_so_far", search.course.best_so_far, internal::counted_json, internal::read_points,
                      internal::Like<std::vector<std::array<double, 2>>>{"evaluation, and least value until then"});
        if (course.has(!search.course.evaluations.empty()))
          course.custom("evaluations", search.course.evaluations, internal::counted_json, internal::read_points,
                        internal::Like<std::vector<std::array<double, 2>>>{"evaluation, and its value; null: infeasible"});
      },
      "course of the search, in files only");
  a("reproduce", search.reproduce, "commands that repeat the result");
  a("robust", search.robust, "findings of a search by one measure of risk");
  a("devices", search.devices, "findings of a search over devices");
  a("seeds", search.seeds, "findings of several searches");
  if (search.devices) {
    a.object(
        "drawing",
        [&](auto& nominal) {
          internal::figures_and_status(nominal, search.devices->nominal, search.devices->nominal_status, internal::every_figure);
          nominal("goal_met", search.devices->nominal_goal_met, "whether the goal of the target is met");
        },
        "waveform for the nominal design, on the nominal device");
  }
  a("limit", search.limit, "least time for the impact velocity that was found");
  if (!a.has(closing.best.figures.has_value())) return;
  a.object(
      "best",
      [&](auto& best) {
        best("parameters", search.parameters, "parameters of the best waveform, by drive and name");
        best("bounds", search.bounds, "bounds of each parameter in the search");
        best("cost", closing.best.cost, "cost of the run");
      },
      "run under the best waveform, or the single run");
  a("checks", search.checks, "repeated simulations that confirm the best waveform");
  if (a.has(!search.checks.empty()))
    a("evaluations_with_more_modes", internal::Count{search.evaluations_of_modes},
      "number of further evaluations with several numbers of modes");
}

/// Members that are computed from other members are written in closing_json.cc.
inline void members(internal::Archive& a, ClosingRecord& record) {
  members(a, record.origin);
  a("status", record.status, "outcome of the run, or `interrupted`");
  a.custom("pull_in", record.pull_in, internal::pull_in_json, internal::read_pull_in,
           internal::OneOrMore<PullInOfElectrode>{"pull-in voltages of the electrode"});
  a("warnings", record.warnings, "warnings");
  a("title", record.title, "title of the scene");
  a("natural_frequencies_rad_s", record.natural_frequencies, "natural angular frequencies");
  a("tolerance", record.tolerance, "relative tolerance of the integrator");
  if (a.has(!record.message.empty())) a("message", record.message, "why the run is not done");
  a("effects", record.effects, "effects that a coarse search left out");
  a.object(
      "curves",
      [&](auto& curves) {
        if (curves.has(record.best.figures.has_value()))
          curves("best", record.best.curve, "run under the best waveform, or the single run");
      },
      "curves of the runs, in files only");
  if (a.has(record.best.figures.has_value())) {
    a.object(
        "metrics",
        [&](auto& metrics) {
          if (metrics.reads() || !record.best.figures) record.best.figures.emplace();
          metrics.figures(*record.best.figures, internal::every_figure);
        },
        "figures of the run under the best waveform, or of the single run");
    a.object(
        "best", [&](auto& best) { members(best, record.best); }, "run under the best waveform, or the single run");
    internal::figure_errors(a, record.best.errors);
  }
  if (a.has(!record.contacts.empty())) a("contacts", record.contacts, "figures of each of several contacts");
  a("closed_state", record.closed_state, "closed equilibrium under the hold levels");
  a("work", record.work, "cost of the simulation");
  if (a.reads()) {
    if (internal::is_of_search(a.from())) record.search.emplace();
    a.object(
        "certified", [&](auto&) { record.certificate.emplace(); },
        "ill-conditioned figures over perturbed runs, with `--certify`");
  }
  if (record.search) members_of_search(a, *record.search, record);
  if (!record.certificate) return;
  a.custom("certified", record.certificate->ill_conditioned, internal::certified_json, internal::read_certified,
           internal::Like<std::map<std::string, Spread>>{"ill-conditioned figures over perturbed runs, with `--certify`"});
  a.object(
      "cloud",
      [&](auto& cloud) {
        cloud("runs", record.certificate->runs, "number of runs");
        cloud("grazing_rebound", internal::OrNull{record.certificate->grazing}, "rebound that makes the figures ill-conditioned");
      },
      "perturbed runs of `--certify`");
}

}  // namespace softland
