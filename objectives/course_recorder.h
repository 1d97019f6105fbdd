// Observes a closing and records what reports need: figures, rebounds, touches, and the knots (points of the simulated motion)
// that a plot needs. The memory does not grow with the number of knots.
//
// All knots are recorded until there are more than most_recorded_knots and the contact point has been beyond the contact plane.
// Afterwards consecutive knots are gathered in a bucket. A bucket stores the first and the last knot, and the knots of the
// smallest and largest position, velocity and contact force. Pairs of buckets are joined when the memory is full.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "objectives/metrics.h"

namespace softland {

inline constexpr std::size_t most_recorded_knots = 40'000;

class CourseRecorder final : public ClosingObserver {
 public:
  /// Takes the distance `contact_gap` from rest to the contact plane [m]; `most_knots`, the largest number of recorded points
  /// of the motion, must be at least 32.
  explicit CourseRecorder(double contact_gap, const MetricsOptions& options = {}, std::size_t most_knots = most_recorded_knots);

  /// Adds a contact, the next in order, of a switch with several contacts; its figures of merit are recorded as well.
  /// `contact_gap` is the distance from rest to its contact plane [m].
  void follow_contact(double contact_gap, const MetricsOptions& options) {
    contacts_.push_back(std::make_unique<CourseRecorder>(contact_gap, options, most_knots_));
  }

  void knot(const TrajectoryPoint& point) override;
  void touch(const Touch& touch) override;

  [[nodiscard]] ClosingObserver* contact(std::size_t number) override {
    return number < contacts_.size() ? contacts_[number].get() : nullptr;
  }

  /// Returns the figures of merit of the run, computed from all points of the motion. Call this function after the end of the
  /// run; see metrics() in metrics.h.
  [[nodiscard]] Metrics metrics(const Trajectory& end) { return figures_.metrics(end); }
  /// Returns the rebounds of the run before the command to open, computed from all points of the motion.
  [[nodiscard]] std::vector<Rebound> rebounds() const;
  /// Returns true when some points of the motion were not recorded.
  [[nodiscard]] bool is_thinned() const { return is_thinned_; }
  /// Returns the figures of merit of contact number `contact` of a switch with several contacts, after the end of the run.
  [[nodiscard]] Metrics metrics_of(std::size_t contact, const Trajectory& end);
  [[nodiscard]] std::vector<Rebound> rebounds_of(std::size_t contact) const { return contacts_[contact]->rebounds(); }
  /// Moves the recorded points of the motion and the touches into `run`.
  void hand_over(Trajectory& run);

 private:
  void coarsen();
  // Returns the index in points_ at which the last, incomplete bucket of motion points begins.
  [[nodiscard]] std::size_t last_begin() const { return ends_.empty() ? 0 : ends_.back(); }
  void reduce_long_last();
  // Removes the points of the motion, from index `begin` of points_ on, that a bucket does not store: all but the first and
  // last one and the extrema.
  void reduce(std::size_t begin);

  double contact_gap_;
  MetricsOptions options_;
  std::size_t most_knots_;
  MetricsObserver figures_;
  ReboundFinder finder_;
  bool has_passed_ = false, is_thinned_ = false;
  std::vector<TrajectoryPoint> points_;
  std::vector<std::size_t> ends_;  // ends of the full buckets of motion points, as indices in points_
  std::size_t bucket_ = 1;         // number of motion points that a full bucket represents
  std::size_t in_last_ = 0;        // number of motion points since the last full bucket
  std::vector<Touch> touches_;
  std::vector<Rebound> rebounds_;
  bool opens_ = false;  // true after the command to open the switch
  std::vector<std::unique_ptr<CourseRecorder>> contacts_;
};

}  // namespace softland
