#include "verbs/device.h"

#include <fmt/format.h>

#include <string>

#include "config/told_quantity.h"

namespace softland::verbs {
namespace {

struct DeviceVerb : Usual, DeviceRequest {
  static constexpr auto name = "device", about = "a simulated device that answers as one in a laboratory, to practise on",
                        python = "device", returns = "PracticeDevice";
  static constexpr Takes takes{.json = false};
  static constexpr auto remarks =
      "Reads shots from standard input, one JSON object a line, and answers each by what a laboratory sees of the closing: when\n"
      "the contact closed and opened. Ends at {\"done\":true} or with the input. docs/tune.md has the lines.\n"
      "Examples:\n  softland tune scenes/mem-gold.toml --device \"softland device scenes/mem-gold.toml --seed 7\"\n"
      "  softland device scenes/mem-gold.toml --seed 7 --model \"modes=+1|stiffness=1.1\" < shots.jsonl";
};

// Reads a quantity that may begin with a minus sign.
double signed_quantity(const std::string& option, const std::string& text, const Dimension& due) {
  const bool is_negative = text.starts_with('-');
  const double size = told_quantity(option, text.substr(is_negative ? 1 : 0), due);
  return is_negative ? -size : size;
}

// Reads "1 %/1000": the share by which the volts change in so many shots, or in one.
void read_drift(const std::string& option, const std::string& text, double& drift) {
  const std::size_t stroke = text.find('/');
  const int shots =
      stroke == std::string::npos ? 1 : whole_number<int>(option + " SHARE/", text.substr(stroke + 1), {.least = 1});
  drift = signed_quantity(option, text.substr(0, stroke), dimension::none) / shots;
}

// Reads "1 us" or "-1 us".
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
    model.stiffness = told_quantity(option + " stiffness=", value, dimension::none);
    require_request(model.stiffness > 0, [&] { return fmt::format("{} stiffness={}: must be above 0", option, value); });
  } else if (name.find('.') != std::string::npos && !value.empty()) {
    model.set.push_back(part);
  } else {
    throw InvalidRequest(
        fmt::format("{} {}: '{}' must be modes=+N, gas=NAME, stiffness=FACTOR or a key of the scene with its value, such as "
                    "gap.contact=\"2.05 um\"",
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
  seed_option(a, p.seed, "same device and same errors; the device differs from the scene as [spread] says");
  a.object("errors", "Mapping[str, float | str] | None", "None",
           "one standard deviation of the errors of instruments, by name: edge_error [s], unseen [s], gain_error and shot_error");
  laboratory_options(a, r.laboratory);
  a.as({.type = "float | str | None", .told = "_quantity({}, \"\")"})
      .parsed("drift", p.drift, read_drift, "SHARE/N", "change of all volts in N shots, such as \"1 %/1000\" (default: none)",
              "drift", "float | str | None");
  a.as({.told = "_quantity({}, \"s\")"})
      .parsed("trigger-delay", p.trigger_delay, read_delay, "TIME",
              "by how much its records begin later than the drives, \"-1 us\": earlier (default: 0 s)", "trigger_delay",
              "float | str | None");
  a.program().parsed("model", p.model, read_model, "CHANGES",
                     "what the device has beside its scene: modes=+1, gas=NAME, stiffness=1.1 of the contact, or a key of the "
                     "scene, gap.contact=\"2.05 um\"; several are joined by |",
                     "model", "str");
  a.python().whole("more-modes", p.model.more_modes, {.least = 0}, "modes that the device has beside those of its scene");
  a.python().text("gas", p.model.gas, "", "law of its gas film, where it is not that of its scene");
  a.python().quantity("stiffness", p.model.stiffness, {dimension::none, positive, "a factor above 0"}, "",
                      "factor of the stiffness of its contact (default: 1)");
  a.python()
      .as({.type = "Mapping[str, str] | None"})
      .assignments("set", p.model.set, "", "keys of its scene that differ, {\"gap.contact\": \"2.05 um\"}");
}

}  // namespace

PracticeOptions DeviceRequest::options(const SceneFile& file) const {
  PracticeOptions options = practice;
  options.laboratory = laboratory.errors(file);
  return options;
}

DeviceRequest device_request(const Told& told) { return read_options<DeviceVerb>(told); }

Study device_study() { return described<DeviceVerb>(); }

}  // namespace softland::verbs
