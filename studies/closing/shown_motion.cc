#include "studies/closing/shown_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>

#include "model/closing/step_motion.h"
#include "model/mode_shapes.h"

namespace softland {
namespace {

constexpr int places_along = 60;
constexpr std::size_t most_told = 200;  // largest number of touches, and of rebounds, whose instants are recorded
// Permitted error of linear interpolation of each mode's amplitude, as a share of the contact gap.
constexpr double line_tolerance = 2e-5;

// Records the modal coordinates of a closing at increasing times.
class MotionSampler final : public ClosingObserver {
 public:
  MotionSampler(const Switch& model, double tolerance, const std::vector<double>& times)
      : modes_(static_cast<std::size_t>(model.modes())), within_(model, tolerance), times_(times) {}

  [[nodiscard]] bool follows_motion() const override { return true; }
  void step(const Knot& begin, const Knot& end, const ContactState& /*contact*/) override {
    for (; next_ < times_.size() && times_[next_] <= end.time; ++next_)
      keep(times_[next_] <= begin.time ? begin.state : times_[next_] == end.time ? end.state : between(begin, end));
    last_ = end.state;
  }
  /// Returns the recorded modal coordinates, ordered by time, then by mode [m kg^(1/2)]. Requested times after the end of the
  /// run get the last state.
  [[nodiscard]] std::vector<double> take() {
    for (; next_ < times_.size() && !last_.empty(); ++next_) keep(last_);
    return std::move(all_);
  }

 private:
  void keep(const std::vector<double>& state) {
    all_.insert(all_.end(), state.begin(), state.begin() + static_cast<std::ptrdiff_t>(modes_));
  }
  [[nodiscard]] const std::vector<double>& between(const Knot& begin, const Knot& end) {
    const double h = end.time - begin.time, share = (times_[next_] - begin.time) / h;
    within_.set(begin, end, {}, true);
    if (within_.moves_by_modes()) return within_.state_at(share);
    cubic_.resize(modes_);
    const double rise = share * share * (3 - 2 * share), early = share * (1 - share) * (1 - share),
                 late = share * share * (share - 1);
    for (std::size_t i = 0; i < modes_; ++i)
      cubic_[i] =
          std::lerp(begin.state[i], end.state[i], rise) + h * (early * begin.state[modes_ + i] + late * end.state[modes_ + i]);
    return cubic_;
  }

