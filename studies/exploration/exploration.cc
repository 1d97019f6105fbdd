#include "studies/exploration/exploration.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <new>
#include <optional>
#include <utility>

#include "base/require.h"
#include "base/shortened.h"
#include "config/aim.h"
#include "model/pull_in.h"
#include "objectives/figures.h"
#include "studies/closing/auto_settings.h"
#include "studies/closing/certify.h"
#include "studies/devices/robustness.h"
#include "studies/search/evaluation_store.h"
#include "studies/search/optimize.h"
#include "studies/search/search_request.h"
#include "studies/search/search_space.h"
#include "waveforms/export.h"

namespace softland {
namespace {

// Default number of devices of a robustness study at a point; the command `robustness` takes 2000 for its single scene.
constexpr std::uint64_t default_devices = 500;
constexpr std::array shown_quantiles{0.5, 0.95};
constexpr std::array step_figures{figure_of(&Metrics::permanent_contact_time), figure_of(&Metrics::bounce_count),
                                  figure_of(&Metrics::major_bounce_height), figure_of(&Metrics::impact_velocity)};

struct OptionRow {
  std::string_view name;
  PointStudy study;  // study (command that is run at every point) to which the option belongs
};
constexpr std::array options{OptionRow{"certify", PointStudy::simulate},  OptionRow{"samples", PointStudy::robustness},
                             OptionRow{"target", PointStudy::optimize},   OptionRow{"actuator", PointStudy::optimize},
                             OptionRow{"waveform", PointStudy::optimize}, OptionRow{"optimizer", PointStudy::optimize},
                             OptionRow{"budget", PointStudy::optimize}};
static_assert(options.size() == std::size(plan_options));

std::uint64_t whole_number(const std::string& text, std::uint64_t least, std::uint64_t most) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  require(!text.empty() && error == std::errc() && end == text.data() + text.size() && value >= least && value <= most,
          [&] { return fmt::format("must be a whole number from {} to {}", least, most); });
  return value;
}

SearchRequest request_of(const std::map<std::string, std::string>& given) {
  SearchRequest request{.robust = std::string(nominal_alone)};
  visit_prose(
      [&](std::string_view name, auto& word) {
        if (const auto found = given.find(std::string(name)); found != given.end()) word = found->second;
      },
      request);
  return request;
}

/// Adds the defaults of the options that a search at a point of an exploration takes.
void complete_search(std::map<std::string, std::string>& given, const SceneFile& scene, const auto& checked) {
  const SearchRequest request = completed(request_of(given), scene);
  given.try_emplace("target", request.target);
  given.try_emplace("actuator", request.actuator);
  given.try_emplace("optimizer", request.optimizer);
  Aim target = Target::bounce;
  checked("target", [&] { target = parse_aim(given["target"]); });
  const auto* actuator = find_named(actuators, given["actuator"]);
  checked("actuator", [&] { require(actuator != nullptr, [] { return fmt::format("must be {}", listed(actuators)); }); });
  const Shaped drives = shaped_drives(scene, actuator->value);
  given.try_emplace("waveform", request.waveform);
  checked("optimizer", [&] { static_cast<void>(optimizer_description(given["optimizer"])); });
  given.try_emplace("budget", std::to_string(default_budget(target, drives)));
  checked("budget", [&] {
    constexpr std::uint64_t most = 1'000'000'000;
    try {
      static_cast<void>(whole_number(given["budget"], 1, most));
    } catch (const InvalidInput& error) {
      throw InvalidInput(std::string(error.what()) +
                         " of evaluations for each search; a time would give every machine other searches (Ctrl-C and --resume "
                         "divide a long exploration)");
    }
  });
}

/// Returns the drives whose pull-in voltage is a figure: the electrodes that pull in, or the dispersion force if there are no
/// such electrodes.
std::vector<std::size_t> pulling_drives(const Device& device) {
  std::vector<std::size_t> drives;
  for (std::size_t k = 0; k < device.electrodes.size(); ++k) {
    if (pulls_in(device, k)) drives.push_back(k);
  }
  if (drives.empty() && device.dispersion) drives.push_back(device.electrodes.size());
  return drives;
}

/// Returns the drive voltages of a scene over time as the ends of straight lines: exact for steps and pulses, within a
/// thousandth of the voltage range for sines.
std::map<std::string, std::vector<std::pair<double, double>>> lines_of(const PreparedScene& p) {
  std::map<std::string, std::vector<std::pair<double, double>>> all;
  const std::vector<std::string> names = p.drive_names();
  const std::vector<Signal> signals = p.signals();
  for (std::size_t k = 0; k < names.size(); ++k) {
    const double swing = signals[k].maximum(p.duration) - signals[k].minimum(p.duration);
    if (names[k] != dispersion_drive) all[names[k]] = polyline(signals[k], p.duration, 1e-3 * swing, 0);
  }
  return all;
}

/// Removes the file name from a message, since the scene of a point is not in a file of the user.
std::string without_file(std::string_view message) {
  constexpr std::string_view file = "scene: ";
  if (message.starts_with(file)) message.remove_prefix(file.size());
  return std::string(message);
}

std::vector<PointFigure> pull_in_figures(const Device& device) {
  std::vector<PointFigure> figures;
  const std::vector<std::size_t> drives = pulling_drives(device);
  require(!drives.empty(), "study pull-in needs an electrode that pulls in, or a dispersion force");
  for (const std::size_t k : drives) {
    const bool is_electrode = k < device.electrodes.size();
    const std::string of = drives.size() > 1 ? device.electrodes[k].name + "_" : "";
    const std::string words = drives.size() > 1 ? " of " + device.electrodes[k].name : "";
    const std::string unit = is_electrode ? "V" : "";
    const char *what = is_electrode ? "pull_in" : "factor", *name = is_electrode ? "pull-in" : "factor";
    figures.push_back({of + "static_" + what, std::string("Static ") + name + words, unit});
    figures.push_back({of + "dynamic_" + what, std::string("Dynamic ") + name + words, unit});
    if (is_electrode) {
      figures.push_back({of + "release", "Release" + words, unit});
      figures.push_back({of + "pull_in_deflection", "Deflection at static pull-in" + words, "m"});
    }
  }
  return figures;
}

std::vector<PointFigure> robustness_figures(const AskedFigures& asked) {
  std::vector<PointFigure> figures;
  figures.push_back({"closing_yield", "Yield of closing devices", ""});
  figures.push_back({"bounce_free_yield", "Yield of bounce-free devices", ""});
  for (const Figure& figure : asked_among(device_figures, asked)) {
    for (const double p : shown_quantiles)
      figures.push_back({fmt::format("{}_q{:g}", figure.quantity(), 100 * p),
                         fmt::format("{}, {:g}th percentile", figure.name, 100 * p), std::string(figure.unit)});
  }
  return figures;
}

}  // namespace

