// The lines of text that a tuning and a device exchange: one JSON object each, in SI units.
//
//   to the device     {"shot":1,"hold_s":2e-4,"drives":{"main":{"time_s":[0,1e-6],"V":[0,17.5]}}}      {"done":true}
//   from the device   {"shot":1,"edges_s":[[3.6e-5,1],[3.8e-5,0],[4.1e-5,1]]}
//                     {"shot":1,"closing_time_s":3.6e-5,"bounce_count":1}
//                     {"shot":1,"error":"no trigger"}
//
// Voltages are linear between rows, and two rows of the same time are a jump. The last voltage is held, and the contact
// recorded, for hold_s after the last row of any drive. An edge is a time since the start of the waveforms, and 1 if the
// contact closes then, 0 if it opens. An empty list of edges, or a closing time that is null, means that the contact stayed
// open. A device may also report a loudness, any number that rises with the impact.
#pragma once

#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "studies/closing/sent_signals.h"
#include "studies/inverse/contact_record.h"
#include "studies/inverse/tuner.h"
#include "waveforms/table.h"

namespace softland {

/// A shot, the voltages for one closing, as it is sent to a device.
struct CommandedShot {
  int number = 0;                       ///< number of the shot, counted from 1
  double hold_time = 0;                 ///< time for which the last levels are held and the contact recorded [s]
  std::map<std::string, Table> drives;  ///< waveforms of the shot by electrode or piezo, in volts at the switch
  /// Volts at the switch per volt of the source, by electrode or piezo with an amplifier.
  std::map<std::string, double> amplifiers = {};

  /// Returns the time of the last row of all waveforms [s].
  [[nodiscard]] double last_row() const;
  /// Returns the time from t = 0 for which the contact is recorded [s].
  [[nodiscard]] double duration() const { return last_row() + hold_time; }
  /// Returns the waveforms as Switch::drives() sorts electrodes, piezos and dispersion force. The factor of the dispersion
  /// force, which is not a voltage, is that of the scene. Throws InvalidInput for an electrode or piezo that the device does
  /// not have.
  [[nodiscard]] std::vector<Waveform> waveforms(const PreparedScene& nominal) const;
};

/// Returns the commanded voltages of a shot as rows of time and voltage: exact for straight pieces, within 1e-4 of the peak for
/// curves.
[[nodiscard]] CommandedShot commanded_shot(int number, double hold_time, const SentSignals& sent);

/// The longest line of text that is read from a device [byte].
inline constexpr std::size_t longest_line = std::size_t{16} << 20;

/// Reads one line of text as a JSON object. This function and the others that read lines throw InvalidInput with the rule:
/// "must be a JSON object: ...".
[[nodiscard]] nlohmann::json read_line(std::string_view line);
/// Returns true for the line {"done":true}, which says that no more shots (closings of the device) follow.
[[nodiscard]] bool is_end(const nlohmann::json& line);
/// Returns the number of the shot (one closing of the device) that a line of text is about, a whole number from 1 on.
[[nodiscard]] int shot_number(const nlohmann::json& line);
/// Reads a shot (voltages for one closing) from its JSON. Messages begin with the invalid key: "drives.main.V: must be a list
/// of numbers".
[[nodiscard]] CommandedShot read_shot(const nlohmann::json& line);
/// Reads the contact record of shot (closing) number `shot` from its JSON. All edges must be within the recorded time
/// `duration` [s].
[[nodiscard]] ContactRecord read_record(const nlohmann::json& line, int shot,
                                        double duration = std::numeric_limits<double>::infinity());

[[nodiscard]] nlohmann::json shot_json(const CommandedShot& shot);
[[nodiscard]] nlohmann::json record_json(int shot, const ContactRecord& record);
[[nodiscard]] nlohmann::json end_json();
/// Returns candidate waveforms for the log of a tuning as JSON, whose numbers keep all bits:
/// {"recipes":[{"x":[...],"volts":1,"time":1,"cost":0.8}]}. The list x has the waveform parameters; volts and time are the
/// units of voltage and time of the devices for which the waveform was optimised, divided by those of the nominal device.
[[nodiscard]] nlohmann::json recipes_json(const std::vector<CandidateWaveform>& recipes);
[[nodiscard]] std::vector<CandidateWaveform> read_recipes(const nlohmann::json& line);
/// Returns the JSON as a line with line feed; bytes that are not UTF-8 become U+FFFD.
[[nodiscard]] std::string line_text(const nlohmann::json& line);

}  // namespace softland
