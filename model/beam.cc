#include "model/beam.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "base/engineering.h"
#include "base/gauss.h"
#include "base/require.h"
#include "model/constants.h"
#include "model/surface.h"

namespace softland {
namespace {

constexpr int functions = 8;       // per element: curvatures up to degree 7, so deflections up to degree 9
constexpr int shortest_count = 6;  // elements over the length, at least

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

// The functions of one element, at rest left of it, at xi in [-1, 1]: first (derivative 1) or second (0) integrals of P_m from
// -1. For m >= 2 both vanish at the right end.
using ElementRow = Eigen::Matrix<double, 1, functions>;
ElementRow integrals(double xi, int derivative) {
  const auto p = legendre(xi, functions + 1);
  ElementRow n;
  if (derivative == 0) {
    n.head<2>() << (xi + 1) * (xi + 1) / 2, (xi + 1) * (xi + 1) * (xi - 2) / 6;
  } else {
    n.head<2>() << xi + 1, (xi + 1) * (xi - 1) / 2;
  }
  for (int m = 2; m < functions; ++m) {
    const auto i = static_cast<std::size_t>(m);
    n[m] = derivative == 0 ? p[i + 2] / ((2 * m + 1) * (2 * m + 3)) - 2 * p[i] / ((2 * m - 1) * (2 * m + 3)) +
                                 p[i - 2] / ((2 * m + 1) * (2 * m - 1))
                           : (p[i + 1] - p[i - 1]) / (2 * m + 1);
  }
  return n;
}

// Orthonormal columns that are orthogonal to those of `held`.
Eigen::MatrixXd complement(const Eigen::MatrixXd& held) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(held);
  const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(held.rows(), held.rows());
  return q.rightCols(held.rows() - held.cols());
}

}  // namespace

double bending_modulus(const Structure& s) {
  return s.plate_strain ? s.youngs_modulus / (1 - s.poissons_ratio * s.poissons_ratio) : s.youngs_modulus;
}

