// Functions that make the descriptions of sections and keys of a scene. Every section of a scene has a file in this folder.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include "base/choice.h"
#include "config/scene.h"
#include "config/schema.h"

namespace softland::internal {

// Ranges of a key's values. If a range leaves an end open, the dimension of the key determines that end.
inline constexpr Range any{};
inline constexpr Range not_negative{.least = 0};
inline constexpr Range small_error{.least = 0, .most = 0.1, .least_open = true};

/// Permitted dimensions of an electrode's voltages, which may be multiples of its pull-in voltages.
inline const std::vector<Dimension> drive_voltage{dimension::voltage, dimension::static_pull_in, dimension::dynamic_pull_in};

/// Returns a key for a number; the caller sets Key::bound, the access to the member of the scene, or reads the value itself.
[[nodiscard]] inline Key number(std::string_view name, std::vector<Dimension> dimensions, Range range, std::string_view about) {
  return {.name = name, .dimensions = std::move(dimensions), .range = range, .about = about};
}
[[nodiscard]] inline Key numbers(std::string_view name, std::vector<Dimension> dimensions, Range range, std::string_view about) {
  Key key = number(name, std::move(dimensions), range, about);
  key.type = KeyType::quantities;
  return key;
}
[[nodiscard]] inline Key words(std::string_view name, std::string_view about) {
  return {.name = name, .type = KeyType::text, .about = about};
}
[[nodiscard]] inline Key one_of(std::string_view name, std::vector<std::string_view> choices, std::string_view about) {
  return {.name = name, .type = KeyType::choice, .choices = std::move(choices), .about = about};
}

/// Makes keys that set members of one part of a scene. part(scene, index) returns this part, for example the Electrode& of this
/// index.
template <auto part>
struct Of {
  template <auto member>
  [[nodiscard]] static Key number(std::string_view name, const Dimension& dimension, Range range, std::string_view about) {
    Key key = internal::number(name, {dimension}, range, about);
    key.bound.number = [](Scene& scene, std::size_t entry) -> double& { return part(scene, entry).*member; };
    return key;
  }
  /// Returns a key for begin and end of a part of the beam, such as a layer: lengths, percentages of the beam's length, or the
  /// word "tip".
  template <auto first, auto last>
  [[nodiscard]] static Key span(std::string_view name, std::string_view about) {
    Key key = internal::numbers(name, {dimension::length, dimension::none}, not_negative, about);
    key.count = 2;
    key.words = {tip};
    key.bound.place = [](Scene& scene, std::size_t entry, std::size_t element) -> Place& {
      return element == 0 ? part(scene, entry).*first : part(scene, entry).*last;
    };
    return key;
  }
  /// Returns a key for the begin and the end of each pad of an electrode; pads after the first are in the list `further`.
  template <auto first, auto last, auto further>
  [[nodiscard]] static Key spans(std::string_view name, std::string_view about) {
    Key key = span<first, last>(name, about);
    key.is_nested = true;
    key.bound.place = [](Scene& scene, std::size_t entry, std::size_t element) -> Place& {
      if (element < 2) return element == 0 ? part(scene, entry).*first : part(scene, entry).*last;
      std::vector<Span>& pads = part(scene, entry).*further;
      pads.resize(std::max(pads.size(), element / 2));
      Span& pad = pads[element / 2 - 1];
      return element % 2 == 0 ? pad.begin : pad.end;
    };
    return key;
  }
  template <auto member>
  [[nodiscard]] static Key flag(std::string_view name, std::string_view about) {
    return {.name = name, .type = KeyType::flag, .about = about, .bound = {.flag = [](Scene& scene, std::size_t entry) -> bool& {
                                                                   return part(scene, entry).*member;
                                                                 }}};
  }
  /// Returns a key whose value is one of the names in the table `rows`.
  template <const auto& rows, auto member>
  [[nodiscard]] static Key choice(std::string_view name, std::string_view about) {
    Key key = one_of(name, names_of(rows), about);
    key.bound.choose = [](Scene& scene, std::size_t entry, std::string_view chosen) {
      part(scene, entry).*member = find_named(rows, chosen)->value;
    };
    return key;
  }
};

/// Returns the keys of a beam's sections, layers and anchors.
[[nodiscard]] std::vector<Key> beam_part_keys();
inline constexpr std::string_view dielectric_advice =
    "'dielectric' describes an insulator on the electrode: dielectric = { thickness = \"0.2 um\", permittivity = 7.6 }";
/// Returns advice for unknown keys of [structure] about sections, layers, anchors and rest shape.
[[nodiscard]] std::vector<Advice> part_advice();

[[nodiscard]] Section title_section();
[[nodiscard]] Section structure_section();
[[nodiscard]] Section gap_section();
[[nodiscard]] Section electrode_section();
[[nodiscard]] Section gas_section();
[[nodiscard]] Section contact_section();
[[nodiscard]] Section piezo_section();
[[nodiscard]] Section dispersion_section();
[[nodiscard]] Section surface_section();
/// Returns the section [waveform.NAME] of a drive other than the dispersion force, whose section is different.
[[nodiscard]] Section waveform_section();
[[nodiscard]] Section force_factor_section();
[[nodiscard]] Section calibration_section();
[[nodiscard]] Section driver_section();
[[nodiscard]] Section simulate_section();
[[nodiscard]] Section load_section();
[[nodiscard]] Section metrics_section();
[[nodiscard]] Section spread_section();

}  // namespace softland::internal
