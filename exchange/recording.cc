#include "exchange/recording.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "base/engineering.h"
#include "base/printable.h"
#include "base/read_file.h"
#include "base/require.h"
#include "exchange/decoding.h"
#include "exchange/parsers.h"

namespace softland {

std::string Recording::place(std::size_t row) const { return row < lines.size() ? fmt::format("{}:{}", file, lines[row]) : file; }

Recording read_recording(const std::string& file, const ReadKeys& keys) { return parse_recording(read_file(file), file, keys); }

Recording parse_recording(std::string_view content, const std::string& file, const ReadKeys& keys) {
  require(!content.empty(), [&] { return file + ": the file is empty"; });
  if (internal::is_uff(content)) return internal::read_uff(content, file);
  std::string storage;
  std::vector<std::string> left_out;
  const std::string_view text = internal::decoded(content, storage, left_out);
  const std::string kind = internal::refused_kind(text);
  require(kind.empty(), [&] { return fmt::format("{}: {}; a record over time is due", file, kind); });
  require(!internal::is_binary(text), [&] {
    return file + ": binary data; what is read are exports as text, and data sets 58b of the Universal File Format";
  });
  Recording made =
      internal::is_spice_pwl(text) ? internal::read_spice_pwl(text, file, keys) : internal::read_columns(text, file, keys);
  made.left_out.insert(made.left_out.begin(), left_out.begin(), left_out.end());
  return made;
}

TimeAxis time_axis(const Recording& recording) {
  TimeAxis axis;
  const std::vector<double>& t = recording.times;
  if (t.empty()) return axis;
  axis.first = t.front();
  axis.last = t.back();
  for (std::size_t i = 1; i < t.size(); ++i) {
    axis.repeated += t[i] == t[i - 1];
    if (t[i] < t[i - 1] && !axis.back) axis.back = i;
  }
  if (recording.interval) {
    axis.interval = *recording.interval;
  } else if (t.size() > 1) {
    axis.interval = (axis.last - axis.first) / static_cast<double>(t.size() - 1);
  }
  return axis;
}

std::string summary(const Recording& recording) {
  constexpr int digits = 6;
  const TimeAxis axis = time_axis(recording);
  std::vector<std::string> names;
  for (const Channel& channel : recording.channels) {
    names.push_back(printable_line(channel.name));
    if (!channel.unit.empty()) names.back() += " [" + channel.unit + "]";
  }
  std::string text = fmt::format("{}: {}, {} samples", recording.format, fmt::join(names, ", "), recording.rows());
  if (recording.times.empty()) {
    text += ", no times";
  } else {
    text += fmt::format(", every {}, from {} to {}", engineering(axis.interval, "s", digits),
                        engineering(axis.first, "s", digits), engineering(axis.last, "s", digits));
  }
  for (const std::string& note : recording.notes) text += "; " + note;
  for (const std::string& what : recording.left_out) text += "; left out: " + what;
  return text;
}

}  // namespace softland
