#include "optimizers/collocation.h"

#include <IpIpoptApplication.hpp>
#include <IpTNLP.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/require.h"
#include "optimizers/ipopt_turn.h"

namespace softland {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index stages = 3;

// The nodes of a piece of the mesh, scaled to [0, 1]: its beginning and its three Radau points. `slopes` are the derivatives at
// the Radau points of the Lagrange polynomials through the nodes.
struct Radau {
  std::array<double, stages + 1> points = {0, (4 - std::sqrt(6.0)) / 10, (4 + std::sqrt(6.0)) / 10, 1};
  Eigen::Matrix<double, stages, stages + 1> slopes;

  Radau() {
    for (Index s = 0; s < stages; ++s) {
      for (Index j = 0; j <= stages; ++j)
        slopes(s, j) = slope(static_cast<std::size_t>(j), points[static_cast<std::size_t>(s) + 1]);
    }
  }

 private:
  [[nodiscard]] double slope(std::size_t j, double at) const {
    double sum = 0;
    for (std::size_t left_out = 0; left_out < points.size(); ++left_out) {
      if (left_out == j) continue;
      double product = 1 / (points[j] - points[left_out]);
      for (std::size_t k = 0; k < points.size(); ++k) {
        if (k != j && k != left_out) product *= (at - points[k]) / (points[j] - points[k]);
      }
      sum += product;
    }
    return sum;
  }
};

const Radau& radau() {
  static const Radau rule;
  return rule;
}

// One term of a control at a point of the mesh: a control is a weighted sum of control variables of the nonlinear program.
struct ControlWeight {
  // Index of the column of control variables: one column per interval between the times at which controls change, or one per
  // such time if their slew is bounded.
  Index column;
  double weight;
};

struct Place {
  Index piece, stage;
  double length;  // length of the piece of the mesh that contains the point, a fraction of the final time T
  double at;      // time of the point, a fraction of the final time T
  std::vector<ControlWeight> parts;
};

// The nonlinear program of the collocation. Its variables are the final time T, the controls column by column and the states
// point by point.
class Program final : public Ipopt::TNLP {
 public:
  Program(const ControlProblem& problem, const ControlledCourse& guess, ControlledCourse& result)
      : problem_(problem),
        guess_(guess),
        result_(result),
        n_(problem.system->states()),
        nc_(problem.system->controls()),
        ramps_(std::isfinite(problem.bounds.front().slew)) {
    const std::vector<double>& knots = problem.knots;
    const auto intervals = static_cast<Index>(knots.size()) - 1;
    columns_ = ramps_ ? intervals + 1 : intervals;
    Index piece = 0;
    for (Index k = 0; k < intervals; ++k) {
      const double begin = knots[static_cast<std::size_t>(k)], end = knots[static_cast<std::size_t>(k) + 1];
      const auto count = std::max<Index>(1, static_cast<Index>(std::ceil((end - begin) / problem.longest_piece - 1e-9)));
      for (Index m = 0; m < count; ++m, ++piece) {
        const double length = (end - begin) / static_cast<double>(count);
        for (Index s = 0; s < stages; ++s) {
          const double inside =
              (static_cast<double>(m) + radau().points[static_cast<std::size_t>(s) + 1]) / static_cast<double>(count);
          std::vector<ControlWeight> parts{{k, 1}};
          if (ramps_) parts = {{k, 1 - inside}, {k + 1, inside}};
          points_.push_back({piece, s, length, begin + (end - begin) * inside, std::move(parts)});
        }
      }
    }
    points_.back().at = 1;
    for (Index r = 0; r < n_; ++r) {
      for (Index k = 0; k < n_ + nc_; ++k) depends_.push_back(problem.system->depends(r, k));
    }
  }

