// Compares closings in lanes of vector registers with the same closings one at a time.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <limits>

#include "model/ensemble/ensemble_closings.h"
#include "model/ensemble/lane_drives.h"
#include "sampling/statistics.h"
#include "scenes.h"
#include "studies/closing/simulate.h"
#include "studies/devices/ensemble.h"
#include "tests/support/nickel_bridge.h"
#include "waveforms/driver.h"
#include "waveforms/waveform.h"

namespace softland::lanes_test {
namespace {

std::vector<Vectors> vectors_here() {
  std::vector<Vectors> all;
  for (const Vectors vectors : {Vectors::avx2, Vectors::avx512})
    if (has(vectors)) all.push_back(vectors);
  return all;
}

struct TestEnsemble {
  static constexpr double forever = std::numeric_limits<double>::infinity();
  PreparedScene nominal;
  std::vector<SampledDevice> devices;

  TestEnsemble(const SceneFile& file, std::uint64_t count) : nominal(prepare(file)) {
    const Ensemble ensemble(nominal, count);
    DeviceBuilder builder(ensemble);
    for (std::uint64_t k = 0; k < count; ++k) devices.push_back(builder.device(k));
  }

  [[nodiscard]] std::vector<DeviceOutcome> close(const std::vector<Signal>& signals, Vectors vectors, double tolerance,
                                                 bool measures_drive_energy = false, double after_contact = forever) const {
    std::vector<DeviceClosing> closings;
    for (const SampledDevice& device : devices) {
      const double steady = device.model ? hold_of(*device.model, signals).steady_force(nominal.scene.metrics) : Metrics::unset;
      closings.push_back(
          {.device = &device,
           .signals = &signals,
           .run = {.duration = nominal.duration, .tolerance = tolerance, .after_contact = after_contact, .steady_force = steady},
           .measures_drive_energy = measures_drive_energy});
    }
    return close_devices(closings, nominal.scene.metrics, vectors);
  }

  /// Returns the number of closings that the lanes simulate to their end.
  [[nodiscard]] std::size_t followed(const std::vector<Signal>& signals, Vectors vectors, double tolerance) const {
    struct : LandingObserver {
      void touch(const Touch&) override {}
      void rebound(double, double, double) override {}
    } nobody;
    std::vector<EnsembleClosing> closings;
    for (const SampledDevice& device : devices)
      closings.push_back({.model = &*device.model, .drives = signals, .duration = nominal.duration, .observer = &nobody});
    return static_cast<std::size_t>(std::ranges::count_if(close_in_lanes(closings, tolerance, vectors), &EnsembleEnd::followed));
  }
};

// Returns all digits of an outcome.
std::string digits(const DeviceOutcome& o) {
  const Metrics& m = o.metrics;
  return fmt::format("{} {} {} {} {} {} {} {} {} {} {} {}", to_string(m.status), m.initial_contact_time, m.permanent_contact_time,
                     m.bounce_count, m.major_bounce_height, m.impact_velocity, m.peak_contact_force, m.impact_energy,
                     m.steady_force_time, m.least_force_after_touch, m.largest_impact_velocity, o.failure);
}
std::vector<std::string> digits(const std::vector<DeviceOutcome>& all) {
  std::vector<std::string> lines;
  for (const DeviceOutcome& o : all) lines.push_back(digits(o));
  return lines;
}

double off(double value, double expected) { return std::abs(value - expected) / std::abs(expected); }

// Compares outcomes of both ways. They may differ by the tolerance, and after the first touches by the magnified tolerance.
// Lanes step over the samples of a filtered signal, whose ripple then counts as an error of some hundredths of it: the error is
// `looser` times that of steps that end on each sample.
void expect_alike(const std::vector<DeviceOutcome>& lanes, const std::vector<DeviceOutcome>& one_by_one, double looser = 1) {
  ASSERT_EQ(lanes.size(), one_by_one.size());
  std::vector<double> heights, forces, energies;
  std::size_t closed = 0, other_counts = 0;
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    SCOPED_TRACE(fmt::format("device {}", k));
    const DeviceOutcome &a = lanes[k], &b = one_by_one[k];
    ASSERT_EQ(a.closed(), b.closed()) << a.failure << b.failure;
    if (b.metrics.touched()) {
      EXPECT_LT(off(a.metrics.initial_contact_time, b.metrics.initial_contact_time), looser * 1e-6);
      EXPECT_LT(off(a.metrics.impact_velocity, b.metrics.impact_velocity), looser * 1e-5);
    }
    if (!b.closed()) {
      EXPECT_EQ(a.metrics.status, b.metrics.status);
      EXPECT_EQ(a.failure, b.failure);
      EXPECT_EQ(a.metrics.touched(), b.metrics.touched());
      continue;
    }
    ++closed;
    if (b.metrics.major_bounce_height > 0) heights.push_back(off(a.metrics.major_bounce_height, b.metrics.major_bounce_height));
    forces.push_back(off(a.metrics.peak_contact_force, b.metrics.peak_contact_force));
    energies.push_back(off(a.metrics.impact_energy, b.metrics.impact_energy));
    other_counts += a.metrics.bounce_count != b.metrics.bounce_count;
  }
  EXPECT_GT(closed, lanes.size() / 2);
  if (!heights.empty()) {
    EXPECT_LT(sample_quantile(heights, 0.9), looser * 1e-4);
  }
  EXPECT_LT(sample_quantile(forces, 0.9), 1e-3);
  EXPECT_LT(sample_quantile(energies, 0.9), 3e-2);
  EXPECT_LE(other_counts, lanes.size() / 10);
}

struct Case {
  std::string name;
  SceneFile file;
  double looser = 1;  // factor of the tolerance in expect_alike()
};
constexpr double over_samples = 5;

/// A nickel bridge, clamped at both ends.
SceneFile bridge() {
  return SceneFile::parse(std::string(test::nickel_bridge) + R"([spread]
"structure.thickness" = { distribution = "normal", cov = "3 %" }
"structure.residual_stress" = { distribution = "normal", standard_deviation = "5 MPa" }
gaps = { keys = ["gap.electrode", "gap.contact"], distribution = "normal", cov = "3 %" }
)",
                          "bridge.toml");
}

