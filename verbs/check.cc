// Verb `check`: derived numbers and warnings of a scene.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/engineering.h"
#include "document/quantity.h"
#include "model/built_beam.h"
#include "model/constants.h"
#include "model/gas/gas_law.h"
#include "model/pull_in.h"
#include "reports/check_report.h"
#include "studies/closing/auto_settings.h"
#include "studies/closing/closed_state.h"
#include "studies/closing/sent_signals.h"
#include "studies/closing/simulate.h"
#include "studies/closing/summits_at_hold.h"
#include "verbs/study.h"

namespace softland::verbs {
namespace {

using internal::given_quantity;
using internal::plain_number;
using internal::quantity;
using internal::scientific;

// Describes the strength of the dispersion force that closes the switch, as a multiple of the strength in the scene.
std::string dispersion_prose(const PreparedScene& p, const Progress& progress) {
  const std::size_t k = p.scene.device.electrodes.size();
  const std::vector<double> bias = bias_of(p.scene, k);
  const StaticPullIn statically = static_pull_in(p.model, k, bias);
  const auto factor = [](double value) { return plain_number(1 + value, 4); };
  const bool known = std::isfinite(statically.voltage);
  if (!p.model.rest() || statically.status == Status::collapsed_at_rest) {
    return "no open state: the switch " +
           (known
                ? fmt::format("closes by itself if the force has at least {} of its nominal strength", factor(statically.voltage))
                : std::string("closes by itself"));
  }
  const std::string rest =
      fmt::format("the tip rests {} lower; ", quantity(p.model.contact_deflection(p.model.rest()->data()), "m"));
  if (!known) return rest + "no strength of the force was found at which the switch closes by itself";
  const DynamicPullIn dynamically = dynamic_pull_in(p.model, k, statically, bias, progress);
  const std::string step =
      std::isfinite(dynamically.voltage) ? fmt::format(", or after a step to {} (dynamic)", factor(dynamically.voltage)) : "";
  return fmt::format("{}the switch closes by itself if the force rises to {} (static){} of its nominal strength", rest,
                     factor(statically.voltage), step);
}

// Describes the closed state at the hold voltages, and the highest voltage at which a closed state exists.
std::string closed_state_prose(const ClosedState& state) {
  std::string words =
      !state.exists ? "no equilibrium at the hold voltages"
      : !state.stable
          ? "stability is not known: one mode of a beam clamped at both ends does not suffice; set structure.modes higher"
      : *state.stable ? "stable at the hold voltages"
      : state.flips   ? "stability at the hold voltages depends on the number of modes"
                      : "unstable at the hold voltages";
  for (const auto& [electrode, volts] : state.pulled_through) {
    words += std::isfinite(volts)
                 ? fmt::format("; the beam collapses onto electrode {} from {} on", electrode, quantity(volts, "V", 4))
                 : fmt::format("; the beam collapses onto electrode {} at no voltage tried", electrode);
    const auto more = state.pulled_through_by_modes.find(electrode);
    if (more == state.pulled_through_by_modes.end()) continue;
    if (const std::string shift = shift_prose(more->second); !shift.empty())
      words += fmt::format(" (more modes shift this voltage by {})", shift);
  }
  return words;
}

// Describes the capacitance of the closed state of a switch that closes onto a dielectric, and its change with more modes.
std::string capacitance_prose(const PreparedScene& p) {
  const ModeLadder ladder(p);
  const ByModes found = closed_capacitance_by_modes(ladder, hold_levels(p.signals()));
  const double own = found.values.begin()->second;
  if (std::isnan(own)) return "its capacitance is not known";
  return "its capacitance is " + engineering(own, "F", 4) +
         (ladder.exists() ? "; more modes shift it by " + shift_prose(found, "F") : "");
}

// Returns a message about a key of the scene with its file and line.
std::string scene_note(const SceneFile& file, const std::string& key, std::string_view words) {
  try {
    file.refuse(key, words);
  } catch (const InvalidInput& said) {
    return said.what();
  }
}

// Relative precision of the dynamic pull-in voltage of a switch with a compressible gas film, which takes a thousand times
// longer to simulate. The verb `pull-in` finds this voltage to full precision.
constexpr double film_precision = 1e-3;

double precision_of(const Switch& model) { return model.film_states() > 0 ? film_precision : dynamic_pull_in_precision; }

ElectrodePullIn quick_pull_in(const Switch& model, std::size_t electrode, Bias bias, const Progress& progress) {
  if (model.film_states() == 0) return electrode_pull_in(model, electrode, bias, progress);
  constexpr double tolerance = 1e-4;  // relative tolerance of the integrator, ten times finer than film_precision
  ElectrodePullIn found{.statically = static_pull_in(model, electrode, bias)};
  found.dynamically = dynamic_pull_in(model, electrode, found.statically, bias, progress, tolerance, film_precision);
  return found;
}

std::string end_prose(const Anchor& anchor) {
  if (anchor.is_clamp()) return "clamped";
  if (anchor.is_free()) return "free";
  const auto stiffness = [](double value, const char* unit) {
    return std::isinf(value) ? std::string("rigid") : given_quantity(value, unit, 4);
  };
  return fmt::format("rotation {}, translation {}", stiffness(anchor.rotation, "N m/rad"), stiffness(anchor.translation, "N/m"));
}

// Lists the sections, layers and anchors of a beam as lines of the report.
void add_parts(CheckRecord& record, const Device& device) {
  const Structure& s = device.structure;
  const Beam* const beam = s.find<Beam>();
  if (beam == nullptr) return;
  const auto length = [](double value) { return given_quantity(value, "m", 4); };
  const auto span = [&](double begin, double end) { return fmt::format("{} to {}", length(begin), length(end)); };
  int number = 0;
  for (const LocalSection& local : local_sections(s)) {
    if (beam->sections.empty()) break;
    std::string words = fmt::format("{}, {}{} wide, {} thick", span(local.begin, local.end), length(local.width),
                                    local.is_even() ? "" : " to " + length(local.end_width), length(local.thickness));
    if (local.holes.exist())
      words += fmt::format(", holes of {} every {}, which leave {} % of the area and {} % of the stiffness",
                           length(local.holes.size), length(local.holes.pitch), plain_number(100 * area_left(local.holes), 3),
                           plain_number(100 * ligament_efficiency(local.holes), 3));
    record.lines.push_back({fmt::format("section {}", ++number), words});
  }
  number = 0;
  for (const LayerPart& layer : beam->layers)
    record.lines.push_back({fmt::format("layer {}", ++number),
                            fmt::format("{} face, {}, {} thick, {}", name_of(sides, layer.face),
                                        span(layer.begin.on(s.length), layer.end.on(s.length)), length(layer.thickness),
                                        layer.stress == 0 ? "stress-free" : given_quantity(layer.stress, "Pa", 4))});
  if (beam->anchor || beam->far_anchor)
    record.lines.push_back(
        {"anchors", fmt::format("near end {}; far end {}", end_prose(s.near_hold()), end_prose(s.far_hold()))});
}

// Describes the rest shape of a structure that is not straight at rest.
void add_rest_shape(CheckRecord& record, const Device& device) {
  constexpr int places = 200;
  const double length = device.structure.length, gap = device.gap.electrode;
  const auto place = [](double begin, double end, int k) { return begin + (end - begin) * k / places; };
  bool is_straight = true;
  for (int k = 0; k <= places; ++k) is_straight = is_straight && device.rest_offset(place(0, length, k)) == 0;
  const std::vector<double> kinks = kinks_at_rest(device.structure);
  for (const double x : kinks) is_straight = is_straight && device.rest_offset(x) == 0;
  if (is_straight) return;
  CheckRecord::Rest rest{.far_end_rise = device.rest_offset(length),
                         .contact_rise = device.rest_offset(device.contact_position()),
                         .contact_gap = device.contact_gap()};
  rest.far_end_gap = gap + rest.far_end_rise;
  std::vector<Stretch> over;
  for (const Electrode& e : device.electrodes) {
    if (e.side != Side::far) std::ranges::copy(e.pads(length), std::back_inserter(over));
  }
  if (over.empty()) over.push_back({0, length});
  double lowest = std::numeric_limits<double>::infinity();
  for (const Stretch& pad : over) {
    for (int k = 0; k <= places; ++k) lowest = std::min(lowest, device.rest_offset(place(pad.begin, pad.end, k)));
    for (const double x : kinks) {
      if (pad.holds(x)) lowest = std::min(lowest, device.rest_offset(x));
    }
  }
  rest.least_gap = gap + lowest;
  const auto words = [](double rise) {
    if (rise == 0) return std::string("as high as that of a straight structure");
    return fmt::format("{} {} the near electrode than that of a straight structure", quantity(std::abs(rise), "m", 4),
                       rise > 0 ? "further from" : "nearer to");
  };
  record.lines.push_back({"rest shape", fmt::format("the far end rests {}, {} above the plane of the electrode",
                                                    words(rest.far_end_rise), quantity(rest.far_end_gap, "m", 4))});
  record.lines.push_back({"", fmt::format("the contact point rests {}: contact gap {}", words(rest.contact_rise),
                                          quantity(rest.contact_gap, "m", 4))});
  record.lines.push_back({"", fmt::format("the smallest gap over an electrode is {}", quantity(rest.least_gap, "m", 4))});
  record.rest_shape = rest;
}

Outcome shown(const CheckRecord& record) { return {.json = json_of(record), .text = text_of(record)}; }

struct CheckRequest : Usual {
  static constexpr bool is_explorable = true;
  static constexpr auto name = "check", about = "validate a scene file; print derived numbers and warnings", python = "checked",
                        leaves = "folder for beam.svg, a drawing of the beam with its sections, layers and anchors",
                        remarks =
                            "Examples:\n  softland check my-switch.toml\n  softland check my-switch.toml --json -\n"
                            "  softland check my-switch.toml --out drawn";
  static std::vector<std::string> files() { return {"beam.svg"}; }
  static Outcome shown_again(const nlohmann::json& json) { return shown(read_check(json)); }
};

template <class Archive>
void options(Archive&, CheckRequest&) {}

// The check of a scene, subject by subject: lines of the report, numbers of the JSON, and warnings.
class SceneCheck {
 public:
  // Keeps references to `setting` and `prepared`, which must outlive this object.
  SceneCheck(const Setting& setting, const PreparedScene& prepared)
      : setting_(setting),
        p_(prepared),
        record_{.file = setting.name,
                .title = p_.scene.title,
                .dynamic_precision = precision_of(p_.model),
                .duration = p_.duration,
                .tolerance = p_.tolerance,
                .warnings = p_.scene.warnings} {}

