#include "studies/search/evaluation_store.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

namespace softland {
namespace {

constexpr std::size_t figures =
    7;  // number of columns after the waveform parameters: cost, guide cost, bounce-free, devices, cost limit, seed, closings

std::vector<StoredColumn> columns_for(const std::vector<std::string>& variables) {
  std::vector<StoredColumn> columns;
  for (const std::string& variable : variables) {
    const PointFigure p = parameter_figure(variable);
    columns.push_back({.key = column_key(p.quantity, p.unit), .name = p.name, .unit = p.unit, .kind = ColumnKind::variable});
  }
  for (const char* name : {"cost", "leading_cost", "lands", "devices", "given_up_above", "seed_of_devices", "closings"})
    columns.push_back({.key = name, .name = name, .unit = {}, .kind = ColumnKind::figure});
  return columns;
}

// Returns the key of an evaluation in the database file. Evaluations with equal keys have equal results. `row` has a value for
// every parameter of every waveform family, as in the keys of files from earlier versions.
ContentKey content_of(const EvaluationKey& key, const std::vector<double>& row) {
  std::string text = fmt::format("{} {} {:016x}", key.devices, key.seed, std::bit_cast<std::uint64_t>(key.hopeless));
  for (const double x : row) text += fmt::format(" {:016x}", std::bit_cast<std::uint64_t>(x));
  return content_key(text);
}

EvaluationValues values_of(const StoredRow& row) {
  const double* figure = row.values.data() + row.values.size() - figures;
  return {.cost = figure[0], .guide = figure[1], .bounce_free = figure[2] == 1, .closings = static_cast<long>(figure[6])};
}

StoredPlan evaluation_plan(const nlohmann::json& plan, std::int64_t points, std::uint64_t seed,
                           const std::vector<std::string>& variables) {
  return {.text = plan.dump(1), .points = points, .columns = columns_for(variables), .seed = seed};
}

}  // namespace

PointFigure parameter_figure(const std::string& name) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 4> suffixes{
      {{"_rad_s", "rad/s"}, {"_rad", "rad"}, {"_s", "s"}, {"_V", "V"}}};
  for (const auto& [suffix, unit] : suffixes) {
    if (!name.ends_with(suffix)) continue;
    std::string quantity = name.substr(0, name.size() - suffix.size());
    return {.quantity = quantity, .name = quantity, .unit = std::string(unit)};
  }
  return {.quantity = name, .name = name, .unit = {}};
}

PointFigure figure_column(const Figure& figure, const std::string& before, const std::string& words) {
  return {.quantity = before + std::string(figure.quantity()),
          .name = std::string(figure.name) + words,
          .unit = std::string(figure.unit)};
}

EvaluationStore::EvaluationStore(const std::filesystem::path& file, const nlohmann::json& plan, std::int64_t points,
                                 std::uint64_t seed, FamilyColumns columns, const StoredOrigin& origin)
    : columns_(std::move(columns)),
      store_(file, evaluation_plan(plan, points, seed, columns_.names()), origin, StudyStore::Opening::resume),
      points_(points) {
  StudyReader(file).read([&](const StoredRow& row) {
    known_.emplace(row.content, values_of(row));
    next_ = row.point + 1;
  });
}

std::optional<EvaluationValues> EvaluationStore::recall(const EvaluationKey& key) noexcept {
  try {
    std::vector<double> row = columns_.row(key.family, key.x);
    const ContentKey content = content_of(key, row);
    {
      const std::scoped_lock lock(mutex_);
      if (const auto found = known_.find(content); found != known_.end()) {
        ++recalled_;
        return found->second;
      }
    }
    const std::optional<StoredRow> earlier = store_.find(content);
    if (!earlier) return std::nullopt;
    const EvaluationValues values = values_of(*earlier);
    add(content, key, std::move(row), values);
    const std::scoped_lock lock(mutex_);
    ++recalled_;
    return values;
  } catch (...) {
    const std::scoped_lock lock(mutex_);
    if (!failure_) failure_ = std::current_exception();
    return std::nullopt;
  }
}

void EvaluationStore::note(const EvaluationKey& key, const EvaluationValues& values) noexcept {
  try {
    {
      const std::scoped_lock lock(mutex_);
      ++computed_;
    }
    std::vector<double> row = columns_.row(key.family, key.x);
    const ContentKey content = content_of(key, row);
    add(content, key, std::move(row), values);
  } catch (...) {
    const std::scoped_lock lock(mutex_);
    if (!failure_) failure_ = std::current_exception();
  }
}

void EvaluationStore::add(const ContentKey& content, const EvaluationKey& key, std::vector<double> x,
                          const EvaluationValues& values) {
  StoredRow row{.content = content, .status = std::isfinite(values.cost) ? "done" : "infeasible", .values = std::move(x)};
  const auto or_none = [&](double value) {
    return key.devices > 0 && std::isfinite(value) ? value : std::numeric_limits<double>::quiet_NaN();
  };
  row.values.insert(row.values.end(),
                    {values.cost, values.guide, values.bounce_free ? 1.0 : 0.0, or_none(static_cast<double>(key.devices)),
                     or_none(key.hopeless), or_none(static_cast<double>(key.seed)), static_cast<double>(values.closings)});
  {
    const std::scoped_lock lock(mutex_);
    if (next_ == points_ || !known_.emplace(content, values).second) return;
    row.point = next_++;
  }
  store_.add(std::move(row));
}

std::int64_t EvaluationStore::computed() const {
  const std::scoped_lock lock(mutex_);
  return computed_;
}

std::int64_t EvaluationStore::recalled() const {
  const std::scoped_lock lock(mutex_);
  return recalled_;
}

void EvaluationStore::check() {
  const std::scoped_lock lock(mutex_);
  if (failure_) std::rethrow_exception(failure_);
}

void EvaluationStore::close() {
  check();
  store_.close();
}

}  // namespace softland
