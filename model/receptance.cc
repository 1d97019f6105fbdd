#include "model/receptance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "base/gauss.h"

namespace softland {
namespace {

// Integrals over xi in [-1, 1] of products of a beam element's motions, and of products of their slopes. The motions are those
// of the rigid element, 1 and 1 + xi, and the shape functions: sqrt(m + 1/2) times the second integrals of the Legendre
// polynomials P_m.
struct ElementProducts {
  static constexpr int size = 2 + element_functions;
  using Row = Eigen::Matrix<double, 1, size>;
  Eigen::Matrix<double, size, size> values, slopes;

  static Row row(double xi, int derivative) {
    Row r;
    r << (derivative == 0 ? 1 : 0), (derivative == 0 ? 1 + xi : 1), element_integrals(xi, derivative);
    for (int m = 0; m < element_functions; ++m) r[2 + m] *= std::sqrt(m + 0.5);
    return r;
  }
  static const ElementProducts& get() {
    static const ElementProducts products = [] {
      ElementProducts p;
      p.values.setZero();
      p.slopes.setZero();
      // Gauss rule that is exact for products of two shape functions, which have the degree 9.
      const GaussRule rule = gauss_rule(element_functions + 2);
      for (std::size_t g = 0; g < rule.points.size(); ++g) {
        const Row value = row(rule.points[g], 0), slope = row(rule.points[g], 1);
        p.values += rule.weights[g] * value.transpose() * value;
        p.slopes += rule.weights[g] * slope.transpose() * slope;
      }
      return p;
    }();
    return products;
  }
};

// Returns false when the integral of the product of the motions i and j is 0 by symmetry: shape functions that leave the right
// end at rest (from index 4 on) are even or odd.
constexpr bool act_on_each_other(int i, int j) { return i < 4 || j < 4 || (i - j) % 2 == 0; }

// At the right end of an element, xi = 1: deflections by the first two shape functions, and the slope by xi of the first one.
// The slope of the second one is 0 there.
const double first_at_end = std::sqrt(2.0), second_at_end = -std::sqrt(2.0 / 3), first_turn = std::sqrt(2.0);

}  // namespace

ElementRow element_integrals(double xi, int derivative) {
  constexpr int most = element_functions + 1;
  std::array<double, most + 1> p;  // values of the Legendre polynomials at xi
  p[0] = 1;
  p[1] = xi;
  for (int k = 2; k <= most; ++k) {
    const auto i = static_cast<std::size_t>(k);
    p[i] = ((2 * k - 1) * xi * p[i - 1] - (k - 1) * p[i - 2]) / k;
  }
  ElementRow n;
  if (derivative == 0) {
    n.head<2>() << (xi + 1) * (xi + 1) / 2, (xi + 1) * (xi + 1) * (xi - 2) / 6;
  } else {
    n.head<2>() << xi + 1, (xi + 1) * (xi - 1) / 2;
  }
  for (int m = 2; m < element_functions; ++m) {
    const auto i = static_cast<std::size_t>(m);
    n[m] = derivative == 0 ? p[i + 2] / ((2 * m + 1) * (2 * m + 3)) - 2 * p[i] / ((2 * m - 1) * (2 * m + 3)) +
                                 p[i - 2] / ((2 * m + 1) * (2 * m - 1))
                           : (p[i + 1] - p[i - 1]) / (2 * m + 1);
  }
  return n;
}

Eigen::MatrixXd slope_products(const std::vector<BeamElement>& elements, const Eigen::MatrixXd& motions,
                               const std::optional<Eigen::RowVectorXd>& first_slopes) {
  const Eigen::Index modes = motions.cols();
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(modes, modes);
  Eigen::Matrix<double, ElementProducts::size, Eigen::Dynamic> local(ElementProducts::size, modes);
  Eigen::RowVectorXd deflection = Eigen::RowVectorXd::Zero(modes), slope = first_slopes.value_or(deflection);
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const double half = elements[e].half(), reach = std::sqrt(std::pow(half, 3) / elements[e].rigidity);
    local << deflection, half * slope,
        reach * motions.middleRows<element_functions>(element_functions * static_cast<Eigen::Index>(e));
    products += local.transpose() * ElementProducts::get().slopes * local / half;
    deflection += 2 * local.row(1) + first_at_end * local.row(2) + second_at_end * local.row(3);
    slope += first_turn / half * local.row(2);
  }
  return products;
}

bool Receptance::ElementKind::holds(const BeamElement& e) const {
  return rigidity == e.rigidity && mass == e.mass && std::abs(half - e.half()) <= 1e-13 * half;
}

Receptance::Receptance(const std::vector<BeamElement>& elements, double axial_force, bool far_clamp)
    : axial_force_(axial_force), far_clamp_(far_clamp), stages_(elements.size()) {
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const BeamElement& e = elements[i];
    if (kinds_.empty() || !kinds_.back().holds(e)) {
      kinds_.emplace_back();
      ElementKind& kind = kinds_.back();
      kind.half = e.half(), kind.mass = e.mass, kind.rigidity = e.rigidity;
      kind.reach = std::sqrt(std::pow(kind.half, 3) / e.rigidity);
    }
    stages_[i].kind = kinds_.size() - 1;
    std::fill(std::begin(stages_[i].load), std::end(stages_[i].load), Lane::Zero());
    nodes_.push_back(e.end);
  }
}

