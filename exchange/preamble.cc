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

enum class Says { interval, rate, start, trigger_sample, centre, samples, frequency, period, level };

/// A key that a preamble (the lines above the numbers) may have, in lower case without blanks and punctuation.
struct KeyRow {
  std::string_view key;
  Says says;
  /// Member of Preamble that the key sets; null for keys about times.
  std::optional<double> Preamble::*member = nullptr;
};
constexpr std::array known_keys{
    KeyRow{"sampleinterval", Says::interval},
    KeyRow{"samplinginterval", Says::interval},
    KeyRow{"samplingperiod", Says::interval},
    KeyRow{"sampleperiod", Says::interval},
    KeyRow{"sampleperiodinseconds", Says::interval},
    KeyRow{"increment", Says::interval},
    KeyRow{"xincrement", Says::interval},
    KeyRow{"xincr", Says::interval},
    KeyRow{"xinc", Says::interval},
    KeyRow{"timeincrement", Says::interval},
    KeyRow{"deltat", Says::interval},
    KeyRow{"dt", Says::interval},
    KeyRow{"tinc", Says::interval},
    KeyRow{"horizontalinterval", Says::interval},
    KeyRow{"horizinterval", Says::interval},
    KeyRow{"tincr", Says::interval},
    KeyRow{"horizontalresolution", Says::interval},
    KeyRow{"timeinterval", Says::interval},
    KeyRow{"deltax", Says::interval},
    KeyRow{"hresolution", Says::interval},
    KeyRow{"resolution", Says::interval},
    KeyRow{"samplerate", Says::rate},
    KeyRow{"samplingrate", Says::rate},
    KeyRow{"samplefrequency", Says::rate},
    KeyRow{"samplingfrequency", Says::rate},
    KeyRow{"start", Says::start},
    KeyRow{"t0", Says::start},
    KeyRow{"x0", Says::start},
    KeyRow{"hoffset", Says::start},
    KeyRow{"xorigin", Says::start},
    KeyRow{"xorg", Says::start},
    KeyRow{"xzero", Says::start},
    KeyRow{"xstart", Says::start},
    KeyRow{"tstart", Says::start},
    KeyRow{"starttime", Says::start},
    KeyRow{"horizontalstart", Says::start},
    KeyRow{"triggerpoint", Says::trigger_sample},
    KeyRow{"zeroindex", Says::trigger_sample},
    KeyRow{"triggersample", Says::trigger_sample},
    KeyRow{"horizontalposition", Says::centre},
    KeyRow{"recordlength", Says::samples},
    KeyRow{"memorylength", Says::samples},
    KeyRow{"datalength", Says::samples},
    KeyRow{"datapoints", Says::samples},
    KeyRow{"numberofdatapoints", Says::samples},
    KeyRow{"dots", Says::samples},
    KeyRow{"samples", Says::samples},
    KeyRow{"period", Says::period},
    KeyRow{"frequency", Says::frequency},
    KeyRow{"verticalscale", Says::level, &Preamble::vertical_scale},
    KeyRow{"highlevel", Says::level, &Preamble::high},
    KeyRow{"lowlevel", Says::level, &Preamble::low},
};

/// Keys of a preamble whose value is a unit: vertical_keys for that of the voltages, horizontal_keys for that of the times.
constexpr Words vertical_keys{"verticalunits", "verticalunit", "yunits", "yunit", "vunit", "yaxisunits", "yaxisunit"};
constexpr Words horizontal_keys{"horizontalunits", "horizontalunit", "xunits",       "xunit",      "hunit",    "timeunits",
                                "timeunit",        "timebaseunits",  "timebaseunit", "xaxisunits", "xaxisunit"};

/// A file format, and the words in lower case by which its preamble and headings are recognised. If several rows match, the
/// first is used.
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
    FormatRow{"Rigol CSV", {"posorig", "trigger mode"}},
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

