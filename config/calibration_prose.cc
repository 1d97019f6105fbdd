#include "config/calibration_prose.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>

#include "base/choice.h"
#include "base/require.h"
#include "base/split.h"

namespace softland {

void set_calibration(SceneFile& file, const std::string& words) {
  if (words.empty()) return;
  file.erase("calibration");
  if (words == "none") return;
  constexpr std::string_view before = " in ", after = " classes";
  const std::size_t in = words.ends_with(after) ? words.rfind(before) : std::string::npos;
  std::set<std::string> seen;
  for (const std::string& one : split(words.substr(0, in), ',')) {
    const std::size_t colon = one.find(':');
    const std::string name = one.substr(0, colon), error = colon != std::string::npos ? one.substr(colon + 1)
                                                           : name == measured_time    ? "0 s"
                                                                                      : "0 %";
    require_field(std::ranges::find(measurement_names, name) != measurement_names.end(), "calibrate", words, [&] {
      return fmt::format("unknown measurement '{}'; choose from {}, with an error such as {}:1 % or {}:50 ns", name,
                         in_words(measurement_names), measured_pull_in, measured_time);
    });
    require_field(seen.insert(name).second, "calibrate", words,
                  [&] { return fmt::format("{} is given twice; give it once", name); });
    file.set(fmt::format("calibration.{}.error=\"{}\"", name, error));
  }
  if (in == std::string::npos) return;
  const std::size_t number = in + before.size();
  file.set("calibration.classes=" + words.substr(number, words.size() - after.size() - number));
}

}  // namespace softland
