#include "studies/search/search_request.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <span>
#include <system_error>
#include <type_traits>
#include <utility>

#include "base/nearest.h"
#include "base/require.h"
#include "base/shortened.h"
#include "config/aim.h"
#include "config/assumed_spread.h"
#include "config/calibration_prose.h"
#include "config/condition.h"
#include "config/units.h"
#include "studies/search/searched_families.h"

namespace softland {
namespace {

// Returns the result of parse(). An InvalidInput of parse() becomes an InvalidRequest that names the field of the request.
template <class Parse>
auto read(const std::string& field, const Parse& parse) {
  try {
    return parse();
  } catch (const InvalidInput& error) {
    throw InvalidRequest(fmt::format("{}: {}", field, error.what()));
  }
}

std::uint64_t whole_number(std::string_view field, const std::string& text, std::uint64_t least) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  require_field(error != std::errc::result_out_of_range, field, text, [&] {
    return fmt::format("must be a whole number from {} to {}", least, std::numeric_limits<std::uint64_t>::max());
  });
  require_field(error == std::errc() && end == text.data() + text.size() && value >= least, field, visible(text),
                [&] { return fmt::format("must be a whole number from {} on", least); });
  return value;
}

std::vector<Condition> conditions_of(const SearchRequest& request, std::span<const Figure> figures) {
  std::vector<Condition> all;
  for (const std::string& text : request.constrain)
    all.push_back(read(requested("constrain"), [&] { return parse_condition(text, figures); }));
  return all;
}

// Parses the conditions of a request: all into `devices`, for the search over devices; those on figures that a single device
// has also into `drawing`, for the search on the nominal device.
void read_shared_conditions(const SearchRequest& request, std::vector<Condition>& nominal, std::vector<Condition>& devices) {
  devices = conditions_of(request, device_figures);
  for (const std::string& text : request.constrain) {
    try {
      nominal.push_back(parse_condition(text, conditioned_figures));
    } catch (const InvalidInput&) {
      continue;  // the figure exists only in a search over devices
    }
  }
}

void read_budget(const std::string& text, OptimizeOptions& options) {
  const auto holds = [&](bool ok) {
    require_field(ok, "budget", visible(text),
                  [] { return "must be a whole number of evaluations such as 2500, or a time such as \"90 s\""; });
  };
  Quantity q;
  try {
    q = parse_quantity(text);
  } catch (const InvalidInput&) {
    holds(false);
  }
  if (q.dimension == dimension::time) {
    holds(q.value > 0);
    options.max_seconds = q.value;
    options.max_evaluations = 1'000'000'000;
  } else {
    holds(q.dimension == dimension::none && q.value >= 1 && q.value <= 1e9 && q.value == std::floor(q.value));
    options.max_evaluations = static_cast<long>(q.value);
  }
}

std::uint64_t devices_of(const SearchRequest& request, std::uint64_t usual, std::uint64_t least) {
  if (!request.samples) return usual;
  const std::uint64_t devices = whole_number("samples", *request.samples, least);
  require_field(devices <= most_searched, "samples", *request.samples,
                [] { return fmt::format("must be at most {}", most_searched); });
  return devices;
}

OptimizeOptions options_of(const SearchRequest& request, const SceneFile& scene, const OwnParts& own) {
  const Named<Actuator>* actuator = find_named(actuators, request.actuator);
  require_field(actuator != nullptr, "actuator", request.actuator, [&] {
    return fmt::format("must be {}{}", listed(actuators), did_you_mean(request.actuator, names_of(actuators)));
  });
  const Aim target = own.objective ? Aim(own.objective)
                                   : read(requested("target") + " " + request.target, [&] { return parse_aim(request.target); });
  OptimizeOptions options = usual_options(scene, target, actuator->value);
  options.family = request.waveform;
  options.own_waveforms = own.waveforms;
  options.optimizer = request.optimizer;
  if (request.seed) options.seed = whole_number("seed", *request.seed, 0);
  if (request.is_by_measure()) options.max_evaluations = default_closings;
  if (request.is_by_measure() || request.budget) options.more_evaluations = 0;
  options.counts_work = !request.budget;
  if (request.robust == nominal_alone) options.conditions = conditions_of(request, conditioned_figures);
  if (request.budget) read_budget(*request.budget, options);
  // With half the budget first (begins_with_half), results at several budgets can be compared. This needs a number of
  // evaluations from the user, and is meant for one search on the nominal device by "auto".
  const bool has_one_seed = !request.seeds || *request.seeds == "1";
  options.begins_with_half = request.robust == nominal_alone && request.budget && has_one_seed && request.optimizer == "auto";
  return options;
}

// Returns the waveform families of the search on the nominal device: `text` without quasi-static families, which only a search
// over devices can use; default families if none is left.
std::string families_of_nominal(const std::string& text, const SceneFile& scene, Actuator actuator) {
  std::string kept;
  for (const std::string& family : families_of(text)) {
    if (!is_quasi_static(family)) kept += (kept.empty() ? "" : "+") + family;
  }
  return kept.empty() ? std::string(default_families(shaped_drives(scene, actuator))) : kept;
}

RobustSearchOptions tournament_of(const SearchRequest& request, const SceneFile& scene, OptimizeOptions& options,
                                  const std::string& families) {
  RobustSearchOptions tournament{
      .families = families, .hold_step_is_chosen = request.hold_step != step_is_fixed, .is_of_before = request.hold_step.empty()};
  options.family = families_of_nominal(options.family, scene, options.actuator);
  read_shared_conditions(request, options.conditions, tournament.conditions);
  tournament.verdict = devices_of(request, tournament.verdict, 100);
  tournament.verdict_is_asked = request.samples.has_value();
  tournament.counts_work = !request.budget;
  if (!request.budget) return tournament;
  if (std::isfinite(options.max_seconds)) {
    constexpr double usual_seconds = 60, most_lengths = 10;
    tournament.closings = static_cast<long>(static_cast<double>(tournament_closings) *
                                            std::clamp(options.max_seconds / usual_seconds, 0.25, most_lengths));
    return tournament;
  }
  share_budget(options, tournament);
  return tournament;
}

RobustOptions robust_of(const SearchRequest& request) {
  RobustOptions robust;
  robust.aim.measure =
      read(requested("robust") + " " + request.robust, [&] { return parse_robust_measure(request.robust, device_figures); });
  robust.aim.conditions = conditions_of(request, device_figures);
  robust.samples = devices_of(request, robust.samples, 8);
  require_field(request.optimizer == "auto", "optimizer", request.optimizer,
                [] { return "a robust search has a method of its own"; });
  return robust;
}

void check_hold_step(const SearchRequest& request) {
  if (request.hold_step.empty()) return;
  require_field(request.hold_step == step_is_chosen || request.hold_step == step_is_fixed, "hold-step", request.hold_step,
                [] { return fmt::format("must be {} or {}", step_is_chosen, step_is_fixed); });
  require_request(request.robust != nominal_alone || request.hold_step == step_is_fixed, [&] {
    return fmt::format("{} {}: is for a search over devices; with {} {} the step is at t = 0", requested("hold-step"),
                       request.hold_step, requested("robust"), nominal_alone);
  });
  const bool delays = request.actuator == name_of(actuators, Actuator::pzt) &&
                      std::ranges::any_of(families_of(request.waveform), is_quasi_static);
  require_request(!delays || request.hold_step == step_is_chosen, [&] {
    return fmt::format("{} {}: a quasi-static approach of the piezo chooses the instant of the step", requested("hold-step"),
                       request.hold_step);
  });
}

std::uint64_t seed_count(const SearchRequest& request, const OptimizeOptions& options) {
  if (!request.seeds) return 1;
  const std::string seeds = requested("seeds");
  const std::uint64_t count = whole_number("seeds", *request.seeds, 1);
  require_field(count <= most_seeds, "seeds", *request.seeds, [] { return fmt::format("must be at most {}", most_seeds); });
  require_field(count - 1 <= std::numeric_limits<std::uint64_t>::max() - options.seed, "seeds", *request.seeds,
                [&] { return fmt::format("from {} {} on there are not so many", requested("seed"), options.seed); });
  require_request(count == 1 || request.robust != by_tournament, [&] {
    return fmt::format("{}: is for searches on the nominal device, or over devices by one measure such as {} cvar:0.9", seeds,
                       requested("robust"));
  });
  require_field(count == 1 || !std::isfinite(options.max_seconds), "budget", request.budget.value_or(""), [] {
    return "searches from several seeds are compared at equal effort, so their budget is a number of evaluations";
  });
  return count;
}

// Returns the default waveform families. Under one measure of risk, varied devices need a slow and flexible family, or, with a
// per-device calibration, a quick family that presses the switch on its contact.
std::string usual_families(const SearchRequest& request, const SceneFile& scene) {
  if (request.is_by_measure())
    return std::string(request.calibrate.empty() || request.calibrate == "none" ? default_robust_family
                                                                                : default_calibrated_family);
  const Named<Actuator>* actuator = find_named(actuators, request.actuator);
  return actuator == nullptr ? std::string() : std::string(default_families(shaped_drives(scene, actuator->value)));
}

template <class Found>
auto& best_of(Found& found) {
  if constexpr (requires { found.found; }) {
    return found.found;
  } else if constexpr (requires { found.nominal; }) {
    return found.best;
  } else {
    return found;
  }
}

RobustSearchResult searched_for_devices(const PlannedSearch& search) {
  RobustSearchResult found = robust_search(search.scene, search.options, *search.for_devices);
  if (found.interrupted) found.best.search.termination = Termination::interrupted;
  return found;
}

}  // namespace

