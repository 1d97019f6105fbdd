// A simulated device in a simulated laboratory, for practice: one device of the spread. It answers a drive by what a laboratory
// sees of its closing.
//
//   commanded f(t)  ->  the scene's source  ->  V(t) = (1 + g) (1 + s_n) (1 + d (n - 1)) f(t)  ->  the device  ->  the record
//
//   g    error of the gain of a drive, constant and unknown       s_n  its scatter in shot n
//   d    drift of all volts from one shot to the next
//
// The record begins late by the trigger's delay, the same in all shots. It holds the edges of the contact, closed or open, each
// late by an error of its own. An opening shorter than the resolution of the instrument is not seen, nor is a touch whose edges
// the errors swap. If the instrument sees the capacitance, the contact counts as closed while that is above its threshold.
//
// The device differs from the scene as [spread] says, or the assumed spread (config/assumed_spread.h), and further by its
// model, which a belief over the scene cannot know. Its random numbers have streams of their own, which no ensemble draws from.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/scene.h"
#include "studies/closing/prepared.h"
#include "studies/devices/ensemble.h"
#include "studies/inverse/contact_record.h"
#include "waveforms/waveform.h"

namespace softland {

/// Differences of the device's model from its scene.
struct PracticeModel {
  int more_modes = 0;                 ///< modes beside those of the scene
  std::string gas = {};               ///< law of the film instead of the scene's; empty: the scene's
  double stiffness = 1;               ///< factor of the stiffness, or modulus, of the contact
  std::vector<std::string> set = {};  ///< further keys of the scene: "gap.contact=2.05 um"
};

struct PracticeOptions {
  std::uint64_t seed = 1;  ///< seed of the device and its errors
  LaboratoryErrors laboratory = {};
  double drift = 0;          ///< drift of all volts from one shot to the next, relative
  double trigger_delay = 0;  ///< time by which records begin late; negative: early [s]
  PracticeModel model = {};
};

/// The record of a closing, and the motion that no laboratory sees.
struct PracticeClosing {
  ContactRecord record;
  Metrics motion;                                   ///< true motion of the contact point
  double largest_impact_velocity = Metrics::unset;  ///< largest velocity of all touches [m/s]
};

/// A closure of the contact.
struct ContactClosure {
  double begin = 0, end = 0;  ///< [s]; the end is NaN if the record ends closed
};

class PracticeDevice {
 public:
  /// Throws InvalidInput for a scene that cannot be simulated or has no contact, and for a model that the scene cannot have.
  explicit PracticeDevice(SceneFile file, const PracticeOptions& options = {});

  /// The scene, with the limits of its drivers in volts: the known part of the device.
  [[nodiscard]] const PreparedScene& nominal() const { return nominal_; }
  /// The hidden part: the device, and the values of the varied quantities.
  [[nodiscard]] const SampledDevice& device() const { return device_; }

  /// Simulates closing number `shot`, from 1 on, under commanded waveforms in the order of Switch::drives() [V], for `duration`
  /// [s]. Shots do not depend on each other. Throws InvalidInput if a waveform leaves the limits of its driver, `shot` is 0, or
  /// `duration` is not positive.
  [[nodiscard]] PracticeClosing close(std::uint64_t shot, const std::vector<Waveform>& waveforms, double duration) const;

 private:
  [[nodiscard]] double gain(std::size_t drive, std::uint64_t shot) const;
  [[nodiscard]] std::vector<ContactEdge> seen_edges(const std::vector<ContactClosure>& closures, std::uint64_t shot) const;

  PracticeOptions options_;
  PreparedScene nominal_, own_;  // the scene, and that of the device's model
  SampledDevice device_;
};

}  // namespace softland
