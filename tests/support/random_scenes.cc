#include "tests/support/random_scenes.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "base/random.h"
#include "base/require.h"
#include "model/constants.h"
#include "model/forces/electrostatic.h"
#include "model/gas/gas_law.h"
#include "model/pull_in.h"
#include "studies/closing/prepared.h"

namespace softland::test {
namespace {

/// The random numbers of one attempt at a scene.
class Dice {
 public:
  Dice(std::uint64_t seed, std::uint64_t index, std::uint64_t draw)
      : key_(random_bits(random_bits(seed, Stream::scene, index), Stream::scene, draw)) {}

  double between(double low, double high) { return low + (high - low) * random_uniform(key_, Stream::scene, count_++); }
  double log_between(double low, double high) { return low * std::pow(high / low, between(0, 1)); }
  double about() { return log_between(1 / 1.3, 1.3); }  ///< returns a factor within 30 %
  bool chance(double probability) { return between(0, 1) < probability; }
  int whole(int low, int high) { return low + static_cast<int>(between(0, high - low + 1)); }
  template <class List>
  auto one_of(const List& list) {
    return list[static_cast<std::size_t>(between(0, static_cast<double>(std::size(list))))];
  }

 private:
  std::uint64_t key_, count_ = 0;
};

void put(SceneFile& file, const std::string& path, std::string_view word) { file.set(fmt::format("{}=\"{}\"", path, word)); }
void put(SceneFile& file, const std::string& path, double value, std::string_view unit) {
  file.set(fmt::format("{}=\"{:.6g} {}\"", path, value, unit));
}
void put(SceneFile& file, const std::string& path, double number) { file.set(fmt::format("{}={:.6g}", path, number)); }
void put_span(SceneFile& file, const std::string& path, double begin, double end) {
  file.set(fmt::format("{}=[\"{:.6g} m\", \"{:.6g} m\"]", path, begin, end));
}

/// Multiplies a quantity, if the scene has it.
void multiply(SceneFile& file, const std::string& section, const std::string& key, double factor) {
  const nlohmann::json scene = file.json();
  const auto found = scene.find(section);
  if (found == scene.end() || !found->contains(key)) return;
  std::size_t digits = 0;
  const std::string text = found->at(key);
  const double value = std::stod(text, &digits);
  put(file, section + "." + key, value * factor, text.substr(digits + 1));
}

/// Returns the device so far; later steps add the rest of the scene.
Device device_of(const SceneFile& file) { return read_scene(file).device; }

bool has_width(const SceneFile& file) { return file.json()["structure"].contains("width"); }

void vary_structure(SceneFile& file, Dice& dice) {
  for (const char* key :
       {"length", "width", "thickness", "youngs_modulus", "density", "mass", "stiffness", "area", "residual_stress"}) {
    multiply(file, "structure", key, dice.about());
  }
  const Device d = device_of(file);
  if (d.structure.is_rigid()) {
    // Gas, fringing fields and asperities need these keys.
    const double area = d.structure.length * d.structure.width;
    if (!has_width(file)) put(file, "structure.width", std::sqrt(area), "m");
    if (!(d.structure.thickness > 0)) put(file, "structure.thickness", 0.03 * std::sqrt(area), "m");
  } else {
    put(file, "structure.modes", dice.whole(1, 8));
  }
  put(file, "structure.damping_ratio", dice.chance(0.5) ? 0 : dice.log_between(1e-3, 0.3));
}

void vary_gaps(SceneFile& file, Dice& dice) {
  const Gap gap = device_of(file).gap;
  const double electrode = gap.electrode * dice.about();
  put(file, "gap.electrode", electrode, "m");
  put(file, "gap.contact", electrode * std::min(0.9, gap.contact / gap.electrode * dice.about()), "m");
}

void vary_layer(SceneFile& file, Dice& dice) {
  const Device d = device_of(file);
  if (!d.piezo) return;
  for (const char* key : {"thickness", "youngs_modulus", "density", "d31"}) multiply(file, "piezo", key, dice.about());
  put_span(file, "piezo.span", dice.between(0, 0.1) * d.structure.length, dice.between(0.6, 1) * d.structure.length);
}

void vary_electrodes(SceneFile& file, Dice& dice) {
  const Device d = device_of(file);
  const bool plate = d.structure.is_rigid();
  for (const Electrode& e : d.electrodes) {
    const std::string section = "electrode." + e.name;
    put(file, section + ".fringing", std::string(dice.one_of(names_of(fringing_laws))));
    if (e.side != Side::near) put(file, section + ".gap", e.gap * dice.about(), "m");
    if (plate) {
      put(file, section + ".area", dice.between(0.5, 0.999) * d.structure.length * d.structure.width, "m^2");
    } else {
      put_span(file, section + ".span", dice.between(0, 0.4) * d.structure.length, dice.between(0.7, 1) * d.structure.length);
    }
  }
}

void put_state(SceneFile& file, Dice& dice) {
  put(file, "gas.viscosity", 1.85e-5 * dice.about(), "Pa s");
  put(file, "gas.pressure", dice.log_between(1e3, 1.2e5), "Pa");
}

void vary_gas(SceneFile& file, Dice& dice) {
  file.erase("gas");
  if (dice.chance(0.3)) return;
  const Device d = device_of(file);
  // The compressible film takes a hundred times longer than the others.
  constexpr std::string_view slow = "reynolds";
  std::vector<std::string_view> quick = names_of_laws<Gas>();
  std::erase(quick, slow);
  const std::string model(dice.chance(0.04) ? slow : dice.one_of(quick));
  put(file, "gas.model", model);
  if (model == "linear") return put(file, "gas.quality_factor", dice.log_between(0.3, 3000));
  put_state(file, dice);
  if (model == "strip-slit") {
    put(file, "gas.slit_height", d.gap.electrode * dice.log_between(0.3, 1), "m");
    put(file, "gas.slit_length", d.gap.electrode * dice.log_between(0.3, 3), "m");
  }
  for (const Electrode& e : d.electrodes) {
    if (e.side != Side::near && model != slow) put(file, "gas.far_gap", e.gap, "m");
  }
}

void vary_dispersion(SceneFile& file, Dice& dice) {
  const Device d = device_of(file);
  if (!d.dispersion && !dice.chance(0.15)) return;
  file.erase("dispersion");
  const std::string model = dice.one_of(std::array{"casimir", "van-der-waals", "auto"});
  put(file, "dispersion.model", model);
  if (model != "van-der-waals") put(file, "dispersion.conductor", dice.one_of(std::array{"ideal", "gold"}));
  if (model == "casimir") return;
  put(file, "dispersion.hamaker_constant", 4e-19 * dice.about(), "J");
  if (dice.chance(0.5)) put(file, "dispersion.equilibrium_distance", 0.3e-9 * dice.about(), "m");
}

/// Puts summits on the pad of device `d`. At a hundredth to a tenth of their height the contact carries the force that bends
/// the beam by the contact gap.
void put_summits(SceneFile& file, Dice& dice, const Device& d, const std::string& model, double force) {
  const double height = d.gap.contact * dice.log_between(0.005, 0.05);
  const double radius = height * dice.log_between(0.5, 5);
  const double modulus = dice.log_between(20e9, 200e9);
  const double carries = height * dice.log_between(0.01, 0.1);
  const Summits summits{.radius = radius, .density = 1, .effective_modulus = modulus};
  Contact one{.pad_length = d.structure.length * dice.log_between(0.01, 0.1)};
  if (model == "asperity-gaussian") {
    one.model = GaussianAsperities{.summits = summits, .deviation = height / 4};
  } else {
    one.model = UniformAsperities{.summits = summits, .height = height};
  }
  const double density = force / contact_force(contact_law(one, d.structure.width), carries);
  put(file, "contact.pad_length", one.pad_length, "m");
  put(file, "contact.asperity_radius", radius, "m");
  put(file, "contact.asperity_density", density, "1/m^2");
  put(file, "contact.effective_modulus", modulus, "Pa");
  if (model == "asperity-gaussian") {
    put(file, "contact.asperity_deviation", height / 4, "m");
  } else {
    put(file, "contact.asperity_height", height, "m");
  }
  if (model == "adhesive") {  // pull-off force over the force that bends the beam
    const double pull = 2 * pi * radius * density * one.pad_length * d.structure.width * carries / height;
    put(file, "contact.adhesion_energy", dice.log_between(0.01, 0.8) * force / pull, "N/m");
  }
  if (model == "elastic-plastic") {
    put(file, "contact.hardness", modulus * dice.log_between(0.005, 0.05), "Pa");
    put(file, "contact.plasticity", dice.one_of(std::array{"zmc", "ke"}));
  }
}

/// Contact laws whose numbers are scaled to the device. Other laws have those of their example, varied.
constexpr std::array<std::string_view, 8> sized_contacts{"linear",   "asperity-uniform",  "asperity-gaussian",
                                                         "adhesive", "hysteretic",        "elastic-plastic",
                                                         "rigid",    "adhesive-repulsive"};

std::vector<std::string> other_contacts() {
  std::vector<std::string> names;
  for_each_law<ContactModel>([&]<class Law>(std::type_identity<Law>) {
    if (std::ranges::find(sized_contacts, Law::name) == sized_contacts.end()) names.emplace_back(Law::name);
  });
  return names;
}

void put_example(SceneFile& file, Dice& dice, const std::string& model) {
  for_each_law<ContactModel>([&]<class Law>(std::type_identity<Law>) {
    Law law = Law::example();
    for (const Field<Law>& field : fields_of<Law>) {
      if (Law::name != model || !field.required || field.in == nullptr) continue;
      const std::string key = "contact." + std::string(field.key);
      const double value = field.in(law)*dice.about();
      field.unit.empty() ? put(file, key, value) : put(file, key, value, field.unit);
    }
  });
}

void vary_contact(SceneFile& file, Dice& dice) {
  file.erase("contact");
  if (dice.chance(0.1)) return;
  const Device d = device_of(file);
  const Switch open(d);
  const double stiffness = 2 * open.bending_energy() / (d.gap.contact * d.gap.contact);
  std::vector<std::string> models{"linear",   "asperity-uniform", "asperity-uniform", "asperity-gaussian",
                                  "adhesive", "hysteretic",       "elastic-plastic"};
  if (d.structure.is_rigid() && !open.film_states()) models.emplace_back("rigid");
  if (d.gap.contact > 1.2e-6) models.emplace_back("adhesive-repulsive");
  const std::vector<std::string> others = other_contacts();
  models.insert(models.end(), others.begin(), others.end());
  const std::string model = dice.one_of(models);
  put(file, "contact.model", model);
  if (std::ranges::find(others, model) != others.end()) {
    put(file, "contact.pad_length", d.structure.length * dice.log_between(0.01, 0.1), "m");
    return put_example(file, dice, model);
  }
  if (model == "rigid") return put(file, "contact.restitution", dice.between(0, 0.95));
  if (model == "linear" || model == "hysteretic") {
    const double loading = stiffness * dice.log_between(1e2, 1e6);
    put(file, "contact.stiffness", loading, "N/m");
    if (model == "hysteretic") put(file, "contact.unloading_stiffness", loading / std::pow(dice.between(0.3, 0.99), 2), "N/m");
    put(file, "contact.pad_length", d.structure.length * dice.log_between(0.01, 0.1), "m");
  } else if (model == "adhesive-repulsive") {
    put(file, "contact.pad_length", d.structure.length * dice.log_between(0.01, 0.1), "m");
    put(file, "contact.wall_pressure", 0.5e9 * dice.about(), "Pa");
  } else {
    put_summits(file, dice, d, model, stiffness * d.gap.contact);
  }
  const bool without_memory = model == "linear" || model == "adhesive" || model.starts_with("asperity");
  if (without_memory && d.structure.find<Cantilever>() != nullptr && d.rest_offset(d.structure.length) == 0 && dice.chance(0.3))
    put(file, "contact.distribution", "pad");
  if (without_memory && model != "adhesive" && dice.chance(0.4)) {
    put(file, "contact.damping", dice.log_between(0.02, 2) / (open.basis().angular_frequencies()[0] * d.gap.contact), "s/m");
  }
}

/// In three cantilevers of ten the free end rises or sinks by up to a third of the contact gap.
void vary_rest_shape(SceneFile& file, Dice dice) {
  const Device d = device_of(file);
  if (d.structure.find<Cantilever>() == nullptr || d.touches_along_pad() || !dice.chance(0.3)) return;
  const double curvature = dice.between(-0.6, 0.6) * d.gap.contact / (d.structure.length * d.structure.length);
  const double end = curvature * d.structure.length * d.structure.length / 2;
  if (dice.chance(0.3))  // the same shape as a table
    return file.set(
        fmt::format(R"(structure.rest_shape={{positions=["0 m", "40 %", "tip"], heights=["0 m", "{:.6g} m", "{:.6g} m"]}})",
                    0.16 * end, end));
  put(file, "structure.stress_gradient", curvature * part_of<Beam>(d.structure).youngs_modulus, "Pa/m");
}

Waveform waveform(Dice& dice, double level, double period) {
  const auto edge = [&](double longest) { return dice.chance(0.5) ? 0 : period * dice.log_between(1e-4 * longest, longest); };
  switch (dice.whole(0, 6)) {
    case 0:
      return Step{.level = level, .rise_time = edge(3)};
    case 1: {
      Pulse pulse{.levels = {level}, .edge = edge(0.1)};
      double time = pulse.edge;
      for (int more = dice.whole(1, 3); more > 0; --more) {
        time += period * dice.log_between(0.01, 1);
        pulse.times.push_back(time);
        pulse.levels.push_back(level * dice.between(0, 1.2));
        time += pulse.edge;
      }
      pulse.levels.back() = dice.chance(0.2) ? 0 : level;
      return pulse;
    }
    case 2: {
      SCurve curve{.levels = {level * dice.between(0, 1.2), level}, .edge = period * dice.log_between(1e-3, 1)};
      curve.times.push_back(curve.edge + period * dice.log_between(0.01, 1));
      return curve;
    }
    case 3: {
      const double start = period * dice.between(0, 1), lasts = period * dice.log_between(0.3, 5);
      const bool ends = dice.chance(0.7);
      return Chirp{
          .base = level,
          .rise_time = edge(1),
          .amplitude = level * dice.log_between(0.02, 0.3),
          .angular_frequency = 2 * pi / period * dice.log_between(0.2, 10),
          .frequency_ratio = ends ? dice.log_between(0.3, 3) : 1,
          .phase = dice.between(0, 2 * pi),
          .start = start,
          .end = ends ? start + lasts : std::numeric_limits<double>::infinity(),
          .fade = ends && dice.chance(0.5) ? lasts * dice.between(0, 0.5) : 0,
          .decay_time = ends && dice.chance(0.5) ? std::numeric_limits<double>::infinity() : period * dice.log_between(0.1, 3)};
    }
    case 4: {
      BSpline spline{.levels = {}, .duration = period * dice.log_between(0.2, 5)};
      for (int more = dice.whole(3, 8); more > 0; --more) spline.levels.push_back(level * dice.between(0, 1.2));
      spline.levels.push_back(level);
      return spline;
    }
    case 5: {
      Sines sines{
          .base = level, .rise_time = edge(1), .amplitudes = {}, .start = 0, .duration = period * dice.log_between(0.3, 5)};
      for (int more = dice.whole(1, 5); more > 0; --more) sines.amplitudes.push_back(level * dice.between(-0.2, 0.2));
      return sines;
    }
    default: {
      const double start = period * dice.between(0, 1), lasts = period * dice.log_between(0.3, 10);
      return Harmonic{.base = level,
                      .rise_time = edge(1),
                      .amplitude = level * dice.log_between(0.02, 0.3),
                      .angular_frequency = 2 * pi / period * dice.log_between(0.2, 20),
                      .phase = dice.between(0, 2 * pi),
                      .start = start,
                      .end = start + lasts,
                      .fade = dice.chance(0.5) ? 0 : lasts * dice.between(0, 0.5)};
    }
  }
}

/// Levels are 0.8 to 2 times the static pull-in voltage, and lower on an electrode that pulls away from the contact. The piezo
/// bends the beam by up to a third of the gap.
void put_waveforms(SceneFile& file, Dice& dice) {
  file.erase("waveform");
  file.erase("driver");
  const Scene scene = read_scene(file);
  const Switch model(scene.device);
  const double period = 2 * pi / model.basis().angular_frequencies()[0];
  double volts = 0;  // static pull-in voltage of the last electrode that pulls in
  for (std::size_t k = 0; k < model.drives(); ++k) {
    const DriveKind kind = model.drive_kind(k);
    if (kind == DriveKind::piezo) {
      const double per_volt = (model.basis()
                                   .contact_shape()
                                   .cwiseProduct(model.basis().piezo_shape())
                                   .cwiseQuotient(model.basis().angular_frequencies().cwiseAbs2()))
                                  .sum();
      const double bends = dice.log_between(0.01, 0.3) * (dice.chance(0.5) ? -1 : 1) * scene.device.gap.contact;
      file.set_waveform(std::string(piezo_drive), waveform(dice, bends / per_volt, period));
    } else if (kind == DriveKind::dispersion) {
      if (volts > 0) continue;
      const StaticPullIn found = static_pull_in(model, k);
      require(found.status == Status::done, "no pull-in");
      const double more = (1 + found.voltage) * dice.log_between(0.8, 2) - 1;  // in addition to the force itself
      file.set_waveform(std::string(dispersion_drive), more > 0 ? waveform(dice, more, period) : Step{.level = more});
    } else {
      const bool closes = pulls_in(scene.device, k);
      if (closes) {
        const StaticPullIn found = static_pull_in(model, k);
        require(found.status == Status::done, "no pull-in");
        volts = found.voltage;
      }
      const double level = volts * (closes ? dice.log_between(0.8, 2) : dice.log_between(0.1, 0.7));
      file.set_waveform(scene.device.electrodes[k].name, waveform(dice, level, period));
    }
  }
  put(file, "simulate.duration", period * dice.log_between(2, 20), "s");
}

}  // namespace

SceneFile random_scene(std::uint64_t seed, std::uint64_t index) {
  const std::string_view family = scene_families[index % scene_families.size()];
  for (int draw = 0; draw < most_draws; ++draw) {
    try {
      Dice dice(seed, index, static_cast<std::uint64_t>(draw));
      SceneFile file = SceneFile::load(fmt::format("{}/{}.toml", SOFTLAND_SCENES, family));
      put(file, "title", fmt::format("Random scene {} of seed {}, from {}", index, seed, family));
      file.erase("waveform");  // written again below; its units would require limits
      file.erase("driver");
      vary_structure(file, dice);
      vary_gaps(file, dice);
      vary_layer(file, dice);
      vary_electrodes(file, dice);
      vary_gas(file, dice);
      vary_dispersion(file, dice);
      vary_contact(file, dice);
      vary_rest_shape(file, Dice(seed, index, most_draws + 1 + static_cast<std::uint64_t>(draw)));
      put_waveforms(file, dice);
      const bool stands_open = prepare(file).model.rest().has_value();
      if (stands_open || dice.chance(0.1)) return file;  // a few scenes that collapse at rest suffice
    } catch (const InvalidInput&) {
    }
  }
  throw std::logic_error(fmt::format("no valid scene in {} draws: seed {}, index {}", most_draws, seed, index));
}

std::optional<SceneFile> random_film_scene(std::uint64_t seed, std::uint64_t index) {
  SceneFile file = random_scene(seed, index);
  const Device d = device_of(file);
  if (d.has_contact() && std::holds_alternative<RigidStop>(d.contacts.front().model)) return std::nullopt;
  Dice dice(seed, index, most_draws);  // random numbers that the scene itself does not use
  file.erase("gas");
  put(file, "gas.model", "reynolds");
  put_state(file, dice);
  return file;
}

}  // namespace softland::test