void Receptance::condense(ElementKind& kind, const Lane& lambda) const {
  const ElementProducts& products = ElementProducts::get();
  const double pull = axial_force_ / kind.half;
  const Lane inertia = kind.mass * kind.half * lambda;
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j <= i; ++j) {
      const double reach = (i < 2 ? 1 : kind.reach) * (j < 2 ? 1 : kind.reach);
      kind.form[i][j] = reach * pull * products.slopes(i, j) - (reach * products.values(i, j)) * inertia;
    }
    if (i >= 2) kind.form[i][i] += 1;
  }
  kind.negative.setZero();
  kind.least_pivot.setConstant(std::numeric_limits<double>::infinity());
  for (int k = size - 1; k >= kept; --k) {
    const Lane inverse = kind.inverse[k] = kind.form[k][k].inverse();
    kind.negative += (kind.form[k][k] < 0).cast<double>();
    kind.least_pivot = kind.least_pivot.min(kind.form[k][k].abs());
    for (int i = 0; i < k; ++i) {
      if (!act_on_each_other(k, i)) continue;
      const Lane factor = kind.form[k][i] * inverse;
      for (int j = 0; j <= i; ++j) {
        if (act_on_each_other(k, j)) kind.form[i][j] -= factor * kind.form[k][j];
      }
    }
  }
}

void Receptance::load(double x) {
  const auto node = std::lower_bound(nodes_.begin(), std::prev(nodes_.end()), x);
  loaded_ = static_cast<std::size_t>(node - nodes_.begin());
  const ElementKind& kind = kinds_[stages_[loaded_].kind];
  const ElementProducts::Row row = ElementProducts::row((x - *node) / kind.half + 1, 0);
  for (int i = 0; i < size; ++i) {
    probe_[i] = row[i] * (i < 2 ? 1 : kind.reach);
    load_[i].setConstant(probe_[i]);
  }
  for (int k = size - 1; k >= kept; --k) {
    const Lane share = load_[k] * kind.inverse[k];
    for (int i = 0; i < k; ++i) {
      if (act_on_each_other(k, i)) load_[i] -= kind.form[k][i] * share;
    }
  }
}

// Adds to the quadratic form and load of an element those of the beam beyond its right end. The beam there acts like a spring,
// `stiffness` (deflection-deflection, deflection-slope, slope-slope), and a load, `force`, on the deflection and slope of this
// end.
void Receptance::add_beyond(Stage& stage, const ElementKind& kind, const Lane* stiffness, const Lane* force) const {
  const double deflection[kept] = {1, 2, kind.reach * first_at_end, kind.reach * second_at_end};
  const double slope[kept] = {0, 1 / kind.half, kind.reach * first_turn / kind.half, 0};
  for (int i = 0; i < kept; ++i) {
    const Lane shear = stiffness[0] * deflection[i] + stiffness[1] * slope[i];
    const Lane moment = stiffness[1] * deflection[i] + stiffness[2] * slope[i];
    for (int j = 0; j <= i; ++j) stage.form[i][j] += shear * deflection[j] + moment * slope[j];
    stage.load[i] += force[0] * deflection[i] + force[1] * slope[i];
  }
}

// Clamps the right end of the last element. Only the first two shape functions move this end, so their factors follow from the
// motion of the left end.
void Receptance::fix_end(Stage& stage, const ElementKind& kind) const {
  const double first = -1 / (kind.reach * first_turn), second = -1 / (kind.reach * second_at_end);
  auto& f = stage.form;
  auto& p = stage.load;
  // Substitute the factors s_0, s_1 of the first two shape functions. They hold the right end in place: s_0 = first * rotation
  // and s_1 = second * (deflection + rotation), deflection and rotation being those of the rigid element.
  const Lane f00 = f[0][0] + 2 * second * f[3][0] + second * second * f[3][3];
  const Lane f10 = f[1][0] + first * f[2][0] + second * (f[3][0] + f[3][1] + first * f[3][2]) + second * second * f[3][3];
  const Lane f11 = f[1][1] + 2 * first * f[2][1] + 2 * second * f[3][1] + first * first * f[2][2] + 2 * first * second * f[3][2] +
                   second * second * f[3][3];
  f[0][0] = f00, f[1][0] = f10, f[1][1] = f11;
  p[0] += second * p[3];
  p[1] += first * p[2] + second * p[3];
}