namespace {

// Splits the key of a figure into name and unit: "touch.least_time_s" into "touch.least_time" and "s".
PointFigure figure_of_key(const std::string& key) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 13> suffixes{{{"_rad_s", "rad/s"},
                                                                                    {"_m_s", "m/s"},
                                                                                    {"_V_s", "V/s"},
                                                                                    {"_rad", "rad"},
                                                                                    {"_Hz", "Hz"},
                                                                                    {"_Pa", "Pa"},
                                                                                    {"_s", "s"},
                                                                                    {"_m", "m"},
                                                                                    {"_V", "V"},
                                                                                    {"_N", "N"},
                                                                                    {"_J", "J"},
                                                                                    {"_F", "F"},
                                                                                    {"_W", "W"}}};
  // The unit may be followed by an index or the name of an electrode, as in "natural_frequencies_rad_s.1": try the whole key,
  // then shorter beginnings.
  for (std::size_t end = key.size(); end != std::string::npos && end > 0; end = key.rfind('.', end - 1)) {
    const std::string_view head = std::string_view(key).substr(0, end);
    for (const auto& [suffix, unit] : suffixes) {
      if (!head.ends_with(suffix)) continue;
      const std::string quantity = std::string(head.substr(0, end - suffix.size())) + key.substr(end);
      return {.quantity = quantity, .name = quantity, .unit = std::string(unit)};
    }
  }
  return {.quantity = key, .name = key, .unit = {}};
}

}  // namespace

