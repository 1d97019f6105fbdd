#include "studies/closing/resistance_course.h"

#include <cmath>

#include "integrators/quintic.h"
#include "model/contact/resistance.h"

namespace softland {
namespace {

// The conductance of one contact as a function of time, at increasing times.
class ContactCourse {
 public:
  ContactCourse(const Device& device, std::size_t contact, double gap, const std::vector<TrajectoryPoint>& points)
      : resistance_(contact_resistance(device, contact)), gap_(gap), points_(points) {}

  [[nodiscard]] bool is_kept() const { return !points_.empty(); }
  [[nodiscard]] double conductance(double time) {
    while (next_ + 1 < points_.size() && points_[next_ + 1].time <= time) ++next_;
    const TrajectoryPoint& from = points_[next_];
    if (next_ + 1 == points_.size() || !(time > from.time))
      return resistance_.conductance(from.position - gap_, from.contact_force);
    const TrajectoryPoint& to = points_[next_ + 1];
    const Quintic between(from.time, from.position, from.velocity, from.acceleration, to.time, to.position, to.velocity,
                          to.acceleration);
    const double share = (time - from.time) / (to.time - from.time);
    return resistance_.conductance(between.position(time) - gap_, std::lerp(from.contact_force, to.contact_force, share));
  }

 private:
  ContactResistance resistance_;
  double gap_;  // rest distance of the contact to its contact plane [m]
  const std::vector<TrajectoryPoint>& points_;
  std::size_t next_ = 0;
};

}  // namespace

bool conducts(const Device& device, std::optional<std::size_t> contact) {
  return contact ? device.contacts[*contact].conduction.is_given() : device.conducts();
}

std::vector<double> resistance_course(const Device& device, const Trajectory& run, std::span<const double> times,
                                      std::optional<std::size_t> contact) {
  if (!conducts(device, contact)) return {};
  std::vector<ContactCourse> contacts;
  if (run.contacts.empty()) {
    contacts.emplace_back(device, 0, run.contact_gap, run.points);
  } else {
    for (std::size_t c = 0; c < run.contacts.size(); ++c)
      contacts.emplace_back(device, c, run.contacts[c].gap, run.contacts[c].points);
  }
  for (const ContactCourse& one : contacts)
    if (!one.is_kept()) return {};
  std::vector<double> course, conductances(contacts.size());
  for (const double time : times) {
    for (std::size_t c = 0; c < contacts.size(); ++c) conductances[c] = contacts[c].conductance(time);
    course.push_back(resistance_of(contact ? conductances[*contact] : connection_conductance(device, conductances)));
  }
  return course;
}

}  // namespace softland