  bool get_nlp_info(Ipopt::Index& n, Ipopt::Index& m, Ipopt::Index& jacobian_entries, Ipopt::Index& hessian_entries,
                    IndexStyleEnum& index_style) override {
    n = static_cast<Ipopt::Index>(variables());
    m = static_cast<Ipopt::Index>(rows());
    Index first = 0, second = 0;
    for_jacobian({}, nullptr, [&](Index, Index, double) { ++first; });
    for_hessian(nullptr, 0, nullptr, [&](Index, Index, double) { ++second; });
    jacobian_entries = static_cast<Ipopt::Index>(first);
    hessian_entries = static_cast<Ipopt::Index>(second);
    index_style = C_STYLE;
    return true;
  }

  bool get_bounds_info(Ipopt::Index n, Ipopt::Number* lower, Ipopt::Number* upper, Ipopt::Index, Ipopt::Number* row_lower,
                       Ipopt::Number* row_upper) override {
    constexpr double none = 2e19;  // Ipopt takes a bound beyond 1e19 as no bound
    std::fill_n(lower, n, -none);
    std::fill_n(upper, n, none);
    lower[0] = problem_.shortest;
    upper[0] = problem_.longest;
    for (Index column = 0; column < columns_; ++column) {
      for (Index k = 0; k < nc_; ++k) {
        const ControlBound& bound = problem_.bounds[static_cast<std::size_t>(k)];
        std::optional<double> fixed;
        if (ramps_ && column + 1 == columns_) fixed = bound.after;
        if (ramps_ && column == 0) fixed = bound.before;
        lower[control(column, k)] = fixed.value_or(bound.lower);
        upper[control(column, k)] = fixed.value_or(bound.upper);
      }
    }
    Index row = collocation_rows();
    std::fill_n(row_lower, row, 0.0);
    std::fill_n(row_upper, row, 0.0);
    const auto bound_row = [&](double low, double high) {
      row_lower[row] = std::max(low, -none);
      row_upper[row] = std::min(high, none);
      ++row;
    };
    for (const StateCondition& c : problem_.on_the_way) {
      for (Index p = stages - 1; p < last_point(); p += stages) bound_row(c.lower, c.upper);
    }
    for (const StateCondition& c : problem_.at_the_end) bound_row(c.lower, c.upper);
    for (Index r = 0; r < slew_rows(); ++r) bound_row(-none, 0);
    return true;
  }

  bool get_starting_point(Ipopt::Index, bool, Ipopt::Number* x, bool, Ipopt::Number*, Ipopt::Number*, Ipopt::Index, bool,
                          Ipopt::Number*) override {
    x[0] = guess_.time;
    for (Index column = 0; column < columns_; ++column) {
      const std::vector<double>& knots = problem_.knots;
      const auto c = static_cast<std::size_t>(column);
      const VectorXd value = guess_.control_at(ramps_ ? knots[c] : (knots[c] + knots[c + 1]) / 2);
      for (Index k = 0; k < nc_; ++k) x[control(column, k)] = value[k];
    }
    for (std::size_t p = 0; p < points_.size(); ++p) {
      const VectorXd state = guess_.state_at(points_[p].at);
      for (Index r = 0; r < n_; ++r) x[this->state(static_cast<Index>(p), r)] = state[r];
    }
    return true;
  }

  bool eval_f(Ipopt::Index, const Ipopt::Number* x, bool, Ipopt::Number& value) override {
    value = problem_.ends_best ? problem_.ends_best->dot(state_of(x, last_point())) : x[0];
    return std::isfinite(value);
  }
  bool eval_grad_f(Ipopt::Index n, const Ipopt::Number*, bool, Ipopt::Number* gradient) override {
    std::fill_n(gradient, n, 0.0);
    if (!problem_.ends_best) gradient[0] = 1;
    for (Index r = 0; problem_.ends_best && r < n_; ++r) gradient[state(last_point(), r)] = (*problem_.ends_best)[r];
    return true;
  }