void complete(PlanRequest& request, const OtherStudies& others) {
  const auto checked = [&](std::string_view key, auto&& check) {
    try {
      check();
    } catch (const InvalidInput& error) {
      throw InvalidInput(fmt::format("{}: {}", request.place(key, 0), error.what()));
    }
  };
  const auto* study = find_named(point_studies, request.study);
  if (const auto other = std::ranges::find(others, request.study, &OtherStudy::name); other != others.end()) {
    for (const auto& [name, value] : request.options) {
      const bool has_place = std::ranges::find(plan_options, name) != std::end(plan_options);
      checked(has_place ? std::string_view(name) : "options", [&] { other->check({{name, value}}); });
    }
    return;
  }
  checked("study", [&] {
    require(study != nullptr, [&] {
      std::vector<std::string> names;
      for (const auto& row : point_studies) names.emplace_back(row.name);
      for (const OtherStudy& one : others) names.push_back(one.name);
      return fmt::format("must be {}", in_words(names, " or "));
    });
  });
  for (const auto& [name, value] : request.options) {
    checked("options", [&] {
      require(std::ranges::find(options, name, &OptionRow::name) != options.end(),
              [&] { return fmt::format("study {} has no option '{}'", request.study, name); });
    });
  }
  for (const OptionRow& option : options) {
    const auto given = request.options.find(std::string(option.name));
    if (given == request.options.end() || option.study == study->value) continue;
    checked(option.name, [&] {
      throw InvalidInput(fmt::format("belongs to study {}, not to {}", name_of(point_studies, option.study), request.study));
    });
  }
  if (study->value == PointStudy::optimize || study->value == PointStudy::robustness)
    require_open_start(read_scene(request.scene), fmt::format("study {} closes the switch", request.study));
  switch (study->value) {
    case PointStudy::simulate:
      if (const auto certify = request.options.find("certify"); certify != request.options.end()) {
        checked("certify", [&] { require(certify->second == "true" || certify->second == "false", "must be true or false"); });
        if (certify->second == "false") request.options.erase(certify);
      }
      break;
    case PointStudy::pull_in:
      break;
    case PointStudy::robustness:
      request.options.try_emplace("samples", std::to_string(default_devices));
      checked("samples", [&] { static_cast<void>(whole_number(request.options["samples"], 1, SamplePoints::largest_size)); });
      break;
    case PointStudy::optimize:
      complete_search(request.options, request.scene, checked);
      break;
  }
}

Exploration::Exploration(Plan plan, const Progress& progress, const OtherStudies& others, std::vector<PointFigure> columns)
    : plan_(std::move(plan)) {
  if (const auto* const row = find_named(point_studies, plan_.study())) {
    study_ = row->value;
  } else {
    other_ = *std::ranges::find(others, plan_.study(), &OtherStudy::name);
    figures_ = std::move(columns);
  }
  for (const PlanVariable& variable : plan_.variables()) {
    for (const PlanKey& key : variable.keys) {
      shares_switches_ = shares_switches_ || key.path.starts_with("waveform.") || key.path.starts_with("driver.") ||
                         key.path.starts_with("spread.") || key.path.starts_with("metrics.") || key.path == "simulate.duration";
    }
  }
  if (figures_.empty()) list_figures(progress);
}

void Exploration::list_figures(const Progress& progress) {
  const auto add = [&](const PointFigure& figure) { figures_.push_back(figure); };
  const auto add_closing = [&] {
    for (const Figure& figure : asked_among(all_figures, asked_)) add(figure_column(figure));
  };
  if (other_) {
    for (const auto& [key, value] : other_->record(plan_.base(), plan_.options(), plan_.seed(), 1, progress).numbers)
      add(figure_of_key(key));
    return;
  }
  const Scene base = read_scene(plan_.base());
  asked_ = base.metrics.asked;
  asked_.opening = std::isfinite(base.simulate.open_at);
  switch (*study_) {
    case PointStudy::simulate:
      add_closing();
      if (!plan_.options().contains("certify")) return;
      for (const Figure& figure : asked_among(all_figures, asked_)) {
        if (figure.has_error())
          add({.quantity = std::string(figure.quantity()) + "_error",
               .name = std::string(figure.name) + ", error",
               .unit = std::string(figure.unit)});
      }
      return;
    case PointStudy::pull_in:
      figures_ = pull_in_figures(read_scene(plan_.base()).device);
      return;
    case PointStudy::robustness:
      require(!read_scene(plan_.base()).spread.empty(), "study robustness needs a [spread] in the scene: how devices differ");
      figures_ = robustness_figures(asked_);
      return;
    case PointStudy::optimize: {
      add_closing();
      add({"goal_met", "Goal met", ""});
      add({"cost", "Cost", ""});
      add({"plain_step_cost", "Cost of the plain step", ""});
      for (const Figure& figure : step_figures) add(figure_column(figure, "plain_step_", ", plain step"));
      add({"evaluations", "Evaluations", ""});
      const PreparedScene base = prepared(plan_.base(), true, progress);
      const std::string& families = plan_.options().at("waveform");
      for (const std::string& family : families_of(families)) {
        const SearchSpace space(base, find_named(actuators, plan_.options().at("actuator"))->value, family, base.duration / 2);
        for (const Variable& variable : space.variables()) {
          parameters_.push_back(prefix_of(families, family) + variable.name);
          add(parameter_figure(parameters_.back()));
        }
      }
      return;
    }
  }
}

