// Bad input, one case each, with the whole message: place, key path, value as written, rule, and the nearest known name.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <type_traits>
#include <vector>

#include "base/require.h"
#include "config/scene.h"
#include "tests/config/message.h"
#include "tests/config/small_scene.h"
#include "waveforms/waveform.h"

namespace softland {
namespace {

TEST(Messages, TheSmallSceneItselfIsFine) { EXPECT_EQ(message(std::string(small_scene)), ""); }

struct Edit {
  std::string from;
  std::string to;
  std::string expected;
};

std::ostream& operator<<(std::ostream& out, const Edit& edit) { return out << edit.from << " -> " << edit.to; }

class BadFile : public testing::TestWithParam<Edit> {};

TEST_P(BadFile, IsRefusedWithThisMessage) {
  ASSERT_NE(small_scene.find(GetParam().from), std::string_view::npos) << GetParam().from;
  EXPECT_EQ(message(edited(small_scene, GetParam().from, GetParam().to)), GetParam().expected);
}

const std::string main_step = "family = \"step\"\nlevel = \"1.25 Vdp\"";
const std::string harmonic = "family = \"harmonic\"\n";
const std::string table = "family = \"table\"\n";

/// Returns the families as a message lists them.
std::string listed_families() {
  std::string all;
  for_each_family(
      [&](const auto& one) { all += (all.empty() ? "" : ", ") + std::string(FamilyOf<std::decay_t<decltype(one)>>::name); });
  return all;
}
const std::string more_damping = R"(; for more give [gas] model = "linear" and quality_factor = 1 / (2 damping_ratio))";

/// Adds a line to [structure] that is not in the small scene.
Edit structure_line(const std::string& line, const std::string& expected) { return {"[gap]", line + "\n[gap]", expected}; }

/// Adds a line to [spread].
Edit spread_line(const std::string& line, const std::string& expected) {
  return {"[gas]", "[spread]\n" + line + "\n[gas]", expected};
}

// clang-format off
INSTANTIATE_TEST_SUITE_P(Quantities, BadFile, testing::Values(
    Edit{R"("4 um")", R"("4 u")", R"(x.toml:6: structure.thickness = "4 u": unknown unit 'u' (expected a length such as "2 um"))"},
    Edit{R"("4 um")", R"("4_um")", R"(x.toml:6: structure.thickness = "4_um": must be a number and a unit (expected a length such as "2 um"))"},
    Edit{R"("4 um")", R"("4")", R"(x.toml:6: structure.thickness = "4": no unit (expected a length such as "2 um"))"},
    Edit{R"("4 um")", R"(4)", R"(x.toml:6: structure.thickness = 4: no unit (expected a length such as "2 um"))"},
    Edit{R"("4 um")", R"(4e-6)", R"(x.toml:6: structure.thickness = 4e-06: no unit (expected a length such as "2 um"))"},
    Edit{R"("4 um")", R"(true)", R"(x.toml:6: structure.thickness = true: not a number with a unit (expected a length such as "2 um"))"},
    Edit{R"("4 um")", R"(["4 um"])", R"(x.toml:6: structure.thickness = ["4 um"]: not a number with a unit (expected a length such as "2 um"); sections describe a beam that changes along it: sections = [{ length = "60 um", width = "10 um" }, { length = "190 um", width = ["40 um", "20 um"] }])"},
    Edit{R"("4 um")", R"("")", R"(x.toml:6: structure.thickness = "": must be a number and a unit (expected a length such as "2 um"))"},
    Edit{R"("4 um")", R"("4 GPa")", R"(x.toml:6: structure.thickness = "4 GPa": expected a length [m], got a pressure [Pa])"},
    Edit{R"("4 um")", R"("4 um s/V")", R"(x.toml:6: structure.thickness = "4 um s/V": expected a length [m], got a quantity [m^-1 kg^-1 s^4 A])"},
    Edit{R"("4 um")", R"("-4 um")", R"(x.toml:6: structure.thickness = "-4 um": must be in [1 pm, 1 m])"},
    Edit{R"("4 um")", R"("0 um")", R"(x.toml:6: structure.thickness = "0 um": must be in [1 pm, 1 m])"},
    Edit{R"("4 um")", R"("4e999 um")", R"(x.toml:6: structure.thickness = "4e999 um": 4e999 is outside the range of double precision (expected a length such as "2 um"))"},
    Edit{R"("4 um")", R"("4 um/s/s")", R"(x.toml:6: structure.thickness = "4 um/s/s": more than one '/' in the unit 'um/s/s' (expected a length such as "2 um"))"},
    Edit{R"("4 um")", R"("4 um^x")", R"(x.toml:6: structure.thickness = "4 um^x": 'um^x' needs an integer power between -9 and 9, not 0 (expected a length such as "2 um"))"},
    Edit{R"("4 um")", R"("nan um")", R"(x.toml:6: structure.thickness = "nan um": must be a number and a unit (expected a length such as "2 um"))"},
    Edit{R"("4 um")", R"(2020-01-01)", R"(x.toml:6: structure.thickness = 2020-01-01: not a number with a unit (expected a length such as "2 um"))"}));

INSTANTIATE_TEST_SUITE_P(Examples, BadFile, testing::Values(
    Edit{"[contact]", "pressure = 100\n[contact]", R"(x.toml:17: gas.pressure = 100: no unit (expected a pressure such as "101325 Pa"))"},
    Edit{R"("78 GPa")", "78", R"(x.toml:7: structure.youngs_modulus = 78: no unit (expected a pressure such as "78 GPa"))"},
    Edit{R"("250 um")", "250", R"(x.toml:4: structure.length = 250: no unit (expected a length such as "250 um"))"},
    Edit{"[contact]", "mean_free_path = 65\n[contact]", R"(x.toml:17: gas.mean_free_path = 65: no unit (expected a length such as "65 nm"))"},
    Edit{R"(max_voltage = )", "sample_rate = \"25 MS\"\nmax_voltage = ", R"(x.toml:37: driver.piezo.sample_rate = "25 MS": expected a frequency [Hz], got a conductance [S])"}));

INSTANTIATE_TEST_SUITE_P(Names, BadFile, testing::Values(
    Edit{"thickness =", "thicknes =", R"(x.toml:6: structure.thicknes = "4 um": unknown key (did you mean 'thickness'?))"},
    Edit{"thickness =", "colour =", R"(x.toml:6: structure.colour = "4 um": unknown key (known: kind, sections, layers, anchor, far_anchor, rest_shape, length, width, thickness, youngs_modulus, density, modes, damping_ratio, plate_strain, poissons_ratio, stress_gradient, residual_stress, biaxial, stretching, mass, stiffness, area, file, axis, direction, length_unit, mass_unit, mass_normalised, clamp, positions, frequencies, shapes, rest_offsets, widths, frequency_factor, axial_stiffness))"},
    Edit{"thickness =", "hinge_width =", R"(x.toml:6: structure.hinge_width = "4 um": unknown key; 'sections' describes a beam whose width, thickness or material changes along it, such as a hinge narrower than the plate: sections = [{ length = "60 um", width = "10 um" }, { length = "190 um", width = "40 um" }])"},
    Edit{"thickness =", "springs =", R"(x.toml:6: structure.springs = "4 um": unknown key; 'anchor' and 'far_anchor' describe compliant ends: anchor = { rotation = "1e-7 N m/rad" })"},
    Edit{"pad_length", "dimples", R"(x.toml:19: contact.dimples = "5 um": unknown key; 'count' gives the number of equal contacts side by side, [contact.NAME] a contact at another place)"},
    Edit{"thickness =", "thick =", R"(x.toml:6: structure.thick = "4 um": unknown key (did you mean 'thickness'?))"},
    Edit{"thickness =", "poisson =", R"(x.toml:6: structure.poisson = "4 um": unknown key (did you mean 'poissons_ratio'?))"},
    Edit{"pad_length", "roughness", R"(x.toml:19: contact.roughness = "5 um": unknown key; the roughness of a face is 'asperity_deviation' with model = "asperity-gaussian", and 'asperity_height' with model = "asperity-uniform")"},
    Edit{"title =", "titel =", R"(x.toml:1: titel = "small": unknown key (did you mean 'title'?))"},
    Edit{"[gas]", "[gass]", "x.toml:14: [gass]: unknown section (did you mean 'gas'?)"},
    Edit{"[gas]", "[weather]", "x.toml:14: [weather]: unknown section (known: structure, gap, electrode, gas, contact, dispersion, surface, piezo, waveform, driver, simulate, load, metrics, spread, calibration)"},
    Edit{R"(kind = "cantilever")", R"(kind = "cantilver")", R"(x.toml:3: structure.kind = "cantilver": unknown value (did you mean 'cantilever'?))"},
    Edit{R"(kind = "cantilever")", R"(kind = 1)", "x.toml:3: structure.kind = 1: expected one of cantilever, clamped-clamped, plate, modes"},
    Edit{R"(kind = "cantilever")", R"(kind = "clamped-clamped")", "x.toml:21: [piezo]: between two clamps the layer's axial force is not released: it would stretch or buckle the beam, and pull off its middle line; a layer needs a cantilever"},
    structure_line(R"(residual_stress = "1 MPa")", R"(x.toml:9: structure.residual_stress = "1 MPa": belongs to kind = "clamped-clamped", not to "cantilever")"),
    Edit{R"(kind = "cantilever")", "kind = \"clamped-clamped\"\nresidual_stress = \"-70 MPa\"", R"(x.toml:4: structure.residual_stress = "-70 MPa": leaves -70 MPa along the beam, which buckles at -65.69 MPa)"},
    Edit{R"(kind = "cantilever")", "kind = \"clamped-clamped\"\nresidual_stress = \"-70 um\"", R"(x.toml:4: structure.residual_stress = "-70 um": expected a pressure [Pa], got a length [m])"},
    Edit{R"(kind = "cantilever")", "kind = \"clamped-clamped\"\nbiaxial = true", "x.toml:4: structure.biaxial = true: needs structure.poissons_ratio"},
    Edit{R"(kind = "cantilever")", "kind = \"clamped-clamped\"\nstretching = 1", "x.toml:4: structure.stretching = 1: expected true or false"},
    structure_line(R"(modes = "many")", R"(x.toml:9: structure.modes = "many": expected a whole number or "auto")"),
    Edit{R"(model = "strip")", R"(model = "veijolla")", R"(x.toml:15: gas.model = "veijolla": unknown value (did you mean 'veijola'?))"},
    Edit{R"(model = "strip")", R"(model = "linear")", R"(x.toml:16: gas.viscosity = "1.86e-5 Pa s": belongs to model = "strip" or "strip-slit" or "veijola" or "gallis-torczynski" or "near-contact" or "guo-alexeenko" or "reynolds", not to "linear")"},
    Edit{R"(viscosity = "1.86e-5 Pa s")", R"(damping = "1 N s/m^2")", R"(x.toml:16: gas.damping = "1 N s/m^2": belongs to model = "linear", not to "strip")"},
    Edit{"model = \"strip\"\nviscosity = \"1.86e-5 Pa s\"", R"(model = "linear")", "x.toml:14: [gas]: missing key 'damping' or 'quality_factor'"},
    Edit{"model = \"strip\"\nviscosity = \"1.86e-5 Pa s\"", "model = \"linear\"\nquality_factor = 5\ndamping = \"1 N s/m^2\"", "x.toml:17: gas.damping = \"1 N s/m^2\": must not be given together with gas.quality_factor = 5: give one of them"},
    Edit{"viscosity", "film_length = \"0 um\"\nviscosity", R"(x.toml:16: gas.film_length = "0 um": must be in [1 pm, 1 m])"},
    Edit{"viscosity", "far_gap = \"1 Pa\"\nviscosity", R"(x.toml:16: gas.far_gap = "1 Pa": expected a length [m], got a pressure [Pa])"},
    Edit{"viscosity", "slit_height = \"1 um\"\nviscosity", R"(x.toml:16: gas.slit_height = "1 um": belongs to model = "strip-slit", not to "strip")"},
    Edit{R"(model = "strip")", R"(model = "strip-slit")", R"(x.toml:14: [gas]: missing key 'slit_height' (a length such as "2 um"))"},
    Edit{R"(viscosity = "1.86e-5 Pa s")", R"(pressure = "0 Pa")", R"(x.toml:16: gas.pressure = "0 Pa": must be in [1 pPa, 1e15 Pa])"},
    Edit{R"(viscosity = "1.86e-5 Pa s")", R"(temperature = "-300 degC")", R"(x.toml:16: gas.temperature = "-300 degC": must be in [1 mK, 100 kK])"},
    Edit{R"(viscosity = "1.86e-5 Pa s")", R"(mean_free_path = "65 Pa")", R"(x.toml:16: gas.mean_free_path = "65 Pa": expected a length [m], got a pressure [Pa])"},
    Edit{R"(stiffness = "100 N/m")", "stiffness = \"100 N/m\"\ndamping = \"0.1 s\"", R"(x.toml:21: contact.damping = "0.1 s": expected an inverse velocity [s/m], got a time [s])"},
    Edit{R"(stiffness = "100 N/m")", "stiffness = \"100 N/m\"\ndamping = \"0 s/m\"", R"(x.toml:21: contact.damping = "0 s/m": must be in [1 ps/m, 100 ks/m])"},
    Edit{R"(stiffness = "100 N/m")", R"(asperity_height = "1 nm")", R"(x.toml:20: contact.asperity_height = "1 nm": belongs to model = "asperity-uniform" or "adhesive" or "elastic-plastic", not to "linear")"},
    Edit{R"(model = "linear")", R"(model = "hysteretic")", R"(x.toml:17: [contact]: missing key 'unloading_stiffness' (a stiffness such as "100 N/m"))"},
    Edit{R"(model = "linear")", "unloading_stiffness = \"50 N/m\"\nmodel = \"hysteretic\"", R"(x.toml:18: contact.unloading_stiffness = "50 N/m": must not be below contact.stiffness = "100 N/m")"},
    Edit{"model = \"linear\"\npad_length = \"5 um\"\nstiffness = \"100 N/m\"", "model = \"elastic-plastic\"\nplasticity = \"ceb\"\npad_length = \"5 um\"\nasperity_radius = \"1 um\"\nasperity_density = \"1e11 1/m^2\"\nasperity_height = \"1 um\"\neffective_modulus = \"48 GPa\"\nhardness = \"1 GPa\"", R"(x.toml:19: contact.plasticity = "ceb": the force of Chang, Etsion and Bogy as published jumps by about half at the critical interference, which no integrator of motion can use; take "zmc" or "ke")"},
    Edit{"model = \"linear\"\npad_length = \"5 um\"\nstiffness = \"100 N/m\"", "model = \"rigid\"\npad_length = \"5 um\"\nrestitution = 0.5", R"(x.toml:18: contact.model = "rigid": needs a plate: a beam has modes that take part in an impact)"},
    Edit{"model = \"linear\"\npad_length = \"5 um\"\nstiffness = \"100 N/m\"", "model = \"rigid\"\npad_length = \"5 um\"\nrestitution = 1", R"(x.toml:20: contact.restitution = 1: must be in [0, 1))"},
    Edit{"model = \"linear\"\npad_length = \"5 um\"\nstiffness = \"100 N/m\"", "model = \"rigid\"\npad_length = \"5 um\"", R"(x.toml:17: [contact]: missing key 'restitution' (a plain number such as 0.02))"},
    Edit{R"(stiffness = "100 N/m")", "stiffness = \"100 N/m\"\nwall_range = \"9 nm\"", R"(x.toml:21: contact.wall_range = "9 nm": belongs to model = "adhesive-repulsive", not to "linear")"},
    Edit{R"(stiffness = "100 N/m")", "stiffness = \"100 N/m\"\ndistribution = \"tip\"", R"(x.toml:21: contact.distribution = "tip": unknown value (known: centre, pad))"},
    Edit{"model = \"linear\"\npad_length = \"5 um\"\nstiffness = \"100 N/m\"", "model = \"linear\"\npad_length = \"30 um\"\nstiffness = \"100 N/m\"\ndistribution = \"pad\"", R"(x.toml:21: contact.distribution = "pad": the pad counts as straight, so pad_length must not exceed a tenth of the beam's length, 25 um)"},
    Edit{"model = \"linear\"\npad_length = \"5 um\"\nstiffness = \"100 N/m\"", "model = \"hysteretic\"\npad_length = \"5 um\"\nstiffness = \"100 N/m\"\nunloading_stiffness = \"200 N/m\"\ndistribution = \"pad\"", R"(x.toml:22: contact.distribution = "pad": not with model = "hysteretic": every point of the pad would keep a dent of its own)"},
    Edit{R"(model = "linear")", R"(model = "asperity-uniform")", R"(x.toml:20: contact.stiffness = "100 N/m": belongs to model = "linear" or "hysteretic", not to "asperity-uniform")"},
    Edit{R"([electrode.main])", R"([electrode.piezo])", "x.toml:12: [electrode.piezo]: the name 'piezo' is reserved for the piezo layer"},
    Edit{R"([electrode.main])", R"([electrode."a b"])", R"(x.toml:12: [electrode."a b"]: a name must consist of at most 64 letters, digits, '_' and '-')"},
    Edit{R"([electrode.main])", R"([electrode])", R"(x.toml:13: electrode.span = ["60 um", "240 um"]: expected a section [electrode.NAME])"},
    Edit{R"([electrode.main])", R"([[electrode]])", R"(x.toml:12: electrode = [{ span = ["60 um", "240 um"] }]: expected sections [electrode.NAME])"},
    Edit{R"([waveform.main])", R"([waveform.mian])", "x.toml:27: [waveform.mian]: unknown electrode (did you mean 'main'?)"},
    Edit{R"([driver.piezo])", R"([driver.other])", "x.toml:35: [driver.other]: unknown electrode (known: main, piezo)"},
    Edit{R"(family = "step")", R"(family = "pulses")", R"(x.toml:28: waveform.main.family = "pulses": unknown value (did you mean 'pulse'?))"},
    Edit{R"(level = "1.25 Vdp")", R"(levels = ["1.25 Vdp"])", R"(x.toml:29: waveform.main.levels = ["1.25 Vdp"]: belongs to family = "pulse", not to "step")"}));

INSTANTIATE_TEST_SUITE_P(Structure, BadFile, testing::Values(
    Edit{R"(thickness = "4 um")", "", R"(x.toml:2: [structure]: missing key 'thickness' (a length such as "2 um"))"},
    Edit{R"(family = "step")", "", "x.toml:27: [waveform.main]: missing key 'family' (one of " + listed_families() + ")"},
    Edit{"[gap]\nelectrode = \"3.5 um\"\ncontact = \"2 um\"\n", "", "x.toml: section [gap] is missing"},
    Edit{"title =", "metrics = 3\ntitle =", "x.toml:1: metrics = 3: expected a section [metrics]"},
    structure_line("modes = 21", "x.toml:9: structure.modes = 21: must be in [1, 20]"),
    structure_line("modes = 4.0", R"(x.toml:9: structure.modes = 4.0: expected a whole number or "auto")"),
    structure_line("damping_ratio = 1.0", "x.toml:9: structure.damping_ratio = 1.0: must be in [0, 1)" + more_damping),
    structure_line("damping_ratio = inf", "x.toml:9: structure.damping_ratio = inf: must be in [0, 1)" + more_damping),
    structure_line("damping_ratio = 2", "x.toml:9: structure.damping_ratio = 2: must be in [0, 1)" + more_damping),
    structure_line(R"(damping_ratio = "2 s")", R"(x.toml:9: structure.damping_ratio = "2 s": expected a plain number, got a time [s])"),
    structure_line("plate_strain = true", "x.toml:9: structure.plate_strain = true: needs structure.poissons_ratio"),
    structure_line(R"(plate_strain = "yes")", R"(x.toml:9: structure.plate_strain = "yes": expected true or false)"),
    structure_line("poissons_ratio = 0.5", "x.toml:9: structure.poissons_ratio = 0.5: must be in (-1, 0.5)"),
    Edit{R"(contact = "2 um")", R"(contact = "3.47 um")", R"(x.toml:11: gap.contact = "3.47 um": must be less than 0.99 times gap.electrode = "3.5 um": force laws do not hold below 1/100 of that gap)"},
    Edit{R"(contact = "2 um")", R"(contact = "3.5 um")", R"(x.toml:11: gap.contact = "3.5 um": must be less than gap.electrode = "3.5 um")"},
    Edit{R"(span = ["60 um", "240 um"])", R"(span = ["60 um", "251 um"])", R"(x.toml:13: electrode.main.span = ["60 um", "251 um"]: must end on the beam: structure.length = "250 um")"},
    Edit{R"(span = ["60 um", "240 um"])", R"(span = ["60 um", "60 um"])", R"(x.toml:13: electrode.main.span = ["60 um", "60 um"]: the end must be greater than the begin)"},
    Edit{R"(span = ["60 um", "240 um"])", R"(span = ["-60 um", "60 um"])", R"(x.toml:13: electrode.main.span = ["-60 um", "60 um"]: value 1: must be in [0 m, 1 m])"},
    Edit{"[gas]", "[electrode.tip]\nspan = [\"200 um\", \"250 um\"]\n[gas]", R"(x.toml:15: electrode.tip.span = ["200 um", "250 um"]: must not overlap electrode.main, which ends at 240 um on the near side too)"},
    Edit{"[gas]", "[electrode.tip]\nspan = [\"240 um\", \"250 um\"]\n[electrode.up]\nspan = [\"0 um\", \"250 um\"]\nside = \"far\"\ngap = \"3 um\"\n[gas]", ""},
    Edit{R"(span = ["60 um", "240 um"])", R"(span = ["60 um"])", R"(x.toml:13: electrode.main.span = ["60 um"]: needs 2 values, got 1 (expected a list such as ["2 um", "tip"]))"},
    Edit{R"(span = ["60 um", "240 um"])", R"(span = ["60 um", 240])", R"(x.toml:13: electrode.main.span = ["60 um", 240]: value 2: no unit (expected a list such as ["2 um", "tip"]))"},
    Edit{R"(span = ["60 um", "240 um"])", R"(span = "60 um")", R"(x.toml:13: electrode.main.span = "60 um": expected a list such as ["2 um", "tip"])"},
    Edit{"[gas]", "side = \"above\"\n[gas]", R"(x.toml:14: electrode.main.side = "above": unknown value (known: near, far, both))"},
    Edit{"[gas]", "gap = \"3 um\"\n[gas]", R"(x.toml:14: electrode.main.gap = "3 um": belongs to side = "far" or "both"; on the near side the distance is gap.electrode)"},
    Edit{"[gas]", "side = \"both\"\n[gas]", R"(x.toml:12: [electrode.main]: side = "both" needs 'gap' (a length such as "2 um"): the rest distance on the far side)"},
    Edit{"[gas]", "side = \"far\"\ngap = \"3 um\"\n[gas]", R"(x.toml:31: waveform.main.level = "1.25 Vdp": an electrode on the far side has no pull-in voltage; give it volts [V])"},
    Edit{R"(span = ["5 um", "240 um"])", R"(span = ["5 um", "0.3 mm"])", R"(x.toml:22: piezo.span = ["5 um", "0.3 mm"]: must end on the beam: structure.length = "250 um")"},
    Edit{R"(span = ["60 um", "240 um"])", R"(area = "60 um^2")", R"(x.toml:13: electrode.main.area = "60 um^2": belongs to a plate; the electrode of a beam has a span)"},
    Edit{"pad_length = \"5 um\"\n", "", R"(x.toml:17: [contact]: missing key 'pad_length' (a length such as "2 um"))"},
    Edit{R"(pad_length = "5 um")", R"(pad_length = "250 um")", R"(x.toml:19: contact.pad_length = "250 um": must be less than structure.length = "250 um")"},
    Edit{R"(title = "small")", R"(title = 3)", "x.toml:1: title = 3: expected a text in quotes"},
    Edit{R"(accuracy = 1e-5)", "accuracy = 0.2", "x.toml:39: simulate.accuracy = 0.2: must be in [1e-12, 0.1]"},
    Edit{R"(accuracy = 1e-5)", "effects = \"some\"", R"(x.toml:39: simulate.effects = "some": unknown value (known: all, auto))"},
    Edit{R"(accuracy = 1e-5)", "effects_tolerance = 0", "x.toml:39: simulate.effects_tolerance = 0: must be in [1e-12, 0.1]"},
    Edit{R"(accuracy = 1e-5)", "accuracy = 1e-5\ntolerance = 1e-9", "x.toml:39: simulate.accuracy = 1e-05: must not be given together with simulate.tolerance = 1e-09: give one of them"},
    Edit{R"(accuracy = 1e-5)", "[metrics]\nsignificant_rebound = \"0 nm\"", R"(x.toml:40: metrics.significant_rebound = "0 nm": must be in [1 pm, 1 m])"},
    Edit{R"(accuracy = 1e-5)", "[metrics]\nsignificant_rebound = \"2 um\"", R"(x.toml:40: metrics.significant_rebound = "2 um": must be less than gap.contact = "2 um")"},
    Edit{R"(contact = "2 um")", R"(contact = "1 nm")", R"(x.toml:11: gap.contact = "1 nm": must exceed metrics.significant_rebound, which is 1 nm)"}));

const std::string casimir = "[dispersion]\nmodel = \"casimir\"\n";
const std::string factor = "[waveform.dispersion]\nfamily = \"step\"\n";

INSTANTIATE_TEST_SUITE_P(Surface, BadFile, testing::Values(
    Edit{"[gas]", "[load]\nvoltage = \"5 V\"\n[gas]", "x.toml:14: [load]: missing key 'resistance' (a resistance such as \"50 ohm\")"},
    Edit{"[gas]", "[surface]\n[gas]", "x.toml:22: [piezo]: must not be combined with [surface], which is for a beam without layers"},
    Edit{"[gas]", "[surface]\nelastic_modulus = \"-1 MN/m\"\n[gas]", "x.toml:14: [surface]: leaves a bending rigidity of -1.623e-10 N m^2, which must be above 0"},
    Edit{"[gas]", "[surface]\nresidual_stress = \"10 N/m\"\ncantilever_load = \"compression\"\n[gas]", "x.toml:14: [surface]: leaves -5 MPa along the beam, which buckles at -4.106 MPa"}));

INSTANTIATE_TEST_SUITE_P(Dispersion, BadFile, testing::Values(
    Edit{"[gas]", "[dispersion]\n[gas]", "x.toml:14: [dispersion]: missing key 'model' (one of casimir, van-der-waals, auto)"},
    Edit{"[gas]", "[dispersion]\nmodel = \"casimr\"\n[gas]", R"(x.toml:15: dispersion.model = "casimr": unknown value (did you mean 'casimir'?))"},
    Edit{"[gas]", "[dispersion]\nmodel = \"auto\"\n[gas]", R"(x.toml:14: [dispersion]: missing key 'hamaker_constant' (an energy such as "3e-19 J"))"},
    Edit{"[gas]", "[dispersion]\nmodel = \"auto\"\nhamaker_constant = \"0 J\"\n[gas]", R"(x.toml:16: dispersion.hamaker_constant = "0 J": must be in [1e-30 J, 1 J])"},
    Edit{"[gas]", casimir + "hamaker_constant = \"4e-19 J\"\n[gas]", R"(x.toml:16: dispersion.hamaker_constant = "4e-19 J": belongs to model = "van-der-waals" or "auto", not to "casimir")"},
    Edit{"[gas]", casimir + "conductor = \"silver\"\n[gas]", R"(x.toml:16: dispersion.conductor = "silver": unknown value (known: ideal, gold))"},
    Edit{"[gas]", "[dispersion]\nmodel = \"auto\"\nhamaker_constant = \"4e-19 J\"\nequilibrium_distance = \"1.5 um\"\n[gas]", R"(x.toml:17: dispersion.equilibrium_distance = "1.5 um": must be less than the closed gap, gap.electrode - gap.contact)"},
    Edit{"[gas]", casimir + factor + "level = \"1.25 V\"\n[gas]", R"(x.toml:18: waveform.dispersion.level = "1.25 V": expected a plain number, got a voltage [V])"},
    Edit{"[gas]", casimir + factor + "[gas]", R"(x.toml:16: [waveform.dispersion]: missing key 'level' (a plain number such as 0.02))"},
    Edit{"[gas]", casimir + "[waveform.dispersion]\nfamily = \"pulse\"\nlevels = 1.25\n[gas]", "x.toml:18: waveform.dispersion.levels = 1.25: expected a list such as [0.02, 0.02]"},
    Edit{"[gas]", factor + "level = 1.25\n[gas]", "x.toml:14: [waveform.dispersion]: the scene has no [dispersion] force"},
    Edit{"[gas]", casimir + "[driver.dispersion]\nmax_voltage = \"2 V\"\n[gas]", "x.toml:16: [driver.dispersion]: the dispersion force has no driver: remove this section"},
    Edit{"[electrode.main]", "[electrode.dispersion]", "x.toml:12: [electrode.dispersion]: the name 'dispersion' is reserved for the dispersion force"}));

INSTANTIATE_TEST_SUITE_P(Drives, BadFile, testing::Values(
    Edit{R"(level = "1.25 Vdp")", R"(level = "2 Vdp")", "x.toml:27: [waveform.main]: the voltage reaches 80 V, above the driver's max_voltage of 75 V; without [driver.main] the limits are 0 V and 1.5 Vsp"},
    Edit{R"(level = "1.25 Vdp")", R"(level = "-1 V")", "x.toml:27: [waveform.main]: the voltage reaches -1 V, below the driver's min_voltage of 0 V; without [driver.main] the limits are 0 V and 1.5 Vsp"},
    Edit{R"(level = "1.25 Vdp")", "level = \"1.25 Vdp\"\nrise_time = \"-1 us\"", R"(x.toml:30: waveform.main.rise_time = "-1 us": must be in [0 s, 1 ks])"},
    Edit{R"("0.6 V", "0 V"])", R"("0.6 Vdp", "0 V"])", R"(x.toml:32: waveform.piezo.levels = ["0.2 V", "0.6 Vdp", "0 V"]: pull-in voltages belong to electrodes; give the piezo volts [V])"},
    Edit{R"("0.6 V", "0 V"])", R"("0.6 V"])", R"(x.toml:33: waveform.piezo.times = ["20 us", "41 us"]: times of a pulse are 2 for 2 levels; there must be one fewer than levels)"},
    Edit{R"("0.6 V", "0 V"])", R"("1.6 V", "0 V"])", "x.toml:30: [waveform.piezo]: the voltage reaches 1.6 V, above the driver's max_voltage of 1 V"},
    Edit{R"(times = ["20 us", "41 us"])", R"(times = ["41 us", "20 us"])", R"(x.toml:33: waveform.piezo.times = ["41 us", "20 us"]: time 2 of a pulse is 2e-05 s; it must be at least 4.6e-05 s, when the edge before it ends)"},
    Edit{R"(min_voltage = "-1 V")", "", R"(x.toml:35: [driver.piezo]: missing key 'min_voltage' (a voltage such as "1 V"))"},
    Edit{R"(min_voltage = "-1 V")", R"(min_voltage = "2 V")", R"(x.toml:36: driver.piezo.min_voltage = "2 V": min_voltage of 2 V must be less than max_voltage of 1 V)"},
    Edit{R"(min_voltage = "-1 V")", R"(min_voltage = "-1 Vsp")", R"(x.toml:36: driver.piezo.min_voltage = "-1 Vsp": pull-in voltages belong to electrodes; give the piezo volts [V])"},
    Edit{R"(max_voltage = "1 V")", "max_voltage = \"1 V\"\nmax_slew = \"3 V\"", R"(x.toml:38: driver.piezo.max_slew = "3 V": expected a slew rate [V/s], got a voltage [V])"},
    Edit{R"(max_voltage = "1 V")", "max_voltage = \"1 V\"\nmax_slew = \"1 mV/us\"", "x.toml:30: [waveform.piezo]: the voltage changes at 120 mV/us, faster than the driver's max_slew of 1 mV/us"},
    Edit{"[piezo]\nspan = [\"5 um\", \"240 um\"]\nthickness = \"1 um\"\nyoungs_modulus = \"61 GPa\"\ndensity = \"7750 kg/m^3\"\nd31 = \"-171 pm/V\"\n", "", "x.toml:24: [waveform.piezo]: the scene has no [piezo] layer"}));

INSTANTIATE_TEST_SUITE_P(Families, BadFile, testing::Values(
    Edit{main_step, harmonic + "base = \"40 V\"\namplitude = \"15 %\"", "x.toml:27: [waveform.main]: missing key 'angular_frequency' or 'frequency'"},
    Edit{main_step, harmonic + "base = \"40 V\"\namplitude = \"15 %\"\nfrequency = \"30 kHz\"\nangular_frequency = \"180543 rad/s\"", R"(x.toml:32: waveform.main.angular_frequency = "180543 rad/s": must not be given together with waveform.main.frequency = "30 kHz": give one of them)"},
    Edit{main_step, harmonic + "base = \"40 V\"\namplitude = \"15 %\"\nfrequency = \"180543 rad/s\"", R"(x.toml:31: waveform.main.frequency = "180543 rad/s": expected a frequency [Hz], got an angular frequency [rad/s])"},
    Edit{main_step, harmonic + "base = \"40 V\"\namplitude = \"15 %\"\nangular_frequency = \"30 kHz\"", R"(x.toml:31: waveform.main.angular_frequency = "30 kHz": expected an angular frequency [rad/s], got a frequency [Hz])"},
    Edit{main_step, harmonic + "base = \"40 V\"\namplitude = 0.15\nangular_frequency = \"30 krad/s\"", R"(x.toml:30: waveform.main.amplitude = 0.15: no unit (expected a voltage such as "45 V" or "1.1 Vsp" or "1.25 Vdp" or "15 %"))"},
    Edit{main_step, harmonic + "base = \"40 V\"\namplitude = \"0.15\"\nangular_frequency = \"30 krad/s\"", R"(x.toml:30: waveform.main.amplitude = "0.15": no unit (expected a voltage such as "45 V" or "1.1 Vsp" or "1.25 Vdp" or "15 %"))"},
    Edit{main_step, harmonic + "amplitude = \"15 %\"\nangular_frequency = \"30 krad/s\"", R"(x.toml:29: waveform.main.amplitude = "15 %": is a percentage of the base level, which is 0 V: give volts)"},
    Edit{main_step, harmonic + "base = \"40 V\"\namplitude = \"15 %\"\nangular_frequency = \"30 krad/s\"\nstart = \"2 us\"\nend = \"1 us\"", R"(x.toml:33: waveform.main.end = "1 us": end of a harmonic is 1e-06 s; it must be after its start, 2e-06 s)"},
    Edit{main_step, harmonic + "base = \"40 V\"\namplitude = \"15 %\"\nangular_frequency = \"30 krad/s\"\nend = \"1 us\"\nfade = \"1 us\"", R"(x.toml:33: waveform.main.fade = "1 us": fade of a harmonic is 1e-06 s; it must be at most half of end - start, 1e-06 s)"},
    Edit{main_step, table, "x.toml:27: [waveform.main]: missing key 'file' or 'times' or 'voltages'"},
    Edit{main_step, table + "times = [\"0 s\"]", "x.toml:27: [waveform.main]: missing key 'voltages' or 'file'"},
    Edit{main_step, table + "file = \"absent.csv\"\ntimes = [\"0 s\"]\nvoltages = [\"1 V\"]", R"(x.toml:29: waveform.main.file = "absent.csv": must not be given together with waveform.main.times = ["0 s"]: give one of them)"},
    Edit{main_step, table + "file = \"absent.csv\"", R"(x.toml:29: waveform.main.file = "absent.csv": ./absent.csv: cannot be read: No such file or directory)"},
    Edit{main_step, table + "times = [\"0 s\", \"1 s\"]\nvoltages = [\"1 V\"]", "x.toml:27: [waveform.main]: a table has 2 times and 1 voltages; it must have as many times as voltages"}));

INSTANTIATE_TEST_SUITE_P(Spread, BadFile, testing::Values(
    spread_line(R"("structure.thicknes" = { distribution = "normal", cov = "2 %" })", R"(x.toml:15: [spread."structure.thicknes"]: 'structure.thicknes' is not a key of this scene that holds one number of the device (did you mean 'thickness'?))"),
    spread_line(R"("structure.kind" = { distribution = "normal", cov = "2 %" })", R"(x.toml:15: [spread."structure.kind"]: 'structure.kind' is not a key of this scene that holds one number of the device (known: length, width, thickness, youngs_modulus, density, damping_ratio))"),
    spread_line(R"("simulate.accuracy" = { distribution = "normal", cov = "2 %" })", R"(x.toml:15: [spread."simulate.accuracy"]: 'simulate.accuracy' is not a key of this scene that holds one number of the device)"),
    spread_line(R"("a b c" = { distribution = "normal", cov = "2 %" })", R"(x.toml:15: [spread."a b c"]: not a key path such as structure.length)"),
    spread_line(R"("structure.thickness" = "2 %")", R"(x.toml:15: spread."structure.thickness" = "2 %": expected a section [spread.NAME] or the key 'correlation')"),
    spread_line(R"("structure.thickness" = { distribution = "normal" })", R"(x.toml:15: [spread."structure.thickness"]: missing key 'cov' or 'standard_deviation')"),
    spread_line(R"("structure.thickness" = { distribution = "gaussian", cov = "2 %" })", R"(x.toml:15: spread."structure.thickness".distribution = "gaussian": unknown value (known: normal, lognormal, uniform, triangular, empirical))"),
    spread_line(R"("structure.thickness" = { distribution = "uniform" })", R"(x.toml:15: [spread."structure.thickness"]: missing key 'cov' or 'half_width')"),
    spread_line(R"("structure.thickness" = { distribution = "normal", half_width = "1 um" })", R"(x.toml:15: spread."structure.thickness".half_width = "1 um": belongs to distribution = "uniform", not to "normal")"),
    spread_line(R"("structure.thickness" = { distribution = "uniform", half_width = "1 GPa" })", R"(x.toml:15: spread."structure.thickness".half_width = "1 GPa": expected a length [m], got a pressure [Pa])"),
    spread_line(R"("structure.thickness" = { distribution = "normal", cov = "200 %" })", R"(x.toml:15: spread."structure.thickness".cov = "200 %": must be in [1e-12, 1])"),
    Edit{"title =", "spread = 3\ntitle =", "x.toml:1: spread = 3: expected sections [spread.NAME]"}));

INSTANTIATE_TEST_SUITE_P(Toml, BadFile, testing::Values(
    Edit{R"("4 um")", "4 um", R"(x.toml:6:15: not TOML: Error while parsing key-value pair: expected a comment or whitespace, saw 'u' (a quantity needs quotes: "2 um"))"},
    Edit{R"("4 um")", "\"4 um", "x.toml:6:18: not TOML: the text is not closed on line 6: its closing quote is missing"},
    Edit{R"("4 um")", "", R"(x.toml:6:13: not TOML: Error while parsing key-value pair: expected value, saw '\n')"},
    Edit{R"("4 um")", "\"\xff um\"", "x.toml:6:13: not TOML: Encountered invalid utf-8 sequence"},
    Edit{R"("4 um")", std::string("\"4 um\" #\0", 9), "x.toml:6:21: not TOML: Error while parsing comment: control characters other than TAB (U+0009) are explicitly prohibited in comments"},
    Edit{R"("4 um")", std::string(1000, '['), "x.toml:6:269: not TOML: Error while parsing value: exceeded maximum nested value depth of 256 (TOML_MAX_NESTED_VALUES)"},
    Edit{"thickness =", "length =", "x.toml:6:10: not TOML: Error while parsing key-value pair: cannot redefine existing string 'length'"},
    Edit{"[gas]", "[gap]", "x.toml:14:1: not TOML: Error while parsing table header: cannot redefine existing table 'gap'"},
    Edit{"[gas]", "[a.b.c.d.e.f.g.h.i.j.k.l.m.n.o.p.q]", "x.toml:14: a key has more than 16 parts"}));
// clang-format on

// A complete plate, with changes in the same way.
constexpr std::string_view small_plate = R"([structure]
kind = "plate"
mass = "2.4e-9 kg"
stiffness = "42 N/m"
area = "1e4 um^2"
width = "100 um"
thickness = "3 um"
[gap]
electrode = "3.8 um"
contact = "2.6 um"
[electrode.main]
area = "6e3 um^2"
[gas]
model = "strip"
viscosity = "1.86e-5 Pa s"
[contact]
model = "linear"
stiffness = "312 N/m"
)";

class BadPlate : public testing::TestWithParam<Edit> {};

TEST_P(BadPlate, IsRefusedWithThisMessage) {
  ASSERT_EQ(message(std::string(small_plate)), "");
  ASSERT_NE(small_plate.find(GetParam().from), std::string_view::npos) << GetParam().from;
  EXPECT_EQ(message(edited(small_plate, GetParam().from, GetParam().to)), GetParam().expected);
}

// clang-format off
INSTANTIATE_TEST_SUITE_P(Plates, BadPlate, testing::Values(
    Edit{"mass = \"2.4e-9 kg\"\n", "", R"(x.toml:1: [structure]: missing key 'mass' (a mass such as "2.4 ug"))"},
    Edit{"[gas]", "[electrode.tip]\narea = \"5e3 um^2\"\nfringing = \"none\"\n[gas]", R"(x.toml:14: electrode.tip.area = "5e3 um^2": the electrodes of the near side must not have more area together than the plate)"},
    Edit{"mass = \"2.4e-9 kg\"", "mass = \"0 kg\"", R"(x.toml:3: structure.mass = "0 kg": must be in [1e-30 kg, 1000 kg])"},
    Edit{"mass =", "modes = 4\nmass =", R"(x.toml:3: structure.modes = 4: belongs to kind = "cantilever" or "clamped-clamped", not to "plate")"},
    Edit{"area = \"6e3", "span = [\"0 um\", \"9 um\"]\narea = \"6e3", R"(x.toml:12: electrode.main.span = ["0 um", "9 um"]: belongs to a beam; the electrode of a plate has an area)"},
    Edit{"area = \"6e3", "area = \"6e4", R"(x.toml:12: electrode.main.area = "6e4 um^2": must not exceed structure.area = "1e4 um^2")"},
    Edit{"thickness = \"3 um\"\n", "", R"(x.toml:10: [electrode.main]: fringing = "meijs-fokkema", the default, needs structure.width and structure.thickness on a plate; fringing = "none" does not)"},
    Edit{"width = \"100 um\"\nthickness = \"3 um\"\n[gap]\nelectrode = \"3.8 um\"\ncontact = \"2.6 um\"\n[electrode.main]", "[gap]\nelectrode = \"3.8 um\"\ncontact = \"2.6 um\"\n[electrode.main]\nfringing = \"none\"", R"(x.toml:13: gas.model = "strip": needs structure.width on a plate)"},
    Edit{"[gas]", "[piezo]\nspan = [\"0 um\", \"9 um\"]\nthickness = \"1 um\"\nyoungs_modulus = \"61 GPa\"\ndensity = \"7750 kg/m^3\"\nd31 = \"-171 pm/V\"\n[gas]", "x.toml:13: [piezo]: a rigid plate does not bend; a layer needs a beam"},
    Edit{"model = \"strip\"\nviscosity = \"1.86e-5 Pa s\"\n[contact]\nmodel = \"linear\"\nstiffness = \"312 N/m\"", "model = \"reynolds\"\n[contact]\nmodel = \"rigid\"\nrestitution = 0.5", R"(x.toml:16: contact.model = "rigid": must not be given with gas.model = "reynolds", whose film still flows under a plate at rest)"},
    Edit{"stiffness = \"312 N/m\"", "stiffness = \"312 N/m\"\ndistribution = \"pad\"", R"(x.toml:19: contact.distribution = "pad": a plate touches with all of its pad at once, as at the centre)"},
    Edit{"stiffness = \"312 N/m\"", "stiffness = \"312 N/m\"\npad_length = \"1 mm\"", R"(x.toml:19: contact.pad_length = "1 mm": must be less than structure.area / structure.width)"}));
// clang-format on

struct Options {
  std::vector<std::string> options;
  std::string expected;
};

std::ostream& operator<<(std::ostream& out, const Options& bad) { return out << testing::PrintToString(bad.options); }

class BadOption : public testing::TestWithParam<Options> {};

TEST_P(BadOption, IsRefusedWithThisMessage) {
  EXPECT_EQ(message(std::string(small_scene), GetParam().options), GetParam().expected);
}

// clang-format off
INSTANTIATE_TEST_SUITE_P(Set, BadOption, testing::Values(
    Options{{"structure.thickness=2 u"}, R"(--set structure.thickness=2 u: unknown unit 'u' (expected a length such as "2 um"))"},
    Options{{"structure.thickness=2"}, R"(--set structure.thickness=2: no unit (expected a length such as "2 um"))"},
    Options{{"structure.thickness="}, R"(--set structure.thickness=: must be a number and a unit (expected a length such as "2 um"))"},
    Options{{"structure.thicknes=2 um"}, "--set structure.thicknes=2 um: unknown key (did you mean 'thickness'?)"},
    Options{{"structure.thickness"}, "--set structure.thickness: must be of the form key.path=value"},
    Options{{"=2 um"}, "--set =2 um: not a key path such as structure.length"},
    Options{{"structure..thickness=2 um"}, "--set structure..thickness=2 um: not a key path such as structure.length"},
    Options{{"structure.length.x=2 um"}, R"(--set structure.length.x=2 um: structure.length = "250 um" is not a section)"},
    Options{{"surface.residual_stress=1 MPa"}, "--set surface.residual_stress=1 MPa: expected a stiffness [N/m], got a pressure [Pa]"},
    Options{{"surface.faces=two"}, "--set surface.faces=two: unknown value (known: all, wide)"},
    Options{{"surface.cantilever_load=tension"}, "--set surface.cantilever_load=tension: unknown value (known: none, compression)"},
    Options{{"gas=3"}, "--set gas=3: expected a section [gas]"},
    Options{{"gap={electrode=\"1 um\", contact=\"2 um\"}"}, R"(--set gap={electrode="1 um", contact="2 um"}: gap.contact = "2 um": must be less than gap.electrode = "1 um")"},
    Options{{"gap={electrode=\"1 um\"}"}, R"(--set gap={electrode="1 um"}: [gap]: missing key 'contact' (a length such as "2 um"))"},
    Options{{"gap.contact=4 um"}, R"(--set gap.contact=4 um: must be less than gap.electrode = "3.5 um")"},
    Options{{"gap.electrode=1 um"}, R"(x.toml:11: gap.contact = "2 um": must be less than gap.electrode = "1 um")"},
    Options{{"electrode.side.fringing=none"}, R"(--set electrode.side.fringing=none: [electrode.side]: missing key 'span' (a list such as ["10 um", "tip"]))"},
    Options{{"waveform.main.level=80 V"}, "--set waveform.main.level=80 V: [waveform.main]: the voltage reaches 80 V, above the driver's max_voltage of 75 V; without [driver.main] the limits are 0 V and 1.5 Vsp"},
    Options{{"driver.main={min_voltage=\"0 V\", max_voltage=\"60 V\", max_slew=\"20 V/us\"}"}, "x.toml:27: [waveform.main]: the voltage jumps, faster than the driver's max_slew of 20 V/us; rise_time = \"driver\" gives the fastest permitted rise, 2.5 us"},
    Options{{"waveform.side.family=step"}, "--set waveform.side.family=step: [waveform.side]: unknown electrode (known: main, piezo)"},
    Options{{"title=\xff"}, "--set title: the value is not UTF-8 text"},
    Options{{"structure.modes=4\nstructure.modes=5"}, R"(--set structure.modes=4\u000astructure.modes=5: expected a whole number or "auto")"},
    Options{{"structure.thickness=\x1b[31m"}, R"(--set structure.thickness=\u001b[31m: must be a number and a unit (expected a length such as "2 um"))"},
    Options{{"structure.thickness=2 um", "structure.thickness=3 m/s"}, "--set structure.thickness=3 m/s: expected a length [m], got a velocity [m/s]"},
    Options{{"a.b.c.d.e.f.g.h.i.j.k.l.m.n.o.p.q=1"}, "--set a.b.c.d.e.f.g.h.i.j.k.l.m.n.o.p.q=1: not a key path such as structure.length"}));
// clang-format on

TEST(Messages, AnEmptyFileMissesItsFirstSection) { EXPECT_EQ(message(""), "x.toml: section [structure] is missing"); }

TEST(Messages, AFileThatIsNotThere) {
  try {
    SceneFile::load("no/such.toml");
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_STREQ(error.what(), "no/such.toml: cannot be read: No such file or directory");
  }
}

TEST(Messages, ADirectoryIsNotAFile) {
  const std::string directory = testing::TempDir() + "scene.toml";
  std::filesystem::create_directory(directory);
  try {
    SceneFile::load(directory);
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_EQ(error.what(), directory + ": is a folder, it must be a regular file");
  }
}

}  // namespace
}  // namespace softland
