#include "verbs/simulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "document/quantity.h"
#include "document/text.h"
#include "reports/closing_document.h"
#include "reports/closing_record.h"
#include "reports/record_file.h"
#include "studies/closing/certify.h"
#include "studies/closing/timing.h"
#include "verbs/report_outcome.h"

namespace softland::verbs {
namespace {

struct SimulateVerb : Usual, SimulateRequest {
  static constexpr auto name = "simulate", about = "simulate one closing of the switch in a scene", python = "simulate",
                        returns = "Closing", progress = "False",
                        leaves = "folder for report.html, gap.svg, result.json and trajectory.csv";
  static constexpr auto in_python = "A numerical failure is the status of the closing, not an exception.";
  static constexpr auto remarks =
      "Example:\n  softland simulate scenes/mem-gold.toml --set waveform.main.level=\"1.1 Vdp\" --json -";
  static std::vector<std::string> files() { return {"report.html", "gap.svg", "result.json", "trajectory.csv"}; }
  static Outcome shown_again(const nlohmann::json& json) { return closing_shown_again(json); }
};

template <class Archive>
void options(Archive& a, SimulateVerb& r) {
  a.python().unless("no-errors", r.errors,
                    "omit the second run with a tighter tolerance, which measures the errors and, if the scene asks for it, "
                    "refines the first run");
  a.flag("certify", r.certified,
         "certify the figures: bounds of their errors, and clouds of perturbed runs for ill-conditioned figures");
  a.object("waveforms", "Mapping[str, Waveform] | None", "None",
           "waveforms of some drives in volts, instead of those of the scene; own waveforms too");
  jobs_option(a, r.jobs, "number of threads of --certify (default: one per core); the result does not depend on it");
}

// Returns a note on the computing time that effects = "auto" saves by omitting effects.
std::string time_saved(const PreparedScene& chosen) {
  PreparedScene whole = chosen;
  whole.scene.device = chosen.effects->described.device;
  whole.model = Switch(whole.scene.device, whole.quadrature);
  const auto seconds = [](const PreparedScene& p) { return right_hand_side_seconds(p.model, p.signals(), p.duration); };
  const double with = seconds(whole), without = seconds(chosen);
  return fmt::format("effects = \"auto\": one evaluation of the equations of motion takes {} instead of {}, {} less",
                     internal::quantity(without, "s"), internal::quantity(with, "s"),
                     internal::percent(std::max(0.0, 1 - without / with)));
}

Outcome run(const Setting& setting, const SimulateVerb& request) {
  const auto [prepared, closing] = simulated(setting.prepared(false), request, setting.progress);
  const auto result = std::make_shared<const ClosingRecord>(record_of(*prepared, closing, setting.command, setting.leaves_files));
  const Status status = closing.metrics.status;
  Outcome outcome = closing_shown(result);
  outcome.fault =
      closing.trajectory.message.empty() ? std::string() : fmt::format("{} ({})", closing.trajectory.message, to_string(status));
  if (status != Status::interrupted && prepared->effects && !prepared->effects->choice.left_out.empty() && setting.note)
    setting.note(time_saved(*prepared));
  const bool is_lost = status == Status::not_settled && closing.is_pulled_through;
  outcome.ending = is_lost ? Ending::no_success : ending_of(status);
  return outcome;
}

}  // namespace

SimulateRequest simulate_request(const Arguments& arguments) { return read_options<SimulateVerb>(arguments); }

Simulated simulated(std::shared_ptr<const PreparedScene> prepared, const SimulateRequest& request, const Progress& progress) {
  Closing closing =
      request.certified ? certify(*prepared, progress, request.jobs) : simulate(*prepared, request.errors, progress);
  return {.prepared = std::move(prepared), .closing = std::move(closing)};
}

Study simulate_study() { return study_of<SimulateVerb>(); }

}  // namespace softland::verbs
