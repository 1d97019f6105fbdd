#include "waveforms/waveform.h"

#include "config/drives.h"
#include "config/schema/sections.h"

namespace softland::internal {
namespace {

/// Returns the scene keys that may give a parameter of a waveform family: two for an angular frequency, which the key frequency
/// may give instead, otherwise one.
template <class Family>
std::vector<Key> keys_of(const Parameter<Family>& parameter, const std::vector<Dimension>& level, bool factor) {
  Key key = std::holds_alternative<double Family::*>(parameter.member) ? number(parameter.name, level, any, parameter.about)
                                                                       : numbers(parameter.name, level, any, parameter.about);
  key.required = parameter.required;
  key.only_for = {FamilyOf<Family>::name};
  if (parameter.name == "rise_time" && std::is_same_v<Family, Step>) key.words = {steepest_rise};
  const auto take = [&](const Dimension& dimension, Range range, std::string_view fallback) {
    key.dimensions = {dimension};
    key.range = range;
    if (!key.required) key.fallback = key.type == KeyType::quantities ? "[]" : fallback;
  };
  switch (parameter.kind) {
    case ParameterKind::level:
      if (!key.required) key.fallback = factor ? "1.0" : "'0 V'";
      break;
    case ParameterKind::swing:
      if (!factor) key.dimensions.push_back(dimension::none);  // permit a percentage of the voltage level, a plain number
      break;
    case ParameterKind::time:
      take(dimension::time, not_negative, "'0 s'");
      break;
    case ParameterKind::end_time:
      take(dimension::time, positive, {});
      break;
    case ParameterKind::angle:
      take(dimension::angle, any, "'0 rad'");
      break;
    case ParameterKind::ratio:
      take(dimension::none, positive, "1.0");
      break;
    case ParameterKind::angular_frequency: {
      take(dimension::angular_frequency, positive, {});
      Key other = std::move(Key(key)).instead(key.name);
      other.name = frequency_key;
      other.dimensions = {dimension::frequency};
      return {std::move(key).instead(frequency_key), std::move(other)};
    }
  }
  return {std::move(key)};
}

/// Returns the keys used together with `file`, for facts that the file of an instrument lacks.
std::vector<Key> keys_beside_file() {
  Key column{.name = file_keys::column,
             .type = KeyType::integer,
             .range = {.least = 1, .most = 1e6},
             .any_word = true,
             .about = "name or number of the channel in the file; absent: the only channel, or that with the name of the drive"};
  Key time_column = column;
  time_column.name = file_keys::time_column;
  time_column.about = "name or number of the column of times; absent: found by its heading";
  Key interval =
      number(
          file_keys::interval, {dimension::time}, positive,
          "time between rows, instead of the times of the file; uneven: its times as they stand, two rows of one time are a jump")
          .such_as("8 ns");
  interval.words = {file_keys::uneven};
  Key shift = number(file_keys::shift, {dimension::time}, any,
                     "shift added to the times of the file; first: the first row is at t = 0; default 0 s");
  shift.words = {file_keys::first};
  std::vector<Key> keys;
  keys.push_back(std::move(column));
  keys.push_back(std::move(time_column));
  keys.push_back(std::move(interval));
  keys.push_back({.name = file_keys::skip,
                  .type = KeyType::integer,
                  .range = {.least = 0, .most = 1e9},
                  .about = "number of lines at the beginning to skip; default 0"});
  keys.push_back(
      words(file_keys::unit, "V, mV, uV or kV: unit of the channel, if the file names none or a wrong one; absent: V"));
  keys.push_back(
      words(file_keys::time_unit, "s, ms, us, ns or ps: unit of the times, if the file names none or a wrong one; absent: s"));
  keys.push_back(one_of(file_keys::decimal, {".", ","}, "decimal sign; absent: found from the numbers"));
  keys.push_back(number(file_keys::scale, {dimension::none}, any,
                        "volts at the switch per volt of the file, such as the factor of a probe or an amplifier; default 1"));
  keys.push_back(std::move(shift));
  return keys;
}

/// Returns the description of the section [waveform.ENTRY] of the drive `entry`; an empty `entry` means all drives but the
/// dispersion force, which has its own. `level` holds the permitted dimensions of a voltage level.
Section section_of(std::string_view entry, const std::vector<Dimension>& level, std::string_view about) {
  std::vector<std::string_view> names;
  std::vector<Key> keys{one_of("family", {}, "shape of the voltage against time").needed(),
                        number(before_key, level, any,
                               entry.empty() ? "voltage before t = 0, under which the switch is at rest; absent: 0 V"
                                             : "value before t = 0, under which the switch is at rest; absent: 1")};
  keys.push_back(one_of(before_state_key, {open_state, closed_state_word},
                        "initial equilibrium under the values before t = 0; default open"));
  for_each_family([&]<class Family>(const Family&) {
    names.push_back(FamilyOf<Family>::name);
    std::vector<Key> own;
    for (const Parameter<Family>& parameter : FamilyOf<Family>::parameters) {
      for (Key& key : keys_of(parameter, level, !entry.empty())) own.push_back(std::move(key));
    }
    if constexpr (requires { FamilyOf<Family>::from_file; }) {
      Key file =
          words(file_key,
                "file of an instrument or of softland (time_s and a column with the name of the drive), relative to the scene")
              .needed();
      file.only_for = {FamilyOf<Family>::name};
      for (Key& key : own) {
        file.instead_of.push_back(key.name);
        key.instead_of.push_back(file_key);
      }
      own.insert(own.begin(), std::move(file));
      for (Key& key : keys_beside_file()) {
        key.only_for = {FamilyOf<Family>::name};
        own.push_back(std::move(key));
      }
    }
    for (Key& key : own) keys.push_back(std::move(key));
  });
  keys.front().choices = std::move(names);
  return {.name = "waveform", .entry = entry, .is_named = true, .selector = "family", .keys = std::move(keys), .about = about};
}

}  // namespace

Section waveform_section() {
  return section_of({}, drive_voltage, "voltage of an electrode or of the piezo; a drive without one stays at 0 V");
}

Section force_factor_section() {
  return section_of(dispersion_drive, {dimension::none},
                    "factor on the dispersion force, nominally 1; without a waveform it stays 1");
}

}  // namespace softland::internal