  std::size_t modes_;
  StepMotion within_;
  const std::vector<double>& times_;
  std::size_t next_ = 0;
  std::vector<double> all_, last_, cubic_;
};

// Returns instants that the animation must contain: begin and end of touches (of the longest touches if there are many), and
// begin, end and largest separation of the highest rebounds.
std::vector<double> labelled_instants(const Closing& closing) {
  const Trajectory& run = closing.trajectory;
  std::vector<Touch> touches = run.touches;
  for (const ContactOutcome& own : run.contacts) touches.insert(touches.end(), own.touches.begin(), own.touches.end());
  const auto length = [](const Touch& t) {
    return std::isnan(t.end) ? std::numeric_limits<double>::infinity() : t.end - t.begin;
  };
  std::ranges::stable_sort(touches, std::ranges::greater(), length);
  std::vector<Rebound> rebounds = closing.rebounds;
  std::ranges::stable_sort(rebounds, std::ranges::greater(), &Rebound::height);
  std::vector<double> all{run.points.front().time, run.points.back().time};
  for (std::size_t k = 0; k < std::min(most_told, touches.size()); ++k) all.insert(all.end(), {touches[k].begin, touches[k].end});
  for (std::size_t k = 0; k < std::min(most_told, rebounds.size()); ++k)
    all.insert(all.end(), {rebounds[k].begin, rebounds[k].time_of_height, rebounds[k].end});
  if (!run.touches.empty()) all.push_back(run.touches.front().begin);
  std::erase_if(all, [&](double t) { return !(t >= run.points.front().time && t <= run.points.back().time); });
  return all;
}

std::vector<double> sorted(std::vector<double> times) {
  std::ranges::sort(times);
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

// The errors of linear interpolation between two rows of a table of motion, by column.
class LineError {
 public:
  LineError(const std::vector<double>& times, const std::vector<double>& table, std::size_t columns)
      : times_(times), table_(table), columns_(columns) {}

  struct Stretch {
    double error = 0;
    std::size_t begin = 0, worst = 0, end = 0;
    [[nodiscard]] bool operator<(const Stretch& other) const { return error < other.error; }
  };
  [[nodiscard]] Stretch between(std::size_t begin, std::size_t end) const {
    Stretch all{.begin = begin, .worst = begin, .end = end};
    for (std::size_t row = begin + 1; row < end; ++row) {
      const double share = (times_[row] - times_[begin]) / (times_[end] - times_[begin]);
      for (std::size_t k = 0; k < columns_; ++k) {
        const double error = std::abs(at(row, k) - std::lerp(at(begin, k), at(end, k), share));
        if (error > all.error) all.error = error, all.worst = row;
      }
    }
    return all;
  }

 private:
  [[nodiscard]] double at(std::size_t row, std::size_t column) const { return table_[row * columns_ + column]; }

  const std::vector<double>& times_;
  const std::vector<double>& table_;
  std::size_t columns_;
};

// Adds rows of a table to the retained rows (at least two), each time the row where linear interpolation has the largest error,
// until there are `most` rows.
std::vector<std::size_t> with_worst(std::vector<std::size_t> kept, const LineError& lines, double tolerance, std::size_t most) {
  std::priority_queue<LineError::Stretch> stretches;
  for (std::size_t k = 1; k < kept.size(); ++k) stretches.push(lines.between(kept[k - 1], kept[k]));
  while (!stretches.empty() && stretches.top().error > tolerance && kept.size() < most) {
    const LineError::Stretch worst = stretches.top();
    stretches.pop();
    kept.push_back(worst.worst);
    stretches.push(lines.between(worst.begin, worst.worst));
    stretches.push(lines.between(worst.worst, worst.end));
  }
  std::ranges::sort(kept);
  return kept;
}

void set_places(ShownMotion& motion, const Switch& model) {
  const Device& device = model.device();
  for (std::size_t c = 0; c < device.contacts.size(); ++c)
    motion.contacts.push_back({.name = device.contacts[c].name,
                               .at = device.contact_position(c),
                               .gap = device.contact_gap(c),
                               .far_side = device.contacts[c].side == Side::far});
  for (const Electrode& one : device.electrodes) {
    for (const Stretch& pad : one.pads(device.structure.length)) {
      const auto add = [&](bool far_side, double gap) {
        motion.electrodes.push_back(
            {.electrode = one.name, .begin = pad.begin, .end = pad.end, .gap = gap, .far_side = far_side});
      };
      if (one.side != Side::far) add(false, device.gap.electrode);
      if (one.side != Side::near) add(true, one.gap);
    }
  }
  for (int k = 0; k <= places_along; ++k) motion.places.push_back(device.structure.length * k / places_along);
  for (const ShownMotion::Contact& one : motion.contacts) motion.places.push_back(std::min(one.at, device.structure.length));
  motion.places = sorted(std::move(motion.places));
  for (const double x : motion.places) motion.rest.push_back(device.rest_offset(x));
}

}  // namespace

std::optional<ShownMotion> shown_motion(const PreparedScene& prepared, const Closing& closing) {
  const Trajectory& run = closing.trajectory;
  if (!came_to_its_end(run) || run.points.size() < 2) return std::nullopt;
  const bool is_refined = closing.quadrature.points_per_length != prepared.quadrature.points_per_length ||
                          closing.quadrature.points_per_panel != prepared.quadrature.points_per_panel;
  const Switch model = is_refined ? Switch(prepared.scene.device, closing.quadrature) : prepared.model;

  const std::vector<double> told = labelled_instants(closing);
  std::vector<double> times = told;
  for (const TrajectoryPoint& point : run.points) times.push_back(point.time);
  times = sorted(std::move(times));
  MotionSampler sampler(model, closing.tolerance, times);
  (void)observe_closing(model, prepared.signals(),
                        {.duration = prepared.duration, .tolerance = closing.tolerance, .start = prepared.start()}, sampler);
  const auto modes = static_cast<std::size_t>(model.modes());
  std::vector<double> table = sampler.take();
  if (table.size() != modes * times.size()) return std::nullopt;

  ShownMotion motion;
  set_places(motion, model);
  const Eigen::MatrixXd shapes = mode_shapes_at(
      model, Eigen::Map<const Eigen::VectorXd>(motion.places.data(), static_cast<Eigen::Index>(motion.places.size())));
  const Eigen::RowVectorXd largest = shapes.cwiseAbs().colwise().maxCoeff();
  for (std::size_t i = 0; i < modes; ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const Eigen::VectorXd shape = shapes.col(column) / largest[column];
    motion.shapes.emplace_back(shape.begin(), shape.end());
    for (std::size_t row = 0; row < times.size(); ++row) table[row * modes + i] *= largest[column];
  }

  std::vector<std::size_t> kept;
  for (const double time : sorted(told))
    kept.push_back(static_cast<std::size_t>(std::ranges::lower_bound(times, time) - times.begin()));
  kept = with_worst(std::move(kept), LineError(times, table, modes), line_tolerance * run.contact_gap,
                    std::min(most_instants, most_amplitudes / modes));
  motion.amplitudes.resize(modes);
  for (const std::size_t row : kept) {
    motion.time.push_back(times[row]);
    for (std::size_t i = 0; i < modes; ++i) motion.amplitudes[i].push_back(table[row * modes + i]);
  }
  return motion;
}

}  // namespace softland
