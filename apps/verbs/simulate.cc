// The closing that a scene describes.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/exit_status.h"
#include "apps/output.h"
#include "apps/progress.h"
#include "apps/scenes.h"
#include "apps/streams.h"
#include "apps/values.h"
#include "apps/verbs/verbs.h"
#include "reports/quantity.h"
#include "reports/result_maker.h"
#include "studies/closing/auto_settings.h"
#include "studies/closing/certify.h"
#include "studies/closing/effect_ablation.h"
#include "studies/closing/effects.h"
#include "studies/closing/timing.h"

namespace softland::apps {
namespace {

using internal::percent;
using internal::quantity;

// effects = "auto": what leaving effects out has saved.
void log_time_saved(const PreparedScene& chosen) {
  PreparedScene whole = chosen;
  whole.scene.device = chosen.effects->described.device;
  whole.model = Switch(whole.scene.device, whole.quadrature);
  const auto seconds = [](const PreparedScene& p) { return right_hand_side_seconds(p.model, p.signals(), p.duration); };
  const double with = seconds(whole), without = seconds(chosen);
  say(fmt::format("effects = \"auto\": a right-hand side takes {} instead of {}, {} less", quantity(without, "s"),
                  quantity(with, "s"), percent(std::max(0.0, 1 - without / with))));
}

struct SimulateRequest {
  bool certified = false;
  std::optional<std::string> jobs;  ///< threads of a certified run; default: one per core
};

int simulate_verb(const Common& c, const SimulateRequest& request) {
  const int jobs = job_count(request.jobs);
  const SceneFile file = load_scene_or_result(c);
  std::optional<WatchedWork> work(std::in_place, c.quiet, c.stop);
  const PreparedScene prepared = prepare_and_choose(file, false, work->watch());
  const std::vector<std::string> files{"report.html", "gap.svg", "result.json", "trajectory.csv"};
  std::optional<ResultFolder> folder = claim_places(c, files);
  const Closing closing = request.certified ? certify(prepared, work->watch(), jobs) : simulate(prepared, true, work->watch());
  work.reset();
  const Result result = result_of(prepared, closing, {.command = c.command});
  const bool interrupted = closing.metrics.status == Status::interrupted;
  std::string left;
  if (folder) {
    write_files(*folder, result);
    left = left_in(folder->destination(interrupted), files);
    folder->publish(interrupted);
  }
  print_result(c, result, left);
  if (!interrupted && prepared.effects && !prepared.effects->choice.left_out.empty() && !c.quiet) log_time_saved(prepared);
  if (!closing.trajectory.message.empty())
    say(fmt::format("{} ({})", closing.trajectory.message, to_string(closing.metrics.status)));
  const bool is_lost = closing.metrics.status == Status::not_settled && closing.is_pulled_through;
  return is_lost ? exit_no_success : exit_status_of(closing.metrics.status);
}

}  // namespace

void add_simulate(Verb& verb) {
  const auto request = std::make_shared<SimulateRequest>();
  verb.with_scene(true, true);
  verb.with_json();
  verb.with_out("folder for report.html, gap.svg, result.json and trajectory.csv");
  verb.flag("--certify", request->certified, "errors that cover the true ones, and clouds of runs for ill-conditioned figures");
  verb.with_jobs(request->jobs, "threads of --certify (default: one per core); the result does not depend on them");
  verb.footer("Example:\n  softland simulate scenes/mem-gold.toml --set waveform.main.level=\"1.1 Vdp\" --json -");
  verb.runs([request](const Common& common) { return simulate_verb(common, *request); });
}

}  // namespace softland::apps