std::string Exploration::content(const SceneFile& scene) const {
  std::string text = plan_.study();
  for (const auto& [name, value] : plan_.options()) text += fmt::format("\n{}={}", name, value);
  if (other_ || study_ == PointStudy::robustness || study_ == PointStudy::optimize)
    text += fmt::format("\nseed={}", plan_.seed());
  return text + "\n\n" + scene.text();
}

std::map<std::string, std::vector<std::pair<double, double>>> Exploration::waveforms(const SceneFile& scene,
                                                                                     const Progress& progress) {
  try {
    return lines_of(prepared(scene, false, progress));
  } catch (const InvalidInput&) {
    return {};
  }
}

PointRow Exploration::row(const SceneFile& scene, int jobs, const Progress& progress) {
  PointRow row;
  try {
    row = computed(scene, jobs, progress);
  } catch (const Interrupted&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const InvalidInput& error) {
    row = {.status = std::string(infeasible), .reason = without_file(error.what()), .figures = {}};
  } catch (const std::exception& error) {
    row = {.status = std::string(internal_fault), .reason = error.what(), .figures = {}};
  }
  progress.throw_if_stopped();  // an interrupted point of the exploration gives no row
  row.figures.resize(figures_.size(), Metrics::unset);
  return row;
}

PointRow Exploration::computed(const SceneFile& scene, int jobs, const Progress& progress) {
  if (other_) return recorded(scene, jobs, progress);
  switch (*study_) {
    case PointStudy::simulate:
      return simulated(scene, jobs, progress);
    case PointStudy::pull_in:
      return pulled_in(scene, progress);
    case PointStudy::robustness:
      return on_devices(scene, jobs, progress);
    case PointStudy::optimize:
      break;
  }
  return optimized(scene, jobs, progress);
}

PreparedScene Exploration::prepared(const SceneFile& scene, bool default_limits, const Progress& progress) {
  const PullInFinder finder = shares_switches_ ? pull_in_.finder(scene) : PullInFinder(electrode_pull_in);
  return choose(prepare(scene, default_limits, progress, finder), default_limits, progress);
}

PointRow Exploration::simulated(const SceneFile& scene, int jobs, const Progress& progress) {
  const PreparedScene p = prepared(scene, false, progress);
  const bool certified = plan_.options().contains("certify");
  const Closing closing = certified ? certify(p, progress, jobs) : simulate(p, true, progress);
  PointRow row{.status = std::string(to_string(closing.metrics.status)), .reason = closing.trajectory.message, .figures = {}};
  for (const Figure& figure : asked_among(all_figures, asked_))
    row.figures.push_back(stored_value(figure.value(closing.metrics)));
  if (!certified) return row;
  for (const Figure& figure : asked_among(all_figures, asked_)) {
    if (figure.has_error()) row.figures.push_back(stored_value(closing.errors[figure]));
  }
  return row;
}

PointRow Exploration::pulled_in(const SceneFile& scene, const Progress& progress) {
  const PreparedScene p = prepared(scene, false, progress);
  const Device& device = p.scene.device;
  PointRow row{.status = std::string(to_string(Status::done)), .reason = {}, .figures = {}};
  for (const std::size_t k : pulling_drives(device)) {
    const bool is_electrode = k < device.electrodes.size();
    const std::vector<double> bias = bias_of(p.scene, k);
    const auto known = is_electrode ? p.pull_in.find(device.electrodes[k].name) : p.pull_in.end();
    const ElectrodePullIn found = known != p.pull_in.end() ? known->second : electrode_pull_in(p.model, k, bias, progress);
    const Status status = found.statically.status == Status::done ? found.dynamically.status : found.statically.status;
    if (status != Status::done) row.status = to_string(status);
    // The drive value of a dispersion force is the factor on the force less one; the row has the factor.
    const double offset = is_electrode ? 0 : 1;
    row.figures.push_back(stored_value(offset + found.statically.voltage));
    row.figures.push_back(stored_value(offset + found.dynamically.voltage));
    if (!is_electrode) continue;
    row.figures.push_back(stored_value(release_voltage(p.model, k, bias)));
    row.figures.push_back(stored_value(found.statically.deflection));
  }
  return row;
}

