// Compares exact derivatives of the figures by parameters of the device with differences of tight closings of separately built
// devices.
#include "studies/devices/derivatives.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "objectives/cost_slope.h"
#include "scenes.h"
#include "studies/devices/robustness.h"
#include "studies/search/search_setting.h"

namespace softland::derivatives_test {
namespace {

constexpr double bound = 1e-5;   // error over the largest derivative of the figure by any factor
constexpr double tight = 1e-11;  // tolerance of the closings
constexpr double agreement =
    1e-6;  // largest difference of extrapolations from two widths; if they differ by more, the case is undecided
constexpr double half_width = 1e-5;  // half width of the narrowest difference

struct Scenes {
  const char* scene;
  Actuator actuator;
  const char* family;
  std::vector<std::string> changes;
  std::vector<std::string> keys;  // varied keys, each by a factor
  std::string calibration = {};
  int arcs = 16;  // parts of an integrator step
};

std::string spread_of(const std::vector<std::string>& keys) {
  std::string entries;
  for (const std::string& key : keys)
    entries += fmt::format(R"({}"{}"={{distribution="normal",cov="1 %"}})", entries.empty() ? "" : ",", key);
  return "spread={" + entries + "}";
}

// Returns a switch with every key within a tenth of the scene's value. It is not shorter, since electrodes must end on it.
SceneFile random_switch(const Scenes& of, std::mt19937_64& random) {
  SceneFile file = scene(of.scene);
  for (const std::string& change : of.changes) file.set(change);
  file.set(spread_of(of.keys));
  const PreparedScene drawn = prepare(file);
  std::uniform_real_distribution<double> factor(0.9, 1.1);
  for (const SpreadVariable& v : drawn.scene.spread.variables) {
    for (const VariedKey& key : v.keys) {
      if (key.drive) continue;
      const double drawn_factor = key.path == "structure.length" ? 1 + std::abs(factor(random) - 1) : factor(random);
      if (key.element > 0) {
        file.assign(key.path, Quantity{.value = key.nominal * drawn_factor, .dimension = key.measured_in}, key.element);
      } else {
        file.assign(key.path, key.nominal * drawn_factor);
      }
    }
  }
  return file;
}

// Computes the figures of derivatives() under the waveforms of a drive, for separately built devices.
class Devices {
 public:
  Devices(const PreparedScene& nominal, const EnsembleDrive& drive)
      : nominal_(nominal), drive_(drive), ensemble_(nominal, 1), builder_(ensemble_), drives_(nominal) {
    if (!drive.known.calibration().is_empty()) meter_.emplace(nominal, MeasuredQuantities::of(drive.known.calibration()), 1e-11);
  }

  std::vector<double> figures(const std::vector<double>& values) {
    const SampledDevice device = builder_.device(values);
    if (!device.model) throw std::logic_error(device.refusal);
    const Switch model(device.model->device(), nominal_.quadrature);
    const DeviceUnits units = meter_ ? drive_.known.of(meter_->exact(model), 0, 0) : DeviceUnits{};
    const DeviceOutcome outcome =
        close_device({.values = values, .model = model}, drives_.signals(drive_.waveforms, units, values), nominal_.scene.metrics,
                     {.duration = nominal_.duration, .tolerance = tight});
    std::vector<double> all;
    for (const Figure& figure : device_figures) all.push_back(outcome.of(figure));
    return all;
  }
  // Returns the differences of the figures by value k.
  std::vector<double> difference(std::vector<double> values, std::size_t k, double width) {
    const double middle = values[k];
    values[k] = middle + width;
    std::vector<double> above = figures(values);
    values[k] = middle - width;
    const std::vector<double> below = figures(values);
    for (std::size_t f = 0; f < above.size(); ++f) above[f] = (above[f] - below[f]) / (2 * width);
    return above;
  }

