#include "verbs/device.h"

#include <fmt/format.h>

#include <string>

#include "config/quantity_argument.h"

namespace softland::verbs {
namespace {

struct DeviceVerb : Usual, DeviceRequest {
  static constexpr auto name = "device", about = "simulate a device in a laboratory, to practise tuning on", python = "device",
                        returns = "PracticeDevice";
  static constexpr Takes takes{.json = false};
  static constexpr auto remarks =
      "Reads shots from standard input, one JSON object a line. "
      "The answer to each shot holds what a laboratory records of the\n"
      "closing: the times at which the contact closed and opened. "
      "The verb ends at {\"done\":true} or at the end of the input.\n"
      "docs/tune.md describes the lines.\n"
      "Examples:\n  softland tune scenes/mem-gold.toml --device \"softland device scenes/mem-gold.toml --seed 7\"\n"
      "  softland device scenes/mem-gold.toml --seed 7 --model \"modes=+1|stiffness=1.1\" < shots.jsonl";
};

// Reads a quantity that may begin with a minus sign.
double signed_quantity(const std::string& option, const std::string& text, const Dimension& due) {
  const bool is_negative = text.starts_with('-');
  const double size = quantity_argument(option, text.substr(is_negative ? 1 : 0), due);
  return is_negative ? -size : size;
}

// Reads the drift of all voltages: "1 %/1000" is a change by 1 % in 1000 shots (closings), "1 %" the change in one shot.
void read_drift(const std::string& option, const std::string& text, double& drift) {
  const std::size_t stroke = text.find('/');
  const int shots =
      stroke == std::string::npos ? 1 : whole_number<int>(option + " SHARE/", text.substr(stroke + 1), {.least = 1});
  drift = signed_quantity(option, text.substr(0, stroke), dimension::none) / shots;
}

// Reads the delay of contact records, which may be negative: "1 us" or "-1 us".
void read_delay(const std::string& option, const std::string& text, double& delay) {
  delay = signed_quantity(option, text, dimension::time);
}

void read_model_part(const std::string& option, PracticeModel& model, const std::string& part, const std::string& given) {
  const std::size_t sign = part.find('=');
  const std::string name = part.substr(0, sign), value = sign == std::string::npos ? "" : part.substr(sign + 1);
  if (name == "modes" && value.starts_with('+')) {
    model.more_modes = whole_number<int>(option + " modes=+", value.substr(1), {.least = 1});
  } else if (name == "gas" && !value.empty()) {
    model.gas = value;
  } else if (name == "stiffness" && !value.empty()) {
    model.stiffness = quantity_argument(option + " stiffness=", value, dimension::none);
    require_request(model.stiffness > 0, [&] { return fmt::format("{} stiffness={}: must be above 0", option, value); });
  } else if (name.find('.') != std::string::npos && !value.empty()) {
    model.set.push_back(part);
  } else {
    throw InvalidRequest(
        fmt::format("{} {}: '{}' must be modes=+N, gas=NAME, stiffness=FACTOR or a key of the scene with its value, "
                    "such as gap.contact=\"2.05 um\"",
                    option, visible(given), part));
  }
}

void read_model(const std::string& option, const std::string& text, PracticeModel& model) {
  for (std::size_t begin = 0, end = 0; end != std::string::npos; begin = end + 1) {
    end = text.find('|', begin);
    read_model_part(option, model, text.substr(begin, end == std::string::npos ? end : end - begin), text);
  }
}

template <class Archive>
void options(Archive& a, DeviceVerb& r) {
  PracticeOptions& p = r.practice;
  seed_option(a, p.seed, "the same device with the same errors; the device is drawn from [spread]");
  a.object(
      "errors", "Mapping[str, float | str] | None", "None",
      "standard deviations of the errors of the instruments, by name: edge_error [s], unseen [s], gain_error and shot_error");
  laboratory_options(a, r.laboratory);
  a.as({.type = "float | str | None", .conversion = "_quantity({}, \"\")"})
      .parsed("drift", p.drift, read_drift, "SHARE/N",
              "relative change of all voltages in N shots, such as \"1 %/1000\" (default: none)", "drift", "float | str | None");
  a.as({.conversion = "_quantity({}, \"s\")"})
      .parsed("trigger-delay", p.trigger_delay, read_delay, "TIME",
              "delay of the records behind the drives; negative if records begin earlier, such as \"-1 us\" (default: 0 s)",
              "trigger_delay", "float | str | None");
  a.program().parsed(
      "model", p.model, read_model, "CHANGES",
      "differences of the device from its scene: modes=+1, gas=NAME, stiffness=1.1 (factor on the contact stiffness), "
      "or a key of the scene such as gap.contact=\"2.05 um\"; several differences are joined by |",
      "model", "str");
  a.python().whole("more-modes", p.model.more_modes, {.least = 0},
                   "number of modes that the device has in addition to those of its scene");
  a.python().text("gas", p.model.gas, "", "gas law of the device, if not that of its scene");
  a.python().quantity("stiffness", p.model.stiffness, {dimension::none, positive, "a factor above 0"}, "",
                      "factor on the contact stiffness of the device (default: 1)");
  a.python()
      .as({.type = "Mapping[str, str] | None"})
      .assignments("set", p.model.set, "",
                   "keys in which the device differs from its scene, such as {\"gap.contact\": \"2.05 um\"}");
}

}  // namespace

PracticeOptions DeviceRequest::options(const SceneFile& file) const {
  PracticeOptions options = practice;
  options.laboratory = laboratory.errors(file);
  return options;
}

DeviceRequest device_request(const Arguments& arguments) { return read_options<DeviceVerb>(arguments); }

Study device_study() { return described<DeviceVerb>(); }

}  // namespace softland::verbs