  [[nodiscard]] CheckRecord record() {
    check_structure();
    for (std::size_t k = 0; k < p_.scene.device.electrodes.size(); ++k) check_electrode(k);
    check_dispersion();
    check_gas();
    for (const auto& [name, signal] : named_signals(p_)) check_drive(name, signal);
    for (std::string& warning : gas_warnings(p_.scene.device, p_.scene.device.closed_gap(), 0))
      record_.warnings.push_back(std::move(warning));
    check_start();
    check_contacts();
    add("window", fmt::format("{}, integrator tolerance {}", given_quantity(p_.duration, "s", 4), scientific(p_.tolerance)));
    if (p_.model.has_contact()) check_closed_state();
    setting_.progress.throw_if_stopped();
    record_.origin = origin_of("check", p_, setting_.command);
    return record_;
  }

 private:
  void add(const std::string& name, const std::string& value) { record_.lines.push_back({name, value}); }

  // Adds natural frequencies, parts and the rest shape.
  void check_structure() {
    std::vector<std::string> frequencies;
    for (const double omega : p_.model.basis().angular_frequencies()) {
      record_.frequencies.push_back(omega);
      frequencies.push_back(quantity(omega / (2 * pi), "Hz", 4));
    }
    add_parts(record_, p_.scene.device);
    add_rest_shape(record_, p_.scene.device);
    add("natural frequencies", fmt::format("{}", fmt::join(frequencies, ", ")));
    if (p_.model.has_contact()) add("in-contact period", quantity(p_.model.basis().in_contact_period(), "s", 4));
  }