/// A switch that is pulled by an electrode and by the increasing Casimir force of ideal conductors.
SceneFile nano_with_casimir() {
  return scene("nem-tin.toml",
               {"dispersion={model=\"casimir\"}", "waveform.dispersion={family=\"step\", level=1.05, rise_time=\"0.4 ns\"}"});
}

/// The gold cantilever with these sections [contact.NAME] instead of [contact], among them `left` and `right`. Their gaps vary
/// together with the electrode's gap.
SceneFile gold_with_contacts(const std::vector<std::string>& contacts, std::initializer_list<std::string_view> changes = {}) {
  SceneFile file = gold_at_17_volts(changes);
  for (const char* one : {"contact", "gap.contact", "spread.gaps"}) file.erase(one);
  for (const std::string& contact : contacts) file.set(contact);
  file.set(
      "spread.gaps={keys=[\"gap.electrode\", \"contact.left.gap\", \"contact.right.gap\"], distribution=\"normal\", cov=\"2 "
      "%\"}");
  return file;
}

// The contacts are at the tip, 15 um from it and a little closer to its plane, beside the middle of the electrode, and on the
// far side.
const std::string left =
    "contact.left={model=\"asperity-uniform\", gap=\"2 um\", pad_length=\"5 um\", asperity_radius=\"100 nm\", "
    "asperity_density=\"1e11 1/m^2\", "
    "asperity_height=\"100 nm\", effective_modulus=\"48 GPa\"}";
const std::string right =
    "contact.right={gap=\"1.9 um\", at=\"235 um\", model=\"linear\", pad_length=\"5 um\", stiffness=\"2 kN/m\", damping=\"1 "
    "s/m\"}";
const std::string remembering =
    "contact.right={gap=\"1.88 um\", at=\"235 um\", model=\"hysteretic\", pad_length=\"5 um\", stiffness=\"2 kN/m\", "
    "unloading_stiffness=\"4 kN/m\"}";
const std::string inner =
    "contact.inner={gap=\"1.2 um\", at=\"70 %\", model=\"linear\", pad_length=\"5 um\", stiffness=\"100 N/m\"}";
const std::string stop =
    "contact.stop={side=\"far\", gap=\"0.6 um\", at=\"240 um\", model=\"linear\", pad_length=\"5 um\", stiffness=\"1 kN/m\", "
    "damping=\"0.5 s/m\"}";
const char* const two_sections =
    "structure.sections=[{length=\"60 um\", width=\"15 um\"}, {length=\"190 um\", thickness=\"2.2 um\"}]";
// A waveform that moves the beam back onto its stop before it closes the switch.
const char* const swing =
    "waveform.main={family=\"pulse\", levels=[\"15.5 V\", \"0 V\", \"18 V\"], times=[\"30 us\", \"85 us\"], edge=\"0.5 us\"}";