// Returns the numbers of a command's record as the row of a point. The columns come from the record of the exploration's own
// scene; a column is unset if the record of this point lacks the number.
PointRow Exploration::recorded(const SceneFile& scene, int jobs, const Progress& progress) {
  const OtherStudy::Record record = other_->record(scene, plan_.options(), plan_.seed(), jobs, progress);
  PointRow row{.status = record.status, .reason = {}, .figures = std::vector<double>(figures_.size(), Metrics::unset)};
  for (const auto& [key, value] : record.numbers) {
    const auto column = std::ranges::find(figures_, figure_of_key(key).quantity, &PointFigure::quantity);
    if (column != figures_.end()) row.figures[static_cast<std::size_t>(column - figures_.begin())] = stored_value(value);
  }
  return row;
}

PointRow Exploration::on_devices(const SceneFile& scene, int jobs, const Progress& progress) {
  const PreparedScene nominal = prepared(scene, true, progress);
  const Robustness found =
      robustness(nominal, {{.name = "scene", .waveforms = nominal.drives.waveforms(), .calibration = nominal.scene.calibration}},
                 {.samples = std::stoull(plan_.options().at("samples")), .seed = plan_.seed(), .jobs = jobs}, progress);
  if (found.interrupted) throw Interrupted();
  const DriveRobustness& own = found.drives.back();
  PointRow row{
      .status = std::string(to_string(Status::done)), .reason = {}, .figures = {own.closing.value, own.bounce_free.value}};
  for (const Figure& figure : asked_among(device_figures, asked_)) {
    for (const double p : shown_quantiles) {
      const auto at = std::find(robustness_quantiles.begin(), robustness_quantiles.end(), p) - robustness_quantiles.begin();
      row.figures.push_back(stored_value(own.figures[figure].quantiles.at(static_cast<std::size_t>(at)).value));
    }
  }
  return row;
}

PointRow Exploration::optimized(const SceneFile& scene, int jobs, const Progress& progress) {
  OptimizeOptions search = planned(request_of(plan_.options()), scene, {}).options;
  // All points have the same budget: one undivided search finds more than a search that begins with half its budget.
  search.begins_with_half = false;
  search.seed = plan_.seed();
  search.jobs = jobs;
  search.stop = progress.stop;
  // End an interrupted search here, since it is not stored and a verification of its results would be in vain.
  search.on_preparation = [&progress](std::string_view, double) { progress.throw_if_stopped(); };
  const OptimizeResult found = optimize(scene, search);
  if (found.search.termination == Termination::interrupted) throw Interrupted();
  PointRow row{.status = {}, .reason = {}, .figures = {}};
  const Metrics figures = found.best ? found.best->metrics : Metrics{};
  for (const Figure& figure : asked_among(all_figures, asked_))
    row.figures.push_back(found.best ? stored_value(figure.value(figures)) : Metrics::unset);
  row.figures.push_back(found.goal_met ? 1 : 0);
  row.figures.push_back(stored_value(found.best_cost));
  row.figures.push_back(stored_value(found.baseline_cost));
  for (const Figure& figure : step_figures) row.figures.push_back(stored_value(figure.value(found.baseline.metrics)));
  row.figures.push_back(static_cast<double>(found.search.evaluations));
  for (const std::string& name : parameters_) row.figures.push_back(stored_value(found.parameter(name)));
  if (found.best_scene) {
    row.scene = found.best_scene->scene.file.text();
    row.waveforms = lines_of(*found.best_scene);
  }
  if (found.is_success()) {
    row.status = to_string(found.best->metrics.status);
  } else {
    row.status = no_success;
    row.reason = found.best ? "the search found nothing better than the plain step" : "no feasible waveform was found";
  }
  return row;
}

}  // namespace softland
