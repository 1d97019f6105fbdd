// Connection: the electrical path through several contacts of a switch, which an observer receives like a single contact.
//
// The connection is closed while all of its contacts are closed, or while any of them is (Device::connection). The separation
// of a contact is the distance of its contact point from the contact plane, negative in contact. The separation of the
// connection is the largest (or smallest) separation of its contacts; its position is the distance of the first contact from
// its plane at rest less this separation. Between two knots (points of the simulated motion), the contact with the largest (or
// smallest) separation at both knots decides. If another contact decides at the second knot, a knot is added at the time at
// which both contacts have the same separation. The force of the connection is the least (or largest) force of its contacts. A
// touch (interval in contact) of the connection has the largest force and impact velocity of the touches of its contacts, and
// the sum of their energies.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "model/closing/observer.h"
#include "model/switch.h"

namespace softland {

/// The touches (intervals in contact) of a connection, which combine the touches of its contacts.
class ConnectionTouches {
 public:
  /// Adds a touch (interval in contact) of one contact of the connection.
  void take(const Touch& touch);
  /// Begins a touch of the connection: the connection closes at this time [s] with this impact velocity [m/s]. Returns the
  /// previous touch of the connection, which is now complete; none at the first touch.
  [[nodiscard]] std::optional<Touch> close(double time, double speed);
  /// Ends the current touch of the connection, which opens at this time [s].
  void open(double time) { touch_->end = time; }
  /// Returns the last touch of the connection. Call it after the touches of all contacts have been added.
  [[nodiscard]] std::optional<Touch> finish();

  /// Returns time and impact velocity of the first touch of any contact of the connection.
  [[nodiscard]] const FirstTouch& first_touch() const { return first_touch_; }

 private:
  std::optional<Touch> touch_;
  Touch pending_;
  FirstTouch first_touch_;
};

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
  /// Passes the last touch (interval in contact) of the connection to its observer. Call it after the last touch of every
  /// contact.
  void finish();

  /// Returns time and impact velocity of the first touch of any contact of the connection.
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

    std::optional<TrajectoryPoint> last;  ///< point of this contact's motion up to which the connection's motion is known
    std::vector<TrajectoryPoint> fresh;

   private:
    ConnectionCourse& connection_;
    ClosingObserver* own_;
    double gap_;  // distance of the contact from its plane at rest [m]
    bool connects_;
  };

  /// Returns the contact with the largest (or smallest) separation at this time, which is also the separation of the
  /// connection. `present` is the contact that has decided until now; it still decides when another contact has the same
  /// separation.
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
  double last_closed_ = 0;  // latest time passed to the observer at which the connection was closed [s]
};

}  // namespace softland
