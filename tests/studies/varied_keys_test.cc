// Every number of a device in the schema, in a scene that has it: [spread], `explore --vary` and `fit` accept it, and give the
// device of the scene with this value. Exceptions are in a table with their messages. The list of keys is the schema.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/require.h"
#include "config/plan.h"
#include "config/schema/laws.h"
#include "config/section_reader.h"
#include "studies/devices/ensemble.h"
#include "studies/inverse/fit.h"

namespace softland::varied_keys_test {
namespace {

using internal::Key;
using internal::KeyType;
using internal::SectionReader;
using testing::HasSubstr;

constexpr std::string_view usual_beam = R"([structure]
kind = "cantilever"
length = "250 um"
width = "20 um"
thickness = "2 um"
youngs_modulus = "78 GPa"
density = "19300 kg/m^3"
damping_ratio = 0.01
modes = 2
)";
constexpr std::string_view usual_gap = R"([gap]
electrode = "3.5 um"
contact = "2 um"
)";
constexpr std::string_view usual_electrode = R"([electrode.main]
span = ["60 um", "96 %"]
)";
constexpr std::string_view usual_contact = R"([contact]
model = "linear"
stiffness = "10 kN/m"
pad_length = "5 um"
)";
constexpr std::string_view usual_waveform = R"([waveform.main]
family = "step"
level = "30 V"
)";

std::string scene_of(std::string_view structure, std::string_view rest = usual_contact,
                     std::string_view electrode = usual_electrode, std::string_view gap = usual_gap) {
  return fmt::format("{}{}{}{}{}", structure, gap, electrode, rest, usual_waveform);
}

/// Returns scenes with the numbers of all sections except the laws of contacts and films.
std::map<std::string, std::string> scenes_of_parts() {
  const std::string beam(usual_beam);
  std::map<std::string, std::string> all;
  all["beam"] = scene_of(beam + "plate_strain = true\npoissons_ratio = 0.3\nstress_gradient = \"0.2 MPa/um\"\n",
                         std::string(usual_contact) + R"([piezo]
span = ["5 um", "240 um"]
thickness = "1 um"
youngs_modulus = "61 GPa"
density = "7750 kg/m^3"
d31 = "-171 pm/V"
relative_permittivity = 1500
)");
  all["effective piezo"] = scene_of(beam, std::string(usual_contact) + R"([piezo]
span = ["5 um", "240 um"]
thickness = "1 um"
youngs_modulus = "61 GPa"
density = "7750 kg/m^3"
e31 = "-12 C/m^2"
)");
  all["surfaces"] = scene_of(beam, std::string(usual_contact) + R"([surface]
elastic_modulus = "1 N/m"
residual_stress = "0.1 N/m"
cantilever_load = "compression"
[dispersion]
model = "van-der-waals"
hamaker_constant = "4e-19 J"
equilibrium_distance = "0.2 nm"
)");
  all["rest shape"] =
      scene_of(beam + R"(rest_shape = { positions = ["0 um", "40 %", "tip"], heights = ["0 nm", "20 nm", "50 nm"] })" + "\n");
  all["parts"] = scene_of(R"([structure]
kind = "cantilever"
modes = 2
stress_gradient = "0.1 MPa/um"
plate_strain = true
poissons_ratio = 0.3
anchor = { rotation = "1e-7 N m/rad", translation = "1e4 N/m" }
sections = [ { length = "60 um", width = "10 um", thickness = "2 um", youngs_modulus = "78 GPa", density = "19300 kg/m^3" },
             { length = "190 um", width = ["40 um", "20 um"], thickness = "3 um", youngs_modulus = "80 GPa", density = "19000 kg/m^3", holes = { pitch = "10 um", size = "4 um" } } ]
layers = [ { face = "near", span = ["10 um", "200 um"], thickness = "0.2 um", youngs_modulus = "70 GPa", density = "2200 kg/m^3", stress = "2 MPa", poissons_ratio = 0.2 } ]
)",
                          R"([contact.left]
at = "90 %"
gap = "1.9 um"
model = "linear"
stiffness = "10 kN/m"
pad_length = "5 um"
pad_width = "8 um"
resistivity = "22 nohm m"
hardness = "1 GPa"
film_resistance = "0.1 ohm"
mean_free_path = "38 nm"
[contact.right]
gap = "2 um"
model = "linear"
stiffness = "9 kN/m"
pad_length = "6 um"
count = 2
[contact.stop]
at = "200 um"
gap = "1 um"
side = "far"
model = "linear"
stiffness = "8 kN/m"
pad_length = "5 um"
)",
                          R"([electrode.main]
