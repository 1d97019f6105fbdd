#include "studies/inverse/practice_device.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/random.h"
#include "base/require.h"
#include "config/assumed_spread.h"
#include "model/closing.h"
#include "model/gas/gas_law.h"
#include "studies/closing/auto_settings.h"
#include "studies/inverse/capacitance_edges.h"
#include "studies/inverse/tuning_model.h"

namespace softland {
namespace {

// Throws InvalidInput if the switch has no contact: a laboratory could not record the closing.
void require_recorded_contact(const PreparedScene& nominal) {
  require(nominal.scene.device.has_contact(), [&] {
    return fmt::format("{}: needs a [contact] section: a laboratory records the state of the contact", nominal.scene.file.name());
  });
}

PreparedScene prepared(SceneFile file) {
  assume_spread(file);
  PreparedScene nominal = prepare_and_choose(file, true);
  require_open_start(nominal.scene, "a device is closed");
  require_recorded_contact(nominal);
  return nominal;
}

void add_modes(SceneFile& file, const Scene& scene, int more) {
  require(!scene.device.structure.is_rigid(),
          [&] { return fmt::format("modes=+{}: {}: a plate has one", more, scene.file.name()); });
  file.assign("structure.modes", scene.device.structure.modes + more);
}

void change_gas(SceneFile& file, const Scene& scene, const std::string& name) {
  require(scene.device.gas.has_value(), [&] { return fmt::format("gas={}: {}: there is no [gas]", name, scene.file.name()); });
  const std::optional<Gas> law = law_named<Gas>(name);
  require(law.has_value(), [&] { return fmt::format("gas={}: must be {}", name, listed_laws<Gas>()); });
  for (const std::string& key : file.keys("gas")) {
    if (key != "model" && !has_key(*law, key)) file.erase("gas." + key);
  }
  file.assign("gas.model", name);
}

void stiffen(SceneFile& file, const Scene& scene, double factor) {
  bool is_stiff = false;
  for (const Contact& contact : scene.device.contacts) {
    for (const char* name : {"stiffness", "unloading_stiffness", "effective_modulus", "asperity_pressure", "wall_pressure"}) {
      const std::string key = fmt::format("{}.{}", path_of(contact), name);
      if (!file.written(key)) continue;
      file.assign(key, number_of(contact.model, name, 0) * factor);
      is_stiff = true;
    }
  }
  require(is_stiff,
          [&] { return fmt::format("stiffness={}: {}: its contact has no stiffness", number_text(factor), scene.file.name()); });
}

// Returns the scene with the device's own model, in volts, so that waveforms stay the same if the model changes the pull-in
// voltage.
PreparedScene with_model(const PreparedScene& nominal, const PracticeModel& model) {
  SceneFile file = nominal.resolved();
  if (model.more_modes != 0) add_modes(file, nominal.scene, model.more_modes);
  if (!model.gas.empty()) change_gas(file, nominal.scene, model.gas);
  if (model.stiffness != 1) stiffen(file, nominal.scene, model.stiffness);
  for (const std::string& assignment : model.set) file.set(assignment);
  PreparedScene own = prepare(file);
  require_recorded_contact(own);
  return own;
}

// Returns the first random device of the seed whose values are possible.
SampledDevice drawn(const PreparedScene& own, std::uint64_t seed) {
  constexpr std::uint64_t most = 100;
  const Ensemble ensemble(own, 1);
  DeviceBuilder builder(ensemble);
  const std::size_t size = own.scene.spread.variables.size();
  SampledDevice device;
  for (std::uint64_t k = 0; k < most && !device.model; ++k) {
    std::vector<double> values(size);
    for (std::size_t i = 0; i < size; ++i) values[i] = random_probability(seed, Stream::practice_device, k * size + i);
    own.scene.spread.to_values(values);
    device = builder.device(std::move(values));
  }
  require(device.model.has_value(), [&] {
    return fmt::format("{}: none of {} devices of [spread] can be described: {}", own.scene.file.name(), most, device.refusal);
  });
  return device;
}

std::string seen_failure(const Trajectory& closing) {
  switch (closing.status) {
    case Status::done:
      return {};
    case Status::collapsed_at_rest:
      return "the switch is pulled in before the first edge of the drive";
    case Status::collapsed_onto_electrode:
      return "the beam collapsed onto the electrode";
    default:
      return fmt::format("the closing cannot be simulated: {}",
                         closing.message.empty() ? std::string(to_string(closing.status)) : closing.message);
  }
}

}  // namespace

PracticeDevice::PracticeDevice(SceneFile file, const PracticeOptions& options)
    : options_(options),
      nominal_(prepared(std::move(file))),
      own_(with_model(nominal_, options.model)),
      device_(drawn(own_, options.seed)) {
  if (const LaboratoryErrors& laboratory = options_.laboratory; laboratory.sees_capacitance())
    static_cast<void>(capacitance_rise(nominal_, laboratory.capacitance));
}

double PracticeDevice::gain(std::size_t drive, std::uint64_t shot) const {
  const std::uint64_t of_drive = random_bits(options_.seed, Stream::practice_gain, drive);
  const double constant = 1 + options_.laboratory.gain_error * random_normal(of_drive, Stream::practice_gain, 0),
               scatter = 1 + options_.laboratory.shot_error * random_normal(of_drive, Stream::practice_gain, shot);
  return constant * scatter * (1 + options_.drift * static_cast<double>(shot - 1));
}

std::vector<ContactEdge> PracticeDevice::seen_edges(const std::vector<ContactClosure>& closures, std::uint64_t shot) const {
  const std::uint64_t of_shot = random_bits(options_.seed, Stream::practice_edges, shot);
  std::uint64_t drawn = 0;
  std::vector<ContactEdge> seen;
  for (const ContactClosure& touch : closures) {
    const double closes = touch.begin + options_.laboratory.edge_error * random_normal(of_shot, Stream::practice_edges, drawn++),
                 opens = touch.end + options_.laboratory.edge_error * random_normal(of_shot, Stream::practice_edges, drawn++);
    const bool stays_open = seen.empty() || closes - seen.back().time > std::max(0.0, options_.laboratory.unseen);
    if (!stays_open) {
      seen.pop_back();  // removes the opening of the contact, which is too short to be recorded
    } else if (!(opens <= closes)) {
      seen.push_back({.time = closes, .closed = true});
    } else {
      continue;  // omits a closed time of the contact that is too short to be recorded
    }
    if (std::isnan(opens)) break;
    seen.push_back({.time = std::max(opens, seen.back().time), .closed = false});
  }
  return seen;
}

PracticeClosing PracticeDevice::close(std::uint64_t shot, const std::vector<Waveform>& waveforms, double duration) const {
  require(shot > 0, "shot 0: shots are counted from 1");
  require(duration > 0, [&] { return fmt::format("a closing of {} s: must be longer than 0 s", number_text(duration)); });
  const std::vector<std::string> names = nominal_.drive_names();
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (!nominal_.drives[k].limits) continue;
    const std::string broken = violation(nominal_.commanded(k, waveforms[k]), nominal_.limits(k));
    require(broken.empty(), [&] { return fmt::format("drives.{}: {}", names[k], broken); });
  }
  std::vector<Signal> signals = DeviceDrives(own_).signals(waveforms, {}, device_.values);
  for (std::size_t k = 0; k < signals.size(); ++k) {
    if (own_.model.drive_kind(k) != DriveKind::dispersion) signals[k] = scaled(signals[k], gain(k, shot));
  }
  const ClosingOptions options{.duration = duration, .tolerance = own_.tolerance};
  const Trajectory closing = simulate_closing(*device_.model, signals, options);
  PracticeClosing seen{.record = {}, .motion = metrics(closing, own_.scene.metrics)};
  for (const Touch& touch : closing.touches)
    seen.largest_impact_velocity = std::fmax(seen.largest_impact_velocity, touch.impact_velocity);
  seen.record.error = seen_failure(closing);
  if (!seen.record.error.empty()) return seen;
  std::vector<ContactClosure> closures;
  if (options_.laboratory.sees_capacitance()) {
    CapacitanceEdges edges(*device_.model, searched_drive(device_.model->device()), options_.laboratory.capacitance);
    static_cast<void>(observe_closing(*device_.model, signals, options, edges));
    for (const CapacitanceRise& rise : edges.rises()) closures.push_back({.begin = rise.begin, .end = rise.end});
  } else {
    for (const Touch& touch : closing.touches) closures.push_back({.begin = touch.begin, .end = touch.end});
  }
  seen.record.edges = seen_edges(closures, shot);
  for (ContactEdge& edge : seen.record.edges) edge.time -= options_.trigger_delay;
  if (const std::string fault = record_fault(seen.record); !fault.empty())
    seen.record = {.error = "the record begins after the contact has closed"};
  return seen;
}

}  // namespace softland