SearchRequest or_else(SearchRequest request, const SearchRequest& other) {
  const auto fill = [](std::string_view, auto& own, const auto& word) {
    if (own == std::remove_cvref_t<decltype(own)>()) own = word;
  };
  visit_prose(fill, request, other);
  if (request.constrain.empty()) request.constrain = other.constrain;
  return request;
}

namespace {

// Returns the default actuator: electrodes that pull, and the piezo, as far as their waveforms can be varied.
Actuator usual_actuator(const SceneFile& scene) {
  const bool has_piezo = scene.written("piezo") && scene.written("driver.piezo");
  if (!has_piezo) return Actuator::electrostatic;
  const bool pulls = std::ranges::any_of(
      scene.keys("electrode"), [&](const std::string& name) { return scene.written("electrode." + name + ".side") != "far"; });
  return pulls ? Actuator::both : Actuator::pzt;
}

}  // namespace

SearchRequest completed(SearchRequest request, const SceneFile& scene) {
  request = or_else(std::move(request), {.target = std::string(to_string(Target::bounce)),
                                         .optimizer = "auto",
                                         .robust = std::string(request.seeds ? nominal_alone : by_tournament)});
  if (request.actuator.empty())
    request.actuator = name_of(actuators, request.robust == by_tournament ? usual_actuator(scene) : Actuator::electrostatic);
  if (request.waveform.empty()) request.waveform = usual_families(request, scene);
  if (request.hold_step.empty()) request.hold_step = request.robust == nominal_alone ? step_is_fixed : step_is_chosen;
  return request;
}

