#include "studies/closing/sweep.h"

#include <optional>
#include <string>

#include "base/require.h"

namespace softland {
namespace {

// A switch in equilibrium at slowly varied voltages. Its state depends on earlier voltages (hysteresis).
class SlowSwitch {
 public:
  SlowSwitch(const Switch& model, std::size_t drive, Bias bias)
      : model_(model), drive_(drive), values_(bias.begin(), bias.end()), work_(model.workspace()) {
    require(bias.empty() || bias.size() == model.drives(), "a bias must have a value for every drive of the switch");
    values_.resize(model.drives(), 0.0);
  }

  SweepPoint follow(double voltage, bool is_up) {
    values_[drive_] = voltage;
    // The sweep cannot continue: no law describes how a beam that has collapsed onto the electrode leaves it.
    if (state_ == SweepState::none) return {.voltage = voltage, .is_up = is_up};
    std::optional<Eigen::VectorXd> q;
    const bool was_closed = state_ == SweepState::closed;
    for (const SweepState next :
         {was_closed ? SweepState::closed : SweepState::open, was_closed ? SweepState::open : SweepState::closed}) {
      q = next == SweepState::open ? model_.open_equilibrium(values_) : closed();
      state_ = next;
      if (q) break;
    }
    SweepPoint point{.voltage = voltage, .is_up = is_up};
    if (!q) {
      state_ = SweepState::none;
      return point;
    }
    point.state = state_;
    point.deflection = model_.contact_deflection(q->data());
    point.capacitance = model_.capacitance(drive_, q->data(), work_);
    return point;
  }

 private:
  [[nodiscard]] std::optional<Eigen::VectorXd> closed() const {
    std::optional<ClosedEquilibrium> found = closed_equilibrium(model_, values_);
    return keeps_closed(model_, found) ? std::optional(std::move(found->q)) : std::nullopt;
  }

  const Switch& model_;
  std::size_t drive_;
  std::vector<double> values_;
  Switch::Workspace work_;
  SweepState state_ = SweepState::open;
};

}  // namespace

std::string_view to_string(SweepState state) {
  switch (state) {
    case SweepState::open:
      return "open";
    case SweepState::closed:
      return "closed";
    case SweepState::none:
      break;
  }
  return softland::to_string(Status::collapsed_onto_electrode);
}

std::vector<SweepPoint> static_sweep(const Switch& model, std::size_t drive, Bias bias, const SweepRange& range,
                                     const Progress& progress) {
  require(range.points >= 2, "a sweep must have at least 2 points");
  SlowSwitch slow(model, drive, bias);
  std::vector<SweepPoint> points;
  const int last = range.points - 1;
  const auto pass = [&](int k, bool is_up) {
    if (progress.stopped()) return;
    progress.tell("static sweep", static_cast<double>(points.size()) / (2 * range.points));
    const double share = static_cast<double>(k) / last;
    points.push_back(slow.follow((1 - share) * range.first + share * range.last, is_up));
  };
  const bool is_up = range.last > range.first;
  for (int k = 0; k <= last; ++k) pass(k, is_up);
  for (int k = last; k >= 0; --k) pass(k, !is_up);
  return points;
}

}  // namespace softland
