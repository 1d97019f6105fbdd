#include "reports/closing_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <limits>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include "base/require.h"
#include "config/units.h"
#include "document/downsample.h"
#include "integrators/quintic.h"
#include "model/structure/structure.h"
#include "objectives/figure_values.h"
#include "reports/robustness_prose.h"
#include "studies/closing/effect_ablation.h"
#include "studies/closing/resistance_course.h"
#include "waveforms/export.h"

namespace softland {
namespace {

using nlohmann::json;

// Returns the value in JSON at this path of keys; null if any key is missing.
const json& at(const json& value, std::initializer_list<std::string_view> path) {
  static const json nothing;
  const json* here = &value;
  for (const std::string_view key : path) {
    if (!here->is_object()) return nothing;
    const auto found = here->find(key);
    if (found == here->end()) return nothing;
    here = &*found;
  }
  return *here;
}

double number(const json& value) { return value.is_number() ? value.get<double>() : Metrics::unset; }

std::string text(const json& value) { return value.is_string() ? value.get<std::string>() : std::string(); }
std::string text(const json& value, std::initializer_list<std::string_view> path) { return text(at(value, path)); }

// Returns a quantity of a resolved scene, such as "2 um", in SI units. A number without a unit is returned as it is.
double quantity(const json& value) {
  if (!value.is_string()) return number(value);
  try {
    return parse_quantity(value.get<std::string>()).value;
  } catch (const InvalidInput&) {
    return Metrics::unset;
  }
}

std::vector<double> quantities(const json& list) {
  std::vector<double> all;
  for (const json& one : list.is_array() ? list : json::array()) all.push_back(quantity(one));
  return all;
}

// Returns the members of a JSON object by name, each converted by the function `read`.
template <class Read>
auto members_of(const json& object, const Read& read) {
  std::map<std::string, decltype(read(object))> all;
  if (!object.is_object()) return all;
  for (const auto& [name, value] : object.items()) all.emplace(name, read(value));
  return all;
}

// Returns a place on a beam [m] that is given as a length, as a percentage of the length of the beam, or as its tip.
double place_on(double length, const json& place) {
  const std::string written = text(place);
  if (written == "tip") return length;
  return written.ends_with('%') ? quantity(place) * length : quantity(place);
}

std::optional<std::array<double, 2>> span_on(double length, const json& span) {
  if (!span.is_array() || span.size() != 2) return std::nullopt;
  const std::array<double, 2> ends{place_on(length, span[0]), place_on(length, span[1])};
  return std::isfinite(ends[0]) && std::isfinite(ends[1]) ? std::optional(ends) : std::nullopt;
}

// Returns the length of the structure in a scene, or the sum of the lengths of its sections.
double length_of(const json& structure) {
  const double length = quantity(at(structure, {"length"}));
  const json& sections = at(structure, {"sections"});
  if (std::isfinite(length) || !sections.is_array() || sections.empty()) return length;
  double sum = 0;
  for (const json& section : sections) sum += quantity(at(section, {"length"}));
  return sum;
}

template <class Kind>
constexpr SideOfStructure side_of_kind() {
  constexpr bool is_rigid = requires { Kind::is_rigid; };
  constexpr bool has_far_clamp = requires { Kind::has_far_clamp; };
  if (is_rigid) return SideOfStructure::on_springs;
  if (!std::is_base_of_v<Beam, Kind>) return SideOfStructure::unknown;
  return has_far_clamp ? SideOfStructure::held_at_both_ends : SideOfStructure::held_at_one_end;
}

template <class... Kinds>
SideOfStructure side_of_named(std::string_view kind, const std::variant<Kinds...>*) {
  SideOfStructure side = SideOfStructure::unknown;
  ((side = Kinds::name == kind ? side_of_kind<Kinds>() : side), ...);
  return side;
}

// Replaces figures of merit that are not finite by NaN: JSON has no infinity.
FigureValues finite(FigureValues values) {
  for (const Figure& figure : all_figures) {
    if (!std::isfinite(values[figure])) values[figure] = Metrics::unset;
  }
  return values;
}

// Returns the points of a waveform; of a long waveform, at most most_curve_rows points that draw the same picture.
Points at_most_rows(Points all) {
  if (all.size() <= most_curve_rows) return all;
  std::vector<double> levels;
  for (const auto& [time, level] : all) levels.push_back(level);
  Points kept;
  for (const std::size_t row : internal::downsampled({&levels}, most_curve_rows)) kept.push_back(all[row]);
  return kept;
}

// Returns the waveforms, by name of the electrode, piezo or dispersion force, as points connected by straight lines. They are
// exact for steps, pulses and tables of up to most_curve_rows, and within a thousandth of the amplitude for sines.
std::map<std::string, Points> waveforms(const PreparedScene& p) {
  std::map<std::string, Points> all;
  const std::vector<std::string> names = p.drive_names();
  const std::vector<Signal> signals = p.signals();
  for (std::size_t k = 0; k < names.size(); ++k) {
    const double swing = signals[k].maximum(p.duration) - signals[k].minimum(p.duration);
    const bool is_factor = names[k] == dispersion_drive;
    // Leave out the factor of the dispersion force if it always has its nominal value 1.
    if (is_factor && signals[k].is_zero()) continue;
    for (const auto& [t, v] : polyline(signals[k], p.duration, 1e-3 * swing, 0))
      all[names[k]].push_back({t, is_factor ? 1 + v : v});
    all[names[k]] = at_most_rows(std::move(all[names[k]]));
  }
  return all;
}

RunRecord run(const PreparedScene& p, const Closing& closing, const MetricsOptions& options, bool shows_motion = true) {
  FigureValues figures(closing.metrics), errors = closing.errors;
  figures.asked = options.asked;
  figures.asked.opening = closing.metrics.asked.opening;
  figures.asked.break_charge = closing.metrics.asked.break_charge;
  errors.asked = figures.asked;
  CurveRecord curve = curve_of(closing.trajectory, closing.rebounds, closing.is_thinned, options);
  curve.resistance = resistance_course(p.scene.device, closing.trajectory, curve.time);
  curve.closed = closed_stretches(closing.trajectory.touches);
  for (const ContactOutcome& own : closing.trajectory.contacts) curve.closed_contacts[own.name] = closed_stretches(own.touches);
  if (shows_motion) curve.motion = shown_motion(p, closing);
  return {.status = std::string(to_string(closing.metrics.status)),
          .figures = finite(figures),
          .errors = finite(errors),
          .curve = std::move(curve),
          .waveforms = waveforms(p),
          .collapse_time = closing.trajectory.collapse_time};
}

// Returns the figures of merit by contact, if there are several contacts or if the beam touches the face of a dielectric.
std::map<std::string, ContactFigures> contacts(const Device& device, const Closing& closing) {
  std::map<std::string, ContactFigures> all;
  if (closing.contacts.empty() && device.closes_along_face())
    all[std::string(face_name)] = {.gap = closing.trajectory.contact_gap, .figures = finite(FigureValues(closing.metrics))};
  for (std::size_t c = 0; c < closing.contacts.size(); ++c) {
    const ContactOutcome& own = closing.trajectory.contacts[c];
    all[own.name] = {.gap = own.gap, .figures = finite(FigureValues(closing.contacts[c].metrics))};
  }
  return all;
}

std::map<std::string, PullInOfElectrode> pull_in(const PreparedScene& p) {
  std::map<std::string, PullInOfElectrode> all;
  const ModeLadder ladder(p);
  for (std::size_t k = 0; k < p.scene.device.electrodes.size(); ++k) {
    const auto found = p.pull_in.find(p.scene.device.electrodes[k].name);
    if (found == p.pull_in.end()) continue;
    PullInOfElectrode& one = all[found->first];
    one = {.static_pull_in = found->second.statically.voltage, .dynamic_pull_in = found->second.dynamically.voltage};
    if (ladder.exists()) one.static_by_modes = static_pull_in_by_modes(ladder, p.scene, k);
  }
  return all;
}

// Makes the part of the results that simulations and searches have in common: the scene, and the version of this program.
ClosingRecord begun(const char* kind, const PreparedScene& p, const std::string& command) {
  for (const auto& [drive, waveform] : p.drives.waveforms()) {
    if (const Own* own = std::get_if<Own>(&waveform))
      throw InvalidInput(fmt::format("waveform.{}: {} cannot be written into a result", drive, described(*own)));
  }
  ClosingRecord r{.origin = whole_origin_of(kind, p, command), .title = p.scene.title, .tolerance = p.tolerance};
  r.scene = read_drawn_scene(r.origin.scene);
  const Eigen::VectorXd& frequencies = p.model.basis().angular_frequencies();
  r.natural_frequencies.assign(frequencies.begin(), frequencies.end());
  if (p.model.has_contact()) r.closed_state = closed_state(p, until_command(p, p.signals()));
  if (p.effects) {
    r.effects = EffectsLeftOut{.left_out = {}, .influence = p.effects->choice.influence};
    for (const EffectAblation& o : p.effects->choice.left_out)
      r.effects->left_out.push_back({.effect = o.what.effect, .influence = o.influence});
  }
  return r;
}

// Reduces a long run to rows that draw the same picture, so that a file can be read after a run of any length.
void keep_most_rows(CurveRecord& c) {
  const std::vector<std::size_t> rows = internal::downsampled({&c.gap, &c.velocity, &c.force}, most_curve_rows);
  if (rows.size() == c.time.size()) return;
  for (std::vector<double>* column : {&c.time, &c.gap, &c.velocity, &c.force}) {
    std::vector<double> kept;
    for (const std::size_t row : rows) kept.push_back((*column)[row]);
    *column = std::move(kept);
  }
}

// Keeps the most_rebounds highest rebounds, in the order of time.
void keep_highest(std::vector<Rebound>& all) {
  if (all.size() <= most_rebounds) return;
  std::ranges::nth_element(all, all.begin() + most_rebounds, std::ranges::greater(), &Rebound::height);
  all.resize(most_rebounds);
  std::ranges::sort(all, {}, &Rebound::begin);
}

}  // namespace

SideOfStructure side_of_structure(std::string_view kind) {
  return side_of_named(kind, static_cast<const StructureKind*>(nullptr));
}

DrawnScene read_drawn_scene(const json& scene) {
  DrawnScene s{.structure = side_of_structure(text(scene, {"structure", "kind"})),
               .length = length_of(at(scene, {"structure"})),
               .electrode_gap = quantity(at(scene, {"gap", "electrode"})),
               .contact_gap = quantity(at(scene, {"gap", "contact"})),
               .pad_length = quantity(at(scene, {"contact", "pad_length"}))};
  if (at(scene, {"piezo"}).is_object()) s.piezo = DrawnScene::Piezo{span_on(s.length, at(scene, {"piezo", "span"}))};
  for (const auto& [name, electrode] : members_of(at(scene, {"electrode"}), [](const json& one) { return &one; })) {
    const json& spans = at(*electrode, {"span"});
    const bool is_nested = spans.is_array() && !spans.empty() && spans[0].is_array();
    for (const json& span : is_nested ? spans : json::array({spans}))
      s.electrodes.push_back({.name = name,
                              .span = span_on(s.length, span),
                              .far_side = text(*electrode, {"side"}) == "far",
                              .gap = quantity(at(*electrode, {"gap"}))});
  }
  for (const auto& [name, contact] : members_of(at(scene, {"contact"}), [](const json& one) { return &one; })) {
    if (!contact->is_object()) continue;
    s.contacts.push_back({.name = name,
                          .at = place_on(s.length, at(*contact, {"at"})),
                          .gap = quantity(at(*contact, {"gap"})),
                          .far_side = text(*contact, {"side"}) == "far"});
  }
  s.waveforms = members_of(at(scene, {"waveform"}), [](const json& one) {
    return DrawnScene::Waveform{.family = text(one, {"family"}),
                                .times = quantities(at(one, {"times"})),
                                .edge = quantity(at(one, {"edge"})),
                                .start = quantity(at(one, {"start"})),
                                .end = quantity(at(one, {"end"}))};
  });
  s.drivers = members_of(at(scene, {"driver"}), [](const json& one) {
    return DriveLimits{.lowest = quantity(at(one, {"min_voltage"})),
                       .highest = quantity(at(one, {"max_voltage"})),
                       .slew = quantity(at(one, {"max_slew"}))};
  });
  if (const double height = quantity(at(scene, {"metrics", "significant_rebound"})); height > 0) s.significant_rebound = height;
  return s;
}

const RunRecord& ClosingRecord::baseline() const {
  static const RunRecord none;
  return search ? search->baseline : none;
}

CurveRecord curve_of(const Trajectory& t, const MetricsOptions& options) { return curve_of(t, rebounds(t), false, options); }

CurveRecord curve_of(const Trajectory& t, const std::vector<Rebound>& all_rebounds, bool is_thinned,
                     const MetricsOptions& options) {
  CurveRecord c;
  const auto add = [&](double at, double position, double velocity, double contact) {
    c.time.push_back(at);
    c.gap.push_back(t.contact_gap - position);
    c.velocity.push_back(velocity);
    c.force.push_back(contact);
  };
  const double longest = t.points.empty() ? 0 : t.points.back().time / 2000;
  for (std::size_t i = 0; i < t.points.size(); ++i) {
    const TrajectoryPoint& a = t.points[i];
    add(a.time, a.position, a.velocity, a.contact_force);
    if (is_thinned || i + 1 == t.points.size()) continue;
    const TrajectoryPoint& b = t.points[i + 1];
    const double h = b.time - a.time;
    if (!(h > longest)) continue;
    const Quintic between(a.time, a.position, a.velocity, a.acceleration, b.time, b.position, b.velocity, b.acceleration);
    const int parts = static_cast<int>(std::ceil(h / longest));
    for (int k = 1; k < parts; ++k) {
      const double at = a.time + h * k / parts;
      add(at, between.position(at), between.velocity(at), a.contact_force + (b.contact_force - a.contact_force) * k / parts);
    }
  }
  for (const Rebound& r : all_rebounds) {
    if (r.height > options.significant_rebound) c.rebounds.push_back(r);
  }
  keep_most_rows(c);
  keep_highest(c.rebounds);
  return c;
}

std::vector<ClosedStretch> closed_stretches(const std::vector<Touch>& touches, std::size_t most) {
  std::vector<double> openings;
  for (std::size_t k = 1; k < touches.size(); ++k) openings.push_back(touches[k].begin - touches[k - 1].end);
  // Longest opening [s] across which two touches become one time span, so that at most `most` spans remain; -infinity: none.
  double joined = -std::numeric_limits<double>::infinity();
  if (touches.size() > most) {
    std::vector<double> by_length = openings;
    const auto last = by_length.begin() + static_cast<std::ptrdiff_t>(touches.size() - most - 1);
    std::ranges::nth_element(by_length, last);
    joined = *last;
  }
  std::vector<ClosedStretch> all;
  for (std::size_t k = 0; k < touches.size(); ++k) {
    if (k > 0 && openings[k - 1] <= joined) {
      all.back().end = touches[k].end;
      ++all.back().touches;
    } else {
      all.push_back({.begin = touches[k].begin, .end = touches[k].end});
    }
  }
  return all;
}

Points drawn_evaluations(Points all) {
  std::vector<double> values;
  for (const auto& [index, value] : all) values.push_back(value);
  Points kept;
  for (const std::size_t row : internal::downsampled({&values}, most_evaluations)) kept.push_back(all[row]);
  return kept;
}

ClosingRecord record_of(const PreparedScene& prepared, const Closing& closing, const std::string& command, bool shows_motion) {
  ClosingRecord r = begun("simulate", prepared, command);
  r.status = to_string(closing.metrics.status);
  r.message = closing.trajectory.message;
  r.best = run(prepared, closing, prepared.scene.metrics, shows_motion);
  r.contacts = contacts(prepared.scene.device, closing);
  if (closing.certificate) r.certificate = *closing.certificate;
  r.pull_in = pull_in(prepared);
  r.work = closing.trajectory.work;
  r.warnings = closing.warnings;
  r.tolerance = closing.tolerance;
  return r;
}

ClosingRecord record_of(const OptimizeResult& found, const OptimizeOptions& options, const std::string& command) {
  ClosingRecord r = begun("optimize", found.best ? *found.best_scene : found.scene, command);
  SearchRecord& s = r.search.emplace();
  const MetricsOptions& metrics_options = found.scene.scene.metrics;
  const bool interrupted = found.search.termination == Termination::interrupted;
  r.status = interrupted  ? std::string_view("interrupted")
             : found.best ? to_string(found.best->metrics.status)
                          : to_string(Status::no_contact);
  s.target = options.target.text();
  s.actuator = name_of(actuators, options.actuator);
  s.waveform = found.plain_step_wins ? "step" : found.family;
  if (found.families.size() > 1) s.families = found.families;
  s.seed = options.seed;
  s.optimizer = options.optimizer;
  s.evaluations = static_cast<double>(found.search.evaluations);
  s.termination = to_string(found.search.termination);
  s.termination_message = found.search.message;
  s.goal_met = found.goal_met;
  s.better_than_baseline = found.better_than_baseline;
  s.plain_step_wins = found.plain_step_wins;
  s.harder_than_step = found.harder_than_step;
  r.pull_in = pull_in(found.scene);
  s.baseline = run(found.baseline_scene, found.baseline, metrics_options);
  s.baseline.cost = found.baseline_cost;
  s.course.value_name = "cost";
  for (const Evaluation& e : found.search.improvements) s.course.best_so_far.push_back({static_cast<double>(e.index), e.value});
  // All closings have the warnings of the scene: add these warnings from one closing only.
  r.warnings = found.best ? found.best->warnings : found.baseline.warnings;
  if (!found.best) return r;
  r.best = run(*found.best_scene, *found.best, metrics_options);
  r.contacts = contacts(found.best_scene->scene.device, *found.best);
  r.best.cost = found.best_cost;
  r.work = found.best->trajectory.work;
  s.parameters = found.parameters;
  for (const Variable& v : found.variables) s.bounds[v.name] = {v.lower, v.upper};
  s.evaluations_of_modes = static_cast<double>(found.evaluations_of_modes);
  for (const CheckingRun& c : found.checks) {
    s.checks.push_back(
        {.name = c.name, .status = std::string(to_string(c.metrics.status)), .figures = finite(FigureValues(c.metrics))});
  }
  return r;
}

ClosingRecord record_of(const RobustResult& found, const OptimizeOptions& options, const std::string& command) {
  ClosingRecord r = record_of(found.found, options, command);
  SearchRecord& s = *r.search;
  s.optimizer = "race of CMA-ES";
  s.course.value_name = "cost over devices";
  s.robust = found.findings;
  return r;
}

ClosingRecord record_of(const RobustSearchResult& found, const OptimizeOptions& options, std::string next_command,
                        const std::string& command) {
  ClosingRecord r = record_of(found.best, options, command);
  SearchRecord& s = *r.search;
  if (!found.rows.empty()) {
    s.devices = found.findings;
    s.devices->spread = internal::spread_prose(found.varied.scene.spread);
    s.devices->next_command = std::move(next_command);
  }
  if (found.interrupted) r.status = "interrupted";
  s.course.value_name = "cost, on the nominal design";
  return r;
}

std::string trajectory_csv(const CurveRecord& curve) {
  std::vector<const std::vector<double>*> columns;
  std::string out;
  for (const auto& [name, column] : {std::pair{"time_s", &curve.time},
                                     {"tip_gap_m", &curve.gap},
                                     {"tip_velocity_m_s", &curve.velocity},
                                     {"contact_force_N", &curve.force},
                                     {"contact_resistance_ohm", &curve.resistance}}) {
    if (column->size() != curve.time.size()) continue;
    out += (out.empty() ? "" : ",") + std::string(name);
    columns.push_back(column);
  }
  out += '\n';
  for (std::size_t row = 0; row < curve.time.size(); ++row) {
    for (const std::vector<double>* column : columns) {
      if (column != columns.front()) out += ',';
      if (std::isfinite((*column)[row])) out += fmt::format("{}", (*column)[row]);
    }
    out += '\n';
  }
  return out;
}

}  // namespace softland
