#include "model/device.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

#include "base/literals.h"
#include "model/status.h"
#include "model/switch.h"
#include "tests/model/expect_refused.h"
#include "tests/support/devices.h"

namespace softland {
namespace {

using namespace literals;

void expect_message(const std::function<void(Device&)>& damage, const std::string& message) {
  Device device = test::gold_pzt_cantilever();
  damage(device);
  test::expect_refused([&] { validate(device); }, message);
  test::expect_refused([&] { (void)Switch(device); }, message);
}

TEST(Device, OfTheReferenceIsValid) {
  EXPECT_NO_THROW(validate(test::gold_cantilever()));
  EXPECT_NO_THROW(validate(test::gold_pzt_cantilever()));
}

TEST(Device, NamesWhatIsWrongWithABeamBetweenTwoClamps) {
  const auto expect = [](const std::function<void(Device&)>& damage, const std::string& message) {
    Device device = test::hung_senturia();
    damage(device);
    test::expect_refused([&] { validate(device); }, message);
    test::expect_refused([&] { (void)Switch(device); }, message);
  };
  expect([](Device& d) { part_of<Bridge>(d.structure).biaxial = true; },
         "structure.poissons_ratio = nan: biaxial needs one between -1 and 0.5");
  expect([](Device& d) { part_of<Bridge>(d.structure).residual_stress = -6.38e6; },
         "structure.residual_stress = -6.38 MPa: leaves -6.38 MPa along the beam, which buckles at -6.376 MPa");
  expect(
      [](Device& d) {
        part_of<Bridge>(d.structure).residual_stress = -10e6;
        part_of<Bridge>(d.structure).biaxial = true;
        part_of<Beam>(d.structure).poissons_ratio = 0.25;
      },
      "structure.residual_stress = -10 MPa: leaves -7.5 MPa along the beam, which buckles at -6.376 MPa");
  expect([](Device& d) { part_of<Bridge>(d.structure).residual_stress = std::nan(""); },
         "structure.residual_stress = nan Pa: leaves nan MPa along the beam, which buckles at -6.376 MPa");
  expect(
      [](Device& d) { d.piezo = test::gold_pzt_cantilever().piezo; },
      "piezo: between two clamps the layer's axial force is not released: it would stretch or buckle the beam, and pull off its "
      "middle line; a layer needs a cantilever");
  Device nearly = test::hung_senturia();
  part_of<Bridge>(nearly.structure).residual_stress = -6.37e6;
  EXPECT_NO_THROW(validate(nearly));
  Device free = test::gold_cantilever();
  EXPECT_DOUBLE_EQ(Switch(free).basis().angular_frequencies()[0],
                   Switch(test::gold_cantilever()).basis().angular_frequencies()[0]);
}

TEST(Device, RefusesElectrodesThatOverlapOnOneSideOfABeam) {
  const auto conflict = [](std::vector<Electrode> electrodes, Structure structure = test::gold_cantilever().structure) {
    const auto found = electrode_conflict(structure, electrodes);
    return found ? std::to_string(found->electrode) + " " + found->why : "";
  };
  const auto electrode = [](double begin, double end, Side side = Side::near) {
    return Electrode{.name = "e" + std::to_string(std::lround(begin * 1e6)), .begin = begin, .end = end, .side = side};
  };
  constexpr double L = 250_um, bit = 1e-14 * L;
  EXPECT_EQ(conflict({electrode(0, 100_um), electrode(100_um, L)}), "");
  EXPECT_EQ(conflict({electrode(100_um - bit, L), electrode(0, 100_um)}), "") << "edges that touch within rounding";
  const std::string near = "must not overlap electrode.e0, which ends at 100 um on the near side too";
  EXPECT_EQ(conflict({electrode(0, 100_um), electrode(99.9_um, L)}), "1 " + near);
  EXPECT_EQ(conflict({electrode(50_um, 60_um), electrode(0, 100_um)}), "0 " + near) << "one inside the other";
  EXPECT_EQ(conflict({electrode(0, 100_um), electrode(0, 100_um)}), "1 " + near);
  EXPECT_EQ(conflict({electrode(120_um, 130_um), electrode(0, 100_um), electrode(90_um, 110_um)}), "2 " + near);
  EXPECT_EQ(conflict({electrode(0, 100_um), electrode(50_um, L, Side::far)}), "") << "opposite sides";
  EXPECT_EQ(conflict({electrode(0, 100_um, Side::both), electrode(50_um, L)}), "1 " + near);
  EXPECT_EQ(conflict({electrode(0, 100_um, Side::both), electrode(50_um, L, Side::far)}),
            "1 must not overlap electrode.e0, which ends at 100 um on the far side too");

  const Structure plate = test::full_plate().structure;  // 100 um long
  const auto share = [&](double length, Side side = Side::near) { return electrode(0, length, side); };
  EXPECT_EQ(conflict({share(70_um), share(30_um), share(100_um, Side::far)}, plate), "");
  EXPECT_EQ(conflict({share(70_um), share(31_um)}, plate),
            "1 the electrodes of the near side must not have more area together than the plate");
  EXPECT_EQ(conflict({share(70_um, Side::far), share(10_um, Side::near), share(31_um, Side::both)}, plate),
            "2 the electrodes of the far side must not have more area together than the plate");
  expect_message([](Device& d) { d.electrodes.push_back({.name = "tip", .begin = 200_um, .end = 250_um}); },
                 "electrode.tip: must not overlap electrode.main, which ends at 240 um on the near side too");
}

TEST(Device, NamesWhatIsWrongWithIt) {
  expect_message([](Device& d) { d.structure.length = 0; }, "structure.length = 0 m: must be greater than 0 and below 1e30");
  expect_message([](Device& d) { d.structure.width = -1e-6; }, "structure.width = -1 um: must be greater than 0 and below 1e30");
  expect_message([](Device& d) { d.structure.thickness = std::nan(""); }, "structure.thickness: must be given for this device");
  expect_message([](Device& d) { part_of<Beam>(d.structure).youngs_modulus = INFINITY; },
                 "structure.youngs_modulus = inf Pa: must be greater than 0 and below 1e30");
  expect_message([](Device& d) { part_of<Beam>(d.structure).density = 0; },
                 "structure.density = 0 kg/m^3: must be greater than 0 and below 1e30");
  expect_message([](Device& d) { d.structure.modes = 0; }, "structure.modes = 0: must be from 1 to 20");
  expect_message([](Device& d) { d.structure.modes = 21; }, "structure.modes = 21: must be from 1 to 20");
  expect_message([](Device& d) { d.structure.damping_ratio = -0.1; }, "structure.damping_ratio = -0.1: must be in [0, 1000)");
  expect_message([](Device& d) { part_of<Beam>(d.structure).plate_strain = true; },
                 "structure.poissons_ratio = nan: plate_strain needs one between -1 and 0.5");
  expect_message([](Device& d) { d.gap.electrode = 0; }, "gap.electrode = 0 m: must be greater than 0 and below 1e30");
  expect_message([](Device& d) { d.gap.contact = 4e-6; },
                 "gap.contact = 4 um: must be positive and below gap.electrode = 3.5 um");
  expect_message([](Device& d) { d.gap.contact = 0; }, "gap.contact = 0 m: must be positive and below gap.electrode = 3.5 um");
  expect_message([](Device& d) { d.electrodes[0] = {.name = "left", .begin = 0, .end = 0.1}; },
                 "electrode.left.span = [0 m, 100 mm]: must increase and lie on the beam, from 0 m to 250 um");
  expect_message([](Device& d) { d.electrodes[0].begin = d.electrodes[0].end = 60_um; },
                 "electrode.main.span = [60 um, 60 um]: must increase and lie on the beam, from 0 m to 250 um");
  expect_message([](Device& d) { test::film(d).viscosity = 0; }, "gas.viscosity = 0 Pa s: must be greater than 0 and below 1e30");
  expect_message([](Device& d) { test::film(d).pressure = 0; }, "gas.pressure = 0 Pa: must be greater than 0 and below 1e30");
  expect_message([](Device& d) { test::film(d).temperature = -1; },
                 "gas.temperature = -1 K: must be greater than 0 and below 1e30");
  expect_message([](Device& d) { test::film(d).mean_free_path = 0; }, "gas.mean_free_path = 0 m: must be in (0 m, 1 Gm]");
  expect_message([](Device& d) { d.gas = LinearGas{}; }, "gas.model = linear: needs either damping or quality_factor");
  expect_message([](Device& d) { d.gas = LinearGas{.damping = 1, .quality_factor = 2}; },
                 "gas.model = linear: needs either damping or quality_factor");
  expect_message([](Device& d) { d.gas = LinearGas{.damping = 0}; },
                 "gas.damping = 0 N s/m^2: must be greater than 0 and below 1e30");
  expect_message([](Device& d) { d.contacts.front().pad_length = 1; },
                 "contact.pad_length = 1 m: must be positive and below structure.length = 250 um");
  expect_message([](Device& d) { test::rough(d).summits.radius = 0; },
                 "contact.asperity_radius = 0 m: must be greater than 0 and below 1e30");
  expect_message([](Device& d) { test::rough(d).summits.density = 0; },
                 "contact.asperity_density = 0 1/m^2: must be greater than 0 and below 1e30");
  expect_message([](Device& d) { test::rough(d).height = 0; },
                 "contact.asperity_height = 0 m: must be greater than 0 and below 1e30");
  expect_message([](Device& d) { test::rough(d).summits.effective_modulus = 0; },
                 "contact.effective_modulus = 0 Pa: must be greater than 0 and below 1e30");
  expect_message([](Device& d) { d.contacts.front().model = LinearSpring(); },
                 "contact.stiffness = 0 N/m: must be greater than 0 and below 1e30");
  expect_message([](Device& d) { d.contacts.front().model = GaussianAsperities{.summits = Summits::example()}; },
                 "contact.asperity_deviation = 0 m: must be greater than 0 and below 1e30");
  expect_message(
      [](Device& d) { d.contacts.front().model = AdhesiveAsperities{.summits = Summits::example(), .height = 100_nm}; },
      "contact.adhesion_energy = 0 J/m^2: must be greater than 0 and below 1e30");
  expect_message([](Device& d) { d.contacts.front().model = PlasticAsperities{.summits = Summits::example(), .height = 100_nm}; },
                 "contact.hardness = 0 Pa: must be greater than 0 and below 1e30");
  expect_message([](Device& d) { d.contacts.front().model = HystereticSpring{.stiffness = 100, .unloading_stiffness = 50}; },
                 "contact.unloading_stiffness = 50 N/m: must not be below contact.stiffness = 100 N/m, and below 1e30 N/m");
  expect_message([](Device& d) { d.contacts.front().model = RigidStop(); },
                 "contact.model = rigid: needs a plate; a beam has modes that take part in an impact");
  expect_message([](Device& d) { d.contacts.front().model = AdhesiveRepulsiveSurfaces{.pressure = {.wall_range = 0}}; },
                 "contact.wall_range = 0 m: must be greater than 0 and below 1e30");
  expect_message([](Device& d) { d.contacts.front().model = AdhesiveRepulsiveSurfaces{.pressure = {.reach = 100_nm}}; },
                 "contact.reach = 100 nm: must exceed asperity_distance + adhesion_range = 112 nm and be at most 1 m");
  expect_message(
      [](Device& d) {
        d.contacts.front().model = AdhesiveRepulsiveSurfaces();
        d.gap.contact = 0.5_um;
      },
      "contact.reach = 1 um: acts 837.940355224 nm above the plane of first touch, which must be less than gap.contact = 500 nm");
  const auto along_pad = [](auto&& change) {
    return [change](Device& d) {
      d.contacts.front().distribution = ContactDistribution::pad;
      change(d);
    };
  };
  expect_message(
      along_pad([](Device& d) { d.contacts.front().model = PlasticAsperities::example(); }),
      "contact.distribution = pad: not with model = \"elastic-plastic\": every point of the pad would keep a dent of its own");
  expect_message(along_pad([](Device& d) { d.contacts.front().model = AdhesiveRepulsiveSurfaces(); }),
                 "contact.distribution = pad: not with model = \"adhesive-repulsive\", which acts before the free end touches");
  expect_message(
      along_pad([](Device& d) {
        d.structure.kind = Bridge{part_of<Beam>(d.structure)};
        d.piezo.reset();
      }),
      "contact.distribution = pad: needs a cantilever, whose tilted pad is straight and touches first with its free end; "
      "between two clamps the pad lies flat about the middle");
  expect_message(along_pad([](Device& d) { d.contacts.front().pad_length = 26_um; }),
                 "contact.distribution = pad: the pad counts as straight, so pad_length must not exceed a tenth of the beam's "
                 "length, 25 um");
  expect_message([](Device& d) { std::get<UniformAsperities>(d.contacts.front().model).damping = -1; },
                 "contact.damping = -1 s/m: must be greater than 0 and below 1e30");
  expect_message([](Device& d) { d.piezo->begin = -1e-6, d.piezo->end = 2e-4; },
                 "piezo.span = [-1 um, 200 um]: must increase and lie on the beam, from 0 m to 250 um");
  expect_message([](Device& d) { d.piezo->thickness = 0; }, "piezo.thickness = 0 m: must be greater than 0 and below 1e30");
  expect_message([](Device& d) { d.piezo->youngs_modulus = 0; },
                 "piezo.youngs_modulus = 0 Pa: must be greater than 0 and below 1e30");
  expect_message([](Device& d) { d.piezo->density = 0; }, "piezo.density = 0 kg/m^3: must be greater than 0 and below 1e30");
  expect_message([](Device& d) { d.piezo->d31 = std::nan(""); }, "piezo.d31 = nan m/V: must be between -1 m/V and 1 m/V");
}

TEST(Device, NamesWhatIsWrongWithAPlate) {
  const auto expect = [](const std::function<void(Device&)>& damage, const std::string& message) {
    Device device = test::full_plate();
    damage(device);
    test::expect_refused([&] { validate(device); }, message);
  };
  const auto expect_valid = [](const std::function<void(Device&)>& change) {
    Device device = test::full_plate();
    change(device);
    validate(device);
  };
  EXPECT_NO_THROW(expect_valid([](Device&) {}));
  expect([](Device& d) { part_of<Plate>(d.structure).mass = 0; }, "structure.mass = 0 kg: must be greater than 0 and below 1e30");
  expect([](Device& d) { part_of<Plate>(d.structure).stiffness = -1; },
         "structure.stiffness = -1 N/m: must be greater than 0 and below 1e30");
  expect([](Device& d) { d.structure.thickness = 0; }, "structure.thickness = 0 m: must be greater than 0 and below 1e30");
  expect([](Device& d) { d.piezo = test::gold_pzt_cantilever().piezo; },
         "piezo: a rigid plate does not bend; a layer needs a beam");
  expect([](Device& d) { d.contacts.front().model = UniformAsperities::example(); },
         "contact.pad_length = 0 m: must be positive and below structure.length = 100 um");
  EXPECT_NO_THROW(expect_valid(
      [](Device& d) { d.contacts = {Contact{.model = HystereticSpring{.stiffness = 100, .unloading_stiffness = 200}}}; }));
  EXPECT_NO_THROW(expect_valid([](Device& d) { d.contacts = {Contact{.model = RigidStop{.restitution = 0}}}; }));
  expect(
      [](Device& d) {
        d.contacts = {Contact{.model = RigidStop{.restitution = 0}}};
        d.gas = ReynoldsGas{};
      },
      "contact.model = rigid: not with gas.model = reynolds, whose film still flows under a plate that rests");
  for (const double e : {-0.1, 1.0, std::nan("")}) {
    expect([e](Device& d) { d.contacts = {Contact{.model = RigidStop{.restitution = e}}}; }, "contact.restitution = " +
                                                                                                 std::string(e < 0    ? "-0.1"
                                                                                                             : e == 1 ? "1"
                                                                                                                      : "nan") +
                                                                                                 ": must be in [0, 1)");
  }
}

TEST(Device, TakesItsFiguresAtTheCentreOfThePad) {
  Device device = test::gold_cantilever();
  EXPECT_DOUBLE_EQ(device.contact_position(), 247.5_um);
  device.contacts.clear();
  EXPECT_DOUBLE_EQ(device.contact_position(), 250_um);
}

TEST(Status, HasItsNames) {
  EXPECT_EQ(to_string(Status::not_run), "not_run");
  EXPECT_EQ(to_string(Status::done), "done");
  EXPECT_EQ(to_string(Status::no_contact), "no_contact");
  EXPECT_EQ(to_string(Status::not_settled), "not_settled");
  EXPECT_EQ(to_string(Status::collapsed_at_rest), "collapsed_at_rest");
  EXPECT_EQ(to_string(Status::collapsed_onto_electrode), "collapsed_onto_electrode");
  EXPECT_EQ(to_string(Status::numerical_failure), "numerical_failure");
  EXPECT_EQ(to_string(Status::interrupted), "interrupted");
}

}  // namespace
}  // namespace softland
