// A user's program with the installed libraries: the time of the first touch of a scene's switch, and the minimum of a
// parabola.
#include <softland/optimizers/problem.h>
#include <softland/studies/closing/simulate.h>

#include <cstdio>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const auto closing = softland::simulate(softland::prepare(softland::SceneFile::load(argv[1])), false);
  std::printf("first contact after %.1f us\n", 1e6 * closing.metrics.initial_contact_time);
  const auto lowest = softland::minimize(
      {.variables = {{"x", 0, 1}}, .objective = [](std::span<const double> x) { return (x[0] - 0.25) * (x[0] - 0.25); }}, {});
  return closing.metrics.status == softland::Status::done && lowest.value < 1e-6 ? 0 : 1;
}