span = ["60 um", "200 um"]
dielectric = { thickness = "0.2 um", permittivity = 7.6, roughness = "5 nm" }
[electrode.back]
span = ["60 um", "200 um"]
side = "far"
gap = "3 um"
[waveform.back]
family = "step"
level = "5 V"
)",
                          "[gap]\nelectrode = \"3.5 um\"\n");
  all["bridge"] = scene_of(R"([structure]
kind = "clamped-clamped"
length = "400 um"
width = "20 um"
thickness = "2 um"
youngs_modulus = "78 GPa"
density = "19300 kg/m^3"
modes = 3
residual_stress = "4 MPa"
biaxial = true
poissons_ratio = 0.3
far_anchor = { rotation = "1e-6 N m/rad", translation = "2e4 N/m" }
)");
  all["landing"] = scene_of(R"([structure]
kind = "clamped-clamped"
length = "280 um"
width = "60 um"
thickness = "0.5 um"
youngs_modulus = "70 GPa"
density = "2700 kg/m^3"
modes = 5
)",
                            "", R"([electrode.main]
span = ["100 um", "180 um"]
dielectric = { thickness = "0.2 um", permittivity = 7.6, roughness = "5 nm", charge = "-10 uC/m^2", landing = { model = "linear", stiffness = "1e17 Pa/m", from = "30 nm" } }
)",
                            "[gap]\nelectrode = \"2.5 um\"\n");
  const std::string_view bed = R"(model = "linear", stiffness = "1e17 Pa/m", from = "30 nm")";
  std::string rough = all["landing"];
  rough.replace(rough.find(bed), bed.size(),
                R"(model = "asperity-uniform", asperity_radius = "100 nm", asperity_density = "1e13 1/m^2", )"
                R"(asperity_height = "30 nm", effective_modulus = "60 GPa")");
  all["landing on asperities"] = rough;
  all["plate"] = scene_of(R"([structure]
kind = "plate"
mass = "5e-9 kg"
stiffness = "50 N/m"
area = "0.04 mm^2"
width = "200 um"
thickness = "2 um"
)",
                          "[contact]\nmodel = \"linear\"\nstiffness = \"10 kN/m\"\n", "[electrode.main]\narea = \"0.03 mm^2\"\n");
  const auto gas = [&](const std::string& numbers) { return scene_of(beam, std::string(usual_contact) + "[gas]\n" + numbers); };
  all["film"] = gas("model = \"strip\"\nviscosity = \"1.86e-5 Pa s\"\nfilm_length = \"250 um\"\nfar_gap = \"3 um\"\n");
  all["rarefied film"] =
      gas("model = \"veijola\"\nviscosity = \"1.86e-5 Pa s\"\npressure = \"101325 Pa\"\nmean_free_path = \"68 nm\"\n");
  all["damper"] = gas("model = \"linear\"\ndamping = \"0.01 N s/m^2\"\n");
  all["damped contact"] = scene_of(beam, std::string(usual_contact) + "damping = \"0.5 s/m\"\n");
  std::string places, shape;
  for (int k = 0; k <= 12; ++k) {
    const double u = k / 12.0;
    places += fmt::format("\"{:.15g} um\",", 240 * u);
    shape += fmt::format("{:.15g},", 2e7 * u * u * (1 - u) * (1 - u));
  }
  all["modes"] =
      scene_of(fmt::format("[structure]\nkind = \"modes\"\npositions = [{}]\nfrequencies = [\"70 kHz\"]\nshapes = [[{}]]\nwidth "
                           "= \"20 um\"\nthickness "
                           "= \"2 um\"\nfar_anchor = \"clamped\"\naxial_stiffness = \"12 kN/m\"\n",
                           places, shape));
  all["modes with widths"] = scene_of(
      "[structure]\nkind = \"modes\"\npositions = [\"0 um\", \"120 um\", \"240 um\"]\nfrequencies = [\"20 kHz\"]\nshapes = [[0, "
      "3e5, "
      "1e6]]\nwidths = [\"20 um\", \"20 um\", \"15 um\"]\nrest_offsets = [\"0 nm\", \"5 nm\", \"20 nm\"]\nthickness = \"2 "
      "um\"\n");
  return all;
}