PlannedSearch planned(const SearchRequest& request, SceneFile scene, const std::string& families, const OwnParts& own) {
  const bool over_devices = request.robust != nominal_alone;
  require_request(over_devices || (request.calibrate.empty() && !request.samples), [] {
    return fmt::format("{} and {} are for a search over devices: they say nothing with {} none", requested("calibrate"),
                       requested("samples"), requested("robust"));
  });
  OptimizeOptions options = options_of(request, scene, own);
  require_request(over_devices || std::ranges::none_of(families_of(options.family), is_quasi_static), [&] {
    return fmt::format(
        "{} {}: a quasi-static approach is searched over devices, not with {} none: other families close the nominal design "
        "sooner",
        requested("waveform"), options.family, requested("robust"));
  });
  check_hold_step(request);
  std::optional<RobustOptions> robust;
  if (request.is_by_measure()) robust = robust_of(request);
  std::optional<RobustSearchOptions> for_devices;
  if (request.robust == by_tournament) for_devices = tournament_of(request, scene, options, families);
  const std::uint64_t seeds = seed_count(request, options);
  if (over_devices) set_calibration(scene, request.calibrate);
  return {.scene = std::move(scene),
          .options = std::move(options),
          .robust = std::move(robust),
          .for_devices = std::move(for_devices),
          .seeds = seeds};
}

const OptimizeResult& FoundSearch::best() const {
  return std::visit([](const auto& found) -> const OptimizeResult& { return best_of(found); }, result);
}

OptimizeResult& FoundSearch::best() {
  return std::visit([](auto& found) -> OptimizeResult& { return best_of(found); }, result);
}

bool FoundSearch::is_success() const {
  const auto* devices = std::get_if<RobustSearchResult>(&result);
  // If the plain step is the result, it counts as a success only if it closes without a bounce.
  const bool has_answer = devices == nullptr || !devices->best.plain_step_wins || devices->plain_step_is_bounce_free();
  return best().is_success() && has_answer;
}

FoundSearch run(PlannedSearch& search) {
  if (search.for_devices) return {searched_for_devices(search)};
  if (!search.robust) return {optimize(search.scene, search.options)};
  assume_spread(search.scene);
  return {robust_optimize(search.scene, search.options, *search.robust)};
}

}  // namespace softland
