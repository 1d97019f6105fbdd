#include "studies/inverse/capacitance_edges.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>

#include "base/engineering.h"
#include "base/require.h"
#include "integrators/roots.h"
#include "model/pull_in.h"

namespace softland {

CapacitanceEdges::CapacitanceEdges(const Switch& model, std::size_t drive, double threshold)
    : model_(model),
      drive_(drive),
      threshold_(threshold),
      work_(model.workspace()),
      between_(static_cast<std::size_t>(model.modes())),
      last_(std::numeric_limits<double>::quiet_NaN()) {}

double CapacitanceEdges::above(const double* q) { return model_.capacitance(drive_, q, work_) - threshold_; }

// Returns the capacitance less the threshold at the share `part` of the integrator step between two knots. Each mode is the
// cubic through its positions and velocities at the knots (Hermite).
double CapacitanceEdges::above(const Knot& begin, const Knot& end, double part) {
  const std::size_t n = between_.size();
  const double span = end.time - begin.time, s = part, r = 1 - part;
  for (std::size_t i = 0; i < n; ++i) {
    between_[i] = r * r * (1 + 2 * s) * begin.state[i] + s * s * (3 - 2 * s) * end.state[i] +
                  s * r * span * (r * begin.state[n + i] - s * end.state[n + i]);
  }
  return above(between_.data());
}

void CapacitanceEdges::step(const Knot& begin, const Knot& end, const ContactState& /*contact*/) {
  if (std::isnan(last_)) last_ = above(begin.state.data());
  const double before = last_;
  last_ = above(end.state.data());
  if ((before > 0) == (last_ > 0)) return;
  const double part = bracketed_zero([&](double at) { return above(begin, end, at); }, 0, 1);
  const double time = begin.time + part * (end.time - begin.time);
  if (last_ > 0) {
    // Length of the last bracket around a crossing of the threshold, as a share of the integrator step.
    constexpr double apart = 1e-3;
    const double change = above(begin, end, part + apart) - above(begin, end, part - apart);
    const double rate = change / (2 * apart * (end.time - begin.time));
    rises_.push_back({.begin = time, .end = std::numeric_limits<double>::quiet_NaN(), .rate = rate});
  } else if (!rises_.empty()) {
    rises_.back().end = time;
  }
}

double capacitance_rise(const PreparedScene& nominal, double threshold) {
  const Switch& model = nominal.model;
  const auto told = [](double farads) { return engineering(farads, "F", 4); };
  require(has_pulling_electrode(model.device()), "a threshold of the capacitance needs an electrode that pulls the switch");
  const std::size_t drive = searched_drive(model.device());
  const std::vector<Signal> signals = nominal.signals();
  const std::optional<Eigen::VectorXd> open = model.open_equilibrium(values_before(signals));
  const std::optional<ClosedEquilibrium> closed = closed_equilibrium(model, hold_levels(signals));
  require(open && closed, "a threshold of the capacitance needs an open and a closed state of the nominal design");
  Switch::Workspace work = model.workspace();
  const double low = model.capacitance(drive, open->data(), work), high = model.capacitance(drive, closed->q.data(), work);
  require(low < threshold && threshold < high, [&] {
    return fmt::format("the threshold {} must lie between the capacitance of the open switch, {}, and that of the closed one, {}",
                       told(threshold), told(low), told(high));
  });
  return high - low;
}

}  // namespace softland