/// Returns the numbers of the example of a law.
template <class Law>
std::string numbers_of(const Law& law) {
  std::string text = fmt::format("model = \"{}\"\n", Law::name);
  for (const Field<Law>& field : fields_of<Law>) {
    if (field.in == nullptr) continue;
    Law own = law;
    const double value = field.in(own);
    if (!std::isfinite(value) || value == 0) continue;
    text += field.unit.empty() ? fmt::format("{} = {:.9e}\n", field.key, value)
                               : fmt::format("{} = \"{:.9g} {}\"\n", field.key, value, field.unit);
  }
  return text;
}

/// Returns the scene of a plate with another contact.
std::string edited_contact(std::string scene, const std::string& numbers) {
  const std::string_view before = "model = \"linear\"\nstiffness = \"10 kN/m\"\n";
  return scene.replace(scene.find(before), before.size(), numbers);
}

/// Returns a scene for each law of contacts and films.
std::map<std::string, std::string> scenes_of_laws() {
  std::map<std::string, std::string> all;
  for_each_law<ContactModel>([&]<class Law>(std::type_identity<Law>) {
    if (std::is_same_v<Law, RigidStop>) {
      all["contact rigid"] = edited_contact(scenes_of_parts().at("plate"), numbers_of(Law::example()));
      return;
    }
    all[fmt::format("contact {}", Law::name)] =
        scene_of(usual_beam, "[contact]\n" + numbers_of(Law::example()) + "pad_length = \"5 um\"\npad_width = \"10 um\"\n");
  });
  for_each_law<Gas>([&]<class Law>(std::type_identity<Law>) {
    all[fmt::format("gas {}", Law::name)] =
        scene_of(usual_beam, std::string(usual_contact) + "[gas]\n" + numbers_of(Law::example()));
  });
  return all;
}

/// A number of a scene.
struct Number {
  std::string path, list;  ///< "structure.sections[1].width[2]", and the same without the element of a list
  std::size_t element = 0;
  const Key* key = nullptr;
  Quantity value;
};

void gather(const SectionReader& in, std::vector<Number>& all) {
  for (const Key& key : in.keys()) {
    if (in.find(key.name) != &key || !in.has_value(key.name) || in.is_word(key.name)) continue;
    const std::string path = in.path(key.name);
    for (const SectionReader& part : key.part == nullptr ? std::vector<SectionReader>() : in.parts(key.name)) gather(part, all);
    if (key.type != KeyType::quantity && key.type != KeyType::quantities) continue;
    const std::vector<Quantity>& values = in.quantities(key.name);
    const bool is_list = in.is_list(key.name);
    for (std::size_t i = 0; i < values.size(); ++i)
      all.push_back({.path = is_list ? fmt::format("{}[{}]", path, i + 1) : path,
                     .list = path,
                     .element = is_list ? i + 1 : 0,
                     .key = &key,
                     .value = values[i]});
  }
}