  // Adds the pull-in voltages of an electrode, from which a search derives its voltage limits where the scene gives none.
  void check_electrode(std::size_t k) {
    const std::string& name = p_.scene.device.electrodes[k].name;
    if (!pulls_in(p_.scene.device, k)) {
      add("electrode " + name, "is on the far side and pulls away from the contact");
      return;
    }
    const auto known = p_.pull_in.find(name);
    const ElectrodeRecord found = record_of(
        p_, k, known != p_.pull_in.end() ? known->second : quick_pull_in(p_.model, k, bias_of(p_.scene, k), setting_.progress));
    const PullInRecord& v = found.volts;
    if (std::isfinite(v.static_pull_in) && std::isfinite(v.dynamic_pull_in))
      searched_to_[name] = {.static_pull_in = v.static_pull_in, .dynamic_pull_in = v.dynamic_pull_in};
    if (found.status == Status::no_contact) {
      add("electrode " + name, "pulls away from the contact in the rest position: no pull-in voltage");
      record_.warnings.push_back(scene_note(setting_.scene, "electrode." + name + ".gap", pulls_away));
      return;
    }
    record_.pull_in[name] = v;
    if (std::isfinite(v.release)) record_.hold_windows[name] = {v.release, v.pulled_through};
    const std::string bias = bias_prose(found);
    const std::string roughly =
        p_.model.film_states() > 0 && std::isfinite(v.static_pull_in) && v.dynamic_pull_in != v.static_pull_in
            ? " (known to 0.1 %, as are levels in Vdp below)"
            : "";
    add("electrode " + name, (found.status == Status::collapsed_at_rest
                                  ? no_open_state
                                  : fmt::format("Vsp {}, Vdp {}", volts(v.static_pull_in), dynamic_prose(v)) + roughly) +
                                 (p_.model.has_contact() ? ", release " + volts(v.release) : "") +
                                 (bias.empty() ? "" : ", under " + bias));
    if (const std::string brief = brief_contact_prose(v); !brief.empty()) add("", brief);
    if (const std::string charge = charge_prose(v); !charge.empty()) add("", "its charge " + charge);
    if (sticks_by_charge(v))
      record_.warnings.push_back(
          scene_note(setting_.scene, "electrode." + name + ".dielectric.charge", "keeps a closed switch closed at 0 V"));
    if (v.by_modes) {
      std::string shifts = "more modes shift Vsp by " + shift_prose(v.by_modes->static_pull_in);
      if (std::isfinite(v.release)) shifts += ", release by " + shift_prose(v.by_modes->release);
      add("", shifts);
    }
    if (const std::optional<Dielectric>& dielectric = p_.scene.device.electrodes[k].dielectric)
      add("", fmt::format("its dielectric adds {} to the gap of the field{}", given_quantity(dielectric->depth(), "m"),
                          !p_.scene.device.closes_on_dielectric() ? std::string()
                          : p_.scene.device.structure.is_rigid()  ? "; the plate lands on it"
                                                                  : "; the beam lands on it"));
  }

