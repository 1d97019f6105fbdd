#include "optimizers/evaluation_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <exception>
#include <ranges>

#include "base/executor.h"
#include "base/random.h"

namespace softland::internal {
namespace {

constexpr std::size_t no_task = std::numeric_limits<std::size_t>::max();

// Objective values beyond this size are mapped monotonically to smaller ones: optimizer libraries square and subtract values,
// which must not overflow.
constexpr double large_value = 1e12;
double compress(double value) {
  const double size = std::abs(value);
  if (size <= large_value) return value;
  return std::copysign(large_value * (1 + std::log(size / large_value)), value);
}
// Penalty of an infeasible point while no feasible point is known: above compress(x) for every finite x, which is at most
// 6.8e14.
constexpr double first_penalty = 1e15;

// Step of finite differences, a fraction of the box of the variables. Smooth parts of an objective may be narrow: those of the
// cost of a switch closing are narrower than 1e-3. With this step a noise of 1e-9 in the objective gives an error of 1e-4 in a
// slope of order 1.
constexpr double difference_step = 1e-5;

// Returns the point that a library requests, moved into [0, 1]: libraries exceed a bound by a rounding error, and pass NaN
// after a NaN of the objective. Adding 0 turns -0 to 0, so that both have the same hash.
Point inside(std::span<const double> point) {
  Point moved(point.begin(), point.end());
  for (double& coordinate : moved) coordinate = std::isnan(coordinate) ? 0.5 : std::clamp(coordinate, 0.0, 1.0) + 0.0;
  return moved;
}

// Number of successive requests for points that were evaluated before, after which a search is ended, since it repeats itself.
// The number of evaluated points is added to this limit, since a continued search first repeats its own evaluations.
constexpr long circles_allowed = 1000;

}  // namespace

std::size_t PointHash::operator()(const Point& point) const noexcept {
  std::uint64_t bits = 0;
  for (const double coordinate : point) bits = random_bits(bits, Stream::library_seed, std::bit_cast<std::uint64_t>(coordinate));
  return static_cast<std::size_t>(bits);
}

BudgetedObjective::BudgetedObjective(EvaluationRecord& record, std::size_t task, long budget, long first_index)
    : record_(record),
      task_(task),
      budget_(budget),
      first_index_(first_index),
      best_seen_(record.best_seen_),
      worst_seen_(record.worst_seen_) {}

bool BudgetedObjective::over() const {
  const long spent = evaluations() + evaluations_of_gradient * static_cast<long>(gradients_.size());
  return cut_ || spent >= budget_ || record_.cut_off(task_);
}

Answer BudgetedObjective::operator()(std::span<const double> point) {
  if (cut_) throw Cut{};
  const Point asked = inside(point);
  const auto recall = [&](const Memory& memory) {
    const auto found = memory.find(asked);
    return found == memory.end() ? nullptr : &found->second;
  };
  const Answer* known = recall(record_.memory_);
  if (known == nullptr) known = recall(memory_);
  if (known != nullptr) {
    const auto points_known = static_cast<long>(record_.memory_.size() + memory_.size());
    if (++repeats_ > circles_allowed + points_known) throw Cut{};
    return *known;
  }

  if (over()) {
    cut_ = true;
    throw Cut{};
  }
  repeats_ = 0;
  const double value = record_.evaluate(*this, asked);
  const Answer answer = remember(asked, value);
  if (answer.feasible && value <= record_.options_.target) {
    cut_ = true;
    std::size_t earliest = record_.target_task_;
    while (task_ < earliest && !record_.target_task_.compare_exchange_weak(earliest, task_)) {
    }
    throw Cut{};
  }
  return answer;
}

Answer BudgetedObjective::remember(const Point& point, double value) {
  Answer answer{compress(value), std::isfinite(value)};
  if (answer.feasible) {
    if (answer.value < best_of_task_) {
      best_of_task_ = answer.value;
      best_point_of_task_ = point;
    }
    best_seen_ = std::min(best_seen_, answer.value);
    worst_seen_ = std::max(worst_seen_, answer.value);
  } else {
    answer.value = penalty();
  }
  memory_.emplace(point, answer);
  records_.push_back({point, answer, value});
  return answer;
}

// Returns the penalty of an infeasible point: above every value seen, but of the same order of magnitude. Some methods fit
// models to the objective, which a penalty of 1e15 next to values of order 1 would spoil.
double BudgetedObjective::penalty() const {
  if (worst_seen_ < best_seen_) return first_penalty;
  const double spread = worst_seen_ - best_seen_;
  return worst_seen_ + (spread > 0 ? std::max(spread, 1e-3 * std::abs(worst_seen_)) : std::max(1.0, std::abs(worst_seen_)));
}

std::size_t BudgetedObjective::conditions() const { return record_.problem_.conditions.count; }

Values BudgetedObjective::values(std::span<const double> point) {
  const Answer answer = (*this)(point);
  if (conditions() == 0) return {{answer.value}, answer.feasible};
  const Point at = inside(point);
  if (const auto known = record_.values_.find(at); known != record_.values_.end()) return {known->second, answer.feasible};
  const auto [found, is_new] = values_.try_emplace(at);
  if (is_new) found->second = record_.values(*this, at, answer);
  return {found->second, answer.feasible};
}

// Writes the gradients that the problem itself provides at a point, with NaN for each unknown entry. Returns false when the
// problem provides no gradients.
bool BudgetedObjective::known_gradients(const Point& point, std::span<double> gradients) {
  if (!record_.has_gradient()) return false;
  const auto recall = [&](const Numbers& known) {
    const auto found = known.find(point);
    if (found == known.end()) return false;
    std::copy(found->second.begin(), found->second.end(), gradients.begin());
    return true;
  };
  if (recall(record_.gradients_) || recall(gradients_)) return true;
  if (over()) {
    cut_ = true;
    throw Cut{};
  }
  gradients_.emplace(point, record_.gradients(*this, point));
  return recall(gradients_);
}

void BudgetedObjective::gradients(std::span<const double> point, std::span<double> gradients) {
  const Values here = values(point);
  Point moved = inside(point);
  const bool are_known = here.feasible && known_gradients(moved, gradients);
  const std::size_t n = point.size();
  const auto all = std::views::iota(std::size_t{0}, here.all.size());
  for (std::size_t i = 0; i < n; ++i) {
    const auto of = [&](std::size_t value) -> double& { return gradients[value * n + i]; };
    const auto is_finite = [&](std::size_t value) { return std::isfinite(of(value)); };
    if (are_known && std::ranges::all_of(all, is_finite)) continue;
    // Take the difference quotient from two neighbours of the point, both on the same side if the point is next to a bound.
    double a = -difference_step;
    double b = difference_step;
    if (point[i] + a < 0) a = 2 * difference_step;
    if (point[i] + b > 1) b = -2 * difference_step;
    const auto probe = [&](double offset) {
      moved[i] = point[i] + offset;
      return values(moved);
    };
    const Values at_a = probe(a);
    const Values at_b = probe(b);
    moved[i] = point[i];
    for (const std::size_t value : all) {
      if (are_known && is_finite(value)) continue;
      const double slope_a = (at_a.all[value] - here.all[value]) / a;
      const double slope_b = (at_b.all[value] - here.all[value]) / b;
      if (!here.feasible) {
        of(value) = at_a.feasible && at_b.feasible ? (at_b.all[value] - at_a.all[value]) / (b - a) : 0;
      } else if (at_a.feasible && at_b.feasible) {
        of(value) = (slope_a * b - slope_b * a) / (b - a);  // slope of the parabola through the three values
      } else {
        of(value) = at_a.feasible ? slope_a : at_b.feasible ? slope_b : 0;
      }
    }
  }
}

EvaluationRecord::EvaluationRecord(const Problem& problem, const OptimizerOptions& options)
    : problem_(problem), options_(options), begin_(std::chrono::steady_clock::now()), target_task_(no_task) {
  for (std::size_t i = 0; i < problem.variables.size(); ++i) {
    if (problem.variables[i].lower < problem.variables[i].upper) free_.push_back(i);
  }
  for (const std::vector<double>& start : problem.starts) {
    Point point = to_point(start);
    std::vector<double> x = start;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = std::clamp(x[i], problem.variables[i].lower, problem.variables[i].upper);
    if (exact_.emplace(point, std::move(x)).second) starts_.push_back(std::move(point));
  }
}

Point EvaluationRecord::to_point(std::span<const double> x) const {
  Point point;
  for (const std::size_t i : free_) {
    const Variable& variable = problem_.variables[i];
    // The bounds are halved before the subtraction, since upper - lower overflows for bounds near the largest double.
    const double part = (0.5 * x[i] - 0.5 * variable.lower) / (0.5 * variable.upper - 0.5 * variable.lower);
    point.push_back(std::clamp(part, 0.0, 1.0) + 0.0);
  }
  return point;
}

std::vector<double> EvaluationRecord::to_user(const Point& point) const {
  if (const auto found = exact_.find(point); found != exact_.end()) return found->second;
  std::vector<double> x;
  for (const Variable& variable : problem_.variables) x.push_back(variable.lower);
  for (std::size_t k = 0; k < free_.size(); ++k) {
    const Variable& variable = problem_.variables[free_[k]];
    const double half = std::lerp(0.5 * variable.lower, 0.5 * variable.upper, point[k]);
    x[free_[k]] = std::clamp(2 * half, variable.lower, variable.upper);
  }
  return x;
}

double EvaluationRecord::evaluate(BudgetedObjective& budgeted, const Point& point) {
  const std::vector<double> x = to_user(point);
  double value = std::numeric_limits<double>::quiet_NaN();
  const auto keep = [&](const char* what) {
    if (!budgeted.first_exception_) budgeted.first_exception_ = what;
  };
  try {
    value = problem_.objective(x);
  } catch (const std::exception& exception) {
    keep(exception.what());
  } catch (...) {
    keep("an exception that is not a std::exception");
  }
  report(budgeted.first_index_ + budgeted.evaluations(), value, x);
  return value;
}

void EvaluationRecord::report(long index, double value, const std::vector<double>& x) {
  if (!options_.on_evaluation && !options_.on_improvement) return;
  const std::scoped_lock lock(report_mutex_);
  if (!failure_.empty()) return;
  try {
    const Evaluation evaluation{.index = index, .value = value, .x = x};
    if (options_.on_evaluation) options_.on_evaluation(evaluation);
    if (std::isfinite(value) && value < live_best_) {
      live_best_ = value;
      if (options_.on_improvement) options_.on_improvement(evaluation);
    }
  } catch (const std::exception& exception) {
    failure_ = fmt::format("on_evaluation or on_improvement threw: {}", exception.what());
  } catch (...) {
    failure_ = "on_evaluation or on_improvement threw";
  }
  if (!failure_.empty()) end_from_outside(Termination::failure);
}

void EvaluationRecord::end_from_outside(Termination reason) {
  Termination none = Termination::not_run;
  outside_.compare_exchange_strong(none, reason);
}

bool EvaluationRecord::cut_off(std::size_t task) {
  if (task > target_task_ || outside_ != Termination::not_run) return true;
  if (options_.stop != nullptr && *options_.stop) {
    end_from_outside(Termination::interrupted);
    return true;
  }
  if (std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count() >= options_.max_seconds) {
    end_from_outside(Termination::time_budget);
    return true;
  }
  return false;
}

long EvaluationRecord::run(const std::vector<Task>& tasks) {
  if (over()) return 0;
  std::vector<BudgetedObjective> strands;
  long left = remaining();
  for (const Task& task : tasks) {
    const long budget = std::min(task.budget, left);
    if (budget <= 0) break;
    strands.push_back(BudgetedObjective(*this, strands.size(), budget, next_index_));
    left -= budget;
    next_index_ += budget;
  }

  target_task_ = no_task;
  run_tasks(strands.size(), options_.jobs, [&](std::size_t k) {
    try {
      if (!strands[k].over()) tasks[k].body(strands[k]);
    } catch (const Cut&) {
    } catch (const std::exception& exception) {
      const std::scoped_lock lock(report_mutex_);
      failure_ = exception.what();
      end_from_outside(Termination::failure);
    }
  });

  const long before = evaluations_;
  settle(strands);
  return evaluations_ - before;
}

// Returns the objective, then the conditions g_i, at a point. The conditions are 0, which counts as fulfilled, if the point is
// infeasible or its conditions cannot be computed.
std::vector<double> EvaluationRecord::values(BudgetedObjective& budgeted, const Point& point, const Answer& answer) const {
  std::vector<double> kept(1 + problem_.conditions.count, 0.0);
  kept[0] = answer.value;
  if (!answer.feasible) return kept;
  try {
    std::vector<double> found = problem_.conditions.values(to_user(point));
    if (found.size() != kept.size() || !std::ranges::all_of(found, [](double v) { return std::isfinite(v); })) return kept;
    for (double& value : found) value = compress(value);
    return found;
  } catch (const std::exception& error) {
    if (!budgeted.first_exception_) budgeted.first_exception_ = error.what();
  }
  return kept;
}

// Returns the gradients of objective and conditions by the variables scaled to [0, 1]; NaN, which finite differences then
// replace, after an exception of the problem.
std::vector<double> EvaluationRecord::gradients(BudgetedObjective& budgeted, const Point& point) const {
  std::vector<double> scaled((1 + problem_.conditions.count) * free_.size(), std::numeric_limits<double>::quiet_NaN());
  try {
    const std::vector<double> by_x = gradient_of_problem()(to_user(point));
    for (std::size_t i = 0; i < scaled.size(); ++i) {
      const std::size_t value = i / free_.size(), variable = free_[i % free_.size()];
      const Variable& of = problem_.variables[variable];
      scaled[i] = by_x.at(value * problem_.variables.size() + variable) * (of.upper - of.lower);
    }
  } catch (const std::exception& error) {
    if (!budgeted.first_exception_) budgeted.first_exception_ = error.what();
  }
  return scaled;
}

void EvaluationRecord::settle(const std::vector<BudgetedObjective>& strands) {
  const std::size_t last = target_task_;
  for (const BudgetedObjective& budgeted : strands) {
    if (budgeted.task_ > last) break;
    if (budgeted.first_exception_ && best_.first_exception.empty()) best_.first_exception = *budgeted.first_exception_;
    values_.insert(budgeted.values_.begin(), budgeted.values_.end());
    gradients_.insert(budgeted.gradients_.begin(), budgeted.gradients_.end());
    for (std::size_t k = 0; k < budgeted.records_.size(); ++k) {
      const BudgetedObjective::Record& record = budgeted.records_[k];
      ++evaluations_;
      known_.push_back({record.point, record.answer});
      memory_.emplace(record.point, record.answer);
      if (!record.answer.feasible) continue;
      best_seen_ = std::min(best_seen_, record.answer.value);
      worst_seen_ = std::max(worst_seen_, record.answer.value);
      if (best_.x.empty() || record.value < best_.value) {
        best_.x = to_user(record.point);
        best_.value = record.value;
        best_.improvements.push_back(
            {.index = budgeted.first_index_ + static_cast<long>(k), .value = record.value, .x = best_.x});
      }
    }
  }
  target_reached_ = last != no_task;
}

OptimizerResult EvaluationRecord::result(bool converged, const std::string& message) const {
  OptimizerResult result = best_;
  result.evaluations = evaluations_;
  const std::string said = message.empty() ? "" : fmt::format("; {}", message);
  if (target_reached_) {
    result.termination = Termination::target_reached;
    result.message = fmt::format("value {} is at or below the target {}", result.value, options_.target);
  } else if (outside_ == Termination::failure) {
    result.termination = Termination::failure;
    result.message = failure_;
  } else if (outside_ == Termination::interrupted) {
    result.termination = Termination::interrupted;
    result.message = fmt::format("interrupted after {} evaluations", evaluations_);
  } else if (outside_ == Termination::time_budget) {
    result.termination = Termination::time_budget;
    result.message = fmt::format("time budget of {} s used up after {} evaluations", options_.max_seconds, evaluations_);
  } else if (result.x.empty()) {
    result.termination = Termination::no_feasible_point;
    result.message = fmt::format("none of {} evaluations gave a finite value{}", evaluations_, said);
  } else if (remaining() <= 0) {
    result.termination = Termination::evaluation_budget;
    result.message = fmt::format("budget of {} evaluations used up{}", options_.max_evaluations, said);
  } else if (converged) {
    result.termination = Termination::converged;
    result.message = fmt::format("converged after {} evaluations{}", evaluations_, said);
  } else {
    result.termination = Termination::failure;
    result.message = fmt::format("ended after {} evaluations{}", evaluations_, said);
  }
  return result;
}

}  // namespace softland::internal