std::vector<Case> cases_of_several_contacts() {
  constexpr const char *any = "metrics.closed=any", *short_window = "simulate.duration=60 us";  // the closing is chaotic later
  const SceneFile stopped = without(
      gold_with_contacts({left, right, stop}, {swing, "simulate.duration=150 us", "driver.main.max_voltage=25 V"}), "gas");
  SceneFile two_of_four = gold_with_contacts({left, right, inner, stop}, {short_window});
  two_of_four.set("metrics.closed=[\"left\", \"inner\"]");
  return {
      {"two sections, two contacts that both close it", gold_with_contacts({left, right}, {two_sections, short_window})},
      {"two sections, two contacts of which any closes it", gold_with_contacts({left, right}, {two_sections, any, short_window})},
      {"a taper, two contacts",
       gold_with_contacts(
           {left, right},
           {"structure.sections=[{length=\"100 um\", width=[\"18 um\", \"20 um\"]}, {length=\"150 um\"}]", short_window})},
      {"two contacts of which any closes it in a thin gas",
       gold_with_contacts({left, right}, {"gas.model=veijola", any, short_window})},
      {"two contacts, one with a memory", gold_with_contacts({left, remembering}, {"simulate.duration=70 us"})},
      {"two contacts, one with a memory, of which any closes it", gold_with_contacts({left, remembering}, {any, short_window})},
      {"two contacts and a back stop that is touched", stopped},
      {"four contacts, two of which close it", two_of_four}};
}

const char* const hysteretic =
    "contact={model=\"hysteretic\", pad_length=\"5 um\", stiffness=\"4 kN/m\", unloading_stiffness=\"8 kN/m\"}";