  bool eval_g(Ipopt::Index, const Ipopt::Number* x, bool is_new, Ipopt::Index m, Ipopt::Number* g) override {
    look_at(x, is_new);
    Index row = 0;
    for (std::size_t p = 0; p < points_.size(); ++p) {
      const Place& point = points_[p];
      VectorXd sum = -point.length * x[0] * rates_[p].value;
      for (Index j = 0; j <= stages; ++j) sum += radau().slopes(point.stage, j) * node_of(x, point.piece, j);
      std::copy(sum.begin(), sum.end(), g + row);
      row += n_;
    }
    for (const StateCondition& c : problem_.on_the_way) {
      for (Index p = stages - 1; p < last_point(); p += stages) g[row++] = c.row.dot(state_of(x, p));
    }
    for (const StateCondition& c : problem_.at_the_end) g[row++] = c.row.dot(state_of(x, last_point()));
    for_slews([&](Index column, Index k, double sign, double span) {
      g[row++] = sign * (x[control(column + 1, k)] - x[control(column, k)]) -
                 problem_.bounds[static_cast<std::size_t>(k)].slew * span * x[0];
    });
    return std::all_of(g, g + m, [](double value) { return std::isfinite(value); });
  }

  bool eval_jac_g(Ipopt::Index, const Ipopt::Number* x, bool is_new, Ipopt::Index, Ipopt::Index, Ipopt::Index* row,
                  Ipopt::Index* column, Ipopt::Number* values) override {
    if (values == nullptr) {
      for_jacobian({}, nullptr, [&](Index r, Index c, double) {
        *row++ = static_cast<Ipopt::Index>(r);
        *column++ = static_cast<Ipopt::Index>(c);
      });
      return true;
    }
    look_at(x, is_new);
    bool finite = true;
    for_jacobian(rates_, x, [&](Index, Index, double value) {
      finite = finite && std::isfinite(value);
      *values++ = value;
    });
    return finite;
  }

  bool eval_h(Ipopt::Index, const Ipopt::Number* x, bool is_new, Ipopt::Number, Ipopt::Index, const Ipopt::Number* multipliers,
              bool, Ipopt::Index, Ipopt::Index* row, Ipopt::Index* column, Ipopt::Number* values) override {
    if (values == nullptr) {
      for_hessian(nullptr, 0, nullptr, [&](Index r, Index c, double) {
        *row++ = static_cast<Ipopt::Index>(r);
        *column++ = static_cast<Ipopt::Index>(c);
      });
      return true;
    }
    look_at(x, is_new);
    bool finite = true;
    for_hessian(x, x[0], multipliers, [&](Index, Index, double value) {
      finite = finite && std::isfinite(value);
      *values++ = value;
    });
    return finite;
  }

  bool intermediate_callback(Ipopt::AlgorithmMode, Ipopt::Index iteration, Ipopt::Number, Ipopt::Number, Ipopt::Number,
                             Ipopt::Number, Ipopt::Number, Ipopt::Number, Ipopt::Number, Ipopt::Number, Ipopt::Index,
                             const Ipopt::IpoptData*, Ipopt::IpoptCalculatedQuantities*) override {
    result_.iterations = iteration;
    return problem_.stop == nullptr || !*problem_.stop;
  }

  void finalize_solution(Ipopt::SolverReturn, Ipopt::Index, const Ipopt::Number* x, const Ipopt::Number*, const Ipopt::Number*,
                         Ipopt::Index, const Ipopt::Number*, const Ipopt::Number*, Ipopt::Number, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    result_.time = x[0];
    result_.knots = problem_.knots;
    result_.controls.resize(nc_, columns_);
    for (Index column = 0; column < columns_; ++column) {
      for (Index k = 0; k < nc_; ++k) result_.controls(k, column) = x[control(column, k)];
    }
    result_.points = {0};
    result_.states.resize(n_, static_cast<Index>(points_.size()) + 1);
    result_.states.col(0) = problem_.start;
    for (std::size_t p = 0; p < points_.size(); ++p) {
      result_.points.push_back(points_[p].at);
      result_.states.col(static_cast<Index>(p) + 1) = state_of(x, static_cast<Index>(p));
    }
  }

