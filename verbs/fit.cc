// Verb `fit`: fits a scene to measurements.
#include "studies/inverse/fit.h"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/assumed_spread.h"
#include "reports/fit_report.h"
#include "reports/record_file.h"
#include "studies/inverse/fitted_scene.h"
#include "verbs/study.h"

namespace softland::verbs {
namespace {

Outcome shown(FitRecord found) {
  const auto record = std::make_shared<const FitRecord>(std::move(found));
  return {.json = json_of(*record),
          .text = terminal_text(document_of(*record)),
          .files = {{"fit.html", [record] { return page_html(document_of(*record)); }, "fit.html"},
                    {"fit.json", [record] { return json_text(json_of(*record), 1) + "\n"; }, "fit.json"}}};
}

struct FitRequest : Usual {
  static constexpr auto name = "fit", about = "fit the parameters of a scene to measurements on devices", python = "fit",
                        scene = scene_alone, leaves = "folder for fitted.toml, fit.json and fit.html (default: softland-fit)",
                        place = "softland-fit";
  static constexpr auto remarks =
      "fitted.toml is the scene with the fitted values; its comments, sources and units are kept. The report gives standard\n"
      "errors, 95 % intervals and correlations. It names the unknowns that the data cannot separate, and the most valuable\n"
      "further measurement.\n"
      "Exit status 3: the simulated devices do not have the measured figures at any start.\n"
      "Exit status 4: the fit is not reliable, and no interval is given: an unknown is 4 standard deviations away from its\n"
      "prior, the RMS residual exceeds 3 sigma, or another minimum describes the data equally well.\n"
      "Examples:\n  softland fit my.toml --data bench.toml\n"
      "  softland fit my.toml --data bench.toml --unknown structure.youngs_modulus --unknown gaps --out device-17\n"
      "  softland fit my.toml --data wafer.toml --shared structure.youngs_modulus --loss cauchy";
  static std::vector<std::string> files() { return {"fitted.toml", "fit.json", "fit.html"}; }
  static Outcome shown_again(const nlohmann::json& json) { return shown(read_fit(json)); }

  std::string data;
  FitOptions options{.jobs = one_per_core()};
};

template <class Archive>
void options(Archive& a, FitRequest& r) {
  FitOptions& o = r.options;
  a.measurements("data", r.data, "file with the measurements and their errors, such as bench.toml (docs/fit.md)");
  a.repeated(
      "unknown", o.unknowns, "KEY",
      "parameter to fit: an entry of [spread], which is its prior, or any other key of the scene, without a prior (default: "
      "all entries of [spread])",
      "unknowns", true);
  a.repeated("shared", o.shared, "KEY",
             "unknown with one value for all devices of the file; every other unknown has a value for each device", "shared");
  a.choice("loss", o.loss, losses, "loss function, which limits the weight of outliers");
  a.whole(
      "starts", o.starts, {.least = 1},
      fmt::format("number of searches; the first one starts from the values of the scene (default: {})", FitOptions{}.starts));
  seed_option(a, o.seed, "the same fit, whatever --jobs is");
  jobs_option(a, o.jobs);
}

Outcome run(const Setting& setting, const FitRequest& request) {
  const Bench bench = load_bench(request.data);
  const auto found = std::make_shared<const Fit>(fit(setting.scene, bench, request.options, setting.progress));
  Outcome outcome = shown(record_of(*found, setting.command));
  if (found->found) {
    const auto text = [found, written = setting.text(), name = setting.name] {
      return fitted_text(*found, written, name, found->devices.front());
    };
    outcome.files.insert(outcome.files.begin(), {"fitted.toml", text, "fitted.toml"});
  }
  if (found->spread_assumed && setting.note) setting.note(std::string(assumed_prose));
  outcome.ending = !found->found ? Ending::numerical_failure : found->doubts.empty() ? Ending::done : Ending::no_success;
  return outcome;
}

}  // namespace

Study fit_study() { return study_of<FitRequest>(); }

}  // namespace softland::verbs
