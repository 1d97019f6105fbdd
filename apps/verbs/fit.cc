// Fits a scene to what was measured on devices.
#include "studies/fitting/fit.h"

#include <fmt/format.h>

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
#include "base/read_file.h"
#include "base/require.h"
#include "config/assumed_spread.h"
#include "reports/fit_report.h"

namespace softland::apps {
namespace {

struct FitRequest {
  std::string data, loss = "huber";
  std::vector<std::string> unknowns, shared;
  std::optional<std::string> starts, seed, jobs;
};

// The file as it is written, or, where --set changed it, the scene without its comments.
std::string text_of(const Common& c, const SceneFile& file) { return c.set.empty() ? read_file(c.scene) : file.text(); }

int fit_verb(const Common& given, const FitRequest& request) {
  Common c = given;
  if (c.out.empty()) c.out = "softland-fit";
  require(!request.data.empty(), "--data: name the file of measurements, such as bench.toml");
  const auto* const loss = find_named(losses, request.loss);
  require(loss != nullptr, [&] { return fmt::format("--loss {}: must be {}", request.loss, listed(losses)); });
  FitOptions options{.unknowns = request.unknowns, .shared = request.shared, .loss = loss->value};
  if (request.starts) options.starts = whole_number<std::size_t>("--starts", *request.starts, 1);
  options.seed = seed_of(request.seed, 1);
  options.jobs = job_count(request.jobs);
  const SceneFile file = load_scene(c);
  const Bench bench = load_bench(request.data);
  std::optional<ResultFolder> folder = claim_places(c, {"fitted.toml", "fit.json", "fit.html"});
  std::optional<WatchedWork> work(std::in_place, c.quiet, c.stop);
  const Fit found = fit(file, bench, options, work->watch());
  work.reset();
  if (found.spread_assumed && !c.quiet) say(std::string(assumed_words));
  const nlohmann::json data = fit_json(found, {.command = c.command});
  std::vector<std::string> left{"fit.html", "fit.json"};
  folder->write("fit.json", json_text(data, 1) + "\n");
  const Document document = fit_document(found, {.command = c.command});
  folder->write("fit.html", page_html(document));
  if (found.found) {
    folder->write("fitted.toml", fitted_text(found, text_of(c, file), c.scene, found.devices.front()));
    left.insert(left.begin(), "fitted.toml");
  }
  const std::string text = terminal_text(document) + left_in(folder->destination(false), left);
  folder->publish(false);
  print_json_or(c, data, text);
  if (!found.found) return exit_numerical_failure;
  return found.doubts.empty() ? exit_done : exit_no_success;
}

}  // namespace

void add_fit(Verb& verb) {
  const auto request = std::make_shared<FitRequest>();
  verb.with_scene();
  verb.with_json();
  verb.option("--data", request->data, "FILE", "what was measured, and how well: a bench.toml (docs/fit.md)");
  verb.repeated("--unknown", request->unknowns, "KEY",
                "what is fitted: an entry of [spread], which is its prior, or any key of the scene, without one (default: all of "
                "[spread])");
  verb.repeated("--shared", request->shared, "KEY",
                "of these, what all devices of the file have in common; the rest is of each device");
  verb.option("--loss", request->loss, "NAME", "how data that do not agree count: " + first_is_default(listed(losses)));
  verb.optional("--starts", request->starts, "N",
                fmt::format("searches, the first one from the scene as it is (default: {})", FitOptions{}.starts));
  verb.with_seed(request->seed, "same searches, whatever --jobs is");
  verb.with_jobs(request->jobs);
  verb.with_out("folder for fitted.toml, fit.json and fit.html (default: softland-fit)");
  verb.footer(
      "fitted.toml is the scene with the values found; comments, sources and units stay. Values have standard errors, 95 %\n"
      "intervals and correlations. What the data cannot tell apart is said in words, and which further measurement would tell "
      "most.\n"
      "Status 3: at no start do the devices have what was measured.\n"
      "Status 4: the fit is not to be believed, and no interval is given. An unknown is 4 standard deviations away from what\n"
      "was known of it, the data are off by more than 3 of their errors, or another minimum describes them as well.\n"
      "Examples:\n  softland fit my.toml --data bench.toml\n"
      "  softland fit my.toml --data bench.toml --unknown structure.youngs_modulus --unknown gaps --out device-17\n"
      "  softland fit my.toml --data wafer.toml --shared structure.youngs_modulus --loss cauchy");
  verb.runs([request](const Common& common) { return fit_verb(common, *request); });
}

}  // namespace softland::apps