CompositeSection plain_section(const Structure& s, const std::optional<Surface>& surface) {
  const double skins = surface ? surface_rigidity(*surface, s) : 0;
  return {.rigidity = bending_modulus(s) * s.width * std::pow(s.thickness, 3) / 12 + skins,
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

double axial_stress(const Structure& s) { return s.residual_stress * (s.biaxial ? 1 - s.poissons_ratio : 1); }

BeamSupport beam_support(const Structure& s, const std::optional<Surface>& surface) {
  const double pull = surface ? surface_pull(*surface, s) : 0;
  if (s.kind == StructureKind::clamped_clamped) {
    return {.far_clamp = true, .axial_force = axial_stress(s) * s.width * s.thickness + pull};
  }
  return {.axial_force = surface && surface->cantilever_load == ResidualLoad::compression ? -pull : 0};
}

double buckling_stress(const Structure& s, const std::optional<Surface>& surface) {
  const double slenderness = (s.kind == StructureKind::clamped_clamped ? 2 * pi : pi / 2) / s.length;
  return slenderness * slenderness * plain_section(s, surface).rigidity / (s.width * s.thickness);
}

std::string why_buckled(const Structure& s, const std::optional<Surface>& surface) {
  const double stress = beam_support(s, surface).axial_force / (s.width * s.thickness), limit = -buckling_stress(s, surface);
  if (stress > limit) return {};
  return fmt::format("leaves {:.4g} MPa along the beam, which buckles at {:.4g} MPa", stress / 1e6, limit / 1e6);
}

std::vector<BeamSection> beam_sections(const Device& device) {
  const Structure& s = device.structure;
  const CompositeSection plain = plain_section(s, device.surface);
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

NormalisedModes::NormalisedModes(Beam beam) : beam_(std::move(beam)) {
  // A strong tension bends the beam close to its clamps only, over lengths of L / sqrt(N L^2 / EI).
  const double layers = std::sqrt(std::max(0.0, beam_.axial_force)) / 5;
  const int modes = beam_.modes, count = std::max({shortest_count, modes, static_cast<int>(std::min(layers, 40.0))});
  std::vector<double> mass;
  for (const Beam::Section& s : beam_.sections) {
    const int parts = std::max(1, static_cast<int>(std::ceil((s.end - s.begin) * count - 1e-9)));
    for (int k = 0; k < parts; ++k) {
      elements_.push_back({.begin = s.begin + (s.end - s.begin) * k / parts,
                           .end = k + 1 == parts ? s.end : s.begin + (s.end - s.begin) * (k + 1) / parts,
                           .rigidity = s.rigidity});
      mass.push_back(s.mass);
    }
  }

  const GaussRule rule = gauss_rule(functions + 2);  // exact for squares of polynomials of degree 9
  const auto points = static_cast<Eigen::Index>(rule.points.size()),
             total = functions * static_cast<Eigen::Index>(elements_.size());
  mass_ = Eigen::MatrixXd::Zero(total, total);
  slopes_ = mass_;
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const Element& element = elements_[e];
    const double half = (element.end - element.begin) / 2;
    const auto gram = [&](double factor, int derivative) {
      Eigen::MatrixXd rows(points, total);
      for (Eigen::Index g = 0; g < points; ++g) {
        const auto i = static_cast<std::size_t>(g);
        rows.row(g) = std::sqrt(factor * rule.weights[i] * half) * shape(element, rule.points[i], derivative);
      }
      return Eigen::MatrixXd(rows.transpose() * rows);
    };
    mass_ += gram(mass[e], 0);
    slopes_ += gram(1, 1);
  }
  support();

  // M x = x / omega^2: the low modes, which matter, are the largest eigenvalues and so the most accurate ones.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(mass_);
  inverse_squares_.resize(modes);
  shapes_.resize(total, modes);
  constexpr double close_to_the_clamp = 1e-3;  // of the length: far short of the first zero of forty modes
  const Eigen::RowVectorXd positive = shape(beam_.far_clamp ? close_to_the_clamp : 1, 0);
  for (int i = 0; i < modes; ++i) {
    const Eigen::Index k = mass_.rows() - 1 - i;
    inverse_squares_[i] = solver.eigenvalues()[k];
    shapes_.col(i) = basis_ * solver.eigenvectors().col(k) / std::sqrt(inverse_squares_[i]);
    if (positive.dot(shapes_.col(i)) < 0) shapes_.col(i) *= -1;
  }
}

void NormalisedModes::support() {
  const Eigen::Index total = mass_.rows();
  basis_ = Eigen::MatrixXd::Identity(total, total);
  if (beam_.far_clamp) {
    Eigen::MatrixXd held(total, 2);  // what must vanish: value and slope at the far end
    held << shape(1, 0).transpose(), shape(1, 1).transpose();
    basis_ = complement(held);
  } else if (beam_.axial_force == 0) {
    return;
  }
  if (beam_.axial_force != 0) {
    const Eigen::MatrixXd stiffness =
        Eigen::MatrixXd::Identity(basis_.cols(), basis_.cols()) + beam_.axial_force * basis_.transpose() * slopes_ * basis_;
    const Eigen::LLT<Eigen::MatrixXd> root(stiffness);
    require(root.info() == Eigen::Success, "beyond the buckling load of the beam");
    basis_ = root.matrixU().solve<Eigen::OnTheRight>(basis_);
  }
  mass_ = basis_.transpose() * mass_ * basis_;
}

Eigen::RowVectorXd NormalisedModes::shape(const Element& element, double xi, int derivative) const {
  Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(functions * static_cast<Eigen::Index>(elements_.size()));
  const double x = element.begin + (element.end - element.begin) * (1 + xi) / 2;
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const Element& other = elements_[e];
    if (other.begin > element.begin) break;
    const double half = (other.end - other.begin) / 2;
    const bool inside = other.begin == element.begin;
    ElementRow local = integrals(inside ? xi : 1, derivative) * std::pow(half, 2 - derivative);
    if (!inside && derivative == 0) local += (x - other.end) * half * integrals(1, 1);  // straight on
    for (int m = 0; m < functions; ++m) local[m] *= std::sqrt((m + 0.5) / (half * other.rigidity));
    row.segment<functions>(functions * static_cast<Eigen::Index>(e)) = local;
  }
  return row;
}

Eigen::RowVectorXd NormalisedModes::shape(double x, int derivative) const {
  const auto element = std::find_if(elements_.begin(), std::prev(elements_.end()), [&](const Element& e) { return x <= e.end; });
  return shape(*element, 2 * (x - element->begin) / (element->end - element->begin) - 1, derivative);
}

double NormalisedModes::pinned_inverse_square(double x) const {
  const Eigen::MatrixXd z = complement(combined(x, 0).transpose());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(z.transpose() * mass_ * z, Eigen::EigenvaluesOnly);
  return solver.eigenvalues().maxCoeff();
}

BeamModes::BeamModes(const std::vector<BeamSection>& sections, int modes, const BeamSupport& support,
                     std::shared_ptr<const NormalisedModes> known) {
  require(modes >= 1 && modes <= 40, [&] { return fmt::format("modes = {}: must be from 1 to 40", modes); });
  require(!sections.empty() && sections.front().begin == 0, "beam sections must start at x = 0");
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const BeamSection& s = sections[i];
    require(s.end > s.begin && s.rigidity > 0 && s.mass_per_length > 0,
            [&] { return fmt::format("beam section {}: needs end > begin, rigidity > 0 and mass_per_length > 0", i); });
    require(i == 0 || s.begin == sections[i - 1].end,
            [&] { return fmt::format("beam section {} must begin where the one before it ends", i); });
  }
  length_ = sections.back().end;
  const double ei = sections.front().rigidity, mu = sections.front().mass_per_length;
  scale_ = 1 / std::sqrt(mu * length_);
  frequency_scale_ = std::sqrt(ei / (mu * length_)) / std::pow(length_, 1.5);

  NormalisedModes::Beam beam{.sections = {},
                             .modes = modes,
                             .far_clamp = support.far_clamp,
                             .axial_force = support.axial_force * length_ * length_ / ei};
  for (const BeamSection& s : sections)
    beam.sections.push_back({s.begin / length_, s.end / length_, s.rigidity / ei, s.mass_per_length / mu});
  try {
    normalised_ = known && known->beam() == beam ? std::move(known) : std::make_shared<const NormalisedModes>(std::move(beam));
  } catch (const InvalidInput& error) {
    throw InvalidInput(fmt::format("axial force {}: {}", engineering(support.axial_force, "N"), error.what()));
  }
  frequencies_ = frequency_scale_ / normalised_->inverse_squares().array().sqrt();
}

}  // namespace softland