// Returns the statement about the times that a key makes with this number: a sampling rate of 1 MHz states an interval of 1 us.
// `says` is the meaning of the key. Returns none if the unit of the number does not fit the key.
std::optional<TimeClaim> claim_of(Says says, const Measured& number) {
  using Of = TimeClaim::Of;
  const bool is_rate = says == Says::rate || says == Says::frequency;
  const bool is_count = says == Says::samples || says == Says::trigger_sample;
  const Measure due = is_rate ? Measure::frequency : is_count ? Measure::samples : Measure::time;
  if (number.unit && number.unit->measure != due) return std::nullopt;
  TimeClaim claim{.value = number.si(), .has_unit = number.unit.has_value() || is_rate};
  if (is_rate || says == Says::interval || says == Says::period) {
    if (!(claim.value > 0)) return std::nullopt;
    if (is_rate) claim.value = 1 / claim.value;
    claim.of = says == Says::period || says == Says::frequency ? Of::period : Of::interval;
  } else {
    claim.of = says == Says::start            ? Of::start
               : says == Says::trigger_sample ? Of::trigger_sample
               : says == Says::centre         ? Of::centre
                                              : Of::samples;
  }
  return claim;
}

}  // namespace

const TimeClaim* Preamble::first(TimeClaim::Of of) const {
  const auto found = std::find_if(claims.begin(), claims.end(), [&](const TimeClaim& claim) { return claim.of == of; });
  return found == claims.end() ? nullptr : &*found;
}

bool Preamble::take(std::string_view key, std::string_view value) {
  key = trimmed(key);
  while (key.ends_with('=') || key.ends_with(':')) key = trimmed(key.substr(0, key.size() - 1));
  const Heading heading = heading_of(key);
  const std::string letters = letters_of(heading.unit ? std::string_view(heading.name) : key);
  value = trimmed(value);
  const bool is_vertical = vertical_keys.contain(letters);
  if (is_vertical || horizontal_keys.contain(letters)) {
    const std::size_t colon = value.rfind(':');
    const std::optional<Unit> unit = unit_of(colon == std::string_view::npos ? value : value.substr(colon + 1));
    std::optional<Unit>& to = is_vertical ? vertical_unit : horizontal_unit;
    if (unit && !to) to = unit;
    return unit.has_value();
  }
  if (letters == "source" && source.empty()) source = value;
  const auto row = std::find_if(known_keys.begin(), known_keys.end(), [&](const KeyRow& one) { return one.key == letters; });
  if (row == known_keys.end()) return false;
  const std::optional<Measured> number = measured_value(value, heading.unit);
  if (!number) return false;
  if (row->says == Says::level) {
    if (!(this->*row->member)) this->*row->member = number->si();
  } else if (std::optional<TimeClaim> claim = claim_of(row->says, *number)) {
    const bool is_known = std::any_of(claims.begin(), claims.end(), [&](const TimeClaim& one) {
      return one.of == claim->of && one.value == claim->value && one.has_unit == claim->has_unit;
    });
    claim->key = key;
    if (!is_known) claims.push_back(std::move(*claim));
  }
  return true;
}

void Preamble::take_line(std::string_view line, const std::vector<std::string_view>& cells) {
  text += lower_case(line) + "\n";
  bool is_taken = false;
  std::vector<std::string_view> filled;
  for (const std::string_view cell : cells) {
    const std::size_t equals = cells.size() > 1 ? cell.find('=') : std::string_view::npos;
    if (equals != std::string_view::npos && equals + 1 < cell.size()) {
      is_taken |= take(cell.substr(0, equals), cell.substr(equals + 1));
    } else if (!cell.empty()) {
      filled.push_back(cell);
    }
  }
  // A line such as "Vertical Units,V,A" gives channels different units, so it does not set a common unit.
  const bool differs = filled.size() > 2 && letters_of(filled[0]).starts_with("vertical") &&
                       std::any_of(filled.begin() + 2, filled.end(), [&](std::string_view cell) { return cell != filled[1]; });
  if (differs) return;
  if (filled.size() >= 2) {
    for (std::size_t i = 0; i + 1 < filled.size(); i += 2) is_taken |= take(filled[i], filled[i + 1]);
  }
  if (is_taken) return;
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
  return vertical_keys.contain(letters) || horizontal_keys.contain(letters) ||
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
