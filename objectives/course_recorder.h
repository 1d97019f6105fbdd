// Receives a closing and keeps what reports need of it in a memory that does not grow with its knots: figures, rebounds and
// touches, and of the course the knots that draw the same picture.
//
// All knots are kept until the contact point has been beyond the contact plane and they are more than most_recorded_knots. From
// then on consecutive ones share a bucket, of which the first and the last stay and those of the smallest and largest position,
// velocity and contact force; buckets are joined by twos as often as that is needed.
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

  /// Figures of the run, once it has ended: see metrics(). Those of all knots.
  [[nodiscard]] Metrics metrics(const Trajectory& end) { return figures_.metrics(end); }
  /// rebounds() of all knots until the command to open.
  [[nodiscard]] std::vector<Rebound> rebounds() const;
  /// Whether some knots are left out.
  [[nodiscard]] bool is_thinned() const { return is_thinned_; }
  /// Figures and rebounds of one of several contacts, once the run has ended.
  [[nodiscard]] Metrics metrics_of(std::size_t contact, const Trajectory& end);
  [[nodiscard]] std::vector<Rebound> rebounds_of(std::size_t contact) const { return contacts_[contact]->rebounds(); }
  /// Moves the knots and touches that are kept into the run.
  void hand_over(Trajectory& run);

 private:
  void coarsen();
  // Of the bucket that is not full, in points_.
  [[nodiscard]] std::size_t last_begin() const { return ends_.empty() ? 0 : ends_.back(); }
  void reduce_long_last();
  // Leaves of the points from `begin` on those that a bucket keeps.
  void reduce(std::size_t begin);

  double contact_gap_;
  MetricsOptions options_;
  std::size_t most_knots_;
  MetricsObserver figures_;
  ReboundFinder finder_;
  bool has_passed_ = false, is_thinned_ = false;
  std::vector<TrajectoryPoint> points_;
  std::vector<std::size_t> ends_;  // of the buckets that are full, in points_
  std::size_t bucket_ = 1;         // knots in a full one
  std::size_t in_last_ = 0;        // knots since the last full one
  std::vector<Touch> touches_;
  std::vector<Rebound> rebounds_;
  bool opens_ = false;  // the command to open is past
  std::vector<std::unique_ptr<CourseRecorder>> contacts_;
};

}  // namespace softland
