// A structure with modes from a table, compared with the beam that has these modes.
#include "model/structure/tabulated_modes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "base/require.h"
#include "model/beam.h"
#include "model/closing.h"
#include "model/mode_shapes.h"
#include "model/pull_in.h"
#include "model/switch.h"
#include "tests/support/devices.h"

namespace softland {
namespace {

/// Returns the modes of a device's beam at equal distances.
std::shared_ptr<const ModalTable> modal_table_of(Device device, int modes, int parts) {
  device.structure.modes = modes;
  const BeamModes beam = beam_modes(device, nullptr);
  std::vector<double> positions, frequencies;
  for (int k = 0; k <= parts; ++k)
    positions.push_back(k == parts ? device.structure.length : device.structure.length * k / parts);
  std::vector<std::vector<double>> shapes;
  for (Eigen::Index i = 0; i < beam.count(); ++i) {
    frequencies.push_back(beam.angular_frequencies()[i] / (2 * pi));
    shapes.push_back({0});
    for (std::size_t k = 1; k < positions.size(); ++k) shapes.back().push_back(beam.value(positions[k])[i]);
  }
  const SplineEnd far_end = device.structure.has_far_clamp() ? SplineEnd::clamped : SplineEnd::free;
  if (far_end == SplineEnd::clamped) {
    for (std::vector<double>& shape : shapes) shape.back() = 0;
  }
  return std::make_shared<const ModalTable>(positions, frequencies, shapes, std::vector<double>(), std::vector<double>(),
                                            far_end);
}

Device by_modes(Device device, std::shared_ptr<const ModalTable> table) {
  device.structure.kind = ModalStructure{};
  part_of<ModalStructure>(device.structure).table = std::move(table);
  return device;
}

template <typename Action>
void expect_refused_with(Action action, const std::string& rule) {
  try {
    action();
    ADD_FAILURE() << "accepted; expected: " << rule;
  } catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr(rule));
  }
}

constexpr int table_places = 100;

TEST(TabulatedModes, OfABeamAreItsModes) {
  constexpr int modes = 4;
  constexpr double interpolated = 1e-6;  // share of the tip: fourth order in the distance of the table_places
  const Device device = test::gold_cantilever();
  const BeamModes beam(beam_sections(device), modes);
  const TabulatedModes table(modal_table_of(device, modes, table_places), modes, 1);
  const double tip = beam.value(beam.length())[0];
  for (double x = 0; x <= 1; x += 0.0173) {
    const Eigen::VectorXd expected = beam.value(x * beam.length()), slope = beam.length() * beam.slope(x * beam.length());
    for (int i = 0; i < modes; ++i) {
      EXPECT_NEAR(table.normalised()->value(x)[i], expected[i], interpolated * tip) << "mode " << i + 1 << " at " << x;
      EXPECT_NEAR(table.normalised()->slope(x)[i], slope[i], 300 * interpolated * tip) << "mode " << i + 1 << " at " << x;
    }
  }
  EXPECT_EQ(table.normalised()->value(0).norm(), 0);
  EXPECT_NEAR(table.normalised()->slope(0).norm(), 0, 1e-9 * tip) << "the clamp";
}

TEST(TabulatedModes, HoldTheBeamAtItsContactAsTheBeamIsHeld) {
  constexpr double modes_left_out = 2e-3;  // effect of modes beyond twelve
  const Device device = test::gold_cantilever();
  const BeamModes beam(beam_sections(device), 4);
  const TabulatedModes table(modal_table_of(device, 12, table_places), 4, 1);
  const double x = device.contact_position();
  const double held = table.frequency_scale() / std::sqrt(table.normalised()->pinned_inverse_square(x / device.structure.length));
  EXPECT_NEAR(held, beam.pinned_frequency(x), modes_left_out * beam.pinned_frequency(x));
  const TabulatedModes alone(modal_table_of(device, 1, table_places), 1, 1);
  EXPECT_EQ(alone.normalised()->pinned_inverse_square(1), 1) << "a single mode cannot move: its own frequency stands in";
}