void Receptance::sweep_to_clamp(Answer& answer) {
  Lane stiffness[3] = {Lane::Zero(), Lane::Zero(), Lane::Zero()}, force[2] = {Lane::Zero(), Lane::Zero()};
  for (std::size_t e = stages_.size(); e-- > 0;) {
    Stage& stage = stages_[e];
    const ElementKind& kind = kinds_[stage.kind];
    for (int i = 0; i < kept; ++i) {
      stage.load[i] = e == loaded_ ? load_[i] : Lane::Zero();
      for (int j = 0; j <= i; ++j) stage.form[i][j] = kind.form[i][j];
    }
    answer.below += kind.negative;
    if (far_clamp_ && e + 1 == stages_.size()) {
      fix_end(stage, kind);
    } else {
      add_beyond(stage, kind, stiffness, force);
      // Eliminate the first two shape functions together: the pivot of one of them alone may be zero at a frequency that is far
      // from every pole of the receptance.
      auto& f = stage.form;
      const Lane determinant = f[2][2] * f[3][3] - f[3][2].square(), over = determinant.inverse();
      stage.inverse[0] = f[3][3] * over;
      stage.inverse[1] = -f[3][2] * over;
      stage.inverse[2] = f[2][2] * over;
      answer.below += (determinant < 0).select(Lane::Ones(), 2 * (f[3][3] < 0).cast<double>());
      if (e > 0) {
        const Lane pivot = determinant.abs() / (f[2][2].abs() + f[3][3].abs() + f[3][2].abs());
        answer.least_pivot = answer.least_pivot.min(pivot);
      }
      for (int i = 0; i < 2; ++i) {
        const Lane first = stage.inverse[0] * f[2][i] + stage.inverse[1] * f[3][i];
        const Lane second = stage.inverse[1] * f[2][i] + stage.inverse[2] * f[3][i];
        for (int j = 0; j <= i; ++j) f[i][j] -= first * f[2][j] + second * f[3][j];
        stage.load[i] -= first * stage.load[2] + second * stage.load[3];
      }
    }
    stiffness[0] = stage.form[0][0];
    stiffness[1] = stage.form[1][0] * kind.half;
    stiffness[2] = stage.form[1][1] * (kind.half * kind.half);
    force[0] = stage.load[0];
    force[1] = stage.load[1] * kind.half;
  }
}

void Receptance::sweep_to_end(Answer& answer) {
  const ElementProducts& products = ElementProducts::get();
  Lane deflection = Lane::Zero(), slope = Lane::Zero();
  for (std::size_t e = 0; e < stages_.size(); ++e) {
    Stage& stage = stages_[e];
    const ElementKind& kind = kinds_[stage.kind];
    auto& y = stage.motion;
    y[0] = deflection;
    y[1] = slope * kind.half;
    if (far_clamp_ && e + 1 == stages_.size()) {
      y[2] = -y[1] / (kind.reach * first_turn);
      y[3] = -(y[0] + y[1]) / (kind.reach * second_at_end);
    } else {
      const Lane first = stage.load[2] - stage.form[2][0] * y[0] - stage.form[2][1] * y[1];
      const Lane second = stage.load[3] - stage.form[3][0] * y[0] - stage.form[3][1] * y[1];
      y[2] = stage.inverse[0] * first + stage.inverse[1] * second;
      y[3] = stage.inverse[1] * first + stage.inverse[2] * second;
    }
    for (int k = kept; k < size; ++k) {
      y[k] = e == loaded_ ? load_[k] : Lane::Zero();
      for (int j = 0; j < k; ++j) {
        if (act_on_each_other(k, j)) y[k] -= kind.form[k][j] * y[j];
      }
      y[k] *= kind.inverse[k];
    }
    deflection = y[0] + 2 * y[1] + kind.reach * (first_at_end * y[2] + second_at_end * y[3]);
    slope = (y[1] + kind.reach * first_turn * y[2]) / kind.half;

    Lane inertia = Lane::Zero();
    for (int i = 0; i < size; ++i) {
      Lane momentum = products.values(i, i) / 2 * (i < 2 ? 1 : kind.reach) * y[i];
      for (int j = 0; j < i; ++j) {
        if (act_on_each_other(i, j)) momentum += products.values(i, j) * (j < 2 ? 1 : kind.reach) * y[j];
      }
      inertia += momentum * ((i < 2 ? 2 : 2 * kind.reach) * y[i]);
    }
    answer.inertia += kind.mass * kind.half * inertia;
  }
  for (int i = 0; i < size; ++i) answer.deflection += probe_[i] * stages_[loaded_].motion[i];
}

Receptance::Answer Receptance::at(const Lane& lambda, double x) {
  Answer answer{.deflection = Lane::Zero(),
                .inertia = Lane::Zero(),
                .below = Lane::Zero(),
                .least_pivot = Lane::Constant(std::numeric_limits<double>::infinity())};
  for (ElementKind& kind : kinds_) {
    condense(kind, lambda);
    answer.least_pivot = answer.least_pivot.min(kind.least_pivot);
  }
  load(x);
  sweep_to_clamp(answer);
  sweep_to_end(answer);
  return answer;
}

Eigen::VectorXd Receptance::motion(Eigen::Index lane) const {
  Eigen::VectorXd factors(element_functions * static_cast<Eigen::Index>(stages_.size()));
  Eigen::Index i = 0;
  for (const Stage& stage : stages_) {
    for (int m = 0; m < element_functions; ++m) factors[i++] = stage.motion[2 + m][lane];
  }
  return factors;
}

}  // namespace softland
