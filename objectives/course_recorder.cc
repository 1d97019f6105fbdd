#include "objectives/course_recorder.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "base/require.h"

namespace softland {
namespace {

constexpr std::size_t most_kept = 8;  // largest number of motion points that a bucket stores

}  // namespace

CourseRecorder::CourseRecorder(double contact_gap, const MetricsOptions& options, std::size_t most_knots)
    : contact_gap_(contact_gap),
      options_(options),
      most_knots_(most_knots),
      figures_(contact_gap, options),
      finder_(contact_gap) {
  require(most_knots >= 4 * most_kept, "most_knots must be at least 32");
}

void CourseRecorder::knot(const TrajectoryPoint& point) {
  figures_.knot(point);
  finder_.knot(point, [this](const Rebound& rebound) {
    if (!opens_) rebounds_.push_back(rebound);
  });
  if (!opens_ && point.time >= options_.opening.time) {
    opens_ = true;
    if (finder_.under_way()) rebounds_.push_back(*finder_.under_way());
  }
  has_passed_ = has_passed_ || point.position > contact_gap_;
  points_.push_back(point);
  if (++in_last_ == bucket_) {
    reduce(last_begin());
    ends_.push_back(points_.size());
    in_last_ = 0;
  }
  reduce_long_last();
  while (has_passed_ && points_.size() > most_knots_) coarsen();
}

void CourseRecorder::touch(const Touch& touch) {
  figures_.touch(touch);
  touches_.push_back(touch);
}

std::vector<Rebound> CourseRecorder::rebounds() const {
  std::vector<Rebound> all = rebounds_;
  if (!opens_ && finder_.under_way()) all.push_back(*finder_.under_way());
  return all;
}

Metrics CourseRecorder::metrics_of(std::size_t contact, const Trajectory& end) {
  const ContactOutcome& own = end.contacts[contact];
  Trajectory alone = end;
  alone.contacts.clear();
  alone.contact_gap = own.gap;
  alone.hold_force = own.hold_force;
  alone.is_held = own.hold_force > 0;
  alone.force = own.force;
  alone.hold_resistance = own.hold_resistance;
  alone.electrical = own.electrical;
  alone.landing_excess = Metrics::unset;
  return contacts_[contact]->metrics(alone);
}

void CourseRecorder::hand_over(Trajectory& run) {
  // The run has no contacts when the state in which it should begin does not exist.
  for (std::size_t c = 0; c < std::min(contacts_.size(), run.contacts.size()); ++c) {
    run.contacts[c].points = std::move(contacts_[c]->points_);
    run.contacts[c].touches = std::move(contacts_[c]->touches_);
  }
  run.points = std::move(points_);
  run.touches = std::move(touches_);
}

// Merges pairs of full buckets of motion points, so that a bucket represents twice as many points. The points after the last
// pair form the new incomplete bucket.
void CourseRecorder::coarsen() {
  const std::vector<TrajectoryPoint> all = std::exchange(points_, {});
  const std::vector<std::size_t> ends = std::exchange(ends_, {});
  const auto copy = [&](std::size_t begin, std::size_t end) {
    points_.insert(points_.end(), all.begin() + static_cast<std::ptrdiff_t>(begin),
                   all.begin() + static_cast<std::ptrdiff_t>(end));
  };
  std::size_t begin = 0;
  for (std::size_t k = 1; k < ends.size(); k += 2) {
    copy(begin, ends[k]);
    reduce(last_begin());
    ends_.push_back(points_.size());
    begin = ends[k];
  }
  copy(begin, all.size());
  if (ends.size() % 2 == 1) in_last_ += bucket_;
  bucket_ *= 2;
  reduce_long_last();
}

void CourseRecorder::reduce_long_last() {
  if (points_.size() - last_begin() >= 2 * most_kept) reduce(last_begin());
}

void CourseRecorder::reduce(std::size_t begin) {
  if (points_.size() - begin <= 2) return;
  const auto first = points_.begin() + static_cast<std::ptrdiff_t>(begin), last = points_.end();
  std::array<std::ptrdiff_t, most_kept> kept{0, std::distance(first, last) - 1};
  std::size_t count = 2;
  for (double TrajectoryPoint::*column :
       {&TrajectoryPoint::position, &TrajectoryPoint::velocity, &TrajectoryPoint::contact_force}) {
    const auto [low, high] = std::ranges::minmax_element(first, last, {}, column);
    kept[count++] = std::distance(first, low);
    kept[count++] = std::distance(first, high);
  }
  std::ranges::sort(kept);
  const auto end = std::ranges::unique(kept).begin();
  const auto left = std::distance(kept.begin(), end);
  is_thinned_ = is_thinned_ || left < std::distance(first, last);
  for (std::ptrdiff_t k = 0; k < left; ++k) first[k] = first[kept[static_cast<std::size_t>(k)]];
  points_.erase(first + left, last);
}

}  // namespace softland
