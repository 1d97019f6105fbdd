// A contact law of softland, implemented again as a user's own law.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <string_view>

#include "model/contact/asperity_uniform.h"
#include "model/contact/contact.h"
#include "model/contact/own.h"

namespace softland::test {

/// The law asperity-uniform, with the damping of Hunt and Crossley.
class OwnAsperities : public OwnContactLaw {
 public:
  OwnAsperities(const UniformAsperities& law, const ContactPad& pad)
      : strength_(law.summits.hertz(pad) / law.height), height_(law.height), damping_(law.damping) {}

  [[nodiscard]] std::string_view name() const override { return "own asperities"; }
  [[nodiscard]] double force(double d, double rate) const override {
    const double depth = std::abs(d), over = std::max(0.0, depth - height_);
    const double size = strength_ * 8 / 15 * (depth * depth * std::sqrt(depth) - over * over * std::sqrt(over));
    return (d < 0 ? -size : size) * std::max(0.0, 1 + 1.5 * damping_ * rate);
  }
  [[nodiscard]] bool depends_on_rate() const override { return damping_ > 0; }

 private:
  double strength_, height_, damping_;
};

/// Returns the contact of the gold cantilever: 20 um wide, with a pad of 5 um.
[[nodiscard]] inline Contact own_contact(const UniformAsperities& law = UniformAsperities::example()) {
  constexpr ContactPad pad{.width = 20e-6, .length = 5e-6};
  return {.model = OwnContact{std::make_shared<const OwnAsperities>(law, pad)}, .pad_length = pad.length};
}

}  // namespace softland::test