std::vector<Number> numbers_of_scene(const SceneFile& file) {
  std::vector<Number> all;
  for (const internal::Section& section : internal::schema()) {
    if (!section.may_vary || file.impl().find({std::string(section.name)}) == nullptr) continue;
    if (!file.impl().is_named(section)) {
      gather(SectionReader(file.impl(), section.name), all);
    } else {
      for (const std::string& name : file.impl().names_in(std::string(section.name)))
        gather(SectionReader(file.impl(), section.name, name), all);
    }
  }
  return all;
}

/// Returns numbers that depend on all properties of a device: its position, the forces on it open and closed, the conduction of
/// its contacts.
std::vector<double> fingerprint(const Switch& model) {
  const Eigen::VectorXd& omega = model.basis().angular_frequencies();
  std::vector<double> all(omega.begin(), omega.end());
  const Device& d = model.device();
  all.insert(all.end(), {model.contact_gap(), d.contact_position(), model.basis().contact_shape()[0], model.bending_energy()});
  const std::vector<double> volts(model.drives(), 10.0);
  Switch::Workspace work = model.workspace();
  for (const double share : {0.3, 0.9, 1.0005, 1.02}) {
    Eigen::VectorXd q = Eigen::VectorXd::Zero(model.modes()), v = q, a = q;
    q[0] = share * model.contact_gap() / model.basis().contact_shape()[0], v[0] = 0.01 / model.basis().contact_shape()[0];
    model.accelerations(q.data(), v.data(), volts, share > 1, work, a.data());
    all.insert(all.end(), a.begin(), a.end());
    if (share > 1) all.push_back(model.potential(q.data(), volts, true, work));
    // The back stop is on the other side.
    q[0] = -share * 1.2e-6 / model.basis().contact_shape()[0];
    model.accelerations(q.data(), v.data(), volts, false, work, a.data());
    all.insert(all.end(), a.begin(), a.end());
  }
  for (std::size_t k = 0; k < d.contacts.size(); ++k) {
    const Contact& c = d.contacts[k];
    all.insert(all.end(), {d.contact_position(k), d.contact_gap(k), c.conduction.resistivity, c.conduction.hardness,
                           c.conduction.film_resistance, c.conduction.mean_free_path, c.pad_width, c.pad_length});
  }
  all.push_back(d.piezo ? d.piezo->relative_permittivity : 0);
  all.push_back(d.dispersion ? d.dispersion->equilibrium_distance : 0);
  // Add numbers for laws with a memory, with a film of their own, and with forces at a distance.
  const auto add_numbers = [&]<class Law>(Law law) {
    if constexpr (!std::is_same_v<Law, OwnContact>) {
      for (const Field<Law>& field : fields_of<Law>)
        if (field.in != nullptr) all.push_back(field.in(law));
    }
  };
  for (const Contact& c : d.contacts) std::visit(add_numbers, c.model);
  if (d.gas) std::visit(add_numbers, *d.gas);
  for (double& value : all) value = std::isfinite(value) ? value : 0;
  return all;
}

/// Returns the largest difference relative to `scale` and to the rounding of the sum.
double distance(const std::vector<double>& a, const std::vector<double>& b, const std::vector<double>& scale) {
  if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] != b[i]) most = std::max(most, std::abs(a[i] - b[i]) / std::max({std::abs(scale[i]), std::abs(b[i]), 1e-300}));
  }
  return most;
}

/// Numbers of a device that cannot vary, and the message; keys are without the NAME of their section.
const std::map<std::string, std::string> refused{
    {"structure.positions", "is not a key of this scene that holds one number of the device"},
    {"structure.frequencies", "is not a key of this scene that holds one number of the device"},
    {"structure.shapes", "is not a key of this scene that holds one number of the device"},
    {"structure.widths", "it belongs to the modes"},
    {"structure.rest_offsets", "it belongs to the modes"},
    {"structure.rest_shape.positions", "is not a key of this scene that holds one number of the device"},
};

