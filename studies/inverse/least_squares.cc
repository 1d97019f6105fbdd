#include "studies/inverse/least_squares.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <filesystem>
#include <mutex>
#include <utility>

#include "base/executor.h"
#include "base/require.h"
#include "studies/inverse/ceres_module.h"

namespace softland {
namespace {

constexpr double square(double x) { return x * x; }

// Returns the possible paths of the shared library with Ceres: beside the installed program, in the build tree, in the install
// prefix.
std::vector<std::filesystem::path> module_places() {
  std::error_code fault;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", fault);
  return {program.parent_path() / SOFTLAND_CERES_FROM_PROGRAM, SOFTLAND_CERES_BUILT, SOFTLAND_CERES_INSTALLED};
}

// Loads the shared library with Ceres. Its dependencies (glog, SuiteSparse, a BLAS) stay separate: a program without a fit
// never loads them, and no other library uses their symbols.
CeresSolve* load_module() {
  std::string faults;
  for (const std::filesystem::path& place : module_places()) {
    if (std::error_code fault; place.empty() || !std::filesystem::exists(place, fault)) continue;
    void* const module = dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (module != nullptr) {
      if (void* const found = dlsym(module, ceres_solve_name)) return reinterpret_cast<CeresSolve*>(found);
    }
    const char* const fault = dlerror();
    faults += fmt::format(" ({})", fault != nullptr ? fault : "it cannot be loaded");
  }
  throw InvalidInput(
      fmt::format("this softland was built without Ceres: install the package libceres-dev and build it again{}", faults));
}

CeresSolve* ceres_solve() {
  static CeresSolve* const found = load_module();
  return found;
}

}  // namespace

double loss_weight(Loss loss, double residual) {
  switch (loss) {
    case Loss::huber:
      return std::abs(residual) <= loss_scale ? 1 : loss_scale / std::abs(residual);
    case Loss::cauchy:
      return 1 / (1 + square(residual / loss_scale));
    case Loss::none:
      break;
  }
  return 1;
}

double loss_value(Loss loss, double residual, double scale) {
  switch (loss) {
    case Loss::huber:
      return std::abs(residual) <= scale ? square(residual) : scale * (2 * std::abs(residual) - scale);
    case Loss::cauchy:
      return square(scale) * std::log1p(square(residual / scale));
    case Loss::none:
      break;
  }
  return square(residual);
}

LeastSquaresEnd solve(const LeastSquares& problem, std::vector<double> start, const Progress& progress) {
  LeastSquaresEnd end;
  std::exception_ptr fault;
  ceres_solve()(problem, std::move(start), progress, end, fault);
  if (fault) std::rethrow_exception(fault);
  return end;
}

bool has_ceres() {
  try {
    return ceres_solve() != nullptr;
  } catch (const InvalidInput&) {
    return false;
  }
}

ManyEnds solve_from(const std::function<LeastSquares()>& make, const std::vector<std::vector<double>>& starts, int jobs,
                    const std::function<bool(const LeastSquaresEnd&, const LeastSquaresEnd&)>& same, const Progress& progress) {
  ManyEnds all;
  all.ends.resize(starts.size());
  std::atomic<std::size_t> done = 0;
  std::mutex telling;
  run_tasks(
      starts.size(), jobs,
      [&](std::size_t k) {
        all.ends[k] = solve(make(), starts[k], progress);
        const std::scoped_lock lock(telling);
        progress.tell("fits", static_cast<double>(++done) / static_cast<double>(starts.size()));
      },
      progress.stop);
  progress.throw_if_stopped();
  const auto is_better = [&](std::size_t a, std::size_t b) {
    const LeastSquaresEnd &one = all.ends[a], &other = all.ends[b];
    return !one.x.empty() && (other.x.empty() || one.cost < other.cost);
  };
  for (std::size_t k = 1; k < all.ends.size(); ++k) {
    if (is_better(k, all.best)) all.best = k;
  }
  std::vector<const LeastSquaresEnd*> distinct;
  for (const LeastSquaresEnd& end : all.ends) {
    if (!end.converged) continue;
    if (std::ranges::none_of(distinct, [&](const LeastSquaresEnd* other) { return same(*other, end); })) distinct.push_back(&end);
  }
  all.minima = distinct.size();
  return all;
}

}  // namespace softland