std::vector<Case> cases() {
  const std::string pulse =
      "waveform.main={family=\"pulse\", levels=[\"21 V\", \"0 V\", \"17 V\"], times=[\"20 us\", \"33 us\"], edge=\"0.5 us\"}";
  const std::string spline =
      "waveform.main={family=\"bspline\", levels=[\"24 V\", \"8 V\", \"2 V\", \"23 V\", \"12 V\", \"17 V\"], duration=\"60 us\"}";
  const std::string dither =
      "waveform.main={family=\"harmonic\", base=\"17 V\", amplitude=\"3 V\", frequency=\"90 kHz\", start=\"5 us\", end=\"70 "
      "us\", "
      "fade=\"3 us\"}";
  std::vector<Case> all;
  all.push_back({"step", gold_at_17_volts()});
  all.push_back({"pulse", gold_at_17_volts({pulse})});
  all.push_back({"ramp without gas",
                 without(gold_at_17_volts({"waveform.main={family=\"step\", level=\"17 V\", rise_time=\"60 us\"}"}), "gas")});
  all.push_back({"linear fringing, modal damping",
                 gold_at_17_volts({"electrode.main.fringing=\"linear\"", "structure.damping_ratio=0.02"})});
  all.push_back({"no fringing, two modes", gold_at_17_volts({"electrode.main.fringing=\"none\"", "structure.modes=2"})});
  all.push_back({"dither", gold_at_17_volts({dither})});
  all.push_back({"spline", gold_at_17_volts({spline})});
  all.push_back({"sampled, slewed and filtered pulse",
                 gold_at_17_volts({pulse, "driver.main.sample_rate=25 MHz", "driver.main.bits=14", "driver.main.bandwidth=1 MHz",
                                   "driver.main.max_slew=50 V/us"}),
                 over_samples});
  all.push_back(
      {"sampled and filtered spline",
       gold_at_17_volts({spline, "driver.main.sample_rate=25 MHz", "driver.main.bits=14", "driver.main.bandwidth=1 MHz"}),
       over_samples});
  all.push_back({"slowly sampled and filtered spline",
                 gold_at_17_volts({spline, "driver.main.sample_rate=1 MHz", "driver.main.bandwidth=200 kHz"})});
  all.push_back(
      {"pulse filtered twice", gold_at_17_volts({pulse, "driver.main.bandwidth=1 MHz", "driver.main.source_resistance=1 Mohm"})});
  all.push_back({"pulse through a resistance into a cable",
                 gold_at_17_volts({pulse, "driver.main.source_resistance=1 Mohm", "driver.main.parallel_capacitance=2 pF"})});
  all.push_back({"two pads", gold_at_17_volts({"electrode.main.span=[[\"60 um\", \"140 um\"], [\"160 um\", \"98 %\"]]"})});
  all.push_back({"seven pads", gold_at_17_volts({"electrode.main.span=[[\"60 um\", \"80 um\"], [\"85 um\", \"100 um\"], "
                                                 "[\"105 um\", \"120 um\"], [\"125 um\", \"140 um\"], [\"145 um\", \"160 um\"], "
                                                 "[\"165 um\", \"180 um\"], [\"185 um\", \"240 um\"]]"})});
  all.push_back({"piezo", gold_pzt({"waveform.piezo={family=\"step\", level=\"-0.2 V\", rise_time=\"30 us\"}",
                                    "simulate.duration=60 us"})});  // the closing is chaotic later
  all.push_back({"curled up", gold_at_17_volts({"structure.stress_gradient=0.2 MPa/um"})});
  all.push_back({"curled down over a film on either side",
                 gold_at_17_volts({"structure.stress_gradient=-0.2 MPa/um", "gas.far_gap=2 um"})});
  all.push_back({"bent by a table",
                 gold_at_17_volts({"structure.rest_shape={positions=[\"0 um\", \"30 %\", \"tip\"], heights=[\"0 nm\", \"60 nm\", "
                                   "\"-150 nm\"]}"})});
  const std::string stepped =
      "structure.sections=[{length=\"60 um\", width=\"15 um\"}, {length=\"190 um\", thickness=\"2.2 um\"}]";
  const std::string tapered = "structure.sections=[{length=\"100 um\", width=[\"12 um\", \"20 um\"]}, {length=\"150 um\"}]";
  all.push_back({"two sections", gold_at_17_volts({stepped})});
  all.push_back({"a taper, linear fringing, film on either side",
                 gold_at_17_volts({tapered, "electrode.main.fringing=linear", "gas.far_gap=2 um"})});
  all.push_back({"a taper, no film, layers, an anchor that turns",
                 without(gold_at_17_volts({tapered, "structure.anchor.rotation=1e-6 N m/rad",
                                           "structure.layers=[{face=\"far\", span=[\"0 um\", \"60 um\"], thickness=\"0.1 um\", "
                                           "youngs_modulus=\"250 GPa\", density=\"3100 kg/m^3\", stress=\"1 MPa\"}]"}),
                         "gas")});
  all.push_back({"two sections in dispersion and a thin gas",
                 gold_at_17_volts({stepped, "dispersion={model=\"casimir\"}", "gas.model=veijola"})});
  all.push_back({"six modes", gold_at_17_volts({"structure.modes=6"})});
  all.push_back({"modes of a file", scene("mem-gold-modes.toml", {"waveform.main.level=17.771 V", "driver.main.max_voltage=25 V",
                                                                  "simulate.duration=100 us", "simulate.accuracy=1e-4"})});
  all.push_back({"bridge that stretches", bridge()});
  for_each_law<Gas>([&]<class Law>(std::type_identity<Law>) {
    Law law = Law::example();
    if (is_compressible(law) || std::is_same_v<Law, LinearGas>) return;  // the example of `linear` bounces for too long
    std::string gas = fmt::format("gas={{model=\"{}\"", Law::name);
    for (const Field<Law>& field : fields_of<Law>) {
      if (field.required && std::isfinite(field.in(law)))
        gas += field.unit.empty() ? fmt::format(", {}={}", field.key, field.in(law))
                                  : fmt::format(", {}=\"{} {}\"", field.key, field.in(law), field.unit);
    }
    all.push_back({std::string(Law::name), gold_at_17_volts({gas + "}"})});
  });
  all.push_back({"a film of given damping", gold_at_17_volts({"gas={model=\"linear\", quality_factor=2}"})});
  all.push_back({"a film on either side", gold_at_17_volts({"gas.far_gap=2 um"})});
  all.push_back({"van der Waals and Casimir force", scene("nem-tin.toml")});
  all.push_back({"van der Waals force", scene("nem-tin.toml", {"dispersion.model=van-der-waals"})});
  all.push_back({"Casimir force", nano_with_casimir()});
  all.push_back({"electrodes on either side, damped contact", scene("two-electrodes.toml")});
  all.push_back(
      {"a plate whose electrodes lie over the same points",
       scene("two-electrodes.toml", {"electrode.main.area=5e-9 m^2", "electrode.upper={area=\"4e-9 m^2\", fringing=\"none\"}"})});
  all.push_back({"an electrode with two faces, two films over slits, linear contact", scene("gap-closing-actuator.toml")});
  all.push_back({"damped asperities", gold_at_17_volts({"contact.damping=1 s/m"})});
  all.push_back({"hysteretic contact", gold_at_17_volts({hysteretic})});
  all.push_back({"hysteretic contact that loses little",
                 gold_at_17_volts({pulse,
                                   "contact={model=\"hysteretic\", pad_length=\"5 um\", stiffness=\"4 kN/m\", "
                                   "unloading_stiffness=\"4.1 kN/m\"}"})});
  all.push_back({"electrodes on either side, hysteretic contact",
                 scene("two-electrodes.toml", {"contact={model=\"hysteretic\", stiffness=\"20 kN/m\", "
                                               "unloading_stiffness=\"60 kN/m\"}"})});
  all.push_back({"electrodes of different fringing", gold_at_17_volts({"electrode.tip={span=[\"240 um\", \"250 um\"], "
                                                                       "fringing=\"linear\"}",
                                                                       "electrode.main.fringing=none"})});
  std::ranges::move(cases_of_several_contacts(), std::back_inserter(all));
  return all;
}

