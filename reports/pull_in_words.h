// Pull-in voltages as `pull-in` and `check` tell them: as JSON, and in words.
#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "base/watch.h"
#include "studies/closing/prepared.h"

namespace softland {

inline constexpr const char* no_open_state = "no pull-in voltage: the switch has no open state";

/// Pull-in of electrode `k` under the bias of the other drives (bias_of()): {"status", "pull_in": {"static_V", ...}}, and
/// {"bias_V": {NAME: ...}} of those that do not stand at 0, "bias_factor" of the dispersion force. "pull_in" has
/// "by_modes", static, release and pull-through voltage by the number of modes (studies/closing/by_modes.h), null where there are
/// no more modes than the scene has, or where the search was interrupted: then the dynamic voltage is null, too.
[[nodiscard]] nlohmann::json pull_in_of(const PreparedScene& prepared, std::size_t k, const Watch& watch,
                                        const PullInFinder& find_pull_in = electrode_pull_in);

/// The same of voltages that are known.
[[nodiscard]] nlohmann::json pull_in_json(const PreparedScene& prepared, std::size_t k, const ElectrodePullIn& known);

/// Everything by name; beside it the keys of one electrode, or of several `status` and their voltages as other verbs give them.
[[nodiscard]] nlohmann::json pull_in_json(const std::map<std::string, nlohmann::json>& by_name, const std::string& status);

/// What all electrodes have come to, as the exit status says it: `done`, or the status of the first one that pulls and has no
/// voltage.
[[nodiscard]] nlohmann::json pull_in_json(const PreparedScene& prepared, const Watch& watch);

/// Whether this, as pull_in_of() has found it, is a switch that closes by itself.
[[nodiscard]] bool collapsed(const nlohmann::json& pull_in);

[[nodiscard]] std::string volts(const nlohmann::json& value);

/// "piezo -1.5 V": the other drives of pull_in_of() that do not stand at 0; empty where all do.
[[nodiscard]] std::string bias_words(const PreparedScene& prepared, std::size_t k);

/// "−6.1 %, to 142.7 V": by how much more modes move the voltage `key` of `pull_in`; empty where there are no more modes.
[[nodiscard]] std::string shift_words(const nlohmann::json& pull_in, const char* key);

/// How far the contact point is deflected at the static pull-in voltage.
[[nodiscard]] std::string deflection_words(const nlohmann::json& pull_in);

/// The dynamic pull-in voltage, of what pull_in_of() has found of electrode `k`. A step that damping lets not overshoot needs no
/// less than the static one; nor does one that leaves the switch where it rests.
[[nodiscard]] std::string dynamic_words(const PreparedScene& prepared, std::size_t k, const nlohmann::json& pull_in);

/// Whether a drive alone carries the switch to its contact through stable equilibria, and on how many devices: "the piezo alone
/// reaches the contact at -0.9483 V through stable equilibria; 96.5 % of devices do within -1 V". Null, and words that say so,
/// where none does; words are empty where the scene has no contact.
struct StablePathFound {
  nlohmann::json data = nullptr;
  std::string words = {};
};
[[nodiscard]] StablePathFound stable_path_of(const PreparedScene& p, const Watch& watch);

}  // namespace softland