 private:
  [[nodiscard]] Index control(Index column, Index k) const { return 1 + column * nc_ + k; }
  [[nodiscard]] Index state(Index point, Index r) const { return 1 + columns_ * nc_ + point * n_ + r; }
  [[nodiscard]] Index last_point() const { return static_cast<Index>(points_.size()) - 1; }
  [[nodiscard]] Index variables() const { return state(last_point() + 1, 0); }
  [[nodiscard]] Index collocation_rows() const { return static_cast<Index>(points_.size()) * n_; }
  [[nodiscard]] Index slew_rows() const { return ramps_ ? 2 * nc_ * (columns_ - 1) : 0; }
  [[nodiscard]] Index rows() const {
    return collocation_rows() + static_cast<Index>(problem_.on_the_way.size()) * (last_point() / stages) +
           static_cast<Index>(problem_.at_the_end.size()) + slew_rows();
  }
  [[nodiscard]] VectorXd state_of(const double* x, Index point) const {
    return Eigen::Map<const VectorXd>(x + state(point, 0), n_);
  }
  // Returns the states at node j of a piece of the mesh: its beginning for j = 0, otherwise its Radau point j.
  [[nodiscard]] VectorXd node_of(const double* x, Index piece, Index j) const {
    const Index point = piece * stages + j - 1;
    return point < 0 ? problem_.start : state_of(x, point);
  }
  [[nodiscard]] VectorXd control_of(const double* x, const Place& point) const {
    VectorXd value = VectorXd::Zero(nc_);
    for (const ControlWeight& part : point.parts)
      value += part.weight * Eigen::Map<const VectorXd>(x + control(part.column, 0), nc_);
    return value;
  }
  [[nodiscard]] bool depends(Index r, Index k) const { return depends_[static_cast<std::size_t>(r * (n_ + nc_) + k)]; }

  void look_at(const double* x, bool is_new) {
    if (!is_new && !rates_.empty()) return;
    rates_.clear();
    for (std::size_t p = 0; p < points_.size(); ++p) {
      rates_.push_back(problem_.system->rates(state_of(x, static_cast<Index>(p)), control_of(x, points_[p])));
    }
  }

  template <class F>
  void for_slews(F&& f) const {
    if (!ramps_) return;
    for (Index column = 0; column + 1 < columns_; ++column) {
      const auto c = static_cast<std::size_t>(column);
      for (Index k = 0; k < nc_; ++k) {
        for (const double sign : {1.0, -1.0}) f(column, k, sign, problem_.knots[c + 1] - problem_.knots[c]);
      }
    }
  }

  // Calls entry(row, column, value) for the entries of the Jacobian of the constraints, in the order of the sparse matrix. With
  // empty `rates` only rows and columns count, which Ipopt requests once for the sparsity pattern.
  template <class F>
  void for_jacobian(const std::vector<ControlledSystem::Rates>& rates, const double* x, F&& entry) const {
    Index row = 0;
    for (std::size_t p = 0; p < points_.size(); ++p) {
      const Place& point = points_[p];
      const double span = x == nullptr ? 0 : point.length * x[0];
      const auto slope = [&](Index r, Index k) { return rates.empty() ? 0.0 : -span * rates[p].slope(r, k); };
      for (Index r = 0; r < n_; ++r, ++row) {
        entry(row, 0, rates.empty() ? 0.0 : -point.length * rates[p].value[r]);
        for (const ControlWeight& part : point.parts) {
          for (Index k = 0; k < nc_; ++k) {
            if (depends(r, n_ + k)) entry(row, control(part.column, k), part.weight * slope(r, n_ + k));
          }
        }
        for (Index j = 0; j <= stages; ++j) {
          const Index node = point.piece * stages + j - 1;
          if (node < 0) continue;
          const double own = radau().slopes(point.stage, j);
          if (j != point.stage + 1) {
            entry(row, state(node, r), own);
            continue;
          }
          for (Index k = 0; k < n_; ++k) {
            if (k == r || depends(r, k)) entry(row, state(node, k), (k == r ? own : 0.0) + (depends(r, k) ? slope(r, k) : 0.0));
          }
        }
      }
    }
    const auto condition = [&](const StateCondition& c, Index point) {
      for (Index r = 0; r < n_; ++r) {
        if (c.row[r] != 0) entry(row, state(point, r), c.row[r]);
      }
      ++row;
    };
    for (const StateCondition& c : problem_.on_the_way) {
      for (Index p = stages - 1; p < last_point(); p += stages) condition(c, p);
    }
    for (const StateCondition& c : problem_.at_the_end) condition(c, last_point());
    for_slews([&](Index column, Index k, double sign, double span) {
      entry(row, 0, -problem_.bounds[static_cast<std::size_t>(k)].slew * span);
      entry(row, control(column, k), -sign);
      entry(row, control(column + 1, k), sign);
      ++row;
    });
  }

