#include "reports/result_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <tuple>
#include <utility>

#include "base/require.h"
#include "base/shortened.h"
#include "config/units.h"
#include "version.h"

namespace softland {
namespace {

using nlohmann::json;

// The value at this path of keys; a null value when any of them is missing.
const json& at(const json& value, std::initializer_list<std::string_view> path) {
  static const json nothing;
  const json* here = &value;
  for (const std::string_view key : path) {
    if (!here->is_object()) return nothing;
    const auto found = here->find(key);
    if (found == here->end()) return nothing;
    here = &*found;
  }
  return *here;
}

double number(const json& value) { return value.is_number() ? value.get<double>() : Metrics::unset; }
double number(const json& value, std::initializer_list<std::string_view> path) { return number(at(value, path)); }

std::string text(const json& value) { return value.is_string() ? value.get<std::string>() : std::string(); }
std::string text(const json& value, std::initializer_list<std::string_view> path) { return text(at(value, path)); }

std::optional<bool> truth(const json& value, std::initializer_list<std::string_view> path) {
  const json& found = at(value, path);
  return found.is_boolean() ? std::optional<bool>(found.get<bool>()) : std::nullopt;
}

// A whole number; 0 for what is none.
template <class Whole>
Whole whole(const json& value) {
  const double found = number(value);
  return std::abs(found) <= static_cast<double>(std::numeric_limits<int>::max()) ? static_cast<Whole>(found) : Whole{0};
}

// A quantity as a resolved scene writes it, "2 um", in SI units; a plain number as it is.
double quantity(const json& value) {
  if (!value.is_string()) return number(value);
  try {
    return parse_quantity(value.get<std::string>()).value;
  } catch (const InvalidInput&) {
    return Metrics::unset;
  }
}

template <class Read>
auto each(const json& list, const Read& read) {
  std::vector<decltype(read(list))> all;
  if (!list.is_array()) return all;
  all.reserve(list.size());
  for (const json& element : list) all.push_back(read(element));
  return all;
}

std::vector<double> numbers(const json& list) {
  return each(list, [](const json& one) { return number(one); });
}

std::vector<std::string> texts(const json& list) {
  std::vector<std::string> all = each(list, [](const json& one) { return text(one); });
  std::erase(all, "");
  return all;
}

std::optional<std::array<double, 2>> pair(const json& value, double (*read)(const json&)) {
  if (!value.is_array() || value.size() != 2) return std::nullopt;
  return std::array{read(value[0]), read(value[1])};
}

Points points(const json& list) {
  Points all;
  for (const auto& point : each(list, [](const json& one) { return pair(one, number); })) {
    if (point && std::isfinite((*point)[0])) all.push_back(*point);
  }
  return all;
}

// The members of an object, by name.
template <class Read>
auto members(const json& object, const Read& read) {
  std::map<std::string, decltype(read(object))> all;
  if (!object.is_object()) return all;
  for (const auto& [name, value] : object.items()) all.emplace(name, read(value));
  return all;
}

FigureValues figures(const json& values) {
  FigureValues all;
  for (const Figure& figure : all_figures) {
    const json& value = at(values, {figure.key});
    all[figure] = figure.is_yes_or_no() && value.is_boolean() ? value.get<bool>() : number(value);
  }
  return all;
}

std::optional<FigureValues> figures_of_run(const json& metrics) {
  return metrics.is_object() ? std::optional(figures(metrics)) : std::nullopt;
}

ResultCurve curve(const json& columns) {
  ResultCurve all{.time = numbers(at(columns, {"time_s"})),
                  .gap = numbers(at(columns, {"tip_gap_m"})),
                  .velocity = numbers(at(columns, {"tip_velocity_m_s"})),
                  .force = numbers(at(columns, {"contact_force_N"})),
                  .rebounds = {}};
  for (const std::vector<double>& row : each(at(columns, {"rebounds"}), numbers)) {
    if (row.size() >= 4) all.rebounds.push_back({.begin = row[0], .end = row[1], .height = row[2], .time_of_height = row[3]});
  }
  return all;
}

ResultRun run(const json& result, std::string_view name) {
  const json& own = at(result, {name});
  return {.status = text(own, {"metrics", "status"}),
          .figures = figures_of_run(at(own, {"metrics"})),
          .errors = figures(at(own, {"errors"})),
          .curve = curve(at(result, {"curves", name})),
          .waveforms = members(at(own, {"waveforms"}), points),
          .cost = number(own, {"cost"}),
          .collapse_time = number(own, {"collapse_time_s"})};
}

Spread spread(const json& cloud) {
  return {.low = number(cloud, {"low"}),
          .median = number(cloud, {"median"}),
          .high = number(cloud, {"high"}),
          .runs = whole<int>(at(cloud, {"runs"}))};
}

std::optional<Certificate> certificate(const json& result) {
  const json& certified = at(result, {"certified"});
  if (!certified.is_object()) return std::nullopt;
  Certificate all{.ill_conditioned = {}, .grazing = {}, .runs = whole<int>(at(result, {"cloud", "runs"}))};
  for (const Figure& figure : all_figures) {
    const json& cloud = at(certified, {figure.key});
    if (cloud.is_object()) all.ill_conditioned.push_back({figure, spread(cloud)});
  }
  const json& grazing = at(result, {"cloud", "grazing_rebound"});
  if (!grazing.is_object()) return all;
  all.grazing = {.number = whole<int>(at(grazing, {"rebound"})),
                 .time = number(grazing, {"time_s"}),
                 .height = number(grazing, {"height_m"}),
                 .impact_velocity = number(grazing, {"impact_velocity_m_s"}),
                 .at_threshold = truth(grazing, {"at_significant_height"}).value_or(false)};
  return all;
}

std::optional<ClosedState> closed_state(const json& result) {
  const json& state = at(result, {"closed_state"});
  if (!state.is_object()) return std::nullopt;
  return ClosedState{.exists = truth(state, {"exists"}).value_or(false),
                     .stable = truth(state, {"stable"}),
                     .smallest_eigenvalue = number(state, {"smallest_eigenvalue_rad2_s2"}),
                     .pulled_through = members(at(state, {"pulled_through_V"}), [](const json& value) { return number(value); })};
}

PullInVoltages pull_in_voltages(const json& volts) {
  return {.static_pull_in = number(volts, {"static_V"}), .dynamic_pull_in = number(volts, {"dynamic_V"})};
}

// Of one electrode without its name.
std::map<std::string, PullInVoltages> pull_in(const json& volts) {
  if (!volts.is_object()) return {};
  if (volts.contains("static_V") || volts.contains("dynamic_V")) return {{"", pull_in_voltages(volts)}};
  return members(volts, pull_in_voltages);
}

std::optional<Work> work(const json& effort) {
  if (!at(effort, {"steps"}).is_number()) return std::nullopt;
  return Work{.steps = whole<long>(at(effort, {"steps"})), .wall = number(effort, {"wall_s"})};
}

ResultRobust::Condition condition(const json& one) {
  ResultRobust::Condition c{
      .text = text(one, {"condition"}), .share = number(one, {"share"}), .holds = truth(one, {"holds"}).value_or(false)};
  if (const auto interval = pair(at(one, {"interval"}), number))
    std::tie(c.low, c.high) = std::tie((*interval)[0], (*interval)[1]);
  return c;
}

std::optional<ResultRobust> robust(const json& found) {
  if (!found.is_object()) return std::nullopt;
  ResultRobust all{.measure = text(found, {"measure"}),
                   .devices = number(found, {"devices"}),
                   .fresh_devices = number(found, {"fresh_devices"}),
                   .closings = number(found, {"closings"}),
                   .cost_on_searched = number(found, {"cost_on_searched_devices"}),
                   .failing = number(found, {"failing_share"}),
                   .is_told = truth(found, {"measure_tells"}).value_or(true),
                   .yield = {},
                   .conditions = each(at(found, {"conditions"}), condition)};
  if (at(found, {"yield"}).is_object()) all.yield = condition(at(found, {"yield"}));
  return all;
}

// A number that is null in JSON where it is infinite.
double or_infinite(const json& value) { return value.is_null() ? std::numeric_limits<double>::infinity() : number(value); }

ResultDevices::Row devices_row(const json& one) {
  return {.name = text(one, {"name"}),
          .pull_in_error = number(one, {"knowledge", "Vdp"}),
          .frequency_error = number(one, {"knowledge", "frequency"}),
          .piezo_error = number(one, {"knowledge", "piezo"}),
          .time_error = number(one, {"knowledge", "time_s"}),
          .searched_for_it = truth(one, {"searched_for_it"}).value_or(true),
          .bounce_free = number(one, {"bounce_free"}),
          .open = number(one, {"does_not_close"}),
          .collapsed = number(one, {"collapsed_onto_electrode"}),
          .at_95 = members(at(one, {"quantile_95"}), or_infinite)};
}

HoldWindows windows(const json& found) {
  HoldWindows all;
  if (const double devices = number(found, {"hold_window_devices"}); devices >= 1 && devices <= most_held_devices)
    all.devices = static_cast<std::size_t>(devices);
  const json& ends = at(found, {"hold_window_V"});
  if (!ends.is_object()) return all;
  for (const auto& [electrode, window] : ends.items()) {
    HoldWindow& one = all.of_electrodes[electrode];
    if (window.is_array() && window.size() == 2) one = {.lower = number(window[0]), .upper = or_infinite(window[1])};
  }
  return all;
}

std::optional<ResultDevices> devices(const json& result) {
  const json& found = at(result, {"devices"});
  if (!found.is_object()) return std::nullopt;
  ResultDevices d{.spread_assumed = truth(found, {"spread_assumed"}).value_or(false),
                  .spread = text(found, {"spread"}),
                  .count = number(found, {"count"}),
                  .seed = number(found, {"seed"}),
                  .closings = number(found, {"closings"}),
                  .measure = text(found, {"chosen", "measure"}),
                  .waveform = text(found, {"chosen", "waveform"}),
                  .better_than_plain_step = truth(found, {"better_than_plain_step"}).value_or(false),
                  .worse_in = texts(at(found, {"worse_in"})),
                  .rows = each(at(found, {"rows"}), devices_row),
                  .conditions = each(at(found, {"conditions"}), condition),
                  .drawing = figures(at(result, {"drawing", "metrics"})),
                  .drawing_status = text(result, {"drawing", "metrics", "status"}),
                  .drawing_goal_met = truth(result, {"drawing", "goal_met"}).value_or(false),
                  .measured = text(found, {"measured"}),
                  .next_command = text(found, {"next_command"})};
  d.front = each(at(found, {"front"}), [](const json& one) {
    return ResultDevices::FrontPoint{.first_touch = number(one, {"initial_contact_time_s"}),
                                     .impact_speed = number(one, {"largest_impact_velocity_m_s"}),
                                     .bounce_free = number(one, {"bounce_free"}),
                                     .candidate = text(one, {"candidate"})};
  });
  d.by_error = each(at(found, {"by_error_of_Vdp"}), [](const json& one) {
    return ResultDevices::ByError{.error = number(one, {"error"}),
                                  .bounce_free = number(one, {"bounce_free"}),
                                  .impact_speed = or_infinite(at(one, {"largest_impact_velocity_m_s"}))};
  });
  d.windows = windows(found);
  d.race = each(at(found, {"race"}), [](const json& one) {
    return ResultDevices::Racer{.measure = text(one, {"measure"}),
                                .waveform = text(one, {"waveform"}),
                                .closings = number(one, {"closings"}),
                                .cost = number(one, {"cost"}),
                                .bounce_free = number(one, {"bounce_free"})};
  });
  return d;
}

ResultSeeds::Search search_of_seed(const json& one) {
  const json& seed = at(one, {"seed"});
  return {.seed = seed.is_number_unsigned() ? seed.get<std::uint64_t>() : 0,
          .status = text(one, {"status"}),
          .termination = text(one, {"termination"}),
          .cost = number(one, {"cost"}),
          .evaluations = number(one, {"evaluations"}),
          .goal_met = truth(one, {"goal_met"}).value_or(false),
          .confirmed = truth(one, {"confirmed"}).value_or(false),
          .better_than_baseline = truth(one, {"better_than_baseline"}).value_or(false),
          .figures = figures(at(one, {"metrics"}))};
}

std::optional<ResultSeeds> seeds(const json& found) {
  if (!found.is_object()) return std::nullopt;
  ResultSeeds all{.planned = whole<std::uint64_t>(at(found, {"planned"})),
                  .searches = each(at(found, {"searches"}), search_of_seed)};
  for (std::size_t k = 0; k < all.searches.size(); ++k) {
    if (at(found, {"best_seed"}) == all.searches[k].seed) all.best = k;
  }
  return all;
}

bool is_search(const json& result) {
  const std::string kind = text(result, {"kind"});
  return kind == "optimize" || (kind.empty() && !at(result, {"baseline"}).is_null());
}

}  // namespace

json parse_result(std::string_view content, const std::string& name) {
  // A result of ours is 6 deep; reports walk through what they show by recursion.
  constexpr int deepest = 64;
  const auto watch_depth = [&](int around, json::parse_event_t event, const json&) {
    const bool opens = event == json::parse_event_t::object_start || event == json::parse_event_t::array_start;
    if (opens && around >= deepest) throw InvalidInput(fmt::format("{}: is nested more than {} deep", name, deepest));
    return true;
  };
  json result = json::parse(content, watch_depth, false);
  const bool is_result =
      result.is_object() && result.contains("kind") && (result["kind"] == "simulate" || result["kind"] == "optimize");
  require(is_result, fmt::format("{}: is not a result.json of softland", name));
  return result;
}

void require_reportable(const json& result, const std::string& name) {
  const std::string made_by = text(result, {"version"});
  require(!made_by.empty(), fmt::format("{}: does not say of which version of softland it is: \"version\" is missing", name));
  require(made_by == version,
          fmt::format("{}: is a result of softland {}, of which softland {} makes no report", name, shortened(made_by), version));
  for (const char* part : {is_search(result) ? "baseline" : "metrics", "curves", "scene"}) {
    require(at(result, {part}).is_object(),
            fmt::format("{}: \"{}\" is missing; name the result.json in the folder that --out named", name, part));
  }
}

namespace {

std::optional<ResultLimit> limit(const json& read) {
  if (!read.is_object()) return std::nullopt;
  return ResultLimit{.least_time = number(read, {"least_time_s"}), .impact_velocity = number(read, {"impact_velocity_m_s"})};
}

std::vector<ResultFamily> families(const json& read) {
  std::vector<ResultFamily> all;
  for (const json& one : read.is_array() ? read : json::array())
    all.push_back({.family = text(one, {"family"}), .evaluations = number(one, {"evaluations"}), .cost = number(one, {"cost"})});
  return all;
}

}  // namespace

Result read_result(const json& result) {
  require(result.is_object(), "the result is not a JSON object");
  Result r{.is_search = is_search(result),
           .status = text(result, {"status"}),
           .title = text(result, {"title"}),
           .target = text(result, {"target"}),
           .actuator = text(result, {"actuator"}),
           .waveform = text(result, {"waveform"}),
           .optimizer = text(result, {"optimizer"}),
           .termination = text(result, {"termination"}),
           .families = families(at(result, {"families"})),
           .goal_met = truth(result, {"goal_met"}),
           .evaluations = number(result, {"evaluations"}),
           .best = run(result, "best"),
           .baseline = run(result, "baseline"),
           .certificate = certificate(result),
           .closed_state = closed_state(result),
           .search = {.value_name = text(result, {"search", "value_name"}),
                      .best_so_far = points(at(result, {"search", "best_so_far"})),
                      .evaluations = points(at(result, {"search", "evaluations"}))},
           .robust = robust(at(result, {"robust"})),
           .devices = devices(result),
           .seeds = seeds(at(result, {"seeds"})),
           .limit = limit(at(result, {"limit"})),
           .pull_in = pull_in(at(result, {"pull_in"})),
           .natural_frequencies = numbers(at(result, {"natural_frequencies_rad_s"})),
           .work = work(at(result, {"work"})),
           .warnings = texts(at(result, {"warnings"})),
           .tolerance = number(result, {"tolerance"}),
           .command = text(result, {"command"}),
           .version = text(result, {"version"}),
           .reproduce = texts(at(result, {"reproduce"}))};
  if (!r.best.figures) r.best.figures = figures_of_run(at(result, {"metrics"}));
  if (r.best.status.empty()) r.best.status = r.status;
  r.best.errors = figures(at(result, {"errors"}));
  r.checks = each(at(result, {"checks"}), [](const json& check) {
    return ResultCheck{.name = text(check, {"name"}), .figures = figures_of_run(at(check, {"metrics"}))};
  });
  r.parameters = members(at(result, {"best", "parameters"}), [](const json& value) { return number(value); });
  for (const auto& [name, box] : members(at(result, {"best", "bounds"}), [](const json& value) { return pair(value, number); })) {
    if (box) r.bounds.emplace(name, *box);
  }
  if (const json& seed = at(result, {"seed"}); seed.is_number_integer() && seed >= 0) r.seed = seed.get<std::uint64_t>();
  const auto made_with = [&](const char* key) { return text(result, {"made_with", key}); };
  r.made_with = {.program = made_with("program"),
                 .compiler = made_with("compiler"),
                 .options = made_with("options"),
                 .instruction_set = made_with("instruction_set"),
                 .vectors = made_with("vectors"),
                 .c_library = made_with("c_library"),
                 .processor = made_with("processor")};
  r.scene = read_result_scene(at(result, {"scene"}), text(result, {"scene_toml"}));
  return r;
}

// Lengths, percentages of a beam's length, or its tip.
std::optional<std::array<double, 2>> span_on(double length, const json& span) {
  if (!span.is_array() || span.size() != 2) return std::nullopt;
  const auto place = [&](const json& one) {
    const std::string written = one.is_string() ? one.get<std::string>() : std::string();
    if (written == "tip") return length;
    const double value = quantity(one);
    return written.ends_with('%') ? value * length : value;
  };
  const std::array<double, 2> ends{place(span[0]), place(span[1])};
  return std::isfinite(ends[0]) && std::isfinite(ends[1]) ? std::optional(ends) : std::nullopt;
}

ResultScene read_result_scene(const json& scene, std::string file) {
  ResultScene s{.structure = text(scene, {"structure", "kind"}),
                .length = quantity(at(scene, {"structure", "length"})),
                .electrode_gap = quantity(at(scene, {"gap", "electrode"})),
                .contact_gap = quantity(at(scene, {"gap", "contact"})),
                .pad_length = quantity(at(scene, {"contact", "pad_length"})),
                .text = std::move(file),
                .tree = scene};
  if (s.text.empty() && scene.is_object()) s.text = scene.dump(2, ' ', false, json::error_handler_t::replace);
  if (at(scene, {"piezo"}).is_object()) s.piezo = ResultScene::Piezo{span_on(s.length, at(scene, {"piezo", "span"}))};
  for (const auto& [name, electrode] : members(at(scene, {"electrode"}), [](const json& one) { return &one; })) {
    const json& spans = at(*electrode, {"span"});
    const bool is_nested = spans.is_array() && !spans.empty() && spans[0].is_array();
    for (const json& span : is_nested ? spans : json::array({spans}))
      s.electrodes.push_back({.name = name,
                              .span = span_on(s.length, span),
                              .far_side = text(*electrode, {"side"}) == "far",
                              .gap = quantity(at(*electrode, {"gap"}))});
  }
  s.waveforms = members(at(scene, {"waveform"}), [](const json& one) {
    return ResultScene::Waveform{.family = text(one, {"family"}),
                                 .times = each(at(one, {"times"}), [](const json& time) { return quantity(time); }),
                                 .edge = quantity(at(one, {"edge"})),
                                 .start = quantity(at(one, {"start"})),
                                 .end = quantity(at(one, {"end"}))};
  });
  s.drivers = members(at(scene, {"driver"}), [](const json& one) {
    return DriveLimits{.lowest = quantity(at(one, {"min_voltage"})),
                       .highest = quantity(at(one, {"max_voltage"})),
                       .slew = quantity(at(one, {"max_slew"}))};
  });
  if (const double height = quantity(at(scene, {"metrics", "significant_rebound"})); height > 0) s.significant_rebound = height;
  return s;
}

}  // namespace softland
