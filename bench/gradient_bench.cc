// Measures the gradient of the cost function of a search: its computing time, in closings, and its error, by the number of
// parameters and the number of parts into which an integrator step of the closing is divided. Parameters that share a
// difference of waveforms are found once before, as in a search. A second table has the gradients of searches of some families.
// A third has derivatives by parameters of the device, and the time for building the two neighbouring switches for each
// parameter.
//   bench_gradient [SCENE]     (default: mem-gold.toml)
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/require.h"
#include "objectives/cost_slope.h"
#include "studies/search/search_setting.h"

namespace {

using namespace softland;

// Processor time, which other programs on the machine do not change.
template <class F>
double milliseconds(F&& f) {
  double least = 1e9;
  for (int k = 0; k < 60; ++k) {
    const std::clock_t begin = std::clock();
    f();
    least = std::min(least, 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  return least;
}

// A rise in this number of levels, which lands with a few rebounds.
struct Rise {
  std::vector<double> x, lower, upper;
};

Rise rise_of(const SearchSetting& s, std::size_t levels) {
  const std::string drive = searched_electrode(s.given.scene.device);
  const DriverLimits& limits = s.given.drives.at(drive).limits.value();
  const double hold = s.given.drives.at(drive).hold_level(), t0 = s.baseline.metrics.initial_contact_time;
  Rise rise;
  for (std::size_t k = 0; k < levels; ++k) {
    rise.x.push_back((0.7 + 0.2 * static_cast<double>(k) / static_cast<double>(levels)) * hold);
    rise.lower.push_back(limits.min_voltage), rise.upper.push_back(limits.max_voltage);
  }
  rise.x.push_back(2 * t0), rise.lower.push_back(t0), rise.upper.push_back(10 * t0);
  return rise;
}

void measure(const SearchSetting& s, std::size_t levels) {
  const std::string drive = searched_electrode(s.given.scene.device);
  const double hold = s.given.drives.at(drive).hold_level();
  const auto [x, lower, upper] = rise_of(s, levels);
  const auto signals_at = [&](std::span<const double> at) {
    BSpline spline{.levels = {at.begin(), at.end() - 1}, .duration = at.back()};
    spline.levels.insert(spline.levels.end(), 2, hold);
    return s.given.applied(signals_of(s.drives({{drive, spline}})));
  };
  const std::vector<ParameterGroup> groups = SignalSlopes(signals_at, upper, lower, upper).groups();
  const std::vector<Signal> signals = signals_at(x);
  const ClosingOptions run = s.run_of(signals);
  const double closing = milliseconds([&] {
    MetricsObserver observer(s.scale.contact_gap, s.given.scene.metrics);
    const Metrics m = observer.metrics(observe_closing(s.given.model, signals, run, observer));
    require(m.major_bounce_height > 0, "the rise must land and rebound");
  });
  const auto gradient = [&](int refinement, bool backward, double tolerance) {
    MetricsObserver observer(s.scale.contact_gap, s.given.scene.metrics);
    RecordedMotion tape(observer);
    ClosingOptions own = run;
    own.tolerance = tolerance;
    const Trajectory end = observe_closing(s.given.model, signals, own, tape);
    LinearizedClosing motion(s.given.model, signals, tape, refinement);
    const CostSlopes slopes = cost_slopes(s.given.model, signals, motion, s.given.scene.metrics);
    const auto slope = cost_slope(Target::bounce, observer.metrics(end), s.scale, s.given.scene.metrics, slopes);
    const SignalSlopes by(signals_at, x, lower, upper, groups);
    Eigen::VectorXd row = (backward ? motion.backward({*slope}, by) : motion.forward({*slope}, by)).transpose();
    for (Eigen::Index k = 0; k < row.size(); ++k)
      row[k] *= upper[static_cast<std::size_t>(k)] - lower[static_cast<std::size_t>(k)];
    return row;
  };
  const double waveforms = milliseconds([&] { (void)SignalSlopes(signals_at, x, lower, upper, groups); });
  const Eigen::VectorXd exact = gradient(16, true, 1e-11);
  for (const int refinement : {1, 2, 4}) {
    const double adjoint = milliseconds([&] { (void)gradient(refinement, true, run.tolerance); });
    const double forward = milliseconds([&] { (void)gradient(refinement, false, run.tolerance); });
    const Eigen::VectorXd found = gradient(refinement, true, run.tolerance);
    fmt::print("| {} | {} | {:.2f} | {:.1f} | {:.1f} | {:.1f} | {:.1e} |\n", x.size(), refinement, closing, adjoint / closing,
               forward / closing, waveforms / closing, (found - exact).cwiseAbs().maxCoeff() / exact.cwiseAbs().maxCoeff());
  }
}

// Parameters of the gold cantilever on which its figures depend.
struct DeviceNumber {
  double& (*of)(Device&);
  bool acts_in_flight = true;
};
constexpr DeviceNumber device_numbers[] = {
    {[](Device& d) -> double& { return d.structure.thickness; }},
    {[](Device& d) -> double& { return d.gap.contact; }, false},
    {[](Device& d) -> double& { return d.gap.electrode; }},
    {[](Device& d) -> double& { return part_of<Beam>(d.structure).youngs_modulus; }},
    {[](Device& d) -> double& { return part_of<Beam>(d.structure).density; }},
    {[](Device& d) -> double& { return d.structure.width; }},
    {[](Device& d) -> double& { return d.structure.length; }},
    {[](Device& d) -> double& { return std::get<StripGas>(*d.gas).film.viscosity; }},
    {[](Device& d) -> double& { return std::get<UniformAsperities>(d.contacts.front().model).summits.effective_modulus; }, false},
    {[](Device& d) -> double& { return std::get<UniformAsperities>(d.contacts.front().model).height; }, false},
    {[](Device& d) -> double& { return std::get<UniformAsperities>(d.contacts.front().model).summits.radius; }, false},
    {[](Device& d) -> double& { return d.contacts.front().pad_length; }, false},
};

SwitchSlopes slopes_by_device(const PreparedScene& p, std::size_t parameters) {
  std::vector<std::optional<SwitchSlopes::Neighbours>> all;
  for (std::size_t k = 0; k < parameters; ++k) {
    Device above = p.model.device(), below = above;
    const double step = SwitchSlopes::step * device_numbers[k].of(above);
    device_numbers[k].of(above) += step;
    device_numbers[k].of(below) -= step;
    all.push_back(SwitchSlopes::Neighbours{.above = Switch(above, p.quadrature, &p.model),
                                           .below = Switch(below, p.quadrature, &p.model),
                                           .distance = 2 * step,
                                           .acts_in_flight = device_numbers[k].acts_in_flight});
  }
  return SwitchSlopes(p.model, std::move(all));
}

// Measures derivatives for the scene's own step, which rebounds, by parameters of the device, each relative to its own size.
void measure_device(const SearchSetting& s, std::size_t parameters) {
  const std::vector<Signal> signals = s.given.signals();
  const ClosingOptions run = s.run_of(signals);
  const std::vector<double> none(parameters, 0.0);
  const SignalSlopes fixed([&](std::span<const double>) { return signals; }, none, none, none);
  const double closing = milliseconds([&] {
    MetricsObserver observer(s.scale.contact_gap, s.given.scene.metrics);
    (void)observe_closing(s.given.model, signals, run, observer);
  });
  const double building = milliseconds([&] { (void)slopes_by_device(s.given, parameters); });
  SwitchSlopes by = slopes_by_device(s.given, parameters);
  const auto derivatives = [&](int refinement, bool backward, double tolerance) {
    MetricsObserver observer(s.scale.contact_gap, s.given.scene.metrics);
    RecordedMotion tape(observer);
    ClosingOptions own = run;
    own.tolerance = tolerance;
    (void)observe_closing(s.given.model, signals, own, tape);
    LinearizedClosing motion(s.given.model, signals, tape, refinement, &by);
    const CostSlopes slopes = cost_slopes(s.given.model, signals, motion, s.given.scene.metrics);
    const std::vector<FigureSlope> figures{slopes.of[&Metrics::initial_contact_time],
                                           slopes.of[&Metrics::largest_impact_velocity], slopes.of[&Metrics::major_bounce_height],
                                           slopes.of[&Metrics::last_rebound_end]};
    Eigen::MatrixXd all = backward ? motion.backward(figures, fixed) : motion.forward(figures, fixed);
    for (Eigen::Index k = 0; k < all.cols(); ++k) {
      Device device = s.given.model.device();
      all.col(k) *= device_numbers[static_cast<std::size_t>(k)].of(device);
    }
    return all;
  };
  const Eigen::MatrixXd exact = derivatives(16, true, 1e-11);
  const double adjoint = milliseconds([&] { (void)derivatives(1, true, run.tolerance); });
  const double forward = milliseconds([&] { (void)derivatives(1, false, run.tolerance); });
  const Eigen::MatrixXd found = derivatives(1, false, run.tolerance);
  double error = 0;
  for (Eigen::Index f = 0; f < found.rows(); ++f)
    error = std::max(error, (found - exact).row(f).cwiseAbs().maxCoeff() / exact.row(f).cwiseAbs().maxCoeff());
  fmt::print("| {} | {:.2f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.1e} |\n", parameters, closing, adjoint / closing,
             forward / closing, 1 + 0.6 * static_cast<double>(parameters), building / closing, error);
}

// Measures the gradient at the first starting point of a search.
void measure_search(const std::string& scene, const std::string& family) {
  const SearchSetting s = search_setting(SceneFile::load(scene), Target::bounce, Actuator::electrostatic, family, {});
  const std::vector<ParameterGroup> groups = s.parameter_groups();
  const std::vector<double> x = s.space.starts().front();
  const std::vector<Signal> signals = s.given.applied(signals_of(s.drives(s.space.waveforms(x))));
  const double closing = milliseconds([&] {
    MetricsObserver observer(s.scale.contact_gap, s.given.scene.metrics);
    (void)observe_closing(s.given.model, signals, s.run_of(signals), observer);
  });
  const double gradient = milliseconds([&] { (void)s.gradient_at(x, Target::bounce, groups); });
  const double waveforms = milliseconds([&] { (void)s.signal_slopes(x, groups); });
  fmt::print("| {} | {} | {:.2f} | {:.1f} | {:.1f} |\n", family, x.size(), closing, gradient / closing, waveforms / closing);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string scene = argc > 1 ? argv[1] : std::string(SOFTLAND_SCENES) + "/mem-gold.toml";
  const SearchSetting setting = search_setting(SceneFile::load(scene), Target::bounce, Actuator::electrostatic, "pulse", {});
  fmt::print(
      "| parameters | parts of a step | closing [ms] | adjoint [closings] | forward [closings] | waveforms alone [closings] | "
      "error |\n");
  fmt::print("|---|---|---|---|---|---|---|\n");
  for (const std::size_t parameters : {4U, 40U, 200U}) measure(setting, parameters - 1);
  fmt::print(
      "\n| family | parameters | closing [ms] | gradient [closings] | waveforms alone [closings] |\n|---|---|---|---|---|\n");
  for (const char* family : {"pulse", "dither", "s-curve", "sines:9", "bspline:20", "knots:20"}) measure_search(scene, family);
  fmt::print(
      "\n| device parameters | closing [ms] | adjoint [closings] | forward [closings] | aim | building [closings] | error |\n"
      "|---|---|---|---|---|---|---|\n");
  for (const std::size_t parameters : {1U, 4U, 12U}) measure_device(setting, parameters);
}
