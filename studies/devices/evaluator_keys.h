// Keys of the input columns of an evaluator: parameters of the waveforms and quantities of the device in a scene.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "config/scene.h"
#include "config/units.h"
#include "waveforms/waveform.h"

namespace softland {

/// Splits a key of a scene into its path and the number of a list element: "electrode.main.span[2]" into "electrode.main.span"
/// and 2. Without an element the number is 0.
[[nodiscard]] std::pair<std::string, std::size_t> key_and_element(const std::string& key);
/// Splits the key of a waveform parameter into drive and parameter: "waveform.main.level" into "main" and "level"; none for
/// other keys.
[[nodiscard]] std::optional<std::pair<std::string, std::string>> waveform_key(const std::string& path);
/// Returns the parameter of a waveform with this name, and writes its kind (level, time, ...) into `kind`; null if the waveform
/// family has none. Adds the names of the family's parameters, up to the one found, to `names`, for a message.
[[nodiscard]] double* waveform_parameter(Waveform& waveform, const std::string& name, std::size_t element,
                                         std::vector<std::string_view>& names, ParameterKind& kind);
/// Returns the SI unit of a waveform parameter; empty for a ratio.
[[nodiscard]] std::string unit_of_parameter(ParameterKind kind, const std::string& drive);
/// Returns the quantity that the scene has at a key; none if the key is missing or is not a quantity.
[[nodiscard]] std::optional<Quantity> written_quantity(const SceneFile& file, const std::string& path, std::size_t element);
/// Returns a scene whose [spread] varies each of these keys by its value. A factor on the nominal value would round the value.
[[nodiscard]] SceneFile scene_that_varies(SceneFile file, const std::vector<std::string>& keys);

}  // namespace softland
