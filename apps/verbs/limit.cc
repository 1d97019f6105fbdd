// The limit of what any drive waveform can do.
#include "studies/search/limit.h"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/exit_status.h"
#include "apps/output.h"
#include "apps/progress.h"
#include "apps/scenes.h"
#include "apps/values.h"
#include "apps/verbs/verbs.h"
#include "base/require.h"
#include "base/shell_word.h"
#include "config/units.h"
#include "reports/limit_report.h"
#include "studies/closing/sent_signals.h"
#include "waveforms/export.h"

namespace softland::apps {
namespace {

struct LimitRequest {
  std::string actuator = "electrostatic";
  std::optional<std::string> impact_velocity;  ///< default: a hundredth of the plain step's
  std::optional<std::string> start;
  bool no_curves = false;
};

double speed_of(const std::string& text) {
  const auto rule = [&](bool ok) {
    require(ok, fmt::format("--impact-velocity {}: must be a speed above 0 m/s such as \"1 mm/s\"", visible(text)));
  };
  Quantity q;
  try {
    q = parse_quantity(text);
  } catch (const InvalidInput&) {
    rule(false);
  }
  rule(q.dimension == dimension::velocity && q.value > 0);
  return q.value;
}

int limit_verb(const Common& c, const LimitRequest& request) {
  const Named<Actuator>* actuator = find_named(actuators, request.actuator);
  require(actuator != nullptr, [&] { return fmt::format("--actuator {}: must be {}", request.actuator, listed(actuators)); });
  LimitOptions options{.actuator = actuator->value, .curves = !request.no_curves};
  if (request.impact_velocity) options.impact_velocity = speed_of(*request.impact_velocity);
  const SceneFile file = load_scene_or_result(c);
  if (request.start) {
    require(!request.start->empty(), "--start: must not be empty");
    const Drives drives = prepare(scene_of_result(*request.start), false, {.stop = c.stop}).drives;
    options.start = drives.waveforms();
    options.before = drives.before();
  }
  std::optional<ResultFolder> folder = claim_places(c, {"limit.json", "limit.svg", "best.toml", "best.csv"});
  std::optional<WatchedWork> work(std::in_place, c.quiet, c.stop);
  const Limit found = limit(file, options, work->watch());
  work.reset();
  const nlohmann::json data = limit_json(found, {.command = c.command});
  std::string text = limit_text(found);
  if (folder) {
    folder->write("limit.json", json_text(data, 1) + "\n");
    folder->write("limit.svg", limit_svg(found));
    std::vector<std::string> left{"limit.json", "limit.svg"};
    if (found.landing) {
      folder->write("best.toml", found.landing->scene.scene.file.text());
      folder->write("best.csv", told_csv(found.landing->scene));
      left.insert(left.end(), {"best.toml (run it with `softland simulate`)", "best.csv"});
    }
    text += left_in(folder->destination(found.interrupted), left);
    folder->publish(found.interrupted);
  }
  print_json_or(c, data, text);
  if (found.interrupted) return exit_interrupted;
  if (found.touch.status == Status::no_contact) return exit_no_success;
  return found.touch.status == Status::done ? exit_done : exit_numerical_failure;
}

}  // namespace

void add_limit(Verb& verb) {
  const auto request = std::make_shared<LimitRequest>();
  verb.with_scene(true, true);
  verb.with_json();
  verb.option("--actuator", request->actuator, "NAME", "drives that may be shaped: " + first_is_default(listed(actuators)));
  verb.optional("--impact-velocity", request->impact_velocity, "SPEED",
                "of the first touch, at most: \"1 mm/s\" (default: a hundredth of the plain step's)");
  verb.optional(
      "--start", request->start, "FILE",
      "a scene or result whose waveform the optimum is looked for from too: of a switch that one swing does not close, say");
  verb.flag("--no-curves", request->no_curves, "leave out the least times over the peak voltage and over the permitted speed");
  verb.with_out("folder for limit.json, limit.svg and the landing as best.toml and best.csv");
  verb.footer(
      "The least time is that of the best waveform of any shape within the limits of [driver.*], found by direct collocation:\n"
      "the yardstick for every searched waveform. It is a lower bound for landings of these volts at that speed in the model\n"
      "that the scene describes: a beam of more modes may touch a little earlier (--set structure.modes=6). The landing that is\n"
      "reported has been simulated, and may take longer where a beam must come to rest.\n"
      "Examples:\n  softland limit scenes/mem-gold.toml\n"
      "  softland limit scenes/mem-gold-pzt.toml --actuator both --impact-velocity \"1 mm/s\" --out limit\n"
      "  softland limit scenes/mem-gold-pzt.toml --actuator pzt --start softland-out --no-curves");
  verb.runs([request](const Common& common) { return limit_verb(common, *request); });
}

}  // namespace softland::apps
