// Receives a closing and keeps what reports need of it: figures, rebounds and touches, and the knots that draw the same picture
// of the course. The memory does not grow with the number of knots.
//
// All knots are kept until the contact point has been beyond the contact plane and they are more than most_recorded_knots.
// Consecutive knots share a bucket afterwards. A bucket keeps the first and the last knot, and those of the smallest and
// largest position, velocity and contact force. Pairs of buckets are joined as often as that is needed.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "objectives/metrics.h"

namespace softland {

inline constexpr std::size_t most_recorded_knots = 40'000;

class CourseRecorder final : public ClosingObserver {
 public:
  /// `contact_gap` [m]; `most_knots`: at least 32.
  explicit CourseRecorder(double contact_gap, const MetricsOptions& options = {}, std::size_t most_knots = most_recorded_knots);

  /// Records one of several contacts, the next in order, beside the connection that they make. `contact_gap` [m]
  void follow_contact(double contact_gap, const MetricsOptions& options) {
    contacts_.push_back(std::make_unique<CourseRecorder>(contact_gap, options, most_knots_));
  }

  void knot(const TrajectoryPoint& point) override;
  void touch(const Touch& touch) override;

  [[nodiscard]] ClosingObserver* contact(std::size_t number) override {
    return number < contacts_.size() ? contacts_[number].get() : nullptr;
  }

  /// Returns the figures of the run, from all knots, once it has ended: see metrics().
  [[nodiscard]] Metrics metrics(const Trajectory& end) { return figures_.metrics(end); }
  /// Returns rebounds() of all knots until the command to open.
  [[nodiscard]] std::vector<Rebound> rebounds() const;
  /// True when some knots are left out.
  [[nodiscard]] bool is_thinned() const { return is_thinned_; }
  /// Returns the figures of one of several contacts, once the run has ended.
  [[nodiscard]] Metrics metrics_of(std::size_t contact, const Trajectory& end);
  [[nodiscard]] std::vector<Rebound> rebounds_of(std::size_t contact) const { return contacts_[contact]->rebounds(); }
  /// Moves the knots and touches that are kept into the run.
  void hand_over(Trajectory& run);

 private:
  void coarsen();
  // Returns the index in points_ at which the bucket that is not full begins.
  [[nodiscard]] std::size_t last_begin() const { return ends_.empty() ? 0 : ends_.back(); }
  void reduce_long_last();
  // Keeps of the points from `begin` on only those that a bucket keeps.
  void reduce(std::size_t begin);

  double contact_gap_;
  MetricsOptions options_;
  std::size_t most_knots_;
  MetricsObserver figures_;
  ReboundFinder finder_;
  bool has_passed_ = false, is_thinned_ = false;
  std::vector<TrajectoryPoint> points_;
  std::vector<std::size_t> ends_;  // ends of the full buckets, in points_
  std::size_t bucket_ = 1;         // number of knots in a full bucket
  std::size_t in_last_ = 0;        // number of knots since the last full bucket
  std::vector<Touch> touches_;
  std::vector<Rebound> rebounds_;
  bool opens_ = false;  // true once the command to open is past
  std::vector<std::unique_ptr<CourseRecorder>> contacts_;
};

}  // namespace softland
