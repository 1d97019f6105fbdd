#include "model/closing/contact_phase.h"

#include "model/contact/contact_law.h"

namespace softland {

ContactPhase::ContactPhase(const Switch& model, std::size_t contact)
    : model_(model),
      contact_(contact),
      plane_(model.contact_gap(contact)),
      reach_(model.contact_reach(contact)),
      has_contact_(model.has_contact()),
      acts_along_pad_(model.has_spread_contact(contact)),
      remembers_(has_contact_ && has_memory(model.contact(contact))) {
  if (has_contact_) kinks_ = contact_kinks(model.contact(contact));
  enter(Phase::flight);
}

double ContactPhase::lost(double position) const {
  if (!remembers_) return 0;
  return healed_ + (phase_ == Phase::loading ? dent(model_.contact(contact_), position - plane_) : dent_).lost;
}

void ContactPhase::turn(double deepest) {
  deepest_ = deepest;
  dent_ = dent(model_.contact(contact_), deepest);
  enter(Phase::unloading);
}

void ContactPhase::begin_closed(double interference) {
  // Begin the unloading curve at a slightly larger interference (by this share) than that at rest. Rounding errors of the
  // position at rest then cause no further loading.
  constexpr double rounding = 1e-9;
  if (model_.rigid_contact() != nullptr) return enter(Phase::rest);
  if (!(interference > 0)) return enter(interference > -reach_ ? above() : Phase::flight);
  if (remembers_) return turn(interference * (1 + rounding));
  std::size_t zone = 0;
  while (zone < kinks_.size() && kinks_[zone] <= interference) ++zone;
  enter(Phase::loading, zone);
}

void ContactPhase::enter(Phase phase, std::size_t zone) {
  phase_ = phase;
  if (!in_contact() && dent_.heals) {
    healed_ += dent_.lost;
    dent_ = {};
    deepest_ = 0;
  }
  law_ = phase == Phase::near || phase == Phase::loading || phase == Phase::unloading || acts_along_pad_;
  law_.unloading = phase == Phase::unloading;
  law_.shift = dent_.shift;
  const auto set = [&](auto... edges) {
    edges_ = {edges...};
    edge_count_ = sizeof...(edges);
  };
  switch (phase) {
    case Phase::rest:
      return set();
    case Phase::near:
      return set(Edge{.level = plane_ - reach_, .side = 1, .next = Phase::flight},
                 Edge{.level = plane_, .side = -1, .next = Phase::loading});
    case Phase::flight:
      if (reach_ > 0) return set(Edge{.level = plane_ - reach_, .side = -1, .next = Phase::near});
      return set(Edge{.level = plane_, .side = -1, .next = deepest_ > 0 ? Phase::dent : Phase::loading});
    case Phase::loading: {
      const Edge out = zone == 0 ? Edge{.level = plane_, .side = 1, .next = above()}
                                 : Edge{.level = plane_ + kinks_[zone - 1], .side = 1, .next = Phase::loading, .zone = zone - 1};
      if (zone == kinks_.size()) return set(out);
      return set(out, Edge{.level = plane_ + kinks_[zone], .side = -1, .next = Phase::loading, .zone = zone + 1});
    }
    case Phase::unloading:
      return set(Edge{.level = plane_ + dent_.shift, .side = 1, .next = Phase::dent},
                 Edge{.level = plane_ + deepest_, .side = -1, .next = Phase::loading});
    case Phase::dent:
      return set(Edge{.level = plane_, .side = 1, .next = Phase::flight},
                 Edge{.level = plane_ + dent_.shift, .side = -1, .next = Phase::unloading});
  }
}

}  // namespace softland
