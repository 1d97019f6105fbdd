// A simulated device in a simulated laboratory, for practice. The device is one of the devices of [spread]. For each shot the
// simulated laboratory returns the record that a real laboratory would make of the closing.
//
//   commanded f(t)  ->  the scene's source  ->  V(t) = (1 + g) (1 + s_n) (1 + d (n - 1)) f(t)  ->  the device  ->  the record
//
//   g    error of the gain of a drive, constant and unknown       s_n  scatter of the gain in shot n
//   d    drift of all voltages from one shot to the next
//
// The record begins late by the delay of the trigger, which is the same in all shots. The record has the edges of the contact's
// state, each with a random error of its time. An opening shorter than the resolution of the instrument is not recorded, nor is
// a contact whose edges are swapped by the errors. If the instrument records the capacitance, the contact counts as closed
// while the capacitance is above a threshold.
//
// The device differs from the scene as [spread], or the assumed spread (config/assumed_spread.h), describes. Its model may
// differ as well, which a belief based on the scene does not include. The device's random numbers have their own streams, which
// no ensemble uses.
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

/// Differences of the device's model from the model of its scene.
struct PracticeModel {
  int more_modes = 0;    ///< number of modes in addition to those of the scene
  std::string gas = {};  ///< law of the gas film in the device, in place of the scene's law; empty for the scene's own law
  double stiffness = 1;  ///< ratio of the contact's stiffness or modulus to that in the scene
  /// Further keys of the scene that differ in the device, with their values: "gap.contact=2.05 um".
  std::vector<std::string> set = {};
};

struct PracticeOptions {
  std::uint64_t seed = 1;  ///< seed of the simulated device and of its measurement errors
  LaboratoryErrors laboratory = {};
  double drift = 0;          ///< relative drift of all drive voltages from one shot (closing) to the next
  double trigger_delay = 0;  ///< delay of contact records behind the drive waveforms [s]; negative if records begin early
  PracticeModel model = {};
};

/// The record of a closing of the simulated device, and the true motion, which no laboratory records.
struct PracticeClosing {
  ContactRecord record;
  Metrics motion;                                   ///< figures of the true motion of the contact point
  double largest_impact_velocity = Metrics::unset;  ///< largest impact velocity of all touches of the contact [m/s]
};

/// A time span in which the contact of the simulated device is closed.
struct ContactClosure {
  /// Times at which the contact closes and opens [s]; the end is NaN if the contact is closed at the end of the record.
  double begin = 0, end = 0;
};

class PracticeDevice {
 public:
  /// Throws InvalidInput for a scene that cannot be simulated or has no contact, and for a model that the scene cannot have.
  explicit PracticeDevice(SceneFile file, const PracticeOptions& options = {});

  /// Returns the scene, with the limits of its voltage sources in volts. A user knows only this scene about the device.
  [[nodiscard]] const PreparedScene& nominal() const { return nominal_; }
  /// Returns the simulated device with the values of its varied quantities. A user does not know these values.
  [[nodiscard]] const SampledDevice& device() const { return device_; }

  /// Simulates the closing in shot number `shot`, counted from 1, for `duration` [s]. `waveforms` are the commanded waveforms,
  /// in the order of Switch::drives() [V]. The shots are independent. Throws InvalidInput if a waveform exceeds the limits of
  /// its voltage source, if `shot` is 0, and if `duration` is not positive.
  [[nodiscard]] PracticeClosing close(std::uint64_t shot, const std::vector<Waveform>& waveforms, double duration) const;

 private:
  [[nodiscard]] double gain(std::size_t drive, std::uint64_t shot) const;
  [[nodiscard]] std::vector<ContactEdge> seen_edges(const std::vector<ContactClosure>& closures, std::uint64_t shot) const;

  PracticeOptions options_;
  PreparedScene nominal_, own_;  // the scene as given, and the scene with the device's own model
  SampledDevice device_;
};

}  // namespace softland
