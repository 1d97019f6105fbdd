#include "config/scene.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/literals.h"
#include "model/beam.h"
#include "model/forces/electrostatic.h"
#include "model/gas/gas_law.h"
#include "tests/config/small_scene.h"
#include "tests/support/measured_actuators.h"

namespace softland {
namespace {

using namespace literals;

Scene read(const std::string& text) { return read_scene(SceneFile::parse(text, "x.toml")); }

Scene read_file(const std::string& name) {
  return read_scene(SceneFile::load(std::string(SOFTLAND_SOURCE_DIR) + "/scenes/" + name));
}

TEST(Scene, TakesTheStressPerFieldOfALayerInsteadOfTheStrain) {
  const auto moment = [](const std::string& text) {
    const Device d = read_scene(SceneFile::parse(text, "x.toml")).device;
    return piezo_moment_per_volt(d.structure, *d.piezo);
  };
  const double by_strain = moment(std::string(small_scene));
  EXPECT_DOUBLE_EQ(moment(edited(small_scene, R"(d31 = "-171 pm/V")", R"(e31 = "-10.431 C/m^2")")), by_strain);
}

// The force per velocity of a whole plate, divided by the length along which films act on it.
TEST(Scene, TakesTheDampingOfAWholePlate) {
  const auto damping = [](const std::string& damper) {
    const SceneFile file = SceneFile::parse(
        "[structure]\nkind = \"plate\"\nmass = \"1 ug\"\nstiffness = \"42 N/m\"\narea = \"1e-8 m^2\"\nwidth = \"50 um\"\n"
        "[gap]\nelectrode = \"3 um\"\ncontact = \"2 um\"\n[gas]\nmodel = \"linear\"\ndamping = \"" +
            damper + "\"\n",
        "x.toml");
    return number_of(*read_scene(file).device.gas, "damping", 0);
  };
  EXPECT_DOUBLE_EQ(damping("2e-5 N s/m"), 2e-5 / 200e-6);
  EXPECT_DOUBLE_EQ(damping("0.1 N s/m^2"), 0.1);
}

TEST(Scene, EverySectionOfTheSmallSceneArrives) {
  const Scene scene = read(std::string(small_scene));
  EXPECT_EQ(scene.title, "small");
  const Structure& structure = scene.device.structure;
  EXPECT_EQ(structure.length, 250e-6);
  EXPECT_EQ(structure.width, 20e-6);
  EXPECT_EQ(structure.thickness, 4e-6);
  EXPECT_EQ(part_of<Beam>(structure).youngs_modulus, 78e9);
  EXPECT_EQ(part_of<Beam>(structure).density, 19300);
  EXPECT_EQ(scene.device.gap.electrode, 3.5e-6);
  EXPECT_EQ(scene.device.gap.contact, 2e-6);
  ASSERT_EQ(scene.device.electrodes.size(), 1U);
  EXPECT_EQ(scene.device.electrodes[0].name, "main");
  EXPECT_EQ(scene.device.electrodes[0].begin, 60e-6);
  EXPECT_EQ(scene.device.electrodes[0].end, 240e-6);
  ASSERT_TRUE(scene.device.gas);
  EXPECT_EQ(std::get<StripGas>(*scene.device.gas).film.viscosity, 1.86e-5);
  ASSERT_TRUE(scene.device.has_contact());
  EXPECT_EQ(std::get<LinearSpring>(scene.device.contacts.front().model).stiffness, 100);
  EXPECT_EQ(scene.device.contacts.front().pad_length, 5e-6);
  ASSERT_TRUE(scene.device.piezo);
  EXPECT_EQ(scene.device.piezo->begin, 5e-6);
  EXPECT_EQ(scene.device.piezo->end, 240e-6);
  EXPECT_EQ(scene.device.piezo->thickness, 1e-6);
  EXPECT_EQ(scene.device.piezo->youngs_modulus, 61e9);
  EXPECT_EQ(scene.device.piezo->density, 7750);
  EXPECT_EQ(scene.device.piezo->d31, -171e-12);
  EXPECT_EQ(scene.simulate.accuracy, 1e-5);
  EXPECT_THAT(scene.need_pull_in, testing::ElementsAre("main"));
  EXPECT_THAT(scene.warnings, testing::IsEmpty());
}

TEST(Scene, GasModelsAreThoseOfTheScene) {
  const std::string section = "model = \"strip\"\nviscosity = \"1.86e-5 Pa s\"";
  for_each_law<Gas>([&]<class Law>(std::type_identity<Law>) {
    std::string keys = std::is_same_v<Law, LinearGas> ? "\nquality_factor = 7" : "\npressure = \"1 kPa\"";
    if (std::is_same_v<Law, StripSlitGas>) keys += "\nslit_height = \"2 um\"\nslit_length = \"3 um\"";
    const Gas gas = *read(edited(small_scene, section, fmt::format("model = \"{}\"{}", Law::name, keys))).device.gas;
    EXPECT_EQ(name_of(gas), Law::name);
    const FilmState* const film = film_of(gas);
    ASSERT_EQ(film == nullptr, (std::is_same_v<Law, LinearGas>)) << Law::name;
    if (film == nullptr) return;
    EXPECT_EQ(film->pressure, 1000);
    EXPECT_TRUE(std::isnan(film->viscosity)) << "that of air";
  });
  const Gas air = *read(edited(small_scene, section, R"(model = "veijola"
viscosity = "2e-5 Pa s"
temperature = "350 K"
mean_free_path = "70 nm")"))
                       .device.gas;
  const FilmState gas = *film_of(air);
  EXPECT_EQ(gas.viscosity, 2e-5);
  EXPECT_EQ(gas.pressure, 101325);
  EXPECT_EQ(gas.temperature, 350);
  EXPECT_EQ(gas.mean_free_path, 70e-9);
  const Gas slotted = *read(edited(small_scene, section, R"(model = "strip-slit"
film_length = "76 um"
slit_height = "2 um"
slit_length = "2.1 um"
far_gap = "8.5 um")"))
                           .device.gas;
  const auto slit = std::get<StripSlitGas>(slotted);
  EXPECT_EQ(slit.film_length, 76e-6);
  EXPECT_EQ(slit.slit_height, 2e-6);
  EXPECT_EQ(slit.slit_length, 2.1e-6);
  EXPECT_EQ(slit.far_gap, 8.5e-6);
  EXPECT_EQ(
      number_of(*read(edited(small_scene, section, "model = \"linear\"\ndamping = \"0.5 N s/m^2\"")).device.gas, "damping", 0),
      0.5);
  EXPECT_EQ(
      number_of(*read(edited(small_scene, section, "model = \"linear\"\nquality_factor = 7")).device.gas, "quality_factor", 0),
      7);
}

TEST(Scene, ElectrodesStandOnTheirSide) {
  const auto electrode = [](const std::string& lines) {
    return read(edited(small_scene, "[gas]", lines + "[gas]")).device.electrodes[0];
  };
  EXPECT_EQ(electrode("").side, Side::near);
  const Electrode both = electrode("side = \"both\"\ngap = \"8.55 um\"\n");
  EXPECT_EQ(both.side, Side::both);
  EXPECT_EQ(both.gap, 8.55e-6);
  const Scene far = read(edited(edited(small_scene, "1.25 Vdp", "20 V"), "[gas]", "side = \"far\"\ngap = \"3 um\"\n[gas]"));
  EXPECT_EQ(far.device.electrodes[0].side, Side::far);
  EXPECT_TRUE(far.need_pull_in.empty());
  EXPECT_FALSE(far.drives({}).at("main").limits) << "no pull-in voltage, no default limit";
}

TEST(Scene, SpansMayFollowTheLengthAndHaveSeveralPads) {
  const auto electrode = [](const std::string& span) {
    return read(edited(small_scene, R"(["60 um", "240 um"])", span)).device.electrodes[0];
  };
  const Electrode whole = electrode(R"(["24 %", "tip"])");
  EXPECT_EQ(whole.begin, Place::share(0.24));
  EXPECT_EQ(whole.end, Place::share(1));
  const std::vector<Stretch> at = whole.pads(200e-6);
  ASSERT_EQ(at.size(), 1U);
  EXPECT_DOUBLE_EQ(at[0].begin, 48e-6);
  EXPECT_DOUBLE_EQ(at[0].end, 200e-6);
  const Electrode pads = electrode(R"([["60 um", "100 um"], ["50 %", "240 um"]])");
  EXPECT_EQ(pads.begin, Place(60e-6));
  EXPECT_EQ(pads.end, Place(100e-6));
  EXPECT_EQ(pads.further, (std::vector<Span>{{Place::share(0.5), Place(240e-6)}}));
  const std::string text = edited(small_scene, R"(["60 um", "240 um"])", R"(["24 %", "tip"])");
  EXPECT_NE(SceneFile::parse(text, "x.toml").text().find(R"(span = ["24 %", "tip"])"), std::string::npos) << "as written";
  EXPECT_EQ(read(edited(small_scene, R"(["5 um", "240 um"])", R"(["2 %", "tip"])")).device.piezo->end, Place::share(1));
}

TEST(Scene, RefusesSpansThatMakeNoSense) {
  const auto reason = [](const std::string& span) -> std::string {
    try {
      (void)read(edited(small_scene, R"(["60 um", "240 um"])", span));
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "none";
  };
  using testing::HasSubstr;
  EXPECT_THAT(reason(R"(["60 um", "101 %"])"), HasSubstr("must end on the beam"));
  EXPECT_THAT(reason(R"(["tip", "240 um"])"), HasSubstr("the end must be greater than the begin"));
  EXPECT_THAT(reason(R"([["60 um", "100 um"], ["90 um", "240 um"]])"),
              HasSubstr("its pads must not overlap: one of them ends at 100 um"));
  EXPECT_THAT(reason(R"([["60 um", "100 um"], ["110 um"]])"), HasSubstr("value 2: needs 2 values, got 1"));
  EXPECT_THAT(reason(R"([["60 um", "100 um"], "110 um"])"), HasSubstr("value 2: a list of lists must hold lists only"));
  EXPECT_THAT(reason(R"([["60 um", "root"]])"), HasSubstr("value 1: value 2: "));
  EXPECT_THAT(reason(R"([])"), HasSubstr("needs 2 values, got 0"));
  EXPECT_THAT(reason(R"(["60 V", "tip"])"), HasSubstr("expected a length [m], got a voltage [V]"));
}

TEST(Scene, WhatIsNotGivenTakesTheDefaultsOfTheStructs) {
  const Scene scene = read(edited(small_scene, "[simulate]\naccuracy = 1e-5\n", ""));
  EXPECT_EQ(scene.device.structure.modes, Structure{}.modes);
  EXPECT_EQ(scene.device.structure.damping_ratio, Structure{}.damping_ratio);
  EXPECT_EQ(part_of<Beam>(scene.device.structure).plate_strain, Beam{}.plate_strain);
  EXPECT_TRUE(std::isnan(part_of<Beam>(scene.device.structure).poissons_ratio));
  EXPECT_EQ(scene.device.electrodes[0].fringing, Electrode{}.fringing);
  EXPECT_EQ(scene.simulate.duration, SimulateOptions{}.duration);
  EXPECT_EQ(scene.simulate.accuracy, SimulateOptions{}.accuracy);
  EXPECT_EQ(scene.simulate.tolerance, SimulateOptions{}.tolerance);
  EXPECT_EQ(scene.metrics.significant_rebound, MetricsOptions{}.significant_rebound);
}

TEST(Scene, OptionalKeysArrive) {
  std::string text =
      edited(small_scene, "[gap]", "modes = 7\ndamping_ratio = \"2 %\"\nplate_strain = true\npoissons_ratio = 0.44\n[gap]");
  text = edited(text, "accuracy = 1e-5", "duration = \"600 us\"\ntolerance = 1e-9\n[metrics]\nsignificant_rebound = \"2 nm\"");
  const Scene scene = read(text);
  EXPECT_EQ(scene.device.structure.modes, 7);
  EXPECT_EQ(scene.device.structure.damping_ratio, 0.02);
  EXPECT_TRUE(part_of<Beam>(scene.device.structure).plate_strain);
  EXPECT_EQ(part_of<Beam>(scene.device.structure).poissons_ratio, 0.44);
  EXPECT_EQ(scene.simulate.duration, 600e-6);
  EXPECT_EQ(scene.simulate.tolerance, 1e-9);
  EXPECT_EQ(scene.metrics.significant_rebound, 2e-9);
}

TEST(Scene, OfTheGapClosingActuatorIsThatOfTheComparison) {
  constexpr double written = 2e-4;  // relative; number of digits in the scene
  const Device scene = read_file("gap-closing-actuator.toml").device, d = test::gap_closing_actuator(76.5e-6);
  EXPECT_NEAR(part_of<Plate>(scene.structure).mass, part_of<Plate>(d.structure).mass, written * part_of<Plate>(d.structure).mass);
  EXPECT_NEAR(part_of<Plate>(scene.structure).stiffness, part_of<Plate>(d.structure).stiffness,
              written * part_of<Plate>(d.structure).stiffness);
  EXPECT_NEAR(scene.structure.length, d.structure.length, written * d.structure.length);
  EXPECT_NEAR(scene.structure.thickness, d.structure.thickness, written * d.structure.thickness);
  EXPECT_NEAR(scene.gap.contact, d.gap.contact, 1e-12);
  EXPECT_NEAR(scene.electrodes[0].gap, d.electrodes[0].gap, 1e-12);
  EXPECT_EQ(scene.electrodes[0].side, Side::both);
  const auto film = std::get<StripSlitGas>(*scene.gas), own = std::get<StripSlitGas>(*d.gas);
  EXPECT_NEAR(film.film_length, own.film_length, 1e-12);
  EXPECT_NEAR(film.slit_length, own.slit_length, 3e-3 * own.slit_length);
  EXPECT_NEAR(film.far_gap, own.far_gap, 1e-12);
}

TEST(Scene, ABeamBetweenTwoClampsHasItsStress) {
  const auto bridge_of = [](const Scene& scene) { return std::get<Bridge>(scene.device.structure.kind); };
  const Bridge senturia = bridge_of(read_file("hung-senturia.toml"));
  EXPECT_EQ(senturia.residual_stress, -3.7e6);
  EXPECT_FALSE(senturia.biaxial);
  EXPECT_FALSE(senturia.stretches);
  constexpr std::string_view bridge = R"([structure]
kind = "clamped-clamped"
length = "250 um"
width = "20 um"
thickness = "4 um"
youngs_modulus = "78 GPa"
density = "19300 kg/m^3"
[gap]
electrode = "3.5 um"
contact = "2 um"
)";
  const Bridge plain = bridge_of(read(std::string(bridge)));
  EXPECT_EQ(plain.residual_stress, Bridge{}.residual_stress);
  EXPECT_EQ(plain.biaxial, Bridge{}.biaxial);
  EXPECT_EQ(plain.stretches, Bridge{}.stretches);
  const Bridge film =
      bridge_of(read(edited(bridge, "[gap]", "biaxial = true\npoissons_ratio = 0.44\nresidual_stress = \"100 MPa\"\n[gap]")));
  EXPECT_TRUE(film.biaxial);
  EXPECT_EQ(film.residual_stress, 100e6);
  EXPECT_EQ(film.poissons_ratio, 0.44);
}

TEST(Scene, ModesMayBeLeftToTheStudies) {
  const Scene scene = read(edited(small_scene, "[gap]", "modes = \"auto\"\n[gap]"));
  EXPECT_TRUE(scene.auto_modes);
  EXPECT_EQ(scene.device.structure.modes, Structure{}.modes);
  EXPECT_FALSE(read(std::string(small_scene)).auto_modes);
}

TEST(Scene, APlateIsAStripOfItsAreaAndWidth) {
  const Device d = read_file("purdue-nickel.toml").device;
  ASSERT_NE(d.structure.find<Plate>(), nullptr);
  EXPECT_EQ(part_of<Plate>(d.structure).mass, 9.2371e-10);
  EXPECT_EQ(part_of<Plate>(d.structure).stiffness, 91.303);
  EXPECT_EQ(d.structure.width, 123e-6);
  EXPECT_DOUBLE_EQ(d.structure.length, 510e-6);
  EXPECT_EQ(d.structure.modes, 1);
  EXPECT_DOUBLE_EQ(d.electrodes[0].end.value - d.electrodes[0].begin.value, 510e-6)
      << "without an area of its own it is as large as the plate";

  const Device square = read(R"([structure]
kind = "plate"
mass = "1e-9 kg"
stiffness = "40 N/m"
area = "1e4 um^2"
[gap]
electrode = "3.5 um"
contact = "2 um"
[electrode.main]
area = "2500 um^2"
fringing = "none"
)")
                            .device;
  EXPECT_DOUBLE_EQ(square.structure.width, 100e-6) << "where no law needs its width";
  EXPECT_DOUBLE_EQ(square.electrodes[0].end.value, 25e-6);
}

TEST(Scene, EveryFringingLawHasAName) {
  for (const FringingRow& law : fringing_laws) {
    const Scene scene = read(edited(small_scene, "[gas]", "fringing = \"" + std::string(law.name) + "\"\n[gas]"));
    EXPECT_EQ(scene.device.electrodes[0].fringing, law.value) << law.name;
  }
}

TEST(Scene, AsperitiesArrive) {
  const auto contact = std::get<UniformAsperities>(read_file("mem-gold.toml").device.contacts.front().model);
  EXPECT_EQ(contact.summits.radius, 100e-9);
  EXPECT_EQ(contact.summits.density, 1e11);
  EXPECT_EQ(contact.height, 100e-9);
  EXPECT_EQ(contact.summits.effective_modulus, 48e9);
}

TEST(Scene, EveryContactLawArrives) {
  const auto contact = [](const std::string& keys) {
    return read(edited(small_scene, "model = \"linear\"\npad_length = \"5 um\"\nstiffness = \"100 N/m\"", keys))
        .device.contacts.front();
  };
  const std::string summits =
      "pad_length = \"5 um\"\nasperity_radius = \"100 nm\"\nasperity_density = \"1e11 1/m^2\"\neffective_modulus = \"48 GPa\"\n";
  const Contact rough = contact(summits + "model = \"asperity-gaussian\"\nasperity_deviation = \"30 nm\"\ndamping = \"0.2 s/m\"");
  const auto gaussian = std::get<GaussianAsperities>(rough.model);
  EXPECT_EQ(gaussian.deviation, 30e-9);
  EXPECT_EQ(gaussian.summits.effective_modulus, 48e9);
  EXPECT_EQ(gaussian.damping, 0.2);
  EXPECT_EQ(rough.distribution, ContactDistribution::centre);
  EXPECT_EQ(contact("model = \"linear\"\npad_length = \"5 um\"\nstiffness = \"100 N/m\"\ndistribution = \"pad\"").distribution,
            ContactDistribution::pad);
  const auto adhesive = std::get<AdhesiveAsperities>(
      contact(summits + "model = \"adhesive\"\nasperity_height = \"100 nm\"\nadhesion_energy = \"0.05 J/m^2\"").model);
  EXPECT_EQ(adhesive.height, 100e-9);
  EXPECT_EQ(adhesive.adhesion_energy, 0.05);
  const std::string yields = summits + "model = \"elastic-plastic\"\nasperity_height = \"100 nm\"\nhardness = \"1 GPa\"";
  const auto plastic = std::get<PlasticAsperities>(contact(yields).model);
  EXPECT_EQ(plastic.hardness, 1e9);
  EXPECT_EQ(plastic.plasticity, Plasticity::zmc);
  EXPECT_EQ(std::get<PlasticAsperities>(contact(yields + "\nplasticity = \"ke\"").model).plasticity, Plasticity::kogut_etsion);
  const auto hysteretic = std::get<HystereticSpring>(
      contact("pad_length = \"5 um\"\nmodel = \"hysteretic\"\nstiffness = \"1e4 N/m\"\nunloading_stiffness = \"2e4 N/m\"").model);
  EXPECT_EQ(hysteretic.stiffness, 1e4);
  EXPECT_EQ(hysteretic.unloading_stiffness, 2e4);
}

TEST(Scene, DispersionForcesArrive) {
  const auto dispersion = [](const std::string& keys) {
    return *read_scene(SceneFile::parse(edited(small_scene, "[gas]", "[dispersion]\n" + keys + "[gas]"), "x.toml"))
                .device.dispersion;
  };
  const Dispersion casimir = dispersion("model = \"casimir\"\nconductor = \"gold\"\n");
  EXPECT_EQ(casimir.model, DispersionModel::casimir);
  EXPECT_EQ(casimir.conductor, Conductor::gold);
  const Dispersion near =
      dispersion("model = \"van-der-waals\"\nhamaker_constant = \"4e-19 J\"\nequilibrium_distance = \"0.3 nm\"\n");
  EXPECT_EQ(near.model, DispersionModel::van_der_waals);
  EXPECT_EQ(near.hamaker_constant, 4e-19);
  EXPECT_EQ(near.equilibrium_distance, 0.3e-9);
  const Dispersion both = dispersion("model = \"auto\"\nhamaker_constant = \"4e-19 J\"\n");
  EXPECT_EQ(both.model, DispersionModel::automatic);
  EXPECT_EQ(both.conductor, Conductor::ideal);
  EXPECT_EQ(both.equilibrium_distance, 0);
}

TEST(Scene, SurfacesArrive) {
  const auto scene = [](const std::string& keys) {
    const std::string layered(small_scene);
    return read_scene(SceneFile::parse(layered.substr(0, layered.find("[piezo]")) + "[surface]\n" + keys, "x.toml"));
  };
  const Scene given = scene(
      "elastic_modulus = \"-10.654 N/m\"\nresidual_stress = \"0.6 N/m\"\nfaces = \"wide\"\ncantilever_load = \"compression\"\n");
  const Surface& surface = *given.device.surface;
  EXPECT_EQ(surface.elastic_modulus, -10.654);
  EXPECT_EQ(surface.residual_stress, 0.6);
  EXPECT_EQ(surface.faces, SurfaceFaces::wide);
  EXPECT_EQ(surface.cantilever_load, ResidualLoad::compression);
  const auto told = [](const Scene& s) {
    return std::count(
        s.warnings.begin(), s.warnings.end(),
        "x.toml: surface.residual_stress has no effect on a cantilever; surface.cantilever_load selects its effect");
  };
  EXPECT_EQ(told(given), 0);
  const Scene bare = scene("residual_stress = \"0.6 N/m\"\n");
  EXPECT_EQ(told(bare), 1);
  EXPECT_EQ(bare.device.surface->elastic_modulus, 0);
  EXPECT_EQ(bare.device.surface->faces, SurfaceFaces::all);
  EXPECT_EQ(bare.device.surface->cantilever_load, ResidualLoad::none);
}

TEST(Scene, AdhesiveRepulsiveContactHasThePublishedNumbersUnlessTold) {
  const auto pressure = [](const std::string& keys) {
    const Scene scene = read(edited(small_scene, "model = \"linear\"\npad_length = \"5 um\"\nstiffness = \"100 N/m\"",
                                    "model = \"adhesive-repulsive\"\npad_length = \"5 um\"" + keys));
    return std::get<AdhesiveRepulsiveSurfaces>(scene.device.contacts.front().model).pressure;
  };
  const SurfacePressure published, read_back = pressure("");
  EXPECT_DOUBLE_EQ(read_back.asperity_pressure, published.asperity_pressure);
  EXPECT_DOUBLE_EQ(read_back.asperity_distance, published.asperity_distance);
  EXPECT_DOUBLE_EQ(read_back.wall_pressure, published.wall_pressure);
  EXPECT_DOUBLE_EQ(read_back.wall_range, published.wall_range);
  EXPECT_DOUBLE_EQ(read_back.adhesion_pressure, published.adhesion_pressure);
  EXPECT_DOUBLE_EQ(read_back.adhesion_range, published.adhesion_range);
  EXPECT_DOUBLE_EQ(read_back.hamaker_constant, published.hamaker_constant);
  EXPECT_DOUBLE_EQ(read_back.smoothing_distance, published.smoothing_distance);
  EXPECT_DOUBLE_EQ(read_back.reach, published.reach);
  EXPECT_DOUBLE_EQ(pressure("\nwall_range = \"9 nm\"").wall_range, 9e-9);
}

TEST(Scene, ElectrodesComeSortedByName) {
  const Scene scene = read(edited(small_scene, "[gas]", "[electrode.back]\nspan = [\"0 m\", \"50 um\"]\n[gas]"));
  ASSERT_EQ(scene.device.electrodes.size(), 2U);
  EXPECT_EQ(scene.device.electrodes[0].name, "back");
  EXPECT_EQ(scene.device.electrodes[1].name, "main");
}

TEST(Scene, AnAbsentSectionIsAnEffectThatIsNotSimulated) {
  const Scene scene = read(R"([structure]
kind = "cantilever"
length = "250 um"
width = "20 um"
thickness = "4 um"
youngs_modulus = "78 GPa"
density = "19300 kg/m^3"
[gap]
electrode = "3.5 um"
contact = "2 um"
)");
  EXPECT_TRUE(scene.device.electrodes.empty());
  EXPECT_FALSE(scene.device.gas);
  EXPECT_FALSE(scene.device.has_contact());
  EXPECT_FALSE(scene.device.piezo);
  EXPECT_EQ(scene.drives({}).size(), 0U);
  EXPECT_THAT(scene.warnings, testing::ElementsAre("x.toml: no drive can move this switch: add [electrode.NAME] or [piezo]"));
}

TEST(Scene, ALayerOnAWideBeamIsWarnedOfItsMoment) {
  const std::string wide = edited(small_scene, "[gap]", "plate_strain = true\npoissons_ratio = 0.3\n[gap]");
  EXPECT_THAT(read(wide).warnings, testing::ElementsAre(testing::HasSubstr("its moment is 43 % above that of d31")));
  EXPECT_THAT(read(edited(wide, "d31 = \"-171 pm/V\"", "e31 = \"-10.4 C/m^2\"")).warnings, testing::IsEmpty());
}

TEST(Scene, SummitsThatStickTooWellAreWarnedAbout) {
  const auto sticking = [](const std::string& energy) {
    return edited(edited(small_scene, "model = \"linear\"", "model = \"adhesive\""), "stiffness = \"100 N/m\"",
                  "asperity_radius = \"100 nm\"\nasperity_density = \"1e11 1/m^2\"\nasperity_height = \"100 nm\"\n"
                  "effective_modulus = \"50 GPa\"\nadhesion_energy = \"" +
                      energy + "\"");
  };
  // (1e-7 1^2 / ((5e10)^2 (3e-10)^3))^(1/3) = 1.14
  EXPECT_THAT(read(sticking("1 J/m^2")).warnings,
              testing::ElementsAre(testing::HasSubstr("the Tabor number of its summits is 1.1;")));
  EXPECT_THAT(read(sticking("0.05 J/m^2")).warnings, testing::IsEmpty());
}

TEST(Scene, AWideBeamWithoutPlateStrainIsWarnedAbout) {
  // A width of exactly five thicknesses does not count as wide.
  EXPECT_THAT(read(edited(small_scene, "\"20 um\"", "\"20.00 um\"")).warnings, testing::IsEmpty());
  EXPECT_THAT(read(edited(small_scene, "\"20 um\"", "\"20.1 um\"")).warnings,
              testing::ElementsAre("x.toml:5: structure.width = \"20.1 um\": more than five thicknesses; "
                                   "youngs_modulus is used as given "
                                   "(plate_strain = false), plate_strain = true with poissons_ratio would use E / (1 - nu^2)"));
  EXPECT_THAT(read(edited(edited(small_scene, "\"20 um\"", "\"20.1 um\""), "[gap]", "plate_strain = false\n[gap]")).warnings,
              testing::IsEmpty())
      << "it says so itself";
  EXPECT_THAT(
      read(edited(edited(small_scene, "\"20 um\"", "\"20.1 um\""), "[gap]", "plate_strain = true\npoissons_ratio = 0.44\n[gap]"))
          .warnings,
      testing::Each(testing::Not(testing::HasSubstr("thicknesses"))));
}

TEST(Scene, ASpreadIsKept) {
  const Scene scene = read(edited(small_scene, "[gas]", R"([spread]
"structure.thickness" = { distribution = "normal", cov = "2 %" }
"structure.density" = { distribution = "lognormal", cov = 0.1 }
"gap.contact" = { distribution = "uniform", half_width = "50 nm" }
"gap.electrode" = { distribution = "uniform", half_width = "2 %" }
[gas])"));
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_EQ(scene.spread.variables.size(), 4U);
  EXPECT_THAT(scene.file.text(), testing::HasSubstr("\"gap.contact\" = { distribution = \"uniform\", half_width = \"50 nm\" }"));
  EXPECT_EQ(resolved(scene, {{"main", {50, 40}}}).json()["spread"], scene.file.json()["spread"]);
}

TEST(Scene, TheReferenceScenesAreFine) {
  for (const char* name : {"mem-gold.toml", "mem-gold-pzt.toml"}) {
    const Scene scene = read_file(name);
    EXPECT_EQ(scene.device.structure.length, 250e-6) << name;
    EXPECT_THAT(scene.need_pull_in, testing::ElementsAre("main")) << name;
    const Drives drives = scene.drives({{"main", {.static_pull_in = 50_V, .dynamic_pull_in = 45_V}}});
    EXPECT_EQ(std::get<Step>(drives.at("main").waveform.value()).level, 1.25 * 45) << name;
    EXPECT_EQ(drives.at("main").limits.value().max_voltage, 1.5 * 45) << name;
  }
}

}  // namespace
}  // namespace softland
