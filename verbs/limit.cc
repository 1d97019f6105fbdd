// Verb `limit`: computes the least time in which a waveform closes the switch at a permitted impact velocity.
#include "studies/search/limit.h"

#include <memory>
#include <optional>
#include <string>

#include "reports/limit_report.h"
#include "reports/record_file.h"
#include "studies/closing/sent_signals.h"
#include "verbs/study.h"
#include "waveforms/export.h"

namespace softland::verbs {
namespace {

Outcome shown(LimitRecord found) {
  const auto record = std::make_shared<const LimitRecord>(std::move(found));
  Outcome outcome{.json = without_curves(json_of(*record)), .text = text_of(*record)};
  outcome.files = {{"limit.json", [record] { return json_text(json_of(*record), 1) + "\n"; }, "limit.json"},
                   {"attempts.csv", [record] { return attempts_csv(*record); }, "attempts.csv (log of the searches)"}};
  if (record->landed || !record->landing)
    outcome.files.push_back({"limit.svg", [record] { return svg_of(*record); }, "limit.svg"});
  return outcome;
}

struct LimitRequest : Usual {
  static constexpr bool is_explorable = true;
  static constexpr auto name = "limit", about = "compute the least time in which a waveform can close the switch softly",
                        python = "limit",
                        leaves =
                            "folder for limit.json, limit.svg, attempts.csv (the log) and the landing as best.toml and best.csv";
  static constexpr auto remarks =
      "The least time is that of the best waveform of any shape within the limits of [driver.*], found by direct collocation.\n"
      "The optimum is a local one, for these voltage limits and this impact velocity in the model of the scene.\n"
      "A beam with more modes may touch a little earlier (--set structure.modes=6). The reported landing is simulated. It may\n"
      "take longer than the least time if a beam must also come to rest. Without --impact-velocity, landings at three and ten\n"
      "times the permitted velocity are tried, too.\n"
      "Examples:\n  softland limit scenes/mem-gold.toml\n"
      "  softland limit scenes/mem-gold-pzt.toml --actuator both --impact-velocity \"1 mm/s\" --out limit\n"
      "  softland limit scenes/mem-gold-pzt.toml --actuator pzt --start softland-out --no-curves";
  static std::vector<std::string> files() { return {"limit.json", "limit.svg", "attempts.csv", "best.toml", "best.csv"}; }
  static Outcome shown_again(const nlohmann::json& json) { return shown(read_limit(json)); }

  LimitOptions options;
  std::optional<std::string> start;
};

template <class Archive>
void options(Archive& a, LimitRequest& r) {
  a.choice("actuator", r.options.actuator, actuators, "drives that may be shaped");
  a.quantity("impact-velocity", r.options.impact_velocity,
             {dimension::velocity, positive, "a velocity above 0 m/s, such as \"1 mm/s\""}, "SPEED",
             "largest permitted impact velocity at first touch, such as \"1 mm/s\" (default: 1/100 of that of the plain step)");
  a.file("start", r.start,
         "scene or result whose waveform is an additional starting point, for a switch that does not close in one swing");
  a.unless("no-curves", r.options.curves,
           "omit the curves of least time against peak voltage and against permitted impact velocity");
}

Outcome run(const Setting& setting, const LimitRequest& request) {
  LimitOptions options = request.options;
  if (request.start) {
    const Drives drives = prepare(setting.load(*request.start), false, {.stop = setting.progress.stop}).drives;
    options.start = drives.waveforms();
    options.before = drives.before();
  }
  const auto found = std::make_shared<const Limit>(limit(setting.scene, options, setting.progress));
  Outcome outcome = shown(record_of(*found, setting.command));
  if (found->landing) {
    outcome.files.push_back({"best.toml", [found] { return found->landing->scene.scene.file.text(); },
                             "best.toml (run it with `softland simulate`)"});
    outcome.files.push_back({"best.csv", [found] { return commanded_csv(found->landing->scene); }, "best.csv"});
  }
  const Status status = found->touch.status;
  outcome.ending = found->interrupted             ? Ending::interrupted
                   : status == Status::no_contact ? Ending::no_success
                   : status == Status::done       ? Ending::done
                                                  : Ending::numerical_failure;
  return outcome;
}

}  // namespace

Study limit_study() { return study_of<LimitRequest>(); }

}  // namespace softland::verbs
