#include "exchange/recording.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/engineering.h"
#include "base/printable.h"
#include "base/read_file.h"
#include "base/require.h"
#include "exchange/decoding.h"
#include "exchange/parsers.h"

namespace softland {
namespace {

std::string names_of(const Recording& recording) {
  std::string names;
  for (const Channel& channel : recording.channels)
    names += fmt::format("{}\"{}\" ({})", names.empty() ? "" : ", ", printable_line(channel.name), channel.column);
  return names;
}

/// Replaces the times of the rows by evenly spaced ones. They begin at the first time of the file, or at 0 if it has no times.
void take_even_times(Recording& made, double interval) {
  const double first = made.times.empty() ? 0 : made.times.front();
  made.interval = interval;
  made.times.resize(made.rows());
  for (std::size_t i = 0; i < made.times.size(); ++i) made.times[i] = first + static_cast<double>(i) * interval;
}

}  // namespace

std::string Recording::place(std::size_t row) const { return row < lines.size() ? fmt::format("{}:{}", file, lines[row]) : file; }

Recording read_recording(const std::string& file, const ReadKeys& keys) { return parse_recording(read_file(file), file, keys); }

Recording parse_recording(std::string_view content, const std::string& file, const ReadKeys& keys) {
  require(!content.empty(), [&] { return file + ": the file is empty"; });
  if (internal::is_uff(content)) {
    Recording made = internal::read_uff(content, file, keys);
    if (keys.interval) take_even_times(made, *keys.interval);
    return made;
  }
  std::string storage;
  std::vector<std::string> left_out;
  const std::string_view text = internal::decoded(content, storage, left_out);
  const std::string kind = internal::refused_kind(text);
  require(kind.empty(), [&] { return fmt::format("{}: the file holds {}; give a record over time", file, kind); });
  require(!internal::is_binary(text),
          [&] { return file + ": binary data; export the file as text, or as data set 58b of the Universal File Format"; });
  Recording made = internal::is_vcd(text)         ? internal::read_vcd(text, file, keys)
                   : internal::is_spice_pwl(text) ? internal::read_spice_pwl(text, file, keys)
                                                  : internal::read_columns(text, file, keys);
  made.left_out.insert(made.left_out.begin(), left_out.begin(), left_out.end());
  if (keys.interval) take_even_times(made, *keys.interval);
  return made;
}

const Channel& channel_of(const Recording& recording, const ReadKeys& keys, const std::string& usual) {
  const auto named = [&](const std::string& name) -> const Channel* {
    const Channel* found = nullptr;
    for (const Channel& channel : recording.channels) {
      if (channel.name != name && channel.heading != name) continue;
      require(found == nullptr, [&] {
        return fmt::format("{}: two channels are called \"{}\"; select one by its number, such as column = {}", recording.file,
                           printable_line(name), channel.column);
      });
      found = &channel;
    }
    return found;
  };
  if (keys.column_number > 0) {
    for (const Channel& channel : recording.channels) {
      if (channel.column == keys.column_number) return channel;
    }
    throw InvalidInput(fmt::format("{}: column = {}: must be the number of a channel; there are {}", recording.file,
                                   keys.column_number, names_of(recording)));
  }
  if (!keys.column.empty()) {
    const Channel* const found = named(keys.column);
    require(found != nullptr || recording.format == "SPICE PWL", [&] {
      return fmt::format("{}: column = \"{}\": must be the name of a channel; there are {}", recording.file,
                         printable_line(keys.column), names_of(recording));
    });
    if (found != nullptr) return *found;
  }
  if (recording.channels.size() == 1) return recording.channels.front();
  const Channel* const found = named(usual);
  require(found != nullptr, [&] {
    return fmt::format("{}: the file has {} channels, {}; select one, such as column = \"{}\"", recording.file,
                       recording.channels.size(), names_of(recording), printable_line(recording.channels.front().name));
  });
  return *found;
}

TimeAxis time_axis(const std::vector<double>& t, std::optional<double> stated_interval) {
  TimeAxis axis;
  if (t.empty()) return axis;
  axis.first = t.front();
  axis.last = t.back();
  for (std::size_t i = 1; i < t.size(); ++i) {
    axis.repeated += t[i] == t[i - 1];
    axis.least_interval = std::min(axis.least_interval, t[i] - t[i - 1]);
    axis.greatest_interval = std::max(axis.greatest_interval, t[i] - t[i - 1]);
    if (t[i] < t[i - 1] && !axis.back) axis.back = i;
  }
  if (stated_interval) {
    axis.interval = *stated_interval;
  } else if (t.size() > 1) {
    axis.interval = (axis.last - axis.first) / static_cast<double>(t.size() - 1);
  }
  return axis;
}

TimeAxis time_axis(const Recording& recording) { return time_axis(recording.times, recording.interval); }

std::string times_prose(const TimeAxis& axis) {
  constexpr double rounding = 1e-3;  // largest difference of intervals by rounded times, relative to the interval
  const auto seconds = [](double time) { return engineering(time, "s", 6); };
  if (axis.greatest_interval < axis.least_interval) return "at " + seconds(axis.first);  // one row has no interval
  const bool differ = axis.greatest_interval - axis.least_interval > rounding * std::abs(axis.interval);
  return fmt::format("{}, from {} to {}",
                     differ
                         ? fmt::format("at intervals of {} to {}", seconds(axis.least_interval), seconds(axis.greatest_interval))
                         : "every " + seconds(axis.interval),
                     seconds(axis.first), seconds(axis.last));
}

std::string summary(const Recording& recording) {
  std::vector<std::string> names;
  for (const Channel& channel : recording.channels) {
    names.push_back(printable_line(channel.name));
    if (!channel.unit.empty()) names.back() += " [" + channel.unit + "]";
  }
  const bool is_one = recording.rows() == 1;
  std::string text =
      fmt::format("{}: {}, {} {}", recording.format, fmt::join(names, ", "), recording.rows(), is_one ? "sample" : "samples");
  text += ", " + (recording.times.empty() ? "no times" : times_prose(time_axis(recording)));
  for (const std::string& note : recording.notes) text += "; " + note;
  for (const std::string& what : recording.left_out) text += "; left out: " + what;
  return text;
}

}  // namespace softland