TEST(TabulatedModes, MoveASwitchAsTheBeamDoes) {
  constexpr double interpolated = 2e-6;
  const Device device = test::gold_cantilever();
  const int modes = device.structure.modes;
  const Switch beam(device), table(by_modes(device, modal_table_of(device, modes, table_places)));
  ASSERT_EQ(table.modes(), modes);
  Eigen::VectorXd q = Eigen::VectorXd::Zero(modes), v = q, expected(modes), found(modes);
  q[0] = 0.4 * device.gap.contact / beam.basis().contact_shape()[0], v[0] = 0.1 / beam.basis().contact_shape()[0],
  q[1] = -0.1 * q[0];
  const std::vector<double> volts(beam.drives(), 20.0);
  Switch::Workspace work = beam.workspace(), other = table.workspace();
  beam.accelerations(q.data(), v.data(), volts, false, work, expected.data());
  table.accelerations(q.data(), v.data(), volts, false, other, found.data());
  EXPECT_LT((found - expected).norm(), interpolated * expected.norm());
}

/// Returns the gold bridge with tabulated modes and its axial stiffness.
Device bridge_by_modes(const Device& bridge, int parts) {
  const Structure& s = bridge.structure;
  Device device = by_modes(bridge, modal_table_of(bridge, s.modes, parts));
  part_of<ModalStructure>(device.structure).axial_stiffness = part_of<Beam>(s).youngs_modulus * s.width * s.thickness / s.length;
  return device;
}

TEST(TabulatedModes, BetweenTwoClampsStretchAsTheBeamDoes) {
  constexpr double interpolated = 5e-6;  // fourth order; the fifth mode turns by 0.17 from place to place
  const Device device = test::gold_bridge();
  const Switch beam(device), table(bridge_by_modes(device, table_places));
  ASSERT_TRUE(table.stretching());
  EXPECT_DOUBLE_EQ(table.stretching()->stiffness, beam.stretching()->stiffness);
  const auto of_largest = [&](const std::vector<double>& all) { return std::abs(*std::ranges::max_element(all)); };
  for (std::size_t k = 0; k < beam.stretching()->slopes.size(); ++k)
    EXPECT_NEAR(table.stretching()->slopes[k], beam.stretching()->slopes[k], interpolated * of_largest(beam.stretching()->slopes))
        << k;
  EXPECT_DOUBLE_EQ(table.device().contact_position(), device.structure.length / 2);
}

// The figures with the table approach those of the beam with the fourth power of the table's spacing.
TEST(TabulatedModes, BetweenTwoClampsPullInAndCloseAsTheBeamDoes) {
  constexpr double interpolated = 1e-5;
  const Device device = test::gold_bridge();
  const Switch beam(device);
  const double volts = static_pull_in(beam, 0).voltage;
  const std::vector<Signal> drives{Signal::constant(1.6 * volts), Signal::constant(0)};
  const auto closing_time = [&](const Switch& model) {
    const Trajectory run = simulate_closing(model, drives, {.duration = 200e-6, .tolerance = 1e-10, .after_contact = 0});
    return run.touches.empty() ? std::numeric_limits<double>::quiet_NaN() : run.touches.front().begin;
  };
  const double expected = closing_time(beam);
  ASSERT_GT(expected, 0);
  const auto errors = [&](int parts) {
    const Switch table(bridge_by_modes(device, parts));
    return std::pair(std::abs(static_pull_in(table, 0).voltage / volts - 1), std::abs(closing_time(table) / expected - 1));
  };
  const auto [volts_error, time_error] = errors(table_places);
  EXPECT_LT(volts_error, interpolated);
  EXPECT_LT(time_error, interpolated);
  const auto [coarse_volts, coarse_time] = errors(10);
  EXPECT_GT(coarse_volts, 10 * volts_error);
  EXPECT_GT(coarse_time, 10 * time_error);
  // Without its axial stiffness it is another switch.
  Device straight = bridge_by_modes(device, table_places);
  part_of<ModalStructure>(straight.structure).axial_stiffness = not_given;
  EXPECT_LT(static_pull_in(Switch(straight), 0).voltage, 0.9 * volts);
}