TEST(Lanes, CloseAsOneAtATimeDoes) {
  for (const auto& [name, file, looser] : cases()) {
    SCOPED_TRACE(name);
    const TestEnsemble ensemble(file, 40);
    ASSERT_EQ(why_not_in_lanes(ensemble.nominal.model), "");
    const std::vector<Signal> signals = ensemble.nominal.signals();
    const std::vector<DeviceOutcome> one_by_one = ensemble.close(signals, Vectors::none, 1e-6);
    for (const Vectors vectors : vectors_here()) {
      EXPECT_EQ(ensemble.followed(signals, vectors, 1e-6), ensemble.devices.size());
      expect_alike(ensemble.close(signals, vectors, 1e-6), one_by_one, looser);
    }
  }
}

// A single closing integrates V dQ. One in lanes sums the energy of the fields and the work on the modes. A single closing with
// a tight tolerance is the oracle.
TEST(Lanes, MeasureTheDriveEnergyAsOneAtATimeDoes) {
  for (const auto& [name, file, looser] : cases()) {
    SCOPED_TRACE(name);
    const TestEnsemble ensemble(file, 16);
    const std::vector<Signal> signals = ensemble.nominal.signals();
    const std::vector<DeviceOutcome> one_by_one = ensemble.close(signals, Vectors::none, 1e-9);
    for (const Vectors vectors : vectors_here()) {
      std::vector<double> energies;
      for (std::size_t k = 0; const DeviceOutcome& o : ensemble.close(signals, vectors, 1e-6, true)) {
        const double expected = one_by_one[k++].metrics.drive_energy;
        EXPECT_EQ(std::isnan(o.metrics.drive_energy), std::isnan(expected));
        if (!std::isnan(expected)) energies.push_back(off(o.metrics.drive_energy, expected));
      }
      ASSERT_FALSE(energies.empty());
      EXPECT_LT(sample_quantile(energies, 0.5), looser * 1e-5);
      EXPECT_LT(sample_quantile(energies, 0.9), looser * 1e-3);
    }
  }
}

// The window ends before the closing becomes chaotic.
TEST(Lanes, MeasureTheForceAsOneAtATimeDoes) {
  const std::string soft =
      "waveform.main={family=\"pulse\", levels=[\"21 V\", \"0 V\", \"14.5 V\"], times=[\"20 us\", \"33 us\"], edge=\"0.5 us\"}";
  int steady = 0, lost = 0, opened = 0, kept = 0, steady_both = 0, steady_any = 0;
  const char* const level = "waveform.main.level=\"17 V\"";
  // Two contacts at the tip, whose planes differ by half a nanometre, with a soft landing in a thick gas.
  const std::string tip = "contact.left={gap=\"2 um\", model=\"linear\", pad_length=\"5 um\", stiffness=\"2 kN/m\"}";
  const std::string second = "contact.right={gap=\"2.0005 um\", model=\"linear\", pad_length=\"5 um\", stiffness=\"2 kN/m\"}";
  const std::string second_remembers =
      "contact.right={gap=\"2.0005 um\", model=\"hysteretic\", pad_length=\"5 um\", stiffness=\"2 "
      "kN/m\", unloading_stiffness=\"4 kN/m\"}";
  const std::vector<SceneFile> files{
      gold_at_17_volts({level}), gold_at_17_volts({soft}), gold_at_17_volts({soft, hysteretic}),
      gold_with_contacts({tip, second},
                         {"waveform.main.level=28 V", "driver.main.max_voltage=30 V", "gas.viscosity=2.5e-4 Pa s"}),
      gold_with_contacts({tip, second_remembers},
                         {"waveform.main.level=20 V", "gas.viscosity=1.2e-4 Pa s", "metrics.closed=any"})};
  for (const SceneFile& file : files) {
    for (const char* window : {"38 us", "45 us", "70 us"}) {
      SCOPED_TRACE(fmt::format("{} {}", &file - files.data(), window));
      SceneFile short_one = file;
      short_one.set(fmt::format("simulate.duration={}", window));
      const TestEnsemble ensemble(short_one, 60);
      const std::vector<Signal> signals = ensemble.nominal.signals();
      const std::vector<DeviceOutcome> one_by_one = ensemble.close(signals, Vectors::none, 1e-8);
      for (const Vectors vectors : vectors_here()) {
        const std::vector<DeviceOutcome> lanes = ensemble.close(signals, vectors, 1e-8);
        for (std::size_t k = 0; k < lanes.size(); ++k) {
          SCOPED_TRACE(k);
          const Metrics &a = lanes[k].metrics, &b = one_by_one[k].metrics;
          EXPECT_EQ(std::isnan(a.steady_force_time), std::isnan(b.steady_force_time));
          EXPECT_FALSE(off(a.steady_force_time, b.steady_force_time) > 1e-6);
          EXPECT_EQ(std::isnan(a.least_force_after_touch), std::isnan(b.least_force_after_touch));
          EXPECT_FALSE(std::abs(a.least_force_after_touch - b.least_force_after_touch) > 1e-4 * b.peak_contact_force);
          if (!lanes[k].closed()) continue;
          (std::isnan(a.steady_force_time) ? lost : steady) += 1;
          if (&file == &files[3]) steady_both += std::isfinite(a.steady_force_time);
          if (&file == &files[4]) steady_any += std::isfinite(a.steady_force_time);
          (a.least_force_after_touch > 0 ? kept : opened) += 1;
        }
      }
    }
  }
  const auto ways = static_cast<int>(vectors_here().size());
  for (const int count : {steady, lost, opened, kept, steady_both, steady_any}) EXPECT_GE(count, 3 * ways);
}

