#include "model/beam.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "base/require.h"
#include "model/gauss.h"

namespace softland {
namespace {

constexpr int bubbles = 6;             // internal functions per element: polynomials up to degree 9
constexpr int unknowns = 4 + bubbles;  // w, w' at both ends, then the internal functions
constexpr int shortest_count = 6;      // elements over the length, at least

// Legendre polynomials P_0 ... P_n at xi.
std::vector<double> legendre(double xi, int n) {
  std::vector<double> p(static_cast<std::size_t>(n) + 1);
  p[0] = 1;
  if (n > 0) p[1] = xi;
  for (int k = 2; k <= n; ++k) {
    const auto i = static_cast<std::size_t>(k);
    p[i] = ((2 * k - 1) * xi * p[i - 1] - (k - 1) * p[i - 2]) / k;
  }
  return p;
}

using ElementRow = Eigen::Matrix<double, 1, unknowns>;

// Shape functions of one element of length h and their derivatives with respect to x, at xi in [-1, 1].
ElementRow element_shape(double xi, double h, int derivative) {
  ElementRow n;
  const double x1 = xi, x2 = xi * xi, x3 = x2 * xi, j = h / 2;  // j = dx/dxi
  switch (derivative) {
    case 0:
      n.head<4>() << (2 - 3 * x1 + x3) / 4, j * (1 - x1 - x2 + x3) / 4, (2 + 3 * x1 - x3) / 4, j * (-1 - x1 + x2 + x3) / 4;
      break;
    case 1:
      n.head<4>() << (-3 + 3 * x2) / 4, j * (-1 - 2 * x1 + 3 * x2) / 4, (3 - 3 * x2) / 4, j * (-1 + 2 * x1 + 3 * x2) / 4;
      break;
    default:
      n.head<4>() << 6 * x1 / 4, j * (-2 + 6 * x1) / 4, -6 * x1 / 4, j * (2 + 6 * x1) / 4;
      break;
  }
  const auto p = legendre(xi, bubbles + 3);
  for (int b = 0; b < bubbles; ++b) {
    const int m = b + 2;  // second derivative is sqrt(m + 1/2) P_m
    const auto i = static_cast<std::size_t>(m);
    double v = 0;
    if (derivative == 0) {
      v = p[i + 2] / ((2 * m + 1) * (2 * m + 3)) - 2 * p[i] / ((2 * m - 1) * (2 * m + 3)) +
          p[i - 2] / ((2 * m + 1) * (2 * m - 1));
    } else if (derivative == 1) {
      v = (p[i + 1] - p[i - 1]) / (2 * m + 1);
    } else {
      v = p[i];
    }
    n[4 + b] = std::sqrt(m + 0.5) * v;
  }
  return n / std::pow(j, derivative);
}

}  // namespace

double bending_modulus(const Structure& s) {
  return s.plate_strain ? s.youngs_modulus / (1 - s.poissons_ratio * s.poissons_ratio) : s.youngs_modulus;
}

CompositeSection plain_section(const Structure& s) {
  return {.rigidity = bending_modulus(s) * s.width * std::pow(s.thickness, 3) / 12,
          .mass_per_length = s.density * s.width * s.thickness};
}

CompositeSection layered_section(const Structure& s, const Piezo& p) {
  const double eb = bending_modulus(s), b = s.thickness, ep = p.youngs_modulus, bp = p.thickness, a = s.width;
  const double zc = (eb * bp * b + ep * bp * bp / 2 + eb * b * b / 2) / (ep * bp + eb * b);
  return {.neutral_axis = zc,
          .rigidity = a * (ep * bp * bp * bp / 12 + eb * b * b * b / 12 + ep * bp * std::pow(zc - bp / 2, 2) +
                           eb * b * std::pow(bp + b / 2 - zc, 2)),
          .mass_per_length = a * (s.density * b + p.density * bp)};
}

double piezo_moment_per_volt(const Structure& s, const Piezo& p) {
  return p.d31 * p.youngs_modulus * s.width * (layered_section(s, p).neutral_axis - p.thickness / 2);
}

std::vector<BeamSection> beam_sections(const Device& device) {
  const Structure& s = device.structure;
  const CompositeSection plain = plain_section(s);
  std::vector<BeamSection> sections;
  const auto add = [&](double begin, double end, const CompositeSection& c) {
    if (end > begin)
      sections.push_back({.begin = begin, .end = end, .rigidity = c.rigidity, .mass_per_length = c.mass_per_length});
  };
  if (!device.piezo) {
    add(0, s.length, plain);
    return sections;
  }
  add(0, device.piezo->begin, plain);
  add(device.piezo->begin, device.piezo->end, layered_section(s, *device.piezo));
  add(device.piezo->end, s.length, plain);
  return sections;
}

BeamModes::BeamModes(std::vector<BeamSection> sections, int modes) {
  require(modes >= 1 && modes <= 40, fmt::format("modes = {}: must be from 1 to 40", modes));
  require(!sections.empty() && sections.front().begin == 0, "beam sections must start at x = 0");
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const BeamSection& s = sections[i];
    require(s.end > s.begin && s.rigidity > 0 && s.mass_per_length > 0,
            fmt::format("beam section {}: needs end > begin, rigidity > 0 and mass_per_length > 0", i));
    require(i == 0 || s.begin == sections[i - 1].end, fmt::format("beam section {} must begin where the one before it ends", i));
  }
  length_ = sections.back().end;
  const double ei = sections.front().rigidity, mu = sections.front().mass_per_length;
  scale_ = 1 / std::sqrt(mu * length_);
  frequency_scale_ = std::sqrt(ei / (mu * length_)) / std::pow(length_, 1.5);

