// Measures the time to build and close a varied device on one core, one device at a time and in lanes, sampling included. Also
// measures the error of B_H against a run with a tight tolerance.
//   bench_fleet [SCENE [DEVICES [ACCURACY [TOLERANCE [key=value ...]]]]]     (default: mem-gold.toml 2000 1e-4 1e-5)
// ACCURACY chooses the quadrature, as simulate.accuracy does. The output is JSON with times in seconds: medians of five rounds,
// in each of which both ways take turns.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sampling/statistics.h"
#include "studies/devices/robustness.h"

namespace {

using namespace softland;

constexpr int rounds = 5;
constexpr std::uint64_t judged_devices = 500;  // number of devices whose error is measured
constexpr double tight_tolerance = 1e-10;      // tolerance of the reference runs
constexpr std::string_view tight_accuracy = "1e-8";

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// The devices of a scene, and the window of a search.
struct BenchEnsemble {
  BenchEnsemble(const std::string& scene, const std::vector<std::string>& changes, std::uint64_t count)
      : nominal(prepared(scene, changes)), ensemble(nominal, count), signals(nominal.signals()) {
    build();
    window = std::max(0.6 * 2 * M_PI / nominal.model.basis().angular_frequencies()[0],
                      2.5 * nominal.model.basis().in_contact_period());
  }
  static PreparedScene prepared(const std::string& scene, const std::vector<std::string>& changes) {
    SceneFile file = SceneFile::load(scene);
    for (const std::string& change : changes) file.set(change);
    return prepare(file);
  }
  void build() {
    devices.clear();
    DeviceBuilder builder(ensemble);
    for (std::uint64_t k = 0; k < ensemble.size(); ++k) devices.push_back(builder.device(k));
  }
  [[nodiscard]] std::vector<DeviceOutcome> close(double tolerance, Vectors vectors) const {
    constexpr std::size_t chunk = 256;
    std::vector<DeviceOutcome> outcomes;
    for (std::size_t first = 0; first < devices.size(); first += chunk) {
      std::vector<DeviceClosing> closings;
      for (std::size_t k = first; k < std::min(first + chunk, devices.size()); ++k)
        closings.push_back({.device = &devices[k],
                            .signals = &signals,
                            .run = {.duration = nominal.duration, .tolerance = tolerance, .after_contact = window}});
      for (DeviceOutcome& outcome : close_devices(closings, nominal.scene.metrics, vectors))
        outcomes.push_back(std::move(outcome));
    }
    return outcomes;
  }

  PreparedScene nominal;
  Ensemble ensemble;
  std::vector<Signal> signals;
  std::vector<SampledDevice> devices;
  double window = 0;  // [s]
};

/// Returns the relative errors of B_H for the devices that could be simulated both ways.
std::vector<double> errors_of_height(const std::vector<DeviceOutcome>& outcomes, const std::vector<DeviceOutcome>& tight) {
  std::vector<double> errors;
  for (std::size_t k = 0; k < tight.size(); ++k) {
    if (outcomes[k].closed() && tight[k].closed())
      errors.push_back(std::abs(outcomes[k].metrics.major_bounce_height / tight[k].metrics.major_bounce_height - 1));
  }
  return errors;
}

double median(const std::vector<double>& values) { return sample_quantile(values, 0.5); }

}  // namespace

int main(int argc, char** argv) {
  const std::string scene = argc > 1 ? argv[1] : SOFTLAND_SCENES "/mem-gold.toml", accuracy = argc > 3 ? argv[3] : "1e-4";
  const std::uint64_t devices = argc > 2 ? std::stoul(argv[2]) : 2000;
  const double tolerance = argc > 4 ? std::stod(argv[4]) : 1e-5;
  std::vector<std::string> changes(argv + std::min(argc, 5), argv + argc);
  changes.push_back("simulate.accuracy=" + accuracy);
  BenchEnsemble ensemble(scene, changes, devices);
  changes.back() = "simulate.accuracy=" + std::string(tight_accuracy);
  const BenchEnsemble judge(scene, changes, std::min(devices, judged_devices));
  const std::vector<DeviceOutcome> tight = judge.close(tight_tolerance, Vectors::none);

  std::vector<double> building;
  std::map<Vectors, std::vector<double>> closing;
  std::map<Vectors, std::vector<DeviceOutcome>> outcomes;
  for (int round = 0; round < rounds; ++round) {
    double begin = seconds();
    ensemble.build();
    building.push_back((seconds() - begin) / static_cast<double>(devices));
    for (const VectorsRow& row : vector_instructions) {
      if (row.value != Vectors::none && !has(row.value)) continue;
      begin = seconds();
      outcomes[row.value] = ensemble.close(tolerance, row.value);
      closing[row.value].push_back((seconds() - begin) / static_cast<double>(devices));
    }
  }

  nlohmann::json result{{"devices", devices},
                        {"accuracy", accuracy},
                        {"tolerance", tolerance},
                        {"building_s", median(building)},
                        {"not_in_lanes", why_not_in_lanes(ensemble.nominal.model)}};
  for (const auto& [vectors, times] : closing) {
    const std::vector<double> errors = errors_of_height(outcomes.at(vectors), tight);
    result["paths"].push_back({{"vectors", row_of(vector_instructions, vectors).name},
                               {"closing_s", median(times)},
                               {"least_s", *std::min_element(times.begin(), times.end())},
                               {"error_median", sample_quantile(errors, 0.5)},
                               {"error_95", sample_quantile(errors, 0.95)},
                               {"error_largest", sample_quantile(errors, 1)}});
  }
  std::cout << result.dump(2) << "\n";
}
