// Verb `device`: a simulated device for practising the verb `tune`. It answers shots (the voltages for one closing) as a device
// in a laboratory does.
#include "verbs/device.h"

#include <fmt/format.h>
#include <unistd.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/exit_status.h"
#include "apps/line_reader.h"
#include "apps/scenes.h"
#include "apps/streams.h"
#include "apps/verbs/verbs.h"
#include "base/require.h"
#include "base/trimmed.h"
#include "reports/tuning_lines.h"
#include "studies/inverse/practice_device.h"

namespace softland::apps {
namespace {

using nlohmann::json;

// Closes the simulated device under the voltages of a shot, one JSON line. Returns the times at which its contact closes and
// opens as JSON, or a message if the line is invalid.
json answer(const PracticeDevice& device, const json& line) {
  try {
    const CommandedShot shot = read_shot(line);
    return record_json(
        shot.number,
        device.close(static_cast<std::uint64_t>(shot.number), shot.waveforms(device.nominal()), shot.duration()).record);
  } catch (const InvalidInput& error) {
    return {{"shot", line.value("shot", json())}, {"error", error.what()}};
  }
}

}  // namespace

int run_device(const Common& c, const verbs::Arguments& arguments) {
  const verbs::DeviceRequest request = verbs::device_request(arguments);
  const SceneFile file = load_scene_or_result(c);
  const PracticeDevice device(file, request.options(file));
  LineReader lines(STDIN_FILENO, longest_line);
  for (LineReader::Line line = lines.next(); line.end == LineReader::End::line; line = lines.next()) {
    if (trimmed(line.text).empty()) continue;
    try {
      const json shot = read_line(line.text);
      if (is_end(shot)) break;
      print(line_text(answer(device, shot)));
    } catch (const InvalidInput& error) {
      print(line_text({{"shot", nullptr}, {"error", fmt::format("the line {}", error.what())}}));
    }
  }
  return exit_done;
}

}  // namespace softland::apps
