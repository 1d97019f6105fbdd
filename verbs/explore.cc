#include "verbs/explore.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string_view>
#include <utility>

#include "base/printable.h"
#include "base/require.h"
#include "base/shortened.h"
#include "studies/exploration/front_search.h"
#include "verbs/points.h"

namespace softland::verbs {
namespace {

struct ExploreVerb : Usual, ExploreRequest {
  static constexpr auto name = "explore", about = "simulate many points of a design space and store their figures",
                        python = "explore", returns = "Store", scene = scene_alone;
  static constexpr auto in_python = "Ctrl-C raises KeyboardInterrupt; the store keeps the rows that are done.";
  static constexpr auto remarks =
      "SCENE is a scene file or a plan file (docs/explore.md). "
      "With --resume or --point it may also be a store, which holds its\n"
      "plan.\n"
      "Ctrl-C ends a run and keeps the rows that are done. --resume continues the run, also after a power cut.\n"
      "Examples:\n"
      "  softland explore scenes/mem-gold.toml --vary \"structure.length=245 um:275 um:7\" --vary \"gap.contact=1.6 um:2.4 "
      "um:20\"\n"
      "  softland explore scenes/mem-gold.toml --vary \"waveform.main.level=1.05 Vdp:1.6 Vdp:40\" --out level.sqlite\n"
      "  softland explore scenes/mem-gold.toml --vary \"gap.electrode*gap.contact=0.9:1.1\" --sample sobol:256 --study "
      "robustness\n"
      "  softland explore scenes/mem-gold.toml --vary \"gap.contact=1.6 um:2.4 um\" --vary \"waveform.main.level=1.05 Vdp:1.6 "
      "Vdp\" --pareto initial_contact_time,impact_velocity,peak_voltage\n"
      "  softland explore softland-out.sqlite --resume\n"
      "  softland explore softland-out.sqlite --point 17 --out point17.toml";
};

std::vector<std::string> study_names() {
  std::vector<std::string> names;
  for (const std::string_view name : names_of(point_studies)) names.emplace_back(name);
  for (const OtherStudy& one : studies_of_points()) names.push_back(one.name);
  return names;
}

template <class Archive>
void options(Archive& a, ExploreVerb& r) {
  const std::vector<std::string> studies = study_names();
  std::string listed_studies = in_words(studies, " or ");
  listed_studies.insert(listed_studies.find(','), " (default)");
  a.as({.type = "Mapping[str, str] | Sequence[str]", .value = "", .conversion = "_settings({})", .is_positional = true})
      .repeated("vary", r.vary, "KEY=VALUES",
                "key to vary and its values: KEY=LOW:HIGH:N (KEY=LOW:HIGH:N:log for equal ratios) or KEY=A,B,C. "
                "KEY*KEY=VALUES multiplies several keys by one factor; KEY[2] is an element of a list. "
                "If repeated, all combinations are computed");
  a.text("sample", r.sample, "SET",
         "draw N points from the box given by --vary KEY=LOW:HIGH: sobol:N or lhs:N (Latin hypercube)");
  a.as({.type = "Sequence[str]", .value = "()", .conversion = "_text(\",\".join({}))"})
      .text("pareto", r.pareto, "FIGURES",
            "search the Pareto front of these figures, such as \"initial_contact_time,impact_velocity\", "
            "by NSGA-II in the box given by --vary KEY=LOW:HIGH. max:FIGURE maximises a figure; "
            "--sample nsga2:N sets the number of points (default: 2000)");
  a.program().text("list", r.list, "FILE",
                   "read the points from a CSV file, whose header holds keys with units, such as structure.length [um]");
  a.as({.type = fmt::format("Literal[\"{}\"]", fmt::join(studies, "\", \"")), .value = "\"simulate\""})
      .text("study", r.study, "NAME", "study to run at every point: " + listed_studies);
  a.as({.keyword = "options", .type = "Mapping[str, Any] | None", .value = "None", .conversion = "_settings({})"})
      .repeated(
          "option", r.options, "NAME=VALUE",
          "option of the verb of --study that explore itself does not have, such as \"impact-velocity=1 mm/s\"; may be repeated");
  a.flag("certify", r.certify, "with --study simulate: compute the errors of the figures too");
  a.as({.type = "int | None"}).text("samples", r.samples, "N", "with --study robustness: number of devices (default: 500)");
  a.text("target", r.target, "NAME", "with --study optimize: --target of optimize");
  a.text("actuator", r.actuator, "NAME", "with --study optimize: --actuator of optimize");
  a.text("waveform", r.waveform, "NAME", "with --study optimize: --waveform of optimize");
  a.text("optimizer", r.optimizer, "NAME", "with --study optimize: --optimizer of optimize");
  a.as({.type = "int | None"})
      .text("budget", r.budget, "N", "with --study optimize: evaluations of every search (default: as in optimize)");
  a.as({.type = "str | os.PathLike[str]", .value = "\"softland-out.sqlite\"", .conversion = "_path({})", .is_positional = true})
      .text("out", r.out, "FILE", "store for the rows (default: softland-out.sqlite); with --point, file for the scene");
  a.flag("resume", r.resume,
         "continue a store. Points that it holds are not computed again, "
         "even if they come from another plan and have the same content");
  a.text("shard", r.shard, "I/N", "compute part I of N of the points; softland merge joins the stores of all parts");
  a.program().whole("point", r.point, {.least = 0}, "print the scene of point K for simulate, and compute nothing", "K");
  seed_option(a, r.seed, "the same rows, whatever --jobs is");
  jobs_option(a, r.jobs, "number of threads (default: one per core)");
}

}  // namespace

std::map<std::string, std::string> ExploreRequest::of_plan() const {
  std::map<std::string, std::string> given;
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) given.emplace(name, value);
  };
  if (!vary.empty()) given.emplace("vary", vary.front());
  add("sample", sample);
  add("pareto", pareto);
  add("list", list);
  add("study", study);
  add("target", target);
  add("actuator", actuator);
  add("waveform", waveform);
  add("optimizer", optimizer);
  if (samples) given.emplace("samples", *samples);
  if (budget) given.emplace("budget", *budget);
  if (seed) given.emplace("seed", std::to_string(*seed));
  if (!options.empty()) given.emplace("option", options.front());
  if (certify) given.emplace("certify", "true");
  return given;
}

