#include "studies/inverse/fit_problem.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "base/require.h"
#include "studies/closing/auto_settings.h"
#include "studies/inverse/bench_instruments.h"
#include "studies/inverse/posterior.h"

namespace softland {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// Returns the name of the entry of [spread] that is called `name` or varies the key `name` alone; `name` itself if there is no
// such entry.
std::string entry_of(const DeviceSpread& spread, const std::string& name) {
  for (const SpreadVariable& v : spread.variables) {
    if (v.name == name) return v.name;
  }
  for (const SpreadVariable& v : spread.variables) {
    if (v.keys.size() == 1 && v.keys.front().name() == name) return v.name;
  }
  return name;
}

// Returns the scene in volts, whose [spread] contains only the unknowns. Unknowns without an entry in [spread] get an entry,
// which does not act as a prior.
PreparedScene with_unknowns(const PreparedScene& given, std::vector<std::string>& unknowns,
                            std::vector<std::string>& without_prior) {
  const DeviceSpread& spread = given.scene.spread;
  SceneFile file = given.resolved();
  if (unknowns.empty()) {
    for (const SpreadVariable& v : spread.variables) {
      if (!v.is_drawn_per_edge) unknowns.push_back(v.name);
    }
  }
  for (std::string& name : unknowns) {
    name = entry_of(spread, name);
    if (std::ranges::any_of(spread.variables, [&](const SpreadVariable& v) { return v.name == name; })) continue;
    for (const SpreadVariable& v : spread.variables) {
      const bool follows = std::ranges::any_of(v.keys, [&](const VariedKey& key) { return key.name() == name; });
      require_request(!follows, [&] {
        return fmt::format("{} {}: give the entry '{}' of [spread] instead, by which it varies together with others",
                           requested("unknown"), name, v.name);
      });
    }
    try {
      SceneFile tried = file;
      tried.set(fmt::format("spread.\"{}\"={{distribution=\"normal\",cov=\"{} %\"}}", name, 100 * scale_without_prior));
      static_cast<void>(read_scene(tried));
      file = std::move(tried);
    } catch (const InvalidInput& error) {
      throw InvalidRequest(fmt::format("{} {}: {}", requested("unknown"), name, error.what()));
    }
    without_prior.push_back(name);
  }
  PreparedScene p = prepare(file);
  DeviceSpread& own = p.scene.spread;
  for (std::size_t i = own.variables.size(); i-- > 0;) {
    require_request(!(own.variables[i].is_drawn_per_edge && has(unknowns, own.variables[i].name)), [&] {
      return fmt::format("{} {}: must have one value per device, but it is random for every edge", requested("unknown"),
                         own.variables[i].name);
    });
    if (!has(unknowns, own.variables[i].name)) own.leave_out(i);
  }
  require(!own.variables.empty(), [&] { return fmt::format("{}: a fit needs at least one unknown", given.scene.file.name()); });
  return p;
}

void add_parameters(FitProblem& problem, const std::vector<std::string>& shared, const std::vector<std::string>& without_prior) {
  const DeviceSpread& spread = problem.devices.front().nominal.scene.spread;
  problem.of_device.assign(problem.devices.size(), std::vector<std::size_t>(spread.variables.size()));
  for (std::size_t v = 0; v < spread.variables.size(); ++v) {
    const SpreadVariable& variable = spread.variables[v];
    const bool is_shared = problem.devices.size() == 1 || has(shared, variable.name);
    for (std::size_t d = 0; d < problem.devices.size(); ++d) {
      if (d == 0 || !is_shared) {
        problem.parameters.push_back({.variable = v,
                                      .device = is_shared ? std::nullopt : std::optional(d),
                                      .mean = variable.distribution.mean(),
                                      .scale = variable.distribution.standard_deviation(),
                                      .has_prior = !has(without_prior, variable.name)});
      }
      problem.of_device[d][v] = problem.parameters.size() - 1;
    }
  }
}

// Adds the prior of a fit, in which the unknowns of one device, or the shared unknowns, have the correlations of [spread].
void add_prior(FitProblem& problem) {
  const auto n = static_cast<Index>(problem.parameters.size());
  problem.prior = problem.prior_root = MatrixXd::Zero(n, n);
  std::set<std::optional<std::size_t>> owners;
  for (const FitParameter& p : problem.parameters) owners.insert(p.device);
  const MatrixXd& correlation = problem.devices.front().nominal.scene.spread.correlation;
  for (const std::optional<std::size_t>& owner : owners) {
    std::vector<Index> places, variables;
    for (Index i = 0; i < n; ++i) {
      const FitParameter& p = problem.parameters[static_cast<std::size_t>(i)];
      if (p.device == owner && p.has_prior) places.push_back(i), variables.push_back(static_cast<Index>(p.variable));
    }
    if (places.empty()) continue;
    const MatrixXd root = whitening_of(correlation(variables, variables));
    problem.prior_root(places, places) = root;
    problem.prior(places, places) = root.transpose() * root;
  }
}

SceneFile with_changes(SceneFile file, const std::string& device, const std::vector<std::string>& changes) {
  for (const std::string& change : changes) {
    try {
      file.set(change);
    } catch (const InvalidInput& error) {
      throw InvalidInput(fmt::format("[device.{}]: {}", device, error.what()));
    }
  }
  return file;
}

}  // namespace