  // Calls entry(row, column, value) for the lower triangle of the Lagrangian's second derivatives, to which the linear
  // objective adds nothing. With x null only rows and columns count, for Ipopt's sparsity pattern.
  template <class F>
  void for_hessian(const double* x, double time, const double* multipliers, F&& entry) {
    MatrixXd curvature = MatrixXd::Zero(n_ + nc_, n_ + nc_);
    VectorXd by_time = VectorXd::Zero(n_ + nc_);
    for (std::size_t p = 0; p < points_.size(); ++p) {
      const Place& point = points_[p];
      const auto at = static_cast<Index>(p);
      if (x != nullptr) {
        const VectorXd own = -point.length * Eigen::Map<const VectorXd>(multipliers + at * n_, n_);
        curvature = time * problem_.system->curvature(state_of(x, at), control_of(x, point), own);
        by_time = rates_[p].slope.transpose() * own;
      }
      for (Index r = 0; r < n_; ++r) {
        entry(state(at, r), 0, by_time[r]);
        for (Index k = 0; k <= r; ++k) entry(state(at, r), state(at, k), curvature(r, k));
        for (const ControlWeight& part : point.parts) {
          for (Index k = 0; k < nc_; ++k) entry(state(at, r), control(part.column, k), part.weight * curvature(r, n_ + k));
        }
      }
      for (const ControlWeight& part : point.parts) {
        for (Index k = 0; k < nc_; ++k) {
          entry(control(part.column, k), 0, part.weight * by_time[n_ + k]);
          for (const ControlWeight& other : point.parts) {
            for (Index j = 0; j < nc_; ++j) {
              if (control(other.column, j) > control(part.column, k)) continue;
              entry(control(part.column, k), control(other.column, j), part.weight * other.weight * curvature(n_ + k, n_ + j));
            }
          }
        }
      }
    }
  }