TEST(Lanes, GiveTheSameBitsWhateverTheirNumberAndCompany) {
  for (const auto& [name, file, looser] : cases()) {
    SCOPED_TRACE(name);
    TestEnsemble ensemble(file, 37);
    const std::vector<Signal> signals = ensemble.nominal.signals();
    std::vector<std::vector<std::string>> all;
    for (const Vectors vectors : vectors_here()) {
      const std::vector<std::string> together = digits(ensemble.close(signals, vectors, 1e-5));
      TestEnsemble alone = ensemble;
      alone.devices = {ensemble.devices[11]};
      EXPECT_EQ(digits(alone.close(signals, vectors, 1e-5))[0], together[11]);
      TestEnsemble reversed = ensemble;
      std::reverse(reversed.devices.begin(), reversed.devices.end());
      std::vector<std::string> back = digits(reversed.close(signals, vectors, 1e-5));
      std::reverse(back.begin(), back.end());
      EXPECT_EQ(back, together);
      all.push_back(together);
    }
#ifndef __clang__  // with clang the results of the two programs differ in the eleventh digit
    if (all.size() == 2) {
      EXPECT_EQ(all[0], all[1]) << "AVX2 and AVX-512";
    }
#endif
  }
}

// A signal with 25 samples in a microsecond after a filter with a time constant of four samples.
TEST(LaneDrives, SmoothRunsOfSamplesAndKeepTheirIntegral) {
  std::vector<std::pair<double, double>> points;
  for (int i = 0; i <= 60; ++i) points.emplace_back(1e-6 * i, 20 * std::sin(0.06 * i));
  const Signal drive =
      applied(Signal::piecewise_linear(points), {.sample_rate = 25e6, .bits = 14, .bandwidth = 1e6}, {.max_voltage = 25}, 1e-3);
  const std::vector<simd::LanePiece> exact = simd::pieces_of(drive);
  const simd::SmoothedDrive smooth = simd::smoothed(exact);
  EXPECT_NEAR(smooth.window, 2 / 25e6, 1e-12) << "two samples";
  EXPECT_LT(smooth.pieces.size(), 1.1 * static_cast<double>(exact.size()));

  const auto voltage = [&](double time) {
    const auto after = std::ranges::upper_bound(smooth.pieces, time, {}, &simd::LanePiece::begin);
    const simd::LanePiece& p = *std::prev(after);
    const double s = time - p.begin;
    return p.value + s * (p.slope + s * (p.square + s * p.cube)) + p.tail[0] * std::exp(-p.decay[0] * s);
  };
  constexpr double step = 1e-9, end = 70e-6;  // [s]
  double difference = 0, largest = 0;         // [V s], [V]
  for (double t = step / 2; t < end; t += step) {
    const double off = voltage(t) - drive.voltage(t);
    difference += off * step;
    largest = std::max(largest, std::abs(off));
  }
  constexpr double ripple =
      0.01;  // [V]: a sample changes by 50 mV, of which the filter lets pass a sixteenth, and more at the corner
  EXPECT_LT(largest, ripple);
  EXPECT_LT(std::abs(difference), 1e-5 * ripple * end) << "but for the sum over points";
}

