// Phase of a contact: the branch of the contact law that acts on the contact point during a closing, and the end of this phase.
//
//   flight     above the contact plane, where no contact force acts
//   near       above the contact plane, within the reach of a law that acts before contact (adhesive_repulsive.h)
//   loading    in contact, on the curve of first loading; a law without memory has no other curve
//   unloading  in contact, on the elastic curve of a law that remembers its deepest interference (memory.h)
//   dent       below the contact plane, in the dent (residual deformation) of a law with memory: no contact force
//   rest       a plate at rest on a rigid contact                              (rigid.h)
//
// An edge is the position of the contact point at which a phase ends. A phase is entered at an edge of another phase or, from
// loading to unloading, at the deepest point. A law with kinks (interferences at which its force is not smooth) has an edge
// from loading to loading at each kink. The integrator is restarted at every edge, so that it only ever integrates smooth
// right-hand sides.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "model/switch.h"

namespace softland {

enum class Phase { flight, near, loading, unloading, dent, rest };

/// The position of the contact point at which a phase (branch of the contact law) ends: side * (position - level) is positive
/// inside the phase.
struct Edge {
  double level = 0;  ///< position of the contact point at which this branch of the contact law ends [m]
  double side = 0;   ///< 1: this branch of the contact law acts beyond the level, towards the contact; -1: before the level
  Phase next = Phase::flight;
  std::size_t zone = 0;  ///< number of the law's kinks at smaller interferences than phase `next`
};

class ContactPhase {
 public:
  /// Begins in the phase `flight` (no contact force): the contact has never touched.
  explicit ContactPhase(const Switch& model, std::size_t contact = 0);

  [[nodiscard]] Phase phase() const { return phase_; }
  /// Returns true when the contact point is at or below the contact plane.
  [[nodiscard]] bool in_contact() const { return phase_ != Phase::flight && phase_ != Phase::near; }
  /// Returns the state of the contact from which the contact law computes its force: whether the law acts now, and for a law
  /// with memory its branch and the residual deformation.
  [[nodiscard]] const ContactState& law() const { return law_; }
  [[nodiscard]] std::span<const Edge> edges() const { return {edges_.data(), edge_count_}; }
  /// Returns the phase (branch of the contact law) just above the contact plane.
  [[nodiscard]] Phase above() const { return reach_ > 0 ? Phase::near : Phase::flight; }
  /// Returns true when the current phase ends where the contact point turns back: a contact law with memory changes there from
  /// loading to unloading.
  [[nodiscard]] bool ends_at_turn() const { return remembers_ && phase_ == Phase::loading; }
  /// Returns whether a contact law without memory acts at this position of the contact point [m].
  [[nodiscard]] ContactState law_at(double position) const {
    return acts_along_pad_ || (has_contact_ && position > plane_ - reach_);
  }
  /// Returns the energy that residual deformation (dents) has dissipated so far, with the contact point at this position [J].
  [[nodiscard]] double lost(double position) const;

  void enter(Phase phase, std::size_t zone = 0);
  /// Begins with the switch at rest on the contact, at this interference of the contact point [m]. A contact law with memory
  /// has been loaded up to this interference.
  void begin_closed(double interference);
  /// Changes the contact law from loading to unloading at this interference [m].
  void turn(double deepest);

 private:
  const Switch& model_;
  std::size_t contact_;
  double plane_;  // position of the contact plane [m]
  double reach_;  // distance above the contact plane at which the contact law begins to act [m]
  bool has_contact_, acts_along_pad_, remembers_;
  std::vector<double> kinks_;  // interferences at which the force of the contact law is not smooth [m]
  Phase phase_ = Phase::flight;
  ContactState law_;
  std::array<Edge, 2> edges_;
  std::size_t edge_count_ = 0;
  double deepest_ = 0;  // deepest interference so far of a contact law with memory [m]
  Dent dent_;           // residual deformation (dent) that a contact law with memory has left
  double healed_ = 0;   // energy dissipated by dents that have since vanished [J]
};

/// The phases (branches of the contact law that act) of all contacts of a switch; for a switch without contact, the phase of
/// its contact point.
class ContactPhases {
 public:
  explicit ContactPhases(const Switch& model) {
    const std::size_t count = std::max<std::size_t>(1, model.contacts());
    for (std::size_t c = 0; c < count; ++c) phases_.emplace_back(model, c);
    further_.resize(count - 1);
    apart_.resize(count - 1);
  }

  [[nodiscard]] std::size_t size() const { return phases_.size(); }
  [[nodiscard]] ContactPhase& operator[](std::size_t c) { return phases_[c]; }
  [[nodiscard]] const ContactPhase& operator[](std::size_t c) const { return phases_[c]; }
  [[nodiscard]] const ContactPhase& first() const { return phases_.front(); }
  /// Returns ContactPhase::law() of every contact, for the forces of the switch; valid until the next call.
  [[nodiscard]] ContactStates states() {
    for (std::size_t c = 1; c < size(); ++c) further_[c - 1] = phases_[c].law();
    return {phases_.front().law(), further_};
  }
  /// Returns states in which no contact law acts, to compute energies of the switch without its contacts.
  [[nodiscard]] ContactStates apart() const { return {false, apart_}; }
  /// Returns true when the contact point of any contact is at or below its contact plane.
  [[nodiscard]] bool in_contact() const { return std::ranges::any_of(phases_, &ContactPhase::in_contact); }

 private:
  std::vector<ContactPhase> phases_;
  std::vector<ContactState> further_, apart_;
};

}  // namespace softland