TEST(TabulatedModes, OfSwitchesOfOneTableShareTheirQuadrature) {
  const Device device = by_modes(test::gold_cantilever(), modal_table_of(test::gold_cantilever(), 4, table_places));
  const Switch nominal(device);
  Device stiffer = device;
  part_of<ModalStructure>(stiffer.structure).frequency_factor = 1.1;
  const Switch built(stiffer), quickly(stiffer, {}, &nominal);
  EXPECT_EQ(built.quadrature().shapes(), quickly.quadrature().shapes());
  EXPECT_EQ(built.basis().angular_frequencies(), quickly.basis().angular_frequencies());
  EXPECT_EQ(built.basis().contact_shape(), quickly.basis().contact_shape());
  EXPECT_NEAR(built.basis().angular_frequencies()[2], 1.1 * nominal.basis().angular_frequencies()[2],
              1e-9 * nominal.basis().angular_frequencies()[2]);
}

TEST(TabulatedModes, OfAnotherTableAreNotTakenFromASwitch) {
  Device layered = test::gold_cantilever();
  layered.piezo = test::gold_pzt_cantilever().piezo;  // other shapes along the same length
  const auto one = modal_table_of(test::gold_cantilever(), 4, table_places), other = modal_table_of(layered, 4, table_places);
  const Switch like(by_modes(test::gold_cantilever(), one));
  const Switch alone(by_modes(test::gold_cantilever(), other)), beside(by_modes(test::gold_cantilever(), other), {}, &like);
  EXPECT_EQ(beside.quadrature().shapes(), alone.quadrature().shapes());
  EXPECT_NE(beside.quadrature().shapes(), like.quadrature().shapes());
}

TEST(ModeShapes, OfATableAreThoseOfItsBeam) {
  constexpr double interpolated = 1e-6;  // error as a share of the tip
  constexpr int places = 9;
  Device device = by_modes(test::gold_cantilever(), modal_table_of(test::gold_cantilever(), 5, table_places));
  device.structure.modes = 4;
  const ModeShapes table = mode_shapes(Switch(device), places), beam = mode_shapes(Switch(test::gold_cantilever()), places);
  ASSERT_EQ(beam.shapes.rows(), places);
  ASSERT_EQ(beam.shapes.cols(), 4);
  EXPECT_EQ(table.places, beam.places);
  EXPECT_EQ(table.places[places - 1], device.structure.length);
  EXPECT_LT((table.shapes - beam.shapes).cwiseAbs().maxCoeff(), interpolated * beam.shapes(places - 1, 0));
  EXPECT_LT(beam.shapes.row(0).norm(), 1e-12 * beam.shapes(places - 1, 0)) << "the clamp";
  EXPECT_NEAR(beam.shapes(places - 1, 0), BeamModes(beam_sections(test::gold_cantilever()), 1).value(device.structure.length)[0],
              1e-12 * beam.shapes(places - 1, 0));
  EXPECT_THROW((void)mode_shapes(Switch(device), 1), InvalidInput);
}

TEST(ModeShapes, OfAPlateAreItsMotion) {
  const Device plate = test::full_plate();
  const ModeShapes shapes = mode_shapes(Switch(plate), 2);
  EXPECT_EQ(shapes.shapes.cols(), 1);
  for (const double shape : shapes.shapes.reshaped())
    EXPECT_DOUBLE_EQ(shape, 1 / std::sqrt(part_of<Plate>(plate.structure).mass));
  EXPECT_EQ(mode_shapes_at(Switch(plate), Eigen::Vector3d(0, 1e-6, plate.structure.length)),
            Eigen::Vector3d::Constant(shapes.shapes(0, 0)));
}