PlanRequest ExploreRequest::plan(SceneFile scene, const Spelling& spelling) const {
  PlanRequest plan{.scene = std::move(scene), .vary = vary, .sample = sample, .pareto = pareto};
  if (!pareto.empty() && sample.empty()) plan.sample = usual_front_sample;
  std::map<std::string, std::string> given = of_plan();
  for (const std::string& one : options) {
    if (const std::size_t equals = one.find('='); equals != std::string::npos)
      given.try_emplace(one.substr(0, equals), one.substr(equals + 1));
  }
  plan.place = [given, vary = vary, options = options, spelling](std::string_view key, std::size_t number) {
    const auto found = given.find(std::string(key));
    const std::string value = key == "options"                        ? in_words(options, ", ")
                              : key == "vary" && number < vary.size() ? vary[number]
                              : found == given.end()                  ? ""
                                                                      : found->second;
    if (key == "certify" && value == "true") return spelling(key);
    return fmt::format("{} {}", spelling(key == "options" ? "option" : key), shortened(printable_line(visible(value))));
  };
  if (!study.empty()) plan.study = study;
  for (const std::string_view name : plan_options) {
    if (const auto value = given.find(std::string(name)); value != given.end()) plan.options[value->first] = value->second;
  }
  add_options(plan, options);
  plan.seed = seed.value_or(plan.seed);
  if (!list.empty()) {
    require(vary.empty() && plan.sample.empty(), [&] {
      return fmt::format("{} {}: gives all points: omit {}, {} and {}", spelling("list"), list, spelling("vary"),
                         spelling("sample"), spelling("pareto"));
    });
    read_list(plan, list);
  }
  require(!plan.vary.empty() || !plan.columns.empty(), [&] {
    return fmt::format("no key varies: give {0} KEY=LOW:HIGH:N, {1} with {0} KEY=LOW:HIGH, {2} FILE.csv, or a plan file",
                       spelling("vary"), spelling("sample"), spelling("list"));
  });
  return plan;
}

Shard ExploreRequest::part() const {
  try {
    return shard.empty() ? Shard{} : shard_from(shard);
  } catch (const InvalidInput& error) {
    throw InvalidRequest(fmt::format("{}: {}", requested("shard"), error.what()));
  }
}

ExploreRequest explore_request(const Arguments& arguments) { return read_options<ExploreVerb>(arguments); }

Study explore_study() { return described<ExploreVerb>(); }

}  // namespace softland::verbs
