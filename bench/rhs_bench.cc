// Evaluates only right-hand sides of a scene, to count their instructions: bench_rhs CALLS SCENE [key=value | -SECTION ...]
//
// The contact is closed and every drive is at its peak, so that all laws of the scene contribute. bench/count_instructions.py
// runs the program under callgrind with two values of CALLS and takes the difference.
#include <cmath>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "studies/closing/prepared.h"

namespace softland {
namespace {

int run(long calls, SceneFile file, const std::vector<std::string>& assignments) {
  for (const std::string& assignment : assignments) {
    if (assignment.starts_with('-')) {
      file.erase(assignment.substr(1));
    } else {
      file.set(assignment);
    }
  }
  const PreparedScene prepared = prepare(file);
  const Switch& model = prepared.model;
  std::vector<double> volts;
  for (const Signal& signal : prepared.signals()) volts.push_back(signal.peak());

  // Place the contact point a nanometre beyond the contact plane, in the shape of the first mode, and give it a velocity.
  const auto n = static_cast<std::size_t>(model.modes());
  std::vector<double> state(2 * n + model.film_states()), rates(n + model.film_states());
  state[0] = (model.device().gap.contact + 1e-9) / model.basis().contact_shape()[0];
  state[n] = model.basis().angular_frequencies()[0] * state[0];
  Switch::Workspace work = model.workspace();
  double sum = 0;
  for (long i = 0; i < calls; ++i) {
    model.rates(state.data(), volts, model.has_contact(), work, rates.data());
    sum += rates[0];
  }
  return std::isfinite(sum) ? 0 : 3;  // the use of the sum keeps the compiler from removing the loop
}

}  // namespace
}  // namespace softland

int main(int argc, char** argv) {
  if (argc < 3) {
    std::cerr << "usage: bench_rhs CALLS SCENE [key=value | -SECTION ...]\n";
    return 2;
  }
  try {
    return softland::run(std::atol(argv[1]), softland::SceneFile::load(argv[2]), {argv + 3, argv + argc});
  } catch (const std::exception& error) {
    std::cerr << "bench_rhs: " << error.what() << "\n";
    return 2;
  }
}