  void check_dispersion() {
    if (!p_.scene.device.dispersion) return;
    add("dispersion force", dispersion_prose(p_, setting_.progress));
    add("drive dispersion", "hold level " + plain_number(1 + p_.signals()[p_.scene.device.electrodes.size()].hold_level(), 5));
  }

  // Adds squeeze and Knudsen numbers of the gas film.
  void check_gas() {
    const FilmState* const film = p_.scene.device.gas ? film_of(*p_.scene.device.gas) : nullptr;
    if (film == nullptr) return;
    const double g = p_.scene.device.gap.electrode;
    const double closed = p_.scene.device.closed_gap(), lambda = mean_free_path(*film);
    const double omega = p_.model.basis().angular_frequencies()[0],
                 width = width_at(p_.scene.device.structure, p_.scene.device.contact_position());
    const double most = limits_of(*p_.scene.device.gas).most_squeeze;
    const std::string holds =
        std::isfinite(most) ? fmt::format("; the law {} holds below about {}", name_of(*p_.scene.device.gas), plain_number(most))
                            : "";
    add("squeeze number", fmt::format("{} at the rest gap, {} in the closed state (first mode{})",
                                      plain_number(squeeze_number(*film, width, g, omega)),
                                      plain_number(squeeze_number(*film, width, closed, omega)), holds));
    add("Knudsen number", fmt::format("{} at the rest gap, {} in the closed state (mean free path {})", plain_number(lambda / g),
                                      plain_number(lambda / closed), given_quantity(lambda, "m", 3)));
  }

  // Adds levels, limits and errors of a drive.
  void check_drive(const std::string& name, const Signal& signal) {
    const Drive& drive = p_.drives.at(name);
    const auto searched = searched_to_.find(name);
    std::string driver = "driver without limits";
    if (drive.limits) {
      driver = fmt::format("driver {} to {}", given_quantity(drive.limits->min_voltage, "V"),
                           given_quantity(drive.limits->max_voltage, "V"));
    } else if (searched != searched_to_.end()) {
      driver = fmt::format("no [driver.{}]: a search limits the voltage to 0 V to {}, {}", name,
                           default_limit_prose(searched->second), quantity(default_limit(searched->second), "V", 5));
      if (signal.peak() > default_limit(searched->second))
        record_.warnings.push_back(
            fmt::format("[waveform.{0}] reaches {1}, above the voltage limit of a search without [driver.{2}]. "
                        "optimize, release, limit and robustness refuse this scene: add [driver.{2}] with max_voltage, "
                        "or lower the waveform",
                        name, given_quantity(signal.peak(), "V"), name));
    }
    if (drive.amplifier)
      driver += fmt::format(", amplifier {}: the source gives at most {}", plain_number(*drive.amplifier, 6),
                            given_quantity(signal.peak() / *drive.amplifier, "V"));
    if (!drive.errors.are_none()) {
      const auto& [gain, offset, delay, edges] = drive.errors;
      driver += fmt::format(", gain {}, offset {}, delay {}", plain_number(gain, 6), given_quantity(offset, "V"),
                            given_quantity(delay, "s"));
    }
    if (const double charging = drive.source.charging_time(); charging > 0)
      driver += fmt::format(", charges the open switch with a time constant of {}", quantity(charging, "s", 3));
    const std::string before = signal.before() == 0 ? "" : fmt::format("{} before t = 0, ", given_quantity(signal.before(), "V"));
    add("drive " + name, fmt::format("{}hold {}, peak {}, {}", before, given_quantity(signal.hold_level(), "V"),
                                     given_quantity(signal.peak(), "V"), driver));
  }