  const int count = std::max(shortest_count, modes);
  std::vector<double> rigidity, mass;
  for (const BeamSection& s : sections) {
    const double begin = s.begin / length_, end = s.end / length_;
    const int parts = std::max(1, static_cast<int>(std::ceil((end - begin) * count - 1e-9)));
    for (int k = 0; k < parts; ++k) {
      elements_.push_back({begin + (end - begin) * k / parts, k + 1 == parts ? end : begin + (end - begin) * (k + 1) / parts});
      rigidity.push_back(s.rigidity / ei);
      mass.push_back(s.mass_per_length / mu);
    }
  }

  // Unknowns: per node (w, w') from the second node on (the first is clamped), then the internal functions element by element.
  const auto n = static_cast<Eigen::Index>(elements_.size());
  const Eigen::Index total = 2 * n + bubbles * n;
  stiffness_ = Eigen::MatrixXd::Zero(total, total);
  mass_ = Eigen::MatrixXd::Zero(total, total);
  const GaussRule rule = gauss_rule(unknowns + 1);  // exact for products of degree 2 (bubbles + 3)
  for (Eigen::Index e = 0; e < n; ++e) {
    const Element& element = elements_[static_cast<std::size_t>(e)];
    const double h = element.end - element.begin;
    Eigen::Matrix<double, unknowns, unknowns> k = Eigen::Matrix<double, unknowns, unknowns>::Zero(), m = k;
    for (std::size_t g = 0; g < rule.points.size(); ++g) {
      const ElementRow d0 = element_shape(rule.points[g], h, 0), d2 = element_shape(rule.points[g], h, 2);
      const double w = rule.weights[g] * h / 2;
      k += w * rigidity[static_cast<std::size_t>(e)] * d2.transpose() * d2;
      m += w * mass[static_cast<std::size_t>(e)] * d0.transpose() * d0;
    }
    for (int i = 0; i < unknowns; ++i) {
      const Eigen::Index gi = i < 4 ? 2 * (e - 1) + i : 2 * n + bubbles * e + (i - 4);
      if (gi < 0) continue;
      for (int j = 0; j < unknowns; ++j) {
        const Eigen::Index gj = j < 4 ? 2 * (e - 1) + j : 2 * n + bubbles * e + (j - 4);
        if (gj < 0) continue;
        stiffness_(gi, gj) += k(i, j);
        mass_(gi, gj) += m(i, j);
      }
    }
  }

  // M x = (1/omega^2) K x: the low modes, which matter, are the largest eigenvalues and so the most accurate ones.
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(mass_, stiffness_);
  frequencies_.resize(modes);
  shapes_.resize(total, modes);
  for (int i = 0; i < modes; ++i) {
    const double inverse_square = solver.eigenvalues()[total - 1 - i];
    frequencies_[i] = frequency_scale_ / std::sqrt(inverse_square);
    const Eigen::VectorXd x = solver.eigenvectors().col(total - 1 - i);
    shapes_.col(i) = x / std::sqrt(x.dot(mass_ * x));
    if (shapes_(2 * n - 2, i) < 0) shapes_.col(i) *= -1;
  }
}

Eigen::RowVectorXd BeamModes::shape(double x, int derivative) const {
  const auto n = static_cast<Eigen::Index>(elements_.size());
  Eigen::Index e = 0;
  while (e + 1 < n && x > elements_[static_cast<std::size_t>(e)].end) ++e;
  const Element& element = elements_[static_cast<std::size_t>(e)];
  const double h = element.end - element.begin;
  const ElementRow local = element_shape(2 * (x - element.begin) / h - 1, h, derivative);
  Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(stiffness_.rows());
  for (int i = 0; i < unknowns; ++i) {
    const Eigen::Index gi = i < 4 ? 2 * (e - 1) + i : 2 * n + bubbles * e + (i - 4);
    if (gi >= 0) row[gi] = local[i];
  }
  return row;
}

Eigen::VectorXd BeamModes::value(double x) const { return scale_ * (shape(x / length_, 0) * shapes_).transpose(); }

Eigen::VectorXd BeamModes::slope(double x) const { return scale_ / length_ * (shape(x / length_, 1) * shapes_).transpose(); }

double BeamModes::pinned_frequency(double x) const {
  // Project K and M on the space orthogonal to the constraint row.
  const Eigen::VectorXd c = shape(x / length_, 0).transpose();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(c);
  const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(c.size(), c.size());
  const Eigen::MatrixXd z = q.rightCols(c.size() - 1);
  const Eigen::MatrixXd k = z.transpose() * stiffness_ * z, m = z.transpose() * mass_ * z;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(m, k, Eigen::EigenvaluesOnly);
  return frequency_scale_ / std::sqrt(solver.eigenvalues().maxCoeff());
}

}  // namespace softland
