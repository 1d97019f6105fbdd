// evaluator_loop --jobs N measures the processor time [s] of 10 000 devices of the gold cantilever in the loop of `robustness`,
// and of one device alone. bench/evaluator.py compares the Python module with it.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "studies/closing/auto_settings.h"
#include "studies/devices/ensemble.h"

namespace {

using namespace softland;

template <class Work>
double least(int times, Work&& work) {
  double best = 1e300;
  for (int i = 0; i < times; ++i) {
    const std::clock_t began = std::clock();
    work();
    best = std::min(best, static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC);
  }
  return best;
}

}  // namespace

int main(int argc, char** argv) {
  const int jobs = argc == 3 ? std::atoi(argv[2]) : 1;
  SceneFile file = SceneFile::load(SOFTLAND_SCENES "/mem-gold.toml");
  file.erase("spread");
  for (const std::string key : {"structure.thickness", "structure.youngs_modulus", "gap.electrode"})
    file.set("spread.\"" + key + R"("={distribution="normal",cov="2 %"})");
  const PreparedScene nominal = prepare_and_choose(file, true);
  const std::vector<EnsembleDrive> drives{{.waveforms = nominal.waveforms()}};
  const Ensemble ensemble(nominal, 10'000);
  const double many =
      least(1, [&] { static_cast<void>(close_all(ensemble, drives, {.duration = nominal.duration, .jobs = jobs})); });
  const DeviceCloser closer(nominal, drives, {.duration = nominal.duration});
  DeviceBuilder builder(ensemble);
  const double one = least(100, [&] {
    const std::vector<SampledDevice> devices{builder.device(0)};
    static_cast<void>(closer(devices, 0));
  });
  std::printf("%.6e %.6e\n", many, one);
}
