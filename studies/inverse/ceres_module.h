// The interface of the shared library that contains the Ceres solver. The library is loaded at the first fit.
#pragma once

#include <exception>
#include <vector>

#include "studies/inverse/least_squares.h"

namespace softland {

inline constexpr const char* ceres_solve_name = "softland_ceres_solve";
/// Signature of solve() in the shared library. `fault` receives the exception that `evaluate` has thrown.
using CeresSolve = void(const LeastSquares& problem, std::vector<double> start, const Progress& progress, LeastSquaresEnd& end,
                        std::exception_ptr& fault);

}  // namespace softland

extern "C" [[gnu::visibility("default")]] void softland_ceres_solve(const softland::LeastSquares& problem,
                                                                    std::vector<double> start, const softland::Progress& progress,
                                                                    softland::LeastSquaresEnd& end, std::exception_ptr& fault);
