#include "exchange/preamble.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <iterator>

#include "base/choice.h"
#include "base/trimmed.h"
#include "exchange/cells.h"

namespace softland::internal {
namespace {

enum class Says { interval, rate, start, trigger_sample, centre, samples, frequency, period, vertical_scale, high, low };

/// A key of a preamble in lower case, letters and digits alone.
struct KeyRow {
  std::string_view key;
  Says says;
  std::optional<double> Preamble::*member;
};
constexpr std::array known_keys{
    KeyRow{"sampleinterval", Says::interval, &Preamble::interval},
    KeyRow{"samplinginterval", Says::interval, &Preamble::interval},
    KeyRow{"samplingperiod", Says::interval, &Preamble::interval},
    KeyRow{"sampleperiod", Says::interval, &Preamble::interval},
    KeyRow{"sampleperiodinseconds", Says::interval, &Preamble::interval},
    KeyRow{"increment", Says::interval, &Preamble::interval},
    KeyRow{"xincrement", Says::interval, &Preamble::interval},
    KeyRow{"xincr", Says::interval, &Preamble::interval},
    KeyRow{"xinc", Says::interval, &Preamble::interval},
    KeyRow{"timeincrement", Says::interval, &Preamble::interval},
    KeyRow{"deltat", Says::interval, &Preamble::interval},
    KeyRow{"dt", Says::interval, &Preamble::interval},
    KeyRow{"tinc", Says::interval, &Preamble::interval},
    KeyRow{"horizontalinterval", Says::interval, &Preamble::interval},
    KeyRow{"horizinterval", Says::interval, &Preamble::interval},
    KeyRow{"tincr", Says::interval, &Preamble::interval},
    KeyRow{"horizontalresolution", Says::interval, &Preamble::interval},
    KeyRow{"timeinterval", Says::interval, &Preamble::interval},
    KeyRow{"deltax", Says::interval, &Preamble::interval},
    KeyRow{"hresolution", Says::interval, &Preamble::interval},
    KeyRow{"resolution", Says::interval, &Preamble::interval},
    KeyRow{"samplerate", Says::rate, &Preamble::interval},
    KeyRow{"samplingrate", Says::rate, &Preamble::interval},
    KeyRow{"samplefrequency", Says::rate, &Preamble::interval},
    KeyRow{"samplingfrequency", Says::rate, &Preamble::interval},
    KeyRow{"start", Says::start, &Preamble::start},
    KeyRow{"t0", Says::start, &Preamble::start},
    KeyRow{"x0", Says::start, &Preamble::start},
    KeyRow{"hoffset", Says::start, &Preamble::start},
    KeyRow{"xorigin", Says::start, &Preamble::start},
    KeyRow{"xorg", Says::start, &Preamble::start},
    KeyRow{"xzero", Says::start, &Preamble::start},
    KeyRow{"xstart", Says::start, &Preamble::start},
    KeyRow{"tstart", Says::start, &Preamble::start},
    KeyRow{"starttime", Says::start, &Preamble::start},
    KeyRow{"horizontalstart", Says::start, &Preamble::start},
    KeyRow{"triggerpoint", Says::trigger_sample, &Preamble::trigger_sample},
    KeyRow{"zeroindex", Says::trigger_sample, &Preamble::trigger_sample},
    KeyRow{"triggersample", Says::trigger_sample, &Preamble::trigger_sample},
    KeyRow{"horizontalposition", Says::centre, &Preamble::centre},
    KeyRow{"recordlength", Says::samples, &Preamble::samples},
    KeyRow{"memorylength", Says::samples, &Preamble::samples},
    KeyRow{"datalength", Says::samples, &Preamble::samples},
    KeyRow{"datapoints", Says::samples, &Preamble::samples},
    KeyRow{"dots", Says::samples, &Preamble::samples},
    KeyRow{"samples", Says::samples, &Preamble::samples},
    KeyRow{"period", Says::period, &Preamble::period},
    KeyRow{"frequency", Says::frequency, &Preamble::frequency},
    KeyRow{"verticalscale", Says::vertical_scale, &Preamble::vertical_scale},
    KeyRow{"highlevel", Says::high, &Preamble::high},
    KeyRow{"lowlevel", Says::low, &Preamble::low},
};

/// Keys of units.
constexpr std::array<std::string_view, 5> vertical_keys{"verticalunits", "verticalunit", "yunits", "yunit", "vunit"};
constexpr std::array<std::string_view, 5> horizontal_keys{"horizontalunits", "horizontalunit", "xunits", "xunit", "hunit"};

bool names_unit(const std::array<std::string_view, 5>& keys, std::string_view letters) {
  return std::find(keys.begin(), keys.end(), letters) != keys.end();
}

/// A format by words that all stand in its preamble and headings, lower case. The first one that fits is taken.
struct FormatRow {
  std::string_view name;
  Words words;
};
constexpr std::array formats{
    FormatRow{"Digilent WaveForms CSV", {"digilent"}},
    FormatRow{"sigrok CSV", {"libsigrok"}},
    FormatRow{"LeCroy CSV", {"lecroy"}},
    FormatRow{"Keysight arb", {"file format:", "data type:"}},
    FormatRow{"EasyWave CSV", {"xpos", "data length"}},
    FormatRow{"GW Instek CSV", {"memory length", "sampling period"}},
    FormatRow{"SmartScope CSV", {"smartscope"}},
    FormatRow{"Siglent CSV", {"record length,analog"}},
    FormatRow{"Siglent CSV", {"source,", "second,volt"}},
    FormatRow{"Tektronix CSV", {"record length", "sample interval"}},
    FormatRow{"Tektronix CSV", {"sample interval", "horizontal scale"}},
    FormatRow{"Rigol CSV", {"increment"}},
    FormatRow{"Rigol CSV", {"t0", "tinc"}},
    FormatRow{"Keysight CSV", {"xinc", "xorg"}},
    FormatRow{"Keysight CSV", {"x-axis"}},
    FormatRow{"Rigol CSV", {"x,ch"}},
    FormatRow{"Rigol CSV", {"second,volt"}},
    FormatRow{"Rigol CSV", {"rigol"}},
    FormatRow{"Yokogawa CSV", {"hresolution", "hoffset"}},
    FormatRow{"PicoScope CSV", {"channel a"}},
    FormatRow{"Rohde & Schwarz CSV", {"in s", "in v"}},
};

std::string letters_of(std::string_view key) {
  std::string letters;
  for (const char c : key) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0) letters.push_back(static_cast<char>(std::tolower(byte)));
  }
  return letters;
}

}  // namespace

