// The faces of dielectrics on which a beam or plate may close, and the contact along the faces.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "model/constants.h"
#include "model/device.h"

namespace softland {

double Dielectric::neutral_voltage() const { return -charge * thickness / (permittivity * vacuum_permittivity); }

bool Device::is_charged() const {
  return std::ranges::any_of(electrodes, [](const Electrode& e) { return e.dielectric && e.dielectric->charge != 0; });
}

double Device::dielectric_depth() const {
  double least = std::numeric_limits<double>::infinity();
  for (const Electrode& e : electrodes) {
    if (e.side != Side::far) least = std::min(least, e.dielectric ? e.dielectric->depth() : 0);
  }
  return std::isfinite(least) ? least : 0;
}

std::optional<std::size_t> Device::face_contact() const {
  const auto face = std::ranges::find(contacts, true, &Contact::along_face);
  if (face == contacts.end()) return std::nullopt;
  return static_cast<std::size_t>(face - contacts.begin());
}

const Landing* Device::landing() const {
  for (const Electrode& e : electrodes)
    if (e.dielectric && e.dielectric->landing) return &*e.dielectric->landing;
  return nullptr;
}

namespace {

// Returns the position at which a beam that bends over its electrodes first touches the faces of their dielectrics. This is the
// free end, or the middle between two clamps, if a pad lies there, and otherwise the edge of the nearest pad.
Place first_touch_on(const Device& d) {
  const double length = d.structure.length, aim = d.structure.has_far_clamp() ? length / 2 : length;
  Place nearest;
  double distance = std::numeric_limits<double>::infinity();
  const auto consider = [&](const Place& place) {
    if (const double away = std::abs(place.on(length) - aim); away < distance) distance = away, nearest = place;
  };
  for (const Electrode& e : d.electrodes) {
    if (!e.dielectric || !e.dielectric->landing) continue;
    for (const Stretch& pad : e.pads(length))
      if (pad.begin < aim && aim < pad.end) return Place::share(0.5);
    consider(e.begin), consider(e.end);
    for (const Span& pad : e.further) consider(pad.begin), consider(pad.end);
  }
  return nearest;
}

// Returns the total length of the electrode pads on whose dielectric the beam may close [m].
double length_of_faces(const Device& d) {
  double sum = 0;
  for (const Electrode& e : d.electrodes) {
    if (!e.dielectric || !e.dielectric->landing) continue;
    for (const Stretch& pad : e.pads(d.structure.length)) sum += pad.end - pad.begin;
  }
  return sum;
}

}  // namespace

void set_face_contact(Device& d) {
  const Landing* landing = d.landing();
  if (landing == nullptr) return;
  const double plane = d.gap.electrode - landing->begin();
  const auto set = [&](Contact& face) {
    // A wall has no stiffness in the description: 1 is a placeholder, which the switch replaces by a stiffness that it computes
    // from its modes.
    face.model = LinearSpring{.stiffness = landing->is_wall() ? 1 : landing->stiffness};
    if (landing->asperities) face.model = *landing->asperities, face.pad_length = length_of_faces(d);
    if (!d.structure.is_rigid()) face.at = first_touch_on(d);
  };
  if (const auto known = d.face_contact()) {
    Contact& face = d.contacts[*known];
    set(face);
    (*known == 0 ? d.gap.contact : face.gap) = plane;
    return;
  }
  Contact face{.along_face = true};
  set(face);
  const bool has_others = d.has_contact();
  if (has_others) face.name = face_name;
  if (std::ranges::find(d.contacts, Side::near, &Contact::side) != d.contacts.end()) {
    face.connects = false;
    face.gap = plane;
    d.contacts.push_back(std::move(face));
    return;
  }
  if (has_others) d.contacts.front().gap = d.gap.contact;
  d.contacts.insert(d.contacts.begin(), std::move(face));
  d.gap.contact = plane;
}

bool have_equal_landings(const Electrode& one, const Electrode& other) {
  const auto of = [](const Electrode& e) { return e.dielectric && e.dielectric->landing ? &*e.dielectric->landing : nullptr; };
  const Landing *a = of(one), *b = of(other);
  if (a == nullptr || b == nullptr) return a == b;
  const bool have_equal_beds = a->stiffness == b->stiffness || (std::isnan(a->stiffness) && std::isnan(b->stiffness));
  return a->from == b->from && have_equal_beds && a->asperities == b->asperities;
}

std::string why_no_landing(const Device& d) {
  if (d.landing() != nullptr) {
    const auto is_near = [](const Electrode& e) { return e.side != Side::far; };
    const auto first = std::ranges::find_if(d.electrodes, is_near);
    const bool all =
        std::ranges::all_of(d.electrodes, [&](const Electrode& e) { return !is_near(e) || have_equal_landings(*first, e); });
    if (!all) return unequal_landings;
    if (d.dispersion) return "a beam that lands on a dielectric takes no dispersion force";
    return {};
  }
  if (!d.structure.is_rigid())
    return "must be less than 0.99 times gap.electrode, unless the dielectric of the electrodes has a landing";
  if (!(d.dielectric_depth() > 0))
    return "must be less than 0.99 times gap.electrode, unless every near electrode has a dielectric";
  if (d.dispersion) return "a plate that lands on a dielectric takes no dispersion force";
  return {};
}

}  // namespace softland
