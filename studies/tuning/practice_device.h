// A simulated device in a simulated laboratory, to practise on: one device of the spread, which answers a drive by what a lab
// sees of its closing.
//
//   told volts f(t)  ->  the scene's source  ->  V(t) = (1 + g) (1 + s_n) (1 + d (n - 1)) f(t)  ->  the device  ->  the record
//
//   g    error of the gain of a drive, constant and unknown       s_n  its scatter in shot n
//   d    drift of all volts from one shot to the next
//
// The record begins late by the trigger's delay, the same in all shots. It holds the edges of the contact, closed or open, each
// late by an error of its own. An opening that is shorter than what the instrument resolves is not seen, nor is a touch that the
// errors turn around. Where the instrument sees the capacitance, the contact counts as closed while that is above its threshold.
//
// The device differs from the scene as [spread] says, or the assumed one (config/assumed_spread.h), and beyond that as its model
// does: what a belief over the scene cannot know. Its random numbers have streams of their own, which no ensemble draws from.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/scene.h"
#include "studies/closing/prepared.h"
#include "studies/devices/ensemble.h"
#include "studies/tuning/contact_record.h"
#include "waveforms/waveform.h"

namespace softland {

/// How the model that a device follows differs from that of its scene.
struct PracticeModel {
  int more_modes = 0;                 ///< beside those of the scene
  std::string gas = {};               ///< law of the film instead of the scene's; empty: the scene's
  double stiffness = 1;               ///< factor of the stiffness, or modulus, of the contact
  std::vector<std::string> set = {};  ///< further keys of the scene: "gap.contact=2.05 um"
};

struct PracticeOptions {
  std::uint64_t seed = 1;  ///< which device, and which errors
  LaboratoryErrors laboratory = {};
  double drift = 0;          ///< of all volts from one shot to the next, relative
  double trigger_delay = 0;  ///< the time by which records begin late; early where it is below 0 [s]
  PracticeModel model = {};
};

/// What is seen of a closing, and what no lab sees.
struct PracticeClosing {
  ContactRecord record;
  Metrics motion;                                   ///< the true one of the contact point
  double largest_impact_velocity = Metrics::unset;  ///< of all touches [m/s]
};

/// The contact is closed.
struct ContactClosure {
  double begin = 0, end = 0;  ///< [s]; the end is NaN where the record ends closed
};

class PracticeDevice {
 public:
  /// Throws InvalidInput for a scene that cannot be simulated or has no contact, and for a model that it cannot have.
  explicit PracticeDevice(SceneFile file, const PracticeOptions& options = {});

  /// The scene, with the limits of its drivers in volts: what is known of the device.
  [[nodiscard]] const PreparedScene& nominal() const { return nominal_; }
  /// What no lab sees: the device, and the values of the quantities that vary.
  [[nodiscard]] const SampledDevice& device() const { return device_; }

  /// Closing number `shot`, from 1 on, under told waveforms in the order of Switch::drives() [V], followed for `duration` [s].
  /// Shots do not depend on each other. Throws InvalidInput where a waveform leaves the limits of its driver, `shot` is 0, or
  /// `duration` not positive.
  [[nodiscard]] PracticeClosing close(std::uint64_t shot, const std::vector<Waveform>& waveforms, double duration) const;

 private:
  [[nodiscard]] double gain(std::size_t drive, std::uint64_t shot) const;
  [[nodiscard]] std::vector<ContactEdge> seen_edges(const std::vector<ContactClosure>& closures, std::uint64_t shot) const;

  PracticeOptions options_;
  PreparedScene nominal_, own_;  // the scene, and that of the device's model
  SampledDevice device_;
};

}  // namespace softland
