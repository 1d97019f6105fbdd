// The connection that several contacts of a switch make, which an observer receives like a single contact.
//
// The connection is closed while all of the contacts that make it are closed, or while any of them is (Device::connection). Its
// separation is the largest of their separations, or the smallest; its position is that of the first contact's plane less this
// separation. Between two knots (points of the simulated motion) of any contact the contact with the largest (or smallest)
// separation at both ends decides; where the deciding contact changes there is a knot at which both have the same separation.
// The force of the connection is the least force of a contact that makes it, or the largest. A touch of the connection has the
// largest force and impact velocity, and the sum of energies, of the touches of its contacts.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "model/closing/observer.h"
#include "model/switch.h"

namespace softland {

/// The touches of a connection of several contacts, which combine the touches of its contacts.
class ConnectionTouches {
 public:
  /// Adds a touch of one contact that makes the connection.
  void take(const Touch& touch);
  /// Begins a touch of the connection at this time [s] with this impact velocity [m/s]; returns the connection's previous
  /// touch, if any.
  [[nodiscard]] std::optional<Touch> close(double time, double speed);
  /// Ends the current touch of the connection at this time [s].
  void open(double time) { touch_->end = time; }
  /// Returns the last touch of the connection, after all touches of contacts have been added.
  [[nodiscard]] std::optional<Touch> finish();

  /// Returns the first touch of any contact that makes the connection.
  [[nodiscard]] const FirstTouch& first_touch() const { return first_touch_; }

 private:
  std::optional<Touch> touch_;
  Touch pending_;
  FirstTouch first_touch_;
};

/// The time from which the contact force is steady [s], and the least force after the first touch [N]; see Trajectory.
struct ForceOutcome {
  double steady_force_time = std::numeric_limits<double>::quiet_NaN();
  double least_force_after_touch = std::numeric_limits<double>::quiet_NaN();
};
/// Computes the outcome of the connection from the outcomes of all contacts of the device, in order.
[[nodiscard]] ForceOutcome force_of_connection(const Device& device, std::span<const ForceOutcome> contacts);

class ConnectionCourse {
 public:
  /// Keeps references to the switch and to `observer`, which receives the motion of the connection; the observers that
  /// observer.contact() returns receive the motion of the contacts.
  ConnectionCourse(const Switch& model, ClosingObserver& observer);
  ConnectionCourse(const ConnectionCourse&) = delete;
  ConnectionCourse& operator=(const ConnectionCourse&) = delete;

  /// Returns the observer that receives the motion of contact number `c`.
  [[nodiscard]] ClosingObserver& contact(std::size_t c) { return followed_[c]; }
  /// Passes the motion of the connection to its observer, up to the latest time for which the motion of every contact is known.
  void hand_over();
  /// Passes the last touch of the connection to its observer, after every contact has passed on its last touch.
  void finish();

  /// Returns the first touch of any contact that makes the connection.
  [[nodiscard]] const FirstTouch& first_touch() const { return touches_.first_touch(); }

 private:
  class Followed final : public ClosingObserver {
   public:
    Followed(ConnectionCourse& connection, ClosingObserver* own, double gap, bool connects)
        : connection_(connection), own_(own), gap_(gap), connects_(connects) {}
    void knot(const TrajectoryPoint& point) override;
    void touch(const Touch& touch) override;

    [[nodiscard]] bool connects() const { return connects_; }
    [[nodiscard]] TrajectoryPoint at(double time) const;
    [[nodiscard]] double separation(double time) const { return gap_ - at(time).position; }
    [[nodiscard]] double gap() const { return gap_; }

    std::optional<TrajectoryPoint> last;  ///< last point of the connection's motion
    std::vector<TrajectoryPoint> fresh;

   private:
    ConnectionCourse& connection_;
    ClosingObserver* own_;
    double gap_;  // distance of the contact from its plane at rest [m]
    bool connects_;
  };

  /// Returns the contact whose separation is that of the connection at a time; `present`, the contact so far, when several
  /// contacts tie.
  [[nodiscard]] std::size_t decides(double time, std::size_t present) const;
  void follow_to(double time);
  void tell(double time);

  ClosingObserver& observer_;
  bool needs_all_;
  double plane_;  // distance of the first contact from its plane at rest [m]
  std::vector<Followed> followed_;
  std::size_t deciding_ = 0;
  double here_ = 0;  // time up to which the connection's motion has been passed to the observer [s]
  ConnectionTouches touches_;
  bool is_closed_ = false;
  double last_closed_ = 0;  // last time at which the connection was closed [s]
};

}  // namespace softland
