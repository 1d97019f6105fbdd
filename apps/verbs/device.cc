// A simulated device that answers as one in a laboratory does, to practise on.
#include <fmt/format.h>
#include <unistd.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/exit_status.h"
#include "apps/laboratory.h"
#include "apps/line_reader.h"
#include "apps/scenes.h"
#include "apps/streams.h"
#include "apps/values.h"
#include "apps/verbs/verbs.h"
#include "base/require.h"
#include "base/trimmed.h"
#include "reports/tuning_lines.h"
#include "studies/tuning/practice_device.h"

namespace softland::apps {
namespace {

using nlohmann::json;

struct DeviceRequest {
  LaboratoryRequest laboratory;
  std::string drift, model, trigger_delay;
  std::optional<std::string> seed;
};

// "1 %/1000": the share by which the volts change in so many shots, or in one.
double drift_of(const std::string& text) {
  if (text.empty()) return 0;
  const std::size_t stroke = text.find('/'), sign = text.starts_with('-') ? 1 : 0;
  const double share = quantity_of("--drift", text.substr(0, stroke).substr(sign), dimension::none);
  const int shots = stroke == std::string::npos ? 1 : whole_number("--drift SHARE/", text.substr(stroke + 1), 1);
  return (sign == 1 ? -share : share) / shots;
}

// "1 us" or "-1 us".
double trigger_delay_of(const std::string& text) {
  if (text.empty()) return 0;
  const bool is_early = text.starts_with('-');
  const double time = quantity_of("--trigger-delay", text.substr(is_early ? 1 : 0), dimension::time);
  return is_early ? -time : time;
}

void read_model_part(PracticeModel& model, const std::string& part, const std::string& given) {
  const std::size_t sign = part.find('=');
  const std::string name = part.substr(0, sign), value = sign == std::string::npos ? "" : part.substr(sign + 1);
  if (name == "modes" && value.starts_with('+')) {
    model.more_modes = whole_number("--model modes=+", value.substr(1), 1);
  } else if (name == "gas" && !value.empty()) {
    model.gas = value;
  } else if (name == "stiffness" && !value.empty()) {
    model.stiffness = quantity_of("--model stiffness=", value, dimension::none);
    require(model.stiffness > 0, [&] { return fmt::format("--model stiffness={}: must be above 0", value); });
  } else if (name.find('.') != std::string::npos && !value.empty()) {
    model.set.push_back(part);
  } else {
    throw InvalidInput(
        fmt::format("--model {}: '{}' must be modes=+N, gas=NAME, stiffness=FACTOR or a key of the scene with its "
                    "value, such as gap.contact=\"2.05 um\"",
                    visible(given), part));
  }
}

PracticeModel model_of(const std::string& text) {
  PracticeModel model;
  for (std::size_t begin = 0, end = 0; !text.empty() && end != std::string::npos; begin = end + 1) {
    end = text.find('|', begin);
    read_model_part(model, text.substr(begin, end == std::string::npos ? end : end - begin), text);
  }
  return model;
}

// What the device says to a line, and what is wrong with it where it cannot be done.
json answer(const PracticeDevice& device, const json& line) {
  try {
    const ToldShot shot = read_shot(line);
    return record_json(
        shot.number,
        device.close(static_cast<std::uint64_t>(shot.number), shot.waveforms(device.nominal()), shot.duration()).record);
  } catch (const InvalidInput& error) {
    return {{"shot", line.value("shot", json())}, {"error", error.what()}};
  }
}

int device_verb(const Common& c, const DeviceRequest& request) {
  const SceneFile file = load_scene_or_result(c);
  PracticeOptions options{.laboratory = laboratory_errors(request.laboratory, file),
                          .drift = drift_of(request.drift),
                          .trigger_delay = trigger_delay_of(request.trigger_delay),
                          .model = model_of(request.model)};
  options.seed = seed_of(request.seed, options.seed);
  const PracticeDevice device(file, options);
  LineReader lines(STDIN_FILENO, longest_line);
  for (LineReader::Line line = lines.next(); line.end == LineReader::End::line; line = lines.next()) {
    if (trimmed(line.text).empty()) continue;
    try {
      const json told = read_line(line.text);
      if (is_end(told)) break;
      print(line_text(answer(device, told)));
    } catch (const InvalidInput& error) {
      print(line_text({{"shot", nullptr}, {"error", fmt::format("the line {}", error.what())}}));
    }
  }
  return exit_done;
}

}  // namespace

void add_device(Verb& verb) {
  const auto request = std::make_shared<DeviceRequest>();
  verb.with_scene(true, true);
  verb.with_seed(request->seed, "same device and same errors; the device differs from the scene as [spread] says");
  with_laboratory(verb, request->laboratory);
  verb.option("--drift", request->drift, "SHARE/N", "change of all volts in N shots, such as \"1 %/1000\" (default: none)");
  verb.option("--trigger-delay", request->trigger_delay, "TIME",
              "by how much its records begin later than the drives, \"-1 us\": earlier (default: 0 s)");
  verb.option("--model", request->model, "CHANGES",
              "what the device has beside its scene: modes=+1, gas=NAME, stiffness=1.1 of the contact, or a key of the scene, "
              "gap.contact=\"2.05 um\"; several are joined by |");
  verb.footer(
      "Reads shots from standard input, one JSON object a line, and answers each by what a laboratory sees of the closing: when\n"
      "the contact closed and opened. Ends at {\"done\":true} or with the input. docs/tune.md has the lines.\n"
      "Examples:\n  softland tune scenes/mem-gold.toml --device \"softland device scenes/mem-gold.toml --seed 7\"\n"
      "  softland device scenes/mem-gold.toml --seed 7 --model \"modes=+1|stiffness=1.1\" < shots.jsonl");
  verb.runs([request](const Common& common) { return device_verb(common, *request); });
}

}  // namespace softland::apps