  void check_start() {
    if (const std::string start = start_prose(p_); !start.empty()) add("start", start);
    if (!p_.start_equilibrium() && (p_.scene.begins_closed || p_.model.rest()))
      record_.warnings.push_back("the simulation cannot start: " + start_prose(p_));
    if (!p_.model.has_contact()) add("contact", "none: the simulation ends at first touch");
  }

  // Adds the contacts of a switch with several, and the connection through them.
  void check_contacts() {
    if (p_.model.contacts() < 2) return;
    std::vector<std::string> connecting;
    for (std::size_t c = 0; c < p_.model.contacts(); ++c) {
      const Contact& contact = p_.scene.device.contacts[c];
      const std::string place = p_.scene.device.structure.is_rigid()
                                    ? std::string()
                                    : "at " + given_quantity(p_.scene.device.contact_position(c), "m", 4) + ", ";
      add("contact " + contact.name,
          fmt::format("{}gap {}, {}{}{}", place, given_quantity(p_.model.contact_gap(c), "m", 4), name_of(contact.model),
                      contact.count > 1 ? fmt::format(", {} of them", contact.count) : "",
                      contact.side == Side::far ? ", a back stop" : ""));
      if (contact.connects) connecting.push_back(contact.name);
    }
    add("connection", fmt::format("closed while {} {} closed; static figures are those of contact {}",
                                  fmt::join(connecting, p_.scene.device.connection == Connection::all ? " and " : " or "),
                                  connecting.size() > 1 && p_.scene.device.connection == Connection::all ? "are" : "is",
                                  p_.scene.device.contacts.front().name));
  }

  // Adds what is known of the switch while the hold levels keep it closed.
  void check_closed_state() {
    record_.stable_path = stable_path_of(p_, setting_.progress);
    add("stable path", words_of(record_.stable_path));
    if (const auto command = open_command(p_, p_.signals()))
      add("command to open", fmt::format("at {}{}", given_quantity(command->time, "s", 4),
                                         std::isfinite(p_.scene.simulate.open_at) ? "" : ", given by the waveforms"));
    const std::vector<Signal> held = until_command(p_, p_.signals());
    const ClosedState state = closed_state(p_, held);
    record_.closed_state = state;
    add("closed state", closed_state_prose(state));
    if (p_.scene.device.closes_along_face()) add("", capacitance_prose(p_));
    const Hold hold = hold_of(p_.model, held);
    if (const auto summits = hold.closed ? summits_at_hold(p_.model, *hold.closed) : std::nullopt)
      add("contact", summits_prose(*summits));
    if (std::string lost = hold_warning(p_.model, held, state); !lost.empty() && !p_.scene.begins_closed)
      record_.warnings.push_back(std::move(lost));
    if (std::string few = few_summits_warning(p_.model, held); !few.empty()) record_.warnings.push_back(std::move(few));
  }

  const Setting& setting_;
  const PreparedScene& p_;
  CheckRecord record_;
  std::map<std::string, PullInVoltages> searched_to_;  // pull-in voltages by electrode, for the limits of a search
};

Outcome run(const Setting& setting, const CheckRequest&) {
  const Progress& progress = setting.progress;
  const PreparedScene p = choose(prepare(setting.scene, false, progress, quick_pull_in), false, progress);
  Outcome outcome = shown(SceneCheck(setting, p).record());
  if (p.scene.device.structure.find<Beam>() != nullptr)
    outcome.files = {
        {"beam.svg", [title = p.scene.title, device = p.scene.device] { return beam_drawing(title, device); }, "beam.svg"}};
  return outcome;
}

}  // namespace

Study check_study() { return study_of<CheckRequest>(); }

}  // namespace softland::verbs