  const ControlProblem& problem_;
  const ControlledCourse& guess_;
  ControlledCourse& result_;
  Index n_, nc_;
  bool ramps_;
  Index columns_ = 0;
  std::vector<Place> points_;
  std::vector<bool> depends_;
  // Rates f(x, c) of the states, and derivatives of the rates, at every Radau point.
  std::vector<ControlledSystem::Rates> rates_;
};

void check(const ControlProblem& p, const ControlledCourse& guess) {
  require(p.system != nullptr, "optimal control: the system must not be null");
  const Index n = p.system->states();
  require(p.start.size() == n, "optimal control: `start` must have one value per state");
  require(static_cast<Index>(p.bounds.size()) == p.system->controls() && !p.bounds.empty(),
          "optimal control: `bounds` must have one entry per control, at least one");
  for (const ControlBound& bound : p.bounds) {
    require(bound.lower <= bound.upper && bound.slew > 0, "optimal control: a control must have lower <= upper and slew > 0");
    require(std::isfinite(bound.slew) == std::isfinite(p.bounds.front().slew),
            "optimal control: the slews must be finite for all controls or for none");
  }
  for (const auto* conditions : {&p.on_the_way, &p.at_the_end}) {
    for (const StateCondition& c : *conditions) {
      require(c.row.size() == n && c.lower <= c.upper,
              "optimal control: a condition must have one coefficient per state and lower <= upper");
    }
  }
  require(p.shortest >= 0 && p.shortest < p.longest && std::isfinite(p.longest),
          "optimal control: the times must be finite with 0 <= shortest < longest");
  require(p.knots.size() >= 2 && p.knots.front() == 0 && p.knots.back() == 1 &&
              std::is_sorted(p.knots.begin(), p.knots.end(), std::less_equal<>()),
          "optimal control: the knots must increase from 0 to 1");
  require(p.longest_piece > 0, "optimal control: longest_piece must be above 0");
  require(guess.states.rows() == n && guess.controls.rows() == p.system->controls() && guess.time > 0,
          "optimal control: the guess must have the states and controls of the problem and a time above 0");
}

std::string words_of(Ipopt::ApplicationReturnStatus status) {
  switch (status) {
    case Ipopt::Solve_Succeeded:
      return "Ipopt: Solve_Succeeded";
    case Ipopt::Solved_To_Acceptable_Level:
      return "Ipopt: Solved_To_Acceptable_Level";
    case Ipopt::Infeasible_Problem_Detected:
      return "Ipopt: Infeasible_Problem_Detected";
    case Ipopt::Maximum_Iterations_Exceeded:
      return "Ipopt: Maximum_Iterations_Exceeded";
    case Ipopt::Restoration_Failed:
      return "Ipopt: Restoration_Failed";
    case Ipopt::Diverging_Iterates:
      return "Ipopt: Diverging_Iterates";
    case Ipopt::Invalid_Number_Detected:
      return "Ipopt: Invalid_Number_Detected";
    case Ipopt::User_Requested_Stop:
      return "Ipopt: stopped by softland";
    default:
      return "Ipopt: status " + std::to_string(static_cast<int>(status));
  }
}

}  // namespace

ControlledCourse solve(const ControlProblem& problem, const ControlledCourse& guess) {
  check(problem, guess);
  ControlledCourse result = guess;
  result.converged = result.interrupted = false;
  result.iterations = 0;
  const auto stopped = [&] { return problem.stop != nullptr && *problem.stop; };
  const auto turn = internal::ipopt_turn(stopped);
  if (!turn) {
    result.interrupted = true;
    return result;
  }
  const Ipopt::SmartPtr<Ipopt::IpoptApplication> application = new Ipopt::IpoptApplication(/*create_console_out=*/false);
  const auto options = application->Options();
  options->SetIntegerValue("print_level", 0);
  options->SetStringValue("sb", "yes");
  options->SetNumericValue("tol", problem.tolerance);
  // This tolerance of complementarity is tighter than Ipopt's default, which would leave controls visibly inside their bounds.
  options->SetNumericValue("compl_inf_tol", problem.tolerance);
  options->SetIntegerValue("max_iter", static_cast<int>(problem.max_iterations));
  options->SetNumericValue("bound_relax_factor", 0.0);
  options->SetNumericValue("mu_init", 1e-3);
  options->SetNumericValue("bound_push", 1e-4);
  options->SetNumericValue("bound_frac", 1e-4);
  // With its default pivot tolerance of 1e-6 the linear solver MUMPS miscounts negative eigenvalues if the states differ by
  // orders of magnitude; Ipopt then regularises the Hessian more and more. Minimum degree ordering fills these matrices less
  // than the ordering that MUMPS would choose.
  options->SetNumericValue("mumps_pivtol", 1e-3);
  options->SetIntegerValue("mumps_pivot_order", 0);
  // The name is empty because otherwise Ipopt would read a file ipopt.opt from the working directory.
  auto status = application->Initialize("");
  if (status == Ipopt::Solve_Succeeded) status = application->OptimizeTNLP(new Program(problem, guess, result));
  result.converged = status == Ipopt::Solve_Succeeded || status == Ipopt::Solved_To_Acceptable_Level;
  result.interrupted = stopped();
  result.message = words_of(status);
  return result;
}

}  // namespace softland