/// Numbers that describe how a file of modes is read.
const std::set<std::string> of_files{"structure.mass", "structure.clamp"};

void gather(const std::string& prefix, const std::vector<Key>& keys, std::map<const Key*, std::string>& all) {
  for (const Key& key : keys) {
    const std::string path = fmt::format("{}.{}", prefix, key.name);
    if (key.part != nullptr) gather(path, key.part()->keys, all);
    if (key.type == KeyType::quantity || key.type == KeyType::quantities) all[&key] = path;
  }
}

std::map<const Key*, std::string> numbers_of_schema() {
  std::map<const Key*, std::string> all;
  for (const internal::Section& section : internal::schema()) {
    if (section.may_vary) gather(std::string(section.name), section.keys, all);
  }
  return all;
}

/// Returns the path without the NAME of its section.
std::string without_name(const SceneFile& file, const std::string& path) {
  std::vector<std::string> parts = internal::split_path(path);
  const internal::Section* const section = internal::find_section(parts[0], parts[1]);
  if (file.impl().is_named(*section)) parts.erase(parts.begin() + 1);
  return fmt::format("{}", fmt::join(parts, "."));
}

std::string refusal(const auto& action) {
  try {
    action();
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return {};
}

constexpr double more = 1.01;  // factor of a number over that of the scene

/// Expects every way of varying the number to give the same device.
void expect_varied(const SceneFile& file, const Number& number, const std::vector<double>& nominal) {
  // Tolerances relative to the effect of the number, and relative to all: a device keeps the nominal quadrature points.
  constexpr double same = 1e-3, quadrature = 1e-4;
  SceneFile written = file, spread = file;
  written.assign(number.list, Quantity{.value = more * number.value.value, .dimension = number.value.dimension}, number.element);
  const std::vector<double> expected = fingerprint(prepare(written).model);
  const double moved = distance(nominal, expected, nominal);
  EXPECT_GT(moved, 0) << "it does nothing";

  spread.set(fmt::format("spread.\"{}\"={{distribution=\"normal\",cov=\"1 %\"}}", number.path));
  const PreparedScene prepared = prepare(spread);
  const Ensemble ensemble(prepared, 1);
  const SampledDevice device = DeviceBuilder(ensemble).device(std::vector{more});
  ASSERT_TRUE(device.model) << device.refusal;
  EXPECT_LE(distance(fingerprint(*device.model), expected, nominal), same * moved + quadrature) << "in [spread]";

  const double here = number.value.value, there = more * here;
  const auto text = [&](double value) { return quantity_text(value, number.value.dimension); };
  PlanRequest request{.scene = file, .vary = {fmt::format("{}={},{}", number.path, text(here), text(there))}};
  request.place = [](std::string_view, std::size_t) { return std::string("--vary"); };
  ASSERT_EQ(refusal([&] { (void)Plan(request); }), "");
  const Plan plan(request);
  EXPECT_LE(distance(fingerprint(prepare(plan.scene(plan.values(1))).model), expected, nominal), same * moved + quadrature)
      << "--vary";
}

// Each number of a device in the schema occurs in one of the scenes.
TEST(VariedKeys, AreAllNumbersOfADevice) {
  std::set<const Key*> seen;
  const auto cases = [] {
    std::map<std::string, std::string> all = scenes_of_parts();
    all.merge(scenes_of_laws());
    return all;
  }();
  for (const auto& [name, text] : cases) {
    SCOPED_TRACE(name);
    const SceneFile file = SceneFile::parse(text, "x.toml");
    const std::vector<double> nominal = fingerprint(prepare(file).model);
    for (const Number& number : numbers_of_scene(file)) {
      SCOPED_TRACE(number.path);
      const std::string general = without_name(file, number.path), of_list = without_name(file, number.list);
      const std::string answer = refusal([&] {
        SceneFile spread = file;
        spread.set(fmt::format("spread.\"{}\"={{distribution=\"normal\",cov=\"1 %\"}}", number.path));
        static_cast<void>(read_scene(spread));
      });
      const auto rule = refused.contains(general) ? refused.find(general) : refused.find(of_list);
      if (rule != refused.end() || !number.key->why_fixed.empty()) {
        EXPECT_THAT(answer, HasSubstr(rule != refused.end() ? rule->second : std::string(number.key->why_fixed)));
        seen.insert(number.key);
        continue;
      }
      if (number.value.value == 0) {
        EXPECT_THAT(answer, HasSubstr("is 0 in this scene"));
        continue;
      }
      EXPECT_EQ(answer, "");
      if (!answer.empty()) continue;
      seen.insert(number.key);
      expect_varied(file, number, nominal);
    }
  }
  for (const auto& [key, path] : numbers_of_schema())
    EXPECT_TRUE(seen.contains(key) || of_files.contains(path)) << path << " stands in no scene";
  EXPECT_GT(seen.size(), 100u);
}

TEST(VariedKeys, MayBeUnknownsOfAFit) {
  if (!has_ceres()) GTEST_SKIP() << "skipped: no Ceres; needs: libceres-dev";
  const auto fitted = [](const std::string& scene, const std::string& quantity, double value, const std::string& unknown) {
    const SceneFile file = SceneFile::parse(scenes_of_parts().at(scene), "x.toml");
    Bench bench{.name = "bench.toml", .measurements = {}, .changes = {}};
    bench.measurements.push_back({.quantity = quantity, .values = {value}, .errors = {1e-4 * value}});
    return fit(file, bench, {.unknowns = {unknown}, .starts = 3, .suggest = false});
  };
  // Fits the number to the frequency of the scene in which it is larger by a hundredth.
  for (const auto& [scene, keys] : std::map<std::string, std::vector<std::string>>{
           {"parts",
            {"structure.sections[1].width", "structure.sections[2].width[2]", "structure.sections[1].thickness",
             "structure.sections[1].length", "structure.sections[2].youngs_modulus", "structure.sections[2].density",
             "structure.sections[2].holes.size", "structure.layers[1].thickness", "structure.anchor.rotation",
             "structure.anchor.translation"}},
           {"bridge", {"structure.far_anchor.rotation", "structure.residual_stress"}}}) {
    for (const std::string& key : keys) {
      SCOPED_TRACE(key);
      const SceneFile file = SceneFile::parse(scenes_of_parts().at(scene), "x.toml");
      const auto all = numbers_of_scene(file);
      const auto number = std::ranges::find(all, key, &Number::path);
      ASSERT_NE(number, all.end());
      SceneFile written = file;
      written.assign(number->list, Quantity{.value = more * number->value.value, .dimension = number->value.dimension},
                     number->element);
      const double frequency = prepare(written).model.basis().angular_frequencies()[0] / (2 * pi);
      const Fit found = fitted(scene, "frequency", frequency, key);
      ASSERT_TRUE(found.found);
      EXPECT_NEAR(found.unknowns.front().value / number->value.value, more, 1e-4);
    }
  }
  // No measurement of a bench file depends on resistances.
  EXPECT_THAT(refusal([&] { (void)fitted("parts", "frequency", 5e4, "contact.left.resistivity"); }),
              HasSubstr("contact.left.resistivity: no measurement of bench.toml depends on it"));
  EXPECT_THAT(refusal([&] { (void)fitted("parts", "frequency", 5e4, "metrics.closed_force"); }),
              HasSubstr("is not a key of this scene that holds one number of the device"));
  EXPECT_THAT(refusal([&] { (void)fitted("parts", "frequency", 5e4, "contact.right.count"); }),
              HasSubstr("it is a number of contacts"));
}

}  // namespace
}  // namespace softland::varied_keys_test
