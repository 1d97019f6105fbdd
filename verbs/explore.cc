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
  static constexpr auto name = "explore", about = "compute many points of a design space into a store", python = "explore",
                        returns = "Store", scene = scene_alone;
  static constexpr auto in_python = "Ctrl-C raises KeyboardInterrupt; the rows that are done are in the store.";
  static constexpr auto remarks =
      "SCENE is a scene, a plan file (docs/explore.md), or with --resume or --point a store, which holds its plan.\n"
      "Ctrl-C ends a run with what there is; --resume goes on, after a power cut too.\n"
      "Examples:\n  softland explore scenes/mem-gold.toml --vary \"structure.length=245 um:275 um:7\" --vary \"gap.contact=1.6 "
      "um:2.4 um:20\"\n"
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
  a.as({.type = "Mapping[str, str] | Sequence[str]", .value = "", .told = "_settings({})", .is_positional = true})
      .repeated("vary", r.vary, "KEY=VALUES",
                "what varies: KEY=LOW:HIGH:N, with :log in equal ratios, or KEY=A,B,C; KEY*KEY=... by one factor; KEY[2] is an "
                "element of a list; may be repeated: all combinations");
  a.text("sample", r.sample, "SET", "sobol:N or lhs:N points in the box of --vary KEY=LOW:HIGH");
  a.as({.type = "Sequence[str]", .value = "()", .told = "_text(\",\".join({}))"})
      .text("pareto", r.pareto, "FIGURES",
            "search the points that no other one beats in all of these figures, \"initial_contact_time,impact_velocity\", in the "
            "box of --vary KEY=LOW:HIGH by NSGA-II; max:FIGURE is to be large; --sample nsga2:N for N points (default: 2000)");
  a.program().text("list", r.list, "FILE", "points of a CSV file, whose header names keys with units: structure.length [um]");
  a.as({.type = fmt::format("Literal[\"{}\"]", fmt::join(studies, "\", \"")), .value = "\"simulate\""})
      .text("study", r.study, "NAME", "study at every point: " + listed_studies);
  a.as({.keyword = "options", .type = "Mapping[str, Any] | None", .value = "None", .told = "_settings({})"})
      .repeated("option", r.options, "NAME=VALUE",
                "option of the study, as its verb has it, where explore has none: \"impact-velocity=1 mm/s\"; may be repeated");
  a.flag("certify", r.certify, "simulate: the errors of the figures too");
  a.as({.type = "int | None"}).text("samples", r.samples, "N", "robustness: devices (default: 500)");
  a.text("target", r.target, "NAME", "optimize: as there");
  a.text("actuator", r.actuator, "NAME", "optimize: as there");
  a.text("waveform", r.waveform, "NAME", "optimize: as there");
  a.text("optimizer", r.optimizer, "NAME", "optimize: as there");
  a.as({.type = "int | None"}).text("budget", r.budget, "N", "optimize: evaluations of every search (default: as there)");
  a.as({.type = "str | os.PathLike[str]", .value = "\"softland-out.sqlite\"", .told = "_path({})", .is_positional = true})
      .text("out", r.out, "FILE", "store for the rows (default: softland-out.sqlite); with --point the scene");
  a.flag("resume", r.resume,
         "go on with a store: points that it holds are not computed again, nor, of another plan, those of the same content");
  a.text("shard", r.shard, "I/N", "part I of N of the points, for as many stores, which softland merge makes one");
  a.program().whole("point", r.point, {.least = 0}, "print the scene of point K, as simulate takes it, instead of exploring",
                    "K");
  seed_option(a, r.seed, "same rows, whatever --jobs is");
  jobs_option(a, r.jobs, "threads (default: one per core)");
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
      return fmt::format("{} {}: gives the points: {} and {} are not for it, nor is {}", spelling("list"), list, spelling("vary"),
                         spelling("sample"), spelling("pareto"));
    });
    read_list(plan, list);
  }
  require(!plan.vary.empty() || !plan.columns.empty(), [&] {
    return fmt::format("nothing varies: give {0} KEY=LOW:HIGH:N, {1} with {0} KEY=LOW:HIGH, {2} FILE.csv, or a plan file",
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

ExploreRequest explore_request(const Told& told) { return read_options<ExploreVerb>(told); }

Study explore_study() { return described<ExploreVerb>(); }

}  // namespace softland::verbs