// Factors of two do not round: half the commanded voltage with a gain of two gives the same bits as the full voltage.
TEST(Lanes, GiveDrivesWithAGainTheBitsOfTheirOwnSignals) {
  for (const auto& [name, file, looser] : cases()) {
    SCOPED_TRACE(name);
    const TestEnsemble ensemble(file, 9);
    const std::vector<Signal> signals = ensemble.nominal.signals();
    std::vector<Signal> halves;
    for (const Signal& one : signals) halves.push_back(scaled(one, 0.5));
    if (std::ranges::any_of(values_before(signals), [](double volts) { return volts != 0; })) continue;
    std::vector<DeviceClosing> by_gains;
    for (const SampledDevice& device : ensemble.devices) {
      const double steady = hold_of(*device.model, signals).steady_force(ensemble.nominal.scene.metrics);
      by_gains.push_back({.device = &device,
                          .signals = &halves,
                          .gains = std::vector<double>(signals.size(), 2),
                          .run = {.duration = ensemble.nominal.duration, .tolerance = 1e-5, .steady_force = steady}});
    }
    std::vector<Vectors> all = vectors_here();
    all.push_back(Vectors::none);
    for (const Vectors vectors : all)
      EXPECT_EQ(digits(close_devices(by_gains, ensemble.nominal.scene.metrics, vectors)),
                digits(ensemble.close(signals, vectors, 1e-5)));
  }
}

// All lanes evaluate sines and cubics if one of them has them.
TEST(Lanes, GiveTheSameBitsBesideOtherDrives) {
  const std::vector<Case> all = cases();
  const TestEnsemble ensemble(gold_at_17_volts(), 9);
  std::vector<std::vector<Signal>> drives;
  for (const Case& one : all)
    if (one.name == "step" || one.name == "dither" || one.name == "spline") drives.push_back(prepare(one.file).signals());
  ASSERT_EQ(drives.size(), 3U);
  std::vector<DeviceClosing> mixed;
  for (std::size_t k = 0; k < ensemble.devices.size(); ++k) {
    const std::vector<Signal>& signals = drives[k % drives.size()];
    const double steady = hold_of(*ensemble.devices[k].model, signals).steady_force(ensemble.nominal.scene.metrics);
    mixed.push_back({.device = &ensemble.devices[k],
                     .signals = &signals,
                     .run = {.duration = ensemble.nominal.duration, .tolerance = 1e-5, .steady_force = steady}});
  }
  for (const Vectors vectors : vectors_here()) {
    const std::vector<std::string> together = digits(close_devices(mixed, ensemble.nominal.scene.metrics, vectors));
    for (std::size_t k = 0; k < drives.size(); ++k) {
      const std::vector<std::string> alike = digits(ensemble.close(drives[k], vectors, 1e-5));
      for (std::size_t n = k; n < mixed.size(); n += drives.size()) EXPECT_EQ(together[n], alike[n]) << k << " " << n;
    }
  }
}

// The beam touches its back stop. A window that begins with the first touch must not begin at the stop.
TEST(Lanes, FollowABackStopThatIsTouched) {
  struct Stop final : ClosingObserver {
    void touch(const Touch&) override { ++touches; }
    int touches = 0;
  };
  struct Connection final : ClosingObserver {
    ClosingObserver* contact(std::size_t c) override { return c == 2 ? &stop : nullptr; }
    Stop stop;
  };
  const std::vector<Case> all = cases_of_several_contacts();
  const auto stopped = std::ranges::find(all, "two contacts and a back stop that is touched", &Case::name);
  ASSERT_NE(stopped, all.end());
  const PreparedScene p = prepare(stopped->file);
  ASSERT_EQ(p.scene.device.contacts[2].side, Side::far);
  Connection seen;
  const Trajectory run = observe_closing(p.model, p.signals(), {.duration = p.duration}, seen);
  EXPECT_GT(seen.stop.touches, 0);
  EXPECT_GT(run.first_touch.time, 85e-6) << "after the swing";
  const TestEnsemble ensemble(stopped->file, 20);
  constexpr double window = 25e-6;
  const std::vector<DeviceOutcome> one_by_one = ensemble.close(p.signals(), Vectors::none, 1e-6, false, window);
  for (const Vectors vectors : vectors_here()) {
    const std::vector<DeviceOutcome> lanes = ensemble.close(p.signals(), vectors, 1e-6, false, window);
    for (std::size_t k = 0; k < lanes.size(); ++k) {
      const Metrics &a = lanes[k].metrics, &b = one_by_one[k].metrics;
      EXPECT_LT(off(a.initial_contact_time, b.initial_contact_time), 1e-6);
      EXPECT_NEAR(a.end, b.end, 2e-6) << "with the first step beyond the window";
    }
  }
}