TEST(ModeShapes, AtThePlaceOfTheContactAreThoseOfTheSwitch) {
  constexpr double rounding = 1e-12;
  const Device device = test::gold_cantilever();
  const Switch model(device);
  const Eigen::RowVectorXd there = mode_shapes_at(model, Eigen::VectorXd::Constant(1, device.contact_position()));
  EXPECT_LT((there.transpose() - model.contact_shape()).norm(), rounding * there.norm());
}

TEST(TabulatedModes, AreRefusedWithTheRule) {
  const auto make = [](std::vector<double> x, std::vector<double> f, std::vector<std::vector<double>> y) {
    return [=] { (void)ModalTable(x, f, y); };
  };
  expect_refused_with(make({0, 1}, {1}, {{0, 1}}), "at least three positions that increase from 0");
  expect_refused_with(make({0.1, 1, 2}, {1}, {{0, 1, 2}}), "at least three positions that increase from 0");
  expect_refused_with(make({0, 1, 2}, {2, 1}, {{0, 1, 2}, {0, 1, 2}}), "the frequencies must be positive and increase");
  expect_refused_with(make({0, 1, 2}, {1}, {{0, 1}}), "a shape must have a value per position");
  expect_refused_with(make({0, 1, 2}, {1}, {{0.1, 1, 2}}), "a shape must be finite and 0 at the clamp");
  expect_refused_with(make({0, 1, 2}, {1}, {{0, 0, 0}}), "a shape must not be 0 everywhere");
  const auto table = modal_table_of(test::gold_cantilever(), 4, table_places);
  Device device = by_modes(test::gold_cantilever(), table);
  device.structure.modes = 5;
  expect_refused_with([&] { (void)Switch(device); }, "structure.modes = 5: must not exceed 4, the modes of the file");
  device.structure.modes = 4;
  expect_refused_with([&] { (void)Switch(device, {.modes = 5}); }, "modes = 5: must be from 1 to 4");
  device.structure.length *= 2;
  expect_refused_with([&] { (void)Switch(device); }, "must be the length of the table of modes");
  device = by_modes(test::gold_pzt_cantilever(), table);
  expect_refused_with([&] { (void)Switch(device); }, "a layer changes the modes");
  for (const double middle : {1e5, -1e5}) {
    device = by_modes(test::gold_cantilever(),
                      std::make_shared<const ModalTable>(std::vector<double>{0, 125e-6, 250e-6}, std::vector<double>{1e4},
                                                         std::vector<std::vector<double>>{{0, middle, 1}}));
    device.structure.modes = 1;
    expect_refused_with([&] { (void)Switch(device); }, "the far end stands still in every mode: far_anchor = \"clamped\"");
  }
  const auto clamped = [](std::vector<double> y) {
    std::vector<double> x(y.size());
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = static_cast<double>(i);
    return [=] { (void)ModalTable(x, {1}, {y}, {}, {}, SplineEnd::clamped); };
  };
  expect_refused_with(clamped({0, 1, 1}), "a clamped far end must not move in any mode");
  expect_refused_with(clamped({0, 1, 4, 9, 16, 25, 36, 49, 56, 48, 32, 16, 0}), "must leave a clamped far end without a slope");
  device = by_modes(test::gold_cantilever(), table);
  part_of<ModalStructure>(device.structure).axial_stiffness = 1e4;
  expect_refused_with([&] { (void)Switch(device); }, "structure.axial_stiffness: needs far_anchor = \"clamped\"");
  device = bridge_by_modes(test::gold_bridge(), 4);
  const auto& straight = *part_of<ModalStructure>(device.structure).table;
  part_of<ModalStructure>(device.structure).table =
      std::make_shared<const ModalTable>(straight.positions(), straight.frequencies(), straight.shapes(),
                                         std::vector<double>{0, 0, 1e-7, 0, 0}, std::vector<double>(), SplineEnd::clamped);
  expect_refused_with([&] { (void)Switch(device); }, "structure.axial_stiffness: cannot stand beside rest offsets");
}

}  // namespace
}  // namespace softland