void Preamble::take(std::string_view key, std::string_view value) {
  const Heading heading = heading_of(key);
  const std::string letters = letters_of(heading.unit ? std::string_view(heading.name) : key);
  value = trimmed(value);
  const bool is_vertical = names_unit(vertical_keys, letters);
  if (is_vertical || names_unit(horizontal_keys, letters)) {
    const std::size_t colon = value.rfind(':');
    const std::optional<Unit> unit = unit_of(colon == std::string_view::npos ? value : value.substr(colon + 1));
    std::optional<Unit>& to = is_vertical ? vertical_unit : horizontal_unit;
    if (unit && !to) to = unit;
    return;
  }
  if (letters == "source" && source.empty()) source = value;
  for (const KeyRow& row : known_keys) {
    if (letters != row.key) continue;
    const std::optional<double> number = measured_value(value, heading.unit);
    std::optional<double>& to = this->*row.member;
    if (!number || to) return;
    if (row.says == Says::rate) {
      if (*number > 0) to = 1 / *number;
    } else if (row.says != Says::interval || *number > 0) {
      to = *number;
    }
    return;
  }
}

void Preamble::take_line(std::string_view line, const std::vector<std::string_view>& cells) {
  text += lower_case(line) + "\n";
  std::vector<std::string_view> filled;
  for (const std::string_view cell : cells) {
    const std::size_t equals = cells.size() > 1 ? cell.find('=') : std::string_view::npos;
    if (equals != std::string_view::npos) {
      take(cell.substr(0, equals), cell.substr(equals + 1));
    } else if (!cell.empty()) {
      filled.push_back(cell);
    }
  }
  // Channels in different units: none of them is that of all.
  const bool differs = filled.size() > 2 && letters_of(filled[0]).starts_with("vertical") &&
                       std::any_of(filled.begin() + 2, filled.end(), [&](std::string_view cell) { return cell != filled[1]; });
  if (differs) return;
  if (filled.size() >= 2) {
    for (std::size_t i = 0; i + 1 < filled.size(); i += 2) take(filled[i], filled[i + 1]);
  }
  std::string_view words = trimmed(line);
  while (!words.empty() && std::string_view("#;%*/\" ").find(words.front()) != std::string_view::npos) words.remove_prefix(1);
  if (const std::size_t at = words.find_first_of(":=\t;,"); at != std::string_view::npos)
    take(words.substr(0, at), words.substr(at + 1));
}

bool is_setting(const std::vector<std::string_view>& cells) {
  std::vector<std::string_view> filled;
  std::copy_if(cells.begin(), cells.end(), std::back_inserter(filled), [](std::string_view cell) { return !cell.empty(); });
  if (filled.size() != 2 || !(looks_like_number(filled[1]) || unit_of(filled[1]))) return false;
  const std::string letters = letters_of(filled[0]);
  return names_unit(vertical_keys, letters) || names_unit(horizontal_keys, letters) ||
         std::any_of(known_keys.begin(), known_keys.end(), [&](const KeyRow& row) { return row.key == letters; });
}

std::string_view format_of(std::string_view text) {
  for (const FormatRow& row : formats) {
    const bool fits = std::all_of(row.words.begin(), row.words.end(),
                                  [&](std::string_view word) { return text.find(word) != std::string_view::npos; });
    if (fits) return row.name;
  }
  return "columns";
}

}  // namespace softland::internal