// Closings one at a time handle what lanes cannot: other laws, other quadrature points, impossible devices, numerical failures.
TEST(Lanes, LeaveTheRestToOneAtATime) {
  constexpr const char* other_law = "the contact law adhesive";
  const std::vector<std::pair<SceneFile, const char*>> others{
      {gold_at_17_volts({"structure.modes=9"}), "more than 8 modes"},
      {scene("nem-casimir.toml"), "a dispersion force between gold"},
      {without(gold_at_17_volts(), "contact"), "no contact"},
      {gold_at_17_volts({"contact.model=adhesive", "contact.adhesion_energy=0.05 J/m^2"}), other_law},
      {gold_at_17_volts({"contact.distribution=pad"}), "a contact along its pad"},
      {gold_at_17_volts({"gas.model=reynolds"}), "a compressible gas film"},
      {gold_at_17_volts({"electrode.main.fringing=bao-2001"}), "fringing by bao-2001"},
      {gold_at_17_volts({"simulate.accuracy=1e-12"}), "more than 48 quadrature points"},
      {gold_with_contacts({left, right, inner, stop,
                           "contact.fifth={side=\"far\", gap=\"1 um\", at=\"50 %\", model=\"linear\", "
                           "pad_length=\"5 um\", stiffness=\"1 kN/m\"}"}),
       "more than 4 contacts"},
      {gold_with_contacts({left,
                           "contact.right={gap=\"1.8 um\", at=\"235 um\", model=\"adhesive\", pad_length=\"5 um\", "
                           "asperity_radius=\"100 nm\", asperity_density=\"1e11 1/m^2\", asperity_height=\"100 nm\", "
                           "effective_modulus=\"48 GPa\", adhesion_energy=\"0.05 J/m^2\"}"}),
       other_law},
      {gold_at_17_volts({"metrics.closed_force=1 uN"}), "a key that says when the connection is electrically closed"}};
  for (const auto& [file, why] : others) {
    SCOPED_TRACE(why);
    const TestEnsemble ensemble(file, 2);
    EXPECT_EQ(why_not_in_lanes(ensemble.nominal.model), why);
    const std::vector<Signal> signals = ensemble.nominal.signals();
    for (const Vectors vectors : vectors_here())
      EXPECT_EQ(digits(ensemble.close(signals, vectors, 1e-5)), digits(ensemble.close(signals, Vectors::none, 1e-5)));
  }
  // Voltages that press the beam onto the electrode, and an impossible device.
  TestEnsemble pressed(gold_at_17_volts(), 6);
  pressed.devices[2] = {.values = {}, .model = {}, .refusal = "none"};
  const std::vector<Signal> signals{Signal::constant(400)};
  const std::vector<DeviceOutcome> one_by_one = pressed.close(signals, Vectors::none, 1e-5);
  EXPECT_EQ(one_by_one[0].metrics.status, Status::collapsed_onto_electrode);
  EXPECT_EQ(one_by_one[0].failure, "") << "a status of its own";
  EXPECT_FALSE(one_by_one[0].closed());
  EXPECT_EQ(one_by_one[2].failure, "none");
  for (const Vectors vectors : vectors_here()) EXPECT_EQ(digits(pressed.close(signals, vectors, 1e-5)), digits(one_by_one));
}

TEST(Lanes, AreChosenByTheProcessorOrTheUser) {
  ASSERT_EQ(unsetenv("SOFTLAND_VECTORS"), 0);
  EXPECT_EQ(vectors_in_use(), vectors_here().empty() ? Vectors::none : vectors_here().back());
  const auto asked_for = [](const char* name) {
    setenv("SOFTLAND_VECTORS", name, 1);
    const Vectors vectors = vectors_in_use();
    unsetenv("SOFTLAND_VECTORS");
    return vectors;
  };
  EXPECT_EQ(asked_for("none"), Vectors::none);
  for (const Vectors vectors : vectors_here())
    EXPECT_EQ(asked_for(std::string(name_of(vector_instructions, vectors)).c_str()), vectors);
  EXPECT_EQ(refusal([&] { asked_for("sse9"); }), "SOFTLAND_VECTORS = sse9: must be none, avx2 or avx512");
  unsetenv("SOFTLAND_VECTORS");
}

}  // namespace
}  // namespace softland::lanes_test