 private:
  const PreparedScene& nominal_;
  const EnsembleDrive& drive_;
  Ensemble ensemble_;
  DeviceBuilder builder_;
  DeviceDrives drives_;
  std::optional<PullInMeter> meter_;
};

struct Compared {
  int cases = 0, grazing = 0, derivatives = 0, undecided = 0;
  double worst = 0;  // largest error over the bound
};

// Returns the index among device_figures.
std::size_t place_of(std::string_view key) {
  return static_cast<std::size_t>(std::ranges::find(device_figures, key, &Figure::key) - device_figures.begin());
}

// Compares one case: a switch, a waveform and a parameter.
void compare(const PreparedScene& nominal, const EnsembleDrive& drive, int arcs, Compared& all) {
  const Derivatives found = derivatives(nominal, drive, {.tolerance = tight, .refinement = arcs});
  ASSERT_EQ(found.why_none, "");
  if (found.grazes()) {
    ++all.grazing;
    return;
  }
  Devices devices(nominal, drive);
  for (std::size_t k = 0; k < found.variables.size(); ++k) {
    ++all.cases;
    ASSERT_EQ(found.variables[k].why_none, "") << found.variables[k].name;
    std::vector<double> values;
    for (const Derivatives::Variable& v : found.variables) values.push_back(v.nominal);
    const std::array differences{devices.difference(values, k, half_width), devices.difference(values, k, 2 * half_width),
                                 devices.difference(values, k, 4 * half_width)};
    for (const FigureDerivatives& figure : found.figures) {
      if (!figure.is_known()) continue;
      double largest = 0;
      for (const double by : figure.by_variable) largest = std::max(largest, std::abs(by));
      // Richardson's extrapolation to zero width.
      const std::size_t f = place_of(figure.key);
      const double expected = (4 * differences[0][f] - differences[1][f]) / 3;
      if (!(std::abs(expected - (4 * differences[1][f] - differences[2][f]) / 3) <= agreement * largest)) {
        ++all.undecided;
        continue;
      }
      ++all.derivatives;
      const double off = std::abs(figure.by_variable[k] - expected);
      const double error = off == 0 ? 0 : off / largest;
      all.worst = std::max(all.worst, error / bound);
      EXPECT_TRUE(error <= bound) << figure.key << " by " << found.variables[k].name << ": " << figure.by_variable[k]
                                  << ", differences " << expected << ", largest " << largest;
    }
  }
}

Compared compare_random(const Scenes& of, int switches, std::uint64_t seed) {
  Compared all;
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> inside(0.05, 0.95);
  for (int done = 0, tried = 0; done < switches && tried < 40 * switches; ++tried) {
    SceneFile file = random_switch(of, random);
    const SearchSetting setting = search_setting(file, Target::bounce, of.actuator, of.family, {});
    std::vector<double> x;
    for (const Variable& v : setting.space.variables()) x.push_back(std::lerp(v.lower, v.upper, inside(random)));
    const auto waveforms = setting.space.waveforms(x);
    if (!setting.is_allowed(waveforms)) continue;
    Calibration calibration;
    if (!of.calibration.empty()) calibration = {.pull_in_error = 0, .frequency_error = 0};
    const EnsembleDrive drive{.waveforms = setting.drives(waveforms), .known = MeasuredUnits(calibration)};
    const Derivatives closes = derivatives(setting.given, drive);
    if (!closes.why_none.empty()) continue;  // the device does not touch
    const int before = all.grazing;
    compare(setting.given, drive, of.arcs, all);
    if (all.grazing == before) ++done;
  }
  std::printf("%s: %d cases, %d derivatives compared, %d undecided, %d waveforms graze, worst %.2g of its bound\n", of.scene,
              all.cases, all.derivatives, all.undecided, all.grazing, all.worst);
  return all;
}

void expect_agreement(const Scenes& of, int switches) {
  const Compared all = compare_random(of, switches, 1);
  EXPECT_EQ(all.cases, switches * static_cast<int>(of.keys.size()));
  EXPECT_GE(all.derivatives, 4 * all.cases);
  EXPECT_LE(2 * all.undecided, all.derivatives);  // observed: 12 of 42 for one kind, 9 with fused multiplications
}

const std::vector<std::string> beam{"structure.length",  "structure.width", "structure.thickness", "structure.youngs_modulus",
                                    "structure.density", "gap.electrode",   "gap.contact"};
std::vector<std::string> with(std::vector<std::string> keys, std::initializer_list<const char*> more) {
  keys.insert(keys.end(), more.begin(), more.end());
  return keys;
}
const std::vector<std::string> surface{"contact.pad_length", "contact.asperity_radius", "contact.asperity_height",
                                       "contact.effective_modulus"};
const std::vector<std::string> plate{"structure.mass", "structure.stiffness", "structure.area", "gap.electrode", "gap.contact"};
const std::string in_100_us = "simulate.duration=100 us";

TEST(Derivatives, OfAGoldCantilever_optimized) {
  expect_agreement({"mem-gold.toml",
                    Actuator::electrostatic,
                    "pulse",
                    {in_100_us},
                    with(beam, {"gas.viscosity", "contact.pad_length", "contact.asperity_height", "contact.effective_modulus"})},
                   2);
}
TEST(Derivatives, OfACurledCantilever_optimized) {
  expect_agreement({"mem-gold.toml",
                    Actuator::electrostatic,
                    "pulse",
                    {in_100_us, "structure.stress_gradient=0.3 MPa/um"},
                    with(beam, {"structure.stress_gradient", "contact.pad_length"})},
                   1);
}
TEST(Derivatives, OfABeamBentByATable_optimized) {
  expect_agreement(
      {"mem-gold.toml",
       Actuator::electrostatic,
       "pulse",
       {in_100_us, "structure.rest_shape={positions=[\"0 um\", \"30 %\", \"tip\"], heights=[\"0 nm\", \"60 nm\", \"150 nm\"]}"},
       {"structure.rest_shape.heights[2]", "structure.rest_shape.heights[3]", "structure.length", "gap.electrode"}},
      1);
}
TEST(Derivatives, OfABeamOfSections_optimized) {
  expect_agreement(
      {"mem-gold.toml",
       Actuator::electrostatic,
       "pulse",
       {in_100_us, "structure.sections=[{length=\"60 um\", width=\"15 um\"}, {length=\"190 um\", width=[\"20 um\", \"18 um\"]}]",
        "structure.anchor.rotation=1e-6 N m/rad"},
       {"structure.sections[1].width", "structure.anchor.rotation", "structure.thickness", "gap.electrode"}},
      1);
}
TEST(Derivatives, OfAStructureByItsModes_optimized) {
  expect_agreement({"mem-gold-modes.toml",
                    Actuator::electrostatic,
                    "pulse",
                    {in_100_us},
                    {"structure.frequency_factor", "gap.electrode", "gap.contact", "contact.asperity_height"}},
                   2);
}
TEST(Derivatives, OfAPiezoAndAnElectrode_optimized) {
  expect_agreement({"mem-gold-pzt.toml",
                    Actuator::both,
                    "pulse",
                    {in_100_us},
                    with(beam, {"piezo.thickness", "piezo.d31", "piezo.youngs_modulus"})},
                   1);
}
TEST(Derivatives, OfADitheredPiezo_optimized) {
  expect_agreement({"mem-gold-pzt.toml", Actuator::pzt, "dither", {in_100_us}, beam}, 1);
}
TEST(Derivatives, OfTwoElectrodes_optimized) {
  expect_agreement({"two-electrodes.toml",
                    Actuator::electrostatic,
                    "coast",
                    {},
                    with(plate, {"structure.damping_ratio", "contact.stiffness", "contact.damping", "electrode.upper.gap",
                                 "driver.main.gain"})},
                   2);
}
TEST(Derivatives, OfAnActuatorInGas_optimized) {
  expect_agreement({"gap-closing-actuator.toml",
                    Actuator::electrostatic,
                    "pulse",
                    {},
                    with(plate, {"gas.viscosity", "gas.slit_height", "gas.far_gap", "electrode.main.gap", "contact.stiffness"})},
                   1);
}
TEST(Derivatives, OfANanometreSwitch_slow) {
  expect_agreement({"nem-tin.toml",
                    Actuator::electrostatic,
                    "pulse",
                    {},
                    with(beam, {"dispersion.hamaker_constant", "dispersion.equilibrium_distance", "structure.damping_ratio",
                                "contact.asperity_height"})},
                   1);
}
TEST(Derivatives, OfABeamBetweenTwoClamps_optimized) {
  expect_agreement({"mem-gold.toml",
                    Actuator::electrostatic,
                    "pulse",
                    {"simulate.duration=20 us", "structure.kind=clamped-clamped", "structure.residual_stress=20 MPa"},
                    with(beam, {"structure.residual_stress", "gas.viscosity", "contact.effective_modulus"})},
                   1);
}
TEST(Derivatives, OfAPlasticContact_optimized) {
  expect_agreement({"mem-gold.toml",
                    Actuator::electrostatic,
                    "pulse",
                    {in_100_us, "contact.model=elastic-plastic", "contact.hardness=1 GPa"},
                    with(surface, {"contact.hardness", "gap.contact", "structure.thickness"})},
                   2);
}
TEST(Derivatives, OfARigidContact_optimized) {
  expect_agreement({"two-electrodes.toml",
                    Actuator::electrostatic,
                    "pulse",
                    {"contact={model=\"rigid\",restitution=0.9}"},
                    with(plate, {"contact.restitution", "structure.damping_ratio"})},
                   1);
}
TEST(Derivatives, OfAnAdhesiveContact_optimized) {
  expect_agreement({"mem-gold.toml",
                    Actuator::electrostatic,
                    "pulse",
                    {in_100_us, "contact.model=adhesive", "contact.adhesion_energy=0.01 J/m^2"},
                    with(surface, {"contact.adhesion_energy", "gap.contact", "structure.youngs_modulus"})},
                   1);
}

TEST(Derivatives, OfAContactThatAttractsFromAfar_optimized) {
  expect_agreement({"mem-gold.toml",
                    Actuator::electrostatic,
                    "pulse",
                    {in_100_us, "contact={model=\"adhesive-repulsive\",pad_length=\"5 um\"}"},
                    {"contact.pad_length", "contact.asperity_pressure", "contact.asperity_distance", "contact.wall_range",
                     "contact.smoothing_distance", "contact.reach", "gap.contact"},
                    {},
                    64},
                   1);
}
TEST(Derivatives, OfAContactAlongThePad_optimized) {
  expect_agreement({"mem-gold.toml",
                    Actuator::electrostatic,
                    "pulse",
                    {in_100_us, "contact.distribution=pad"},
                    with(surface, {"gap.contact", "structure.thickness"})},
                   1);
}

// The start of a run depends on the device.
TEST(Derivatives, FromRestUnderWhatDrivesStandAt_optimized) {
  expect_agreement({"mem-gold-pzt.toml",
                    Actuator::electrostatic,
                    "pulse",
                    {in_100_us, "waveform.main.before=8 V", R"(waveform.piezo={family="step",level="0 V",before="0.4 V"})"},
                    with(beam, {"piezo.d31", "piezo.thickness"})},
                   1);
}

// Voltages and times follow the pull-in voltage and the frequency of each device.
TEST(Derivatives, OfDevicesInTheirOwnUnits_optimized) {
  expect_agreement({"mem-gold.toml", Actuator::electrostatic, "pulse", {in_100_us}, beam, "Vdp,frequency"}, 1);
}

EnsembleDrive own_drive(const PreparedScene& p) { return {.waveforms = p.waveforms()}; }

const FigureDerivatives& figure(const Derivatives& of, std::string_view key) {
  return *std::find_if(of.figures.begin(), of.figures.end(), [&](const FigureDerivatives& f) { return f.key == key; });
}

// Without gas, time enters by inertia only: with c times the density all times are multiplied by the root of c.
TEST(Derivatives, TimesGrowWithTheRootOfTheDensity_optimized) {
  SceneFile file = gold_at_17_volts({spread_of({"structure.density"})});
  file.erase("gas");
  const PreparedScene p = prepare(file);
  const Derivatives found = derivatives(p, own_drive(p), {.tolerance = tight, .refinement = 16});
  constexpr double exact = 1e-7;  // SwitchSlopes
  const auto elasticity = [&](std::string_view key) { return figure(found, key).by_variable[0] / figure(found, key).value; };
  EXPECT_NEAR(elasticity("initial_contact_time_s"), 0.5, exact);
  EXPECT_NEAR(elasticity("impact_velocity_m_s"), -0.5, exact);
  EXPECT_NEAR(elasticity("major_bounce_height_m"), 0, exact);
  EXPECT_NEAR(figure(found, "initial_contact_time_s").deviation, 0.005 * figure(found, "initial_contact_time_s").value,
              exact * figure(found, "initial_contact_time_s").value);
}

// Two fully correlated quantities spread a figure as a single quantity does.
TEST(Derivatives, AddUpAsCorrelated_optimized) {
  const auto found_with = [](const std::string& correlation) {
    const PreparedScene p = prepare(gold_at_17_volts(
        {fmt::format(R"(spread={{"structure.width"={{distribution="normal",cov="1 %"}},"gap.contact"={{distribution="normal",)"
                     R"(cov="2 %"}},correlation=[["structure.width","gap.contact",{}]]}})",
                     correlation)}));
    return derivatives(p, own_drive(p));
  };
  const Derivatives alone = found_with("0.0"), together = found_with("0.5");
  const FigureDerivatives& time = figure(alone, "initial_contact_time_s");
  const double a = time.by_variable[0] * 0.02, b = time.by_variable[1] * 0.01;  // gap.contact is the first variable
  EXPECT_NEAR(time.deviation, std::hypot(a, b), 1e-12 * time.deviation);
  EXPECT_NEAR(figure(together, "initial_contact_time_s").deviation, std::sqrt(a * a + b * b + a * b), 1e-12 * time.deviation);
}

TEST(Derivatives, ForwardAreThoseBackward_optimized) {
  for (const char* model : {"contact.model=asperity-uniform", "contact.model=elastic-plastic"}) {
    SceneFile file = gold_at_17_volts({model});
    if (std::string(model).find("plastic") != std::string::npos) file.set("contact.hardness=1 GPa");
    const PreparedScene p = prepare(file);
    std::vector<std::optional<SwitchSlopes::Neighbours>> neighbours(4);
    const auto set = [&](std::size_t k, auto&& member) {
      Device above = p.model.device(), below = above;
      const double step = SwitchSlopes::step * member(above);
      member(above) += step;
      member(below) -= step;
      neighbours[k].emplace(SwitchSlopes::Neighbours{
          .above = Switch(above, p.quadrature), .below = Switch(below, p.quadrature), .distance = 2 * step});
    };
    set(0, [](Device& d) -> double& { return d.structure.thickness; });
    set(2, [](Device& d) -> double& {
      ContactModel& contact = d.contacts.front().model;
      if (auto* const plastic = std::get_if<PlasticAsperities>(&contact)) return plastic->height;
      return std::get<UniformAsperities>(contact).height;
    });
    set(3, [](Device& d) -> double& { return d.gap.contact; });
    SwitchSlopes by(p.model, std::move(neighbours));
    EXPECT_EQ(by.parameters(), 4U);
    EXPECT_EQ(by.moving(), (std::vector<std::size_t>{0, 2, 3}));
    const std::vector<Signal> signals = p.signals();
    const std::vector<double> none(4, 0.0);
    const SignalSlopes fixed([&](std::span<const double>) { return signals; }, none, none, none);
    RecordedMotion tape;
    (void)observe_closing(p.model, signals, {.duration = p.duration, .tolerance = 1e-8}, tape);
    LinearizedClosing motion(p.model, signals, tape, 1, &by);
    const CostSlopes slopes = cost_slopes(p.model, signals, motion, p.scene.metrics);
    std::vector<FigureSlope> figures;
    for (const auto figure : {&Metrics::initial_contact_time, &Metrics::impact_velocity, &Metrics::major_bounce_height,
                              &Metrics::impact_energy, &Metrics::peak_contact_force})
      figures.push_back(slopes.of[figure]);
    const Eigen::MatrixXd backward = motion.backward(figures, fixed), forward = motion.forward(figures, fixed);
    EXPECT_TRUE(backward.col(1).isZero(0) && forward.col(1).isZero(0)) << "nothing depends on that parameter";
    for (Eigen::Index f = 0; f < backward.rows(); ++f) {
      for (const Eigen::Index k : {0, 2, 3})
        EXPECT_NEAR(forward(f, k), backward(f, k), 1e-8 * std::abs(backward(f, k)) + 1e-300) << model << " " << f << " " << k;
    }
  }
}

// The reference closing is chaotic in the whole window: imperceptible changes decide its permanent contact time.
TEST(Derivatives, NameIllConditionedFigures_optimized) {
  const PreparedScene p = prepare(gold());
  const Derivatives found = derivatives(p, own_drive(p));
  EXPECT_TRUE(found.grazes());
  EXPECT_FALSE(figure(found, "permanent_contact_time_s").is_known());
  EXPECT_FALSE(figure(found, "impact_energy_J").is_known());
  for (const char* key : {"initial_contact_time_s", "impact_velocity_m_s", "major_bounce_height_m"}) {
    EXPECT_TRUE(figure(found, key).is_known()) << key;
    EXPECT_LE(figure(found, key).error, 1e-3) << key;
  }
}

TEST(Derivatives, SayWhyThereAreNone_optimized) {
  const auto found = [](std::initializer_list<std::string_view> changes, const Calibration& calibration = {}) {
    const PreparedScene p = prepare(gold_at_17_volts(changes));
    EnsembleDrive drive = own_drive(p);
    if (!calibration.is_empty()) drive.known = measured_units(p, std::array{calibration}, 1).front();
    return derivatives(p, drive);
  };
  const std::string thickness = spread_of({"structure.thickness"});
  EXPECT_NE(found({thickness, "gas.model=reynolds"}).why_none, "");
  EXPECT_NE(found({thickness, "waveform.main.level=10 V"}).why_none, "");
  EXPECT_NE(found({thickness}, {.pull_in_error = {}, .frequency_error = 0, .classes = 4}).why_none, "");
  const std::string_view jitter = R"(spread."driver.main.jitter"={distribution="normal",standard_deviation="10 ns"})";
  EXPECT_NE(found({R"(spread={"driver.main.jitter"={distribution="normal",standard_deviation="10 ns"}})"}).why_none, "");
  const Derivatives both = found({thickness, jitter});
  EXPECT_EQ(both.why_none, "");
  EXPECT_NE(both.variables[0].why_none, "");
  EXPECT_TRUE(std::isnan(both.figures[0].by_variable[0]));
  EXPECT_TRUE(std::isfinite(both.figures[0].by_variable[1]));
  // The clock starts with an early step, so that nothing changes; a late step touches later.
  const Derivatives late = found({R"(spread."driver.main.delay"={distribution="normal",standard_deviation="10 ns"})"});
  EXPECT_NE(late.variables[0].why_none, "");
  // The electrode ends at the end of the beam, so that the beam cannot be shorter.
  const Derivatives shorter = found({spread_of({"structure.length"}), R"(electrode.main.span=["60 um","250 um"])"});
  EXPECT_NE(shorter.variables[0].why_none, "");
}

}  // namespace
}  // namespace softland::derivatives_test