VectorXd FitProblem::residuals(const VectorXd& predicted) const { return (predicted - measured).cwiseQuotient(errors); }

VectorXd FitProblem::weights(const VectorXd& residuals) const {
  return residuals.unaryExpr([this](double r) { return loss_weight(loss, r); });
}

FitProblem problem_without_data(const SceneFile& file, const Bench& bench, const FitOptions& options, const Progress& progress) {
  FitProblem problem;
  problem.loss = options.loss;
  std::vector<std::string> names;
  for (const BenchMeasurement& m : bench.measurements) {
    if (!has(names, m.device)) names.push_back(m.device);
  }
  require(names.size() == 1 || !has(names, ""),
          [&] { return fmt::format("{}: either all measurements must name their device, or none", bench.name); });
  require_open_start(read_scene(file), "fit closes the switch");
  std::vector<std::string> without_prior;
  std::optional<PreparedScene> plain;
  for (const std::string& name : names) {
    const auto changes = bench.changes.find(name);
    const bool differs = changes != bench.changes.end();
    std::vector<std::string> unknowns = options.unknowns;
    without_prior.clear();
    if (differs || !plain) {
      PreparedScene own =
          with_unknowns(prepare_and_choose(differs ? with_changes(file, name, changes->second) : file, false, progress), unknowns,
                        without_prior);
      if (!differs) plain = own;
      problem.devices.push_back({.name = name, .nominal = std::move(own)});
    } else {
      problem.devices.push_back({.name = name, .nominal = *plain});
      static_cast<void>(with_unknowns(*plain, unknowns, without_prior));
    }
  }
  for (const std::string& name : options.shared) {
    const auto& variables = problem.devices.front().nominal.scene.spread.variables;
    require_request(std::ranges::any_of(variables, [&](const SpreadVariable& v) { return v.name == name; }),
                    [&] { return fmt::format("{} {}: must be one of the unknowns", requested("shared"), name); });
  }
  add_parameters(problem, options.shared, without_prior);
  add_prior(problem);
  return problem;
}

FitProblem with_data(FitProblem problem, const Bench& bench) {
  for (FitDevice& device : problem.devices) device.instruments.clear();
  problem.data.clear();
  std::vector<double> values, errors;
  for (std::size_t n = 0; n < bench.measurements.size(); ++n) {
    const BenchMeasurement& m = bench.measurements[n];
    const auto device =
        static_cast<std::size_t>(std::ranges::find(problem.devices, m.device, &FitDevice::name) - problem.devices.begin());
    FitDevice& own = problem.devices[device];
    const bool reads_all = instrument_of(own.nominal, m, 0).size() > 1;
    for (std::size_t i = 0; i < m.values.size(); ++i) {
      if (i == 0 || (!reads_all && !m.levels.empty() && m.levels[i] != m.levels[i - 1]))
        own.instruments.push_back(instrument_of(own.nominal, m, i));
      if (!reads_all) own.instruments.back().edges = 1;
      problem.data.push_back({.device = device,
                              .instrument = own.instruments.size() - 1,
                              .row = reads_all ? static_cast<Index>(i) : 0,
                              .measurement = n,
                              .time = m.times.empty() ? Metrics::unset : m.times[i]});
    }
    values.insert(values.end(), m.values.begin(), m.values.end());
    errors.insert(errors.end(), m.errors.begin(), m.errors.end());
  }
  problem.measured = Eigen::Map<const VectorXd>(values.data(), static_cast<Index>(values.size()));
  problem.errors = Eigen::Map<const VectorXd>(errors.data(), static_cast<Index>(errors.size()));
  return problem;
}

}  // namespace softland
