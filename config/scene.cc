#include "config/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/engineering.h"
#include "base/require.h"
#include "config/drives.h"
#include "config/section_reader.h"
#include "model/beam.h"
#include "model/gas/gas_law.h"
#include "model/surface.h"

namespace softland {
namespace {

using internal::SectionReader;

Fringing fringing(const std::string& name) {
  if (name == "none") return Fringing::none;
  if (name == "bao-2001") return Fringing::bao_2001;
  if (name == "linear") return Fringing::linear;
  return Fringing::meijs_fokkema;
}

Conductor conductor(const std::string& name) { return name == "gold" ? Conductor::gold : Conductor::ideal; }

Side side(const std::string& name) {
  if (name == "far") return Side::far;
  return name == "both" ? Side::both : Side::near;
}

void check_section_names(const SceneFile::Impl& file) {
  std::vector<std::string_view> known;
  for (const internal::Section& section : internal::schema()) {
    if (!section.name.empty() && section.entry.empty()) known.push_back(section.name);
  }
  for (const auto& [name, node] : file.root) {
    if (internal::find_section("")->find(name.str())) continue;
    const std::string path = internal::join_path("", name.str());
    const internal::Section* section = internal::find_section(name.str());
    if (!section || name.str().empty()) {
      if (node.is_table()) file.fail_section(path, "unknown section" + internal::hint(name.str(), known));
      known.emplace_back("title");
      file.fail(path, "unknown key" + internal::hint(name.str(), known));
    }
  }
}

Structure read_plate(const SectionReader& in) {
  const double area = in.number("area");
  // Where no law needs its width a plate is as good as square.
  const double width = in.is_given("width") ? in.number("width") : std::sqrt(area);
  return {.kind = StructureKind::plate,
          .length = area / width,
          .width = width,
          .thickness = in.number("thickness"),
          .modes = 1,
          .mass = in.number("mass"),
          .stiffness = in.number("stiffness"),
          .damping_ratio = in.number("damping_ratio")};
}

bool is_plate(const SectionReader& structure) { return structure.text("kind") == "plate"; }

Structure read_structure(const SectionReader& in) {
  if (is_plate(in)) return read_plate(in);
  Structure s{.length = in.number("length"),
              .width = in.number("width"),
              .thickness = in.number("thickness"),
              .youngs_modulus = in.number("youngs_modulus"),
              .density = in.number("density"),
              .modes = in.is_word("modes") ? Structure{}.modes : in.integer("modes"),
              .damping_ratio = in.number("damping_ratio"),
              .plate_strain = in.flag("plate_strain"),
              .poissons_ratio = in.number("poissons_ratio")};
  const auto needs_poissons_ratio = [&](const char* key) {
    in.require(!in.flag(key) || in.is_given("poissons_ratio"), key, "needs structure.poissons_ratio");
  };
  needs_poissons_ratio("plate_strain");
  if (in.text("kind") != "clamped-clamped") return s;
  needs_poissons_ratio("biaxial");
  s.kind = StructureKind::clamped_clamped;
  s.residual_stress = in.number("residual_stress");
  s.biaxial = in.flag("biaxial");
  s.stretching = in.flag("stretching");
  return s;
}

Gap read_gap(const SectionReader& in) {
  const Gap gap{.electrode = in.number("electrode"), .contact = in.number("contact")};
  in.require(gap.contact < gap.electrode, "contact", "must be less than " + in.written("electrode"));
  // A run that comes within a hundredth of the electrode gap of the electrode has failed: see Switch::gap_floor().
  constexpr double most = 0.99;
  in.require(gap.contact < most * gap.electrode, "contact",
             fmt::format("must be less than {:g} times {}: nearer than a hundredth of that gap no force law holds", most,
                         in.written("electrode")));
  return gap;
}

Surface read_surface(const SectionReader& in) {
  return {.elastic_modulus = in.number("elastic_modulus"),
          .residual_stress = in.number("residual_stress"),
          .faces = in.text("faces") == "wide" ? SurfaceFaces::wide : SurfaceFaces::all,
          .cantilever_load = in.text("cantilever_load") == "compression" ? ResidualLoad::compression : ResidualLoad::none};
}

/// What a law per length needs to know of a plate, if this is one.
void require_of_plate(const SectionReader& in, std::string_view key, const SectionReader& structure, std::string_view needed) {
  in.require(!is_plate(structure) || structure.is_given(needed), key, fmt::format("needs structure.{} on a plate", needed));
}

/// A span along the beam: [begin, end] in metres.
std::pair<double, double> read_span(const SectionReader& in, const SectionReader& structure) {
  const double begin = in.quantities("span")[0].value;
  const double end = in.quantities("span")[1].value;
  in.require(begin < end, "span", "the end must lie beyond the begin");
  in.require(end <= structure.number("length"), "span", "must end on the beam: " + structure.written("length"));
  return {begin, end};
}

/// Where an electrode begins and ends [m]; a plate counts the length that gives its area.
std::pair<double, double> read_extent(const SceneFile::Impl& file, const SectionReader& in, const SectionReader& structure,
                                      const Structure& s) {
  if (is_plate(structure)) {
    in.require(!in.is_given("span"), "span", "belongs to a beam; the electrode of a plate has an area");
    if (!in.is_given("area")) return {0, s.length};
    in.require(in.number("area") <= structure.number("area"), "area", "must not exceed " + structure.written("area"));
    return {0, in.number("area") / s.width};
  }
  in.require(!in.is_given("area"), "area", "belongs to a plate; the electrode of a beam has a span");
  if (!in.is_given("span")) file.fail_section(in.path(), R"(missing key 'span' (a list such as ["2 um", "2 um"]))");
  return read_span(in, structure);
}

double read_pad_length(const SceneFile::Impl& file, const SectionReader& in, const SectionReader& structure, const Structure& s) {
  const std::string& model = in.text("model");
  const bool is_rough = model != "linear" && model != "hysteretic" && model != "rigid";  // or has an area
  if (!in.is_given("pad_length")) {
    if (is_plate(structure) && !is_rough) return 0;  // only the area of a plate's pad would count
    file.fail_section(in.path(), R"(missing key 'pad_length' (a length such as "2 um"))");
  }
  if (is_rough) require_of_plate(in, "pad_length", structure, "width");
  const double pad_length = in.number("pad_length");
  in.require(pad_length < s.length, "pad_length",
             "must be less than " + (is_plate(structure) ? "structure.area / structure.width" : structure.written("length")));
  return pad_length;
}

Contact read_contact(const SceneFile::Impl& file, const SectionReader& in, const SectionReader& structure, const Structure& s) {
  Contact contact{.pad_length = read_pad_length(file, in, structure, s)};
  for (const ContactModel model : all_contact_models) {
    if (in.text("model") == to_string(model)) contact.model = model;
  }
  const auto read = [&](const char* key, double& value) {
    if (in.has_value(key)) value = in.number(key);
  };
  read("stiffness", contact.stiffness);
  read("asperity_radius", contact.asperity_radius);
  read("asperity_density", contact.asperity_density);
  read("asperity_height", contact.asperity_height);
  read("asperity_deviation", contact.asperity_deviation);
  read("effective_modulus", contact.effective_modulus);
  read("adhesion_energy", contact.adhesion_energy);
  read("damping", contact.damping);
  read("unloading_stiffness", contact.unloading_stiffness);
  read("hardness", contact.hardness);
  read("restitution", contact.restitution);
  read("asperity_pressure", contact.pressure.asperity_pressure);
  read("asperity_distance", contact.pressure.asperity_distance);
  read("wall_pressure", contact.pressure.wall_pressure);
  read("wall_range", contact.pressure.wall_range);
  read("adhesion_pressure", contact.pressure.adhesion_pressure);
  read("adhesion_range", contact.pressure.adhesion_range);
  read("hamaker_constant", contact.pressure.hamaker_constant);
  read("smoothing_distance", contact.pressure.smoothing_distance);
  read("reach", contact.pressure.reach);
  in.require(contact.model != ContactModel::rigid || is_plate(structure), "model",
             "needs a plate: a beam has modes that take part in an impact");
  if (contact.model == ContactModel::hysteretic) {
    in.require(contact.unloading_stiffness >= contact.stiffness, "unloading_stiffness",
               "must not be below " + in.written("stiffness"));
  }
  in.require(contact.model != ContactModel::elastic_plastic || in.text("plasticity") != "ceb", "plasticity",
             "the force of Chang, Etsion and Bogy as published jumps by about half at the critical interference, which no "
             "integrator of motion can use; take \"zmc\" or \"ke\"");
  if (in.has_value("plasticity") && in.text("plasticity") == "ke") contact.plasticity = Plasticity::kogut_etsion;
  if (in.text("distribution") == "pad") {
    contact.distribution = ContactDistribution::pad;
    const std::string wrong = why_not_along_pad(s, contact);
    in.require(wrong.empty(), "distribution", wrong);
  }
  return contact;
}

Gas read_gas(const SectionReader& in) {
  Gas gas;
  for (const GasModelEntry& e : gas_models) {
    if (e.name == in.text("model")) gas.model = e.model;
  }
  gas.damping = in.number("damping");
  gas.quality_factor = in.number("quality_factor");
  if (gas.model == GasModel::linear) return gas;
  gas.viscosity = in.number("viscosity");
  gas.pressure = in.number("pressure");
  gas.temperature = in.number("temperature");
  gas.mean_free_path = in.number("mean_free_path");
  gas.far_gap = in.number("far_gap");
  if (in.has_value("film_length")) gas.film_length = in.number("film_length");
  if (gas.model == GasModel::strip_slit) {
    gas.slit_height = in.number("slit_height");
    gas.slit_length = in.number("slit_length");
  }
  return gas;
}

Dispersion read_dispersion(const SectionReader& in, const Gap& gap) {
  const std::string& model = in.text("model");
  if (model == "casimir") {
    return {.model = DispersionModel::casimir, .conductor = conductor(in.text("conductor"))};
  }
  Dispersion dispersion{.hamaker_constant = in.number("hamaker_constant"),
                        .equilibrium_distance = in.number("equilibrium_distance")};
  in.require(dispersion.equilibrium_distance < gap.electrode - gap.contact, "equilibrium_distance",
             "must be less than the closed gap, gap.electrode - gap.contact");
  if (model == "van-der-waals") {
    dispersion.model = DispersionModel::van_der_waals;
  } else {
    dispersion.conductor = conductor(in.text("conductor"));
  }
  return dispersion;
}

Device read_device(const SceneFile::Impl& file) {
  const SectionReader structure(file, "structure");
  Device device{.structure = read_structure(structure), .gap = read_gap(SectionReader(file, "gap"))};
  for (const std::string& name : file.names_in("electrode")) {
    internal::check_drive_name(file, name);
    const SectionReader in(file, "electrode", name);
    const auto [begin, end] = read_extent(file, in, structure, device.structure);
    const Fringing law = fringing(in.text("fringing"));
    if (law != Fringing::none && is_plate(structure)) {
      const auto given = [&](std::string_view key) { return structure.is_given(key); };
      if (!given("width") || (law != Fringing::linear && !given("thickness"))) {
        file.fail_section(in.path(), fmt::format("fringing = {} needs structure.width{} on a plate; fringing = \"none\" does not",
                                                 internal::toml_string(in.text("fringing")),
                                                 law == Fringing::linear ? "" : " and structure.thickness"));
      }
    }
    const Side at = side(in.text("side"));
    in.require(at != Side::near || !in.is_given("gap"), "gap",
               "belongs to side = \"far\" or \"both\"; on the near side the distance is gap.electrode");
    if (at != Side::near && !in.is_given("gap")) {
      file.fail_section(in.path(),
                        fmt::format("side = {} needs 'gap' (a length such as \"2 um\"): the rest distance on the far side",
                                    internal::toml_string(in.text("side"))));
    }
    device.electrodes.push_back(
        {.name = name, .begin = begin, .end = end, .fringing = law, .side = at, .gap = at == Side::near ? 0 : in.number("gap")});
  }
  if (const auto conflict = electrode_conflict(device.structure, device.electrodes)) {
    const SectionReader in(file, "electrode", device.electrodes[conflict->electrode].name);
    for (const std::string_view key : {"span", "area"}) in.require(!in.is_given(key), key, conflict->why);
    file.fail_section(in.path(), conflict->why);
  }
  if (const SectionReader in(file, "gas"); in.is_present()) {
    if (!in.is_given("quality_factor")) require_of_plate(in, "model", structure, "width");
    if (in.text("model") == "guo-alexeenko") require_of_plate(in, "model", structure, "thickness");
    device.gas = read_gas(in);
  }
  if (const SectionReader in(file, "contact"); in.is_present()) {
    device.contact = read_contact(file, in, structure, device.structure);
    in.require(device.contact->model != ContactModel::rigid || !device.gas || !is_compressible(device.gas->model), "model",
               "not with gas.model = \"reynolds\", whose film still flows under a plate that rests");
  }
  if (const SectionReader in(file, "dispersion"); in.is_present()) device.dispersion = read_dispersion(in, device.gap);
  if (const SectionReader in(file, "surface"); in.is_present()) {
    device.surface = read_surface(in);
    if (const std::string wrong = why_no_surface(device); !wrong.empty()) file.fail_section(in.path(), wrong);
  } else if (device.structure.kind == StructureKind::clamped_clamped) {
    const std::string buckled = why_buckled(device.structure);
    structure.require(buckled.empty(), "residual_stress", buckled);
  }
  if (const SectionReader in(file, "piezo"); in.is_present()) {
    if (is_plate(structure)) file.fail_section(in.path(), "a plate does not bend; a layer needs a beam");
    if (device.surface) file.fail_section(in.path(), "covers a face of the beam; [surface] is for a bare beam");
    if (device.structure.kind == StructureKind::clamped_clamped) {
      file.fail_section(in.path(),
                        "between two clamps the layer's axial force is not released: it would stretch or buckle the beam, and "
                        "pull off its middle line; a layer needs a cantilever");
    }
    const auto [begin, end] = read_span(in, structure);
    device.piezo = Piezo{.begin = begin,
                         .end = end,
                         .thickness = in.number("thickness"),
                         .youngs_modulus = in.number("youngs_modulus"),
                         .density = in.number("density"),
                         .d31 = in.number("d31")};
  }
  return device;
}

SimulateOptions read_simulate(const SectionReader& in) {
  SimulateOptions options;
  if (in.is_given("duration")) options.duration = in.number("duration");
  if (in.is_given("tolerance")) {
    options.tolerance = in.number("tolerance");
  } else {
    options.accuracy = in.number("accuracy");
  }
  options.automatic_effects = in.text("effects") == "auto";
  options.effects_tolerance = in.number("effects_tolerance");
  return options;
}

MetricsOptions read_metrics(const SectionReader& in, const SectionReader& gap) {
  const MetricsOptions options{.significant_rebound = in.number("significant_rebound")};
  const bool seen = options.significant_rebound < gap.number("contact");
  in.require(seen || !in.is_given("significant_rebound"), "significant_rebound", "must be less than " + gap.written("contact"));
  gap.require(seen, "contact",
              "must exceed metrics.significant_rebound, which is " + engineering(options.significant_rebound, "m"));
  return options;
}

/// The key that [spread."NAME"] varies. Throws InvalidInput unless it is a number that is in force in this scene.
const internal::Key& varied_key(const SceneFile::Impl& file, const SectionReader& in, const std::string& name) {
  std::vector<std::string> parts;
  try {
    parts = internal::split_path(name);
  } catch (const InvalidInput& error) {
    file.fail_section(in.path(), error.what());
  }
  std::vector<std::string_view> candidates;
  const internal::Section* section = internal::find_section(parts.front(), parts.size() > 1 ? parts[1] : std::string());
  const std::size_t depth = section && section->is_named ? 3 : 2;
  if (section && section->may_vary && parts.size() == depth && file.find({parts.begin(), parts.end() - 1})) {
    const SectionReader varied(file, parts[0], section->is_named ? parts[1] : std::string());
    for (const internal::Key& key : section->keys) {
      if (key.type == internal::KeyType::quantity && varied.find(key.name) == &key && varied.has_value(key.name))
        candidates.push_back(key.name);
    }
    if (std::find(candidates.begin(), candidates.end(), parts.back()) != candidates.end()) return *varied.find(parts.back());
  }
  file.fail_section(in.path(), fmt::format("'{}' is not a key of this scene that holds one number of the device{}", name,
                                           internal::hint(parts.back(), candidates)));
}

/// Returns whether there is a spread.
bool check_spread(const SceneFile::Impl& file) {
  const std::vector<std::string> names = file.names_in("spread");
  for (const std::string& name : names) {
    const SectionReader in(file, "spread", name);
    const auto& allowed = varied_key(file, in, name).dimensions;
    if (!in.is_given("half_width")) continue;
    const Dimension given = in.quantities("half_width").front().dimension;
    const bool is_percentage = given == dimension::none;
    in.require(is_percentage || std::find(allowed.begin(), allowed.end(), given) != allowed.end(), "half_width",
               fmt::format("expected {}, got {}", describe(allowed.front()), describe(given)));
  }
  return !names.empty();
}

std::vector<std::string> find_warnings(const SceneFile::Impl& file, const Device& device, bool has_spread) {
  std::vector<std::string> warnings;
  if (device.electrodes.empty() && !device.piezo && !file.find({"waveform", "dispersion"})) {
    warnings.push_back(file.name + ": neither an electrode nor a piezo layer: nothing drives this switch");
  }
  if (const auto& surface = device.surface; surface && surface->residual_stress != 0 &&
                                            device.structure.kind == StructureKind::cantilever &&
                                            surface->cantilever_load == ResidualLoad::none) {
    warnings.push_back(fmt::format(
        "{}: surface.residual_stress does nothing to a cantilever unless surface.cantilever_load says so", file.name));
  }
  constexpr double wide = 5;          // width over thickness from which the beam bends more like a plate
  constexpr double rounding = 1e-12;  // 20 um is not more than five times 4 um, whatever the last bit says
  const Structure& structure = device.structure;
  if (structure.kind != StructureKind::plate && !structure.plate_strain &&
      structure.width > wide * structure.thickness * (1 + rounding)) {
    warnings.push_back(fmt::format(
        "{}: {}: more than five thicknesses; youngs_modulus is used as given, plate_strain = true with poissons_ratio would "
        "use E / (1 - nu^2)",
        file.origin("structure.width").text, file.written("structure.width")));
  }
  if (has_spread) {
    warnings.push_back(
        fmt::format("{}: [spread] describes device variation and is not used by this command", file.origin("spread").text));
  }
  return warnings;
}

}  // namespace

Scene read_scene(const SceneFile& file) {
  const SceneFile::Impl& impl = file.impl();
  check_section_names(impl);
  Scene scene{.title = SectionReader(impl, "").text("title"),
              .device = read_device(impl),
              .simulate = read_simulate(SectionReader(impl, "simulate")),
              .auto_modes = SectionReader(impl, "structure").is_word("modes"),
              .metrics = read_metrics(SectionReader(impl, "metrics"), SectionReader(impl, "gap")),
              .need_pull_in = {},
              .warnings = {},
              .file = file};
  scene.need_pull_in = internal::check_drives(impl, scene.device);
  scene.warnings = find_warnings(impl, scene.device, check_spread(impl));
  try {
    validate(scene.device);
  } catch (const InvalidInput& error) {
    throw InvalidInput(fmt::format("{}: {}", impl.name, error.what()));
  }
  return scene;
}

Drives Scene::drives(const std::map<std::string, PullInVoltages>& pull_in) const {
  for (const std::string& name : need_pull_in) {
    const auto known = pull_in.find(name);
    require(known != pull_in.end(), fmt::format("{}: the pull-in voltages of electrode '{}' are needed", file.name(), name));
    const auto& [static_voltage, dynamic_voltage] = known->second;
    require(static_voltage > 0 && dynamic_voltage > 0 && std::isfinite(static_voltage) && std::isfinite(dynamic_voltage),
            fmt::format("{}: electrode '{}' has no pull-in voltage (static {} V, dynamic {} V) to multiply", file.name(), name,
                        static_voltage, dynamic_voltage));
  }
  return internal::read_drives(file.impl(), device, pull_in);
}

SceneFile resolved(const Scene& scene, const std::map<std::string, PullInVoltages>& pull_in) {
  const Drives drives = scene.drives(pull_in);
  const SceneFile::Impl& impl = scene.file.impl();
  toml::table root;
  for (const internal::Section& section : internal::schema()) {
    const std::string name(section.name);
    if (name == "waveform" || name == "driver") continue;
    if (name.empty()) {
      root = SectionReader(impl, "").with_defaults();
    } else if (!section.is_named) {
      const SectionReader in(impl, name);
      if (in.is_present() || section.always_in_force) root.insert(name, in.with_defaults());
    } else {
      toml::table named;
      for (const std::string& entry : impl.names_in(name)) {
        toml::table keys = SectionReader(impl, name, entry).with_defaults();
        keys.is_inline(name == "spread");
        named.insert(entry, std::move(keys));
      }
      if (!named.empty()) root.insert(name, std::move(named));
    }
  }
  toml::table drivers;
  for (const auto& [name, limits] : drives.limits) {
    toml::table keys;
    const auto insert = [&](std::string_view key, double value, const Dimension& unit) {
      if (std::isfinite(value)) keys.insert(key, quantity_text(value, unit));
    };
    insert("min_voltage", limits.min_voltage, dimension::voltage);
    insert("max_voltage", limits.max_voltage, dimension::voltage);
    insert("max_slew", limits.max_slew, dimension::slew_rate);
    drivers.insert(name, std::move(keys));
  }
  if (!drivers.empty()) root.insert("driver", std::move(drivers));

  // Written and read once more: like any other file, the result then has lines to cite.
  SceneFile file = SceneFile::parse(internal::write_scene(root), impl.name + " (resolved)", impl.directory);
  for (const auto& [name, waveform] : drives.waveforms) file.set_waveform(name, waveform);
  return file;
}

}  // namespace softland
