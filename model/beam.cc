#include "model/beam.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "base/decompositions.h"
#include "base/engineering.h"
#include "base/gauss.h"
#include "base/require.h"
#include "model/built_beam.h"

namespace softland {
namespace {

constexpr int functions = element_functions;
constexpr int shortest_count = 6;  // least number of elements into which a beam is divided
// Smallest pivot at which a receptance is accurate enough: smaller pivots magnify rounding errors, and the full search follows.
constexpr double least_pivot = 2e-3;

// Returns combinations of the shape functions that the supports of the beam permit, orthonormal in the elastic energy. The
// shape functions have the values and slopes `end` at the far end, and `slopes` has the integrals of products of their slopes.
Eigen::MatrixXd permitted(const NormalisedModes::Beam& beam, const Eigen::MatrixXd& end, const Eigen::MatrixXd& slopes) {
  Eigen::MatrixXd basis = Eigen::MatrixXd::Identity(slopes.rows(), slopes.rows());
  if (beam.far_clamp) basis = orthogonal_complement(end);
  if (beam.axial_force != 0) {
    const Eigen::MatrixXd stiffness =
        Eigen::MatrixXd::Identity(basis.cols(), basis.cols()) + beam.axial_force * basis.transpose() * slopes * basis;
    std::optional<Eigen::MatrixXd> orthonormal = orthonormal_in(stiffness, basis);
    require(orthonormal.has_value(), "beyond the buckling load of the beam");
    basis = std::move(*orthonormal);
  }
  return basis;
}

// Returns the coupling of the shape functions m and m + 1 in the bending energy of an element whose rigidity is 1 + xi, xi in
// [-1, 1]. It is the integral of xi times the normalised Legendre polynomials of degrees m and m + 1.
double taper_coupling(int m) { return (m + 1) / std::sqrt((2 * m + 1.0) * (2 * m + 3.0)); }

// The phase that a travelling bending wave with the frequency of a mode gains over the beam, and its derivative by omega^2.
// Modes of similar beams have nearly the same phase, so that the phase predicts the frequency of a mode of a changed beam.
struct WavePhase {
  double value = 0, slope = 0;
  WavePhase(const NormalisedModes::Beam& beam, double square) {
    for (const NormalisedModes::Beam::Section& s : beam.sections) {
      const double n = beam.axial_force / (2 * s.rigidity), root = std::sqrt(n * n + s.mass * square / s.rigidity);
      // Wave number k with EI k^4 + N k^2 = mu omega^2, where N is the tension and n = N / (2 EI).
      const double number = std::sqrt(root - n);
      value += (s.end - s.begin) * number;
      slope += (s.end - s.begin) * s.mass / (4 * s.rigidity * root * number);
    }
  }
};

// Estimates omega^2 of a mode of the beam `to` from `square`, omega^2 of the mode of the same number of the similar beam
// `from`: both modes have nearly the same wave phase.
double carried_over(double square, const NormalisedModes::Beam& from, const NormalisedModes::Beam& to) {
  constexpr int steps = 3;
  const double phase = WavePhase(from, square).value;
  for (int i = 0; i < steps; ++i) {
    const WavePhase here(to, square);
    square += (phase - here.value) / here.slope;
  }
  return square;
}

// Finds four poles of the receptance at `place` (squared frequencies of four modes) at once by Newton's method, from the
// estimates in `squares`, up to a relative change of `rounding`. Returns none without convergence, and when rounding errors may
// be large: at a small pivot, or when a mode hardly moves at `place`.
std::optional<Receptance::Answer> nearest_poles(Receptance& receptance, double place, const Lane& rounding, Lane& squares) {
  constexpr int most_steps = 10;
  constexpr double least_motion = 1e-3;  // least deflection at `place`, for modes of mean square 1 over the beam
  for (int i = 0; i < most_steps; ++i) {
    const Receptance::Answer at = receptance.at(squares, place);
    const Lane step = at.deflection / at.inertia;
    squares += step;
    if ((step.abs() <= rounding * squares).all()) {
      const bool moves = (at.deflection.abs() >= least_motion * at.inertia.sqrt()).all();
      return moves && (at.least_pivot >= least_pivot).all() ? std::optional(at) : std::nullopt;
    }
  }
  return {};
}

// Finds 1 / omega^2 of the first mode of a beam on springs or with linear sections that is also held at one position. The
// receptance at this position, the sum of r_i^2 / (1 - omega^2 / omega_i^2), grows from the first frequency of the beam to the
// second and is 0 at the result. The r_i in `deflections` are deflections of all modes there, each with unit elastic energy.
double general_pinned_inverse_square(const Eigen::RowVectorXd& deflections, const Eigen::VectorXd& inverse_squares) {
  constexpr int bits = 60;
  const Eigen::Index last = inverse_squares.size() - 1;
  double low = 1 / inverse_squares[last], high = 1 / inverse_squares[last - 1];
  const Eigen::ArrayXd weights = deflections.transpose().array().square();
  for (int i = 0; i < bits; ++i) {
    const double middle = (low + high) / 2;
    (((weights / (1 - middle * inverse_squares.array())).sum() > 0) ? high : low) = middle;
  }
  return 1 / high;
}

// Returns true when the modes of the beam `known` are also those of `beam`: the beams are equal. Beams on springs or with
// linear sections may also differ by rounding, as when one factor scales all thicknesses, because the search for their modes
// cannot start from those of a similar beam.
bool is_known(const NormalisedModes::Beam& beam, const NormalisedModes::Beam& known) {
  if (beam == known) return true;
  if (!beam.is_general() || !known.is_general() || beam.modes != known.modes || beam.far_clamp != known.far_clamp ||
      beam.sections.size() != known.sections.size())
    return false;
  const auto same = [](double a, double b) {
    constexpr double rounding = 1e-13;
    return a == b || std::abs(a - b) <= rounding * std::abs(b);
  };
  const auto alike = [&](const NormalisedModes::Beam::Section& a, const NormalisedModes::Beam::Section& b) {
    return same(a.begin, b.begin) && same(a.end, b.end) && same(a.rigidity, b.rigidity) && same(a.mass, b.mass) &&
           same(a.taper, b.taper);
  };
  return same(beam.axial_force, known.axial_force) && same(beam.near_rotation, known.near_rotation) &&
         same(beam.near_translation, known.near_translation) && same(beam.far_rotation, known.far_rotation) &&
         same(beam.far_translation, known.far_translation) && std::ranges::equal(beam.sections, known.sections, alike);
}

}  // namespace

std::string why_buckled(const Structure& s, const std::optional<Surface>& surface) {
  if (s.is_built() || !s.near_hold().is_clamp() || !(s.far_hold().is_clamp() || s.far_hold().is_free())) {
    Structure lowest = s;
    lowest.modes = 1;
    try {
      static_cast<void>(beam_modes({.structure = lowest, .surface = surface}));
    } catch (const InvalidInput&) {
      return fmt::format("leaves an axial force of {}, a compression beyond the buckling load of the beam",
                         engineering(beam_support(s, surface).axial_force, "N", 4));
    }
    return {};
  }
  const double stress = beam_support(s, surface).axial_force / (s.width * s.thickness), limit = -buckling_stress(s, surface);
  if (stress > limit) return {};
  return fmt::format("leaves {:.4g} MPa along the beam, which buckles at {:.4g} MPa", stress / 1e6, limit / 1e6);
}

std::string why_no_beam(const Device& d) {
  const auto needs_ratio = [](const char* who, double ratio) {
    return fmt::format("structure.poissons_ratio = {}: {} needs one between -1 and 0.5", ratio, who);
  };
  const Beam& beam = part_of<Beam>(d.structure);
  if (const auto conflict = part_conflict(d)) return fmt::format("structure.{}: {}", conflict->key, conflict->rule);
  const bool has_ratio = beam.poissons_ratio > -1 && beam.poissons_ratio < 0.5;
  if (beam.plate_strain && !has_ratio) return needs_ratio("plate_strain", beam.poissons_ratio);
  const auto* const bridge = d.structure.find<Bridge>();
  if (bridge == nullptr) return {};
  if (bridge->biaxial && !has_ratio) return needs_ratio("biaxial", beam.poissons_ratio);
  const std::string buckled = d.surface ? std::string() : why_buckled(d.structure);
  if (buckled.empty() && bridge->residual_stress < 1e30) return {};
  return fmt::format("structure.residual_stress = {}: {}", engineering(bridge->residual_stress, "Pa"),
                     buckled.empty() ? "must be below 1e30 Pa" : buckled);
}

NormalisedModes::NormalisedModes(Beam beam, const NormalisedModes* near) : beam_(std::move(beam)) {
  // Under a strong tension N the modes bend the beam sharply only close to its clamps, over lengths of L / sqrt(N L^2 / EI).
  // Take an element for every five of these lengths, up to 40 elements.
  const double layers = std::sqrt(std::max(0.0, beam_.axial_force)) / 5;
  const int count = std::max({shortest_count, beam_.modes, static_cast<int>(std::min(layers, 40.0))});
  // Smallest mass over rigidity of a section; the fourth power of a section's wave number is proportional to this ratio.
  double lowest = std::numeric_limits<double>::infinity();
  for (const Beam::Section& s : beam_.sections) lowest = std::min(lowest, s.mass / s.rigidity);
  for (const Beam::Section& s : beam_.sections) {
    // Waves are shorter where the beam is thin; elements are shorter there when the wave length is below half of the largest.
    double shorter = std::max(1.0, std::sqrt(std::sqrt(s.mass / s.rigidity / lowest)) / 2);
    // More elements: the curvature of a mode is moment over rigidity, which is not a polynomial for a linear rigidity.
    if (s.taper != 0) shorter *= 1.5;
    const int parts = std::max(1, static_cast<int>(std::ceil((s.end - s.begin) * shorter * count - 1e-9)));
    for (int k = 0; k < parts; ++k) {
      // Rigidity in the middle of the element over that in the middle of the section.
      const double larger = 1 + s.taper * ((2 * k + 1.0) / parts - 1);
      elements_.push_back({.begin = s.begin + (s.end - s.begin) * k / parts,
                           .end = k + 1 == parts ? s.end : s.begin + (s.end - s.begin) * (k + 1) / parts,
                           .rigidity = s.rigidity * larger,
                           .mass = s.mass * larger,
                           .taper = s.taper / parts / larger});
    }
  }
  if (std::isfinite(beam_.near_translation)) shift_ = 1 / std::sqrt(1 + beam_.near_translation);
  if (std::isfinite(beam_.near_rotation)) turn_ = 1 / std::sqrt(1 + beam_.near_rotation);
  if (near == nullptr || !follow(*near)) search();
}

void NormalisedModes::search() {
  const GaussRule rule = gauss_rule(functions + 2);  // exact for products of two shape functions, which have the degree 9
  const auto points = static_cast<Eigen::Index>(rule.points.size()), total = shape(1, 0).size();
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(total, total), slopes = mass;
  for (const BeamElement& element : elements_) {
    const double half = element.half();
    const auto gram = [&](double factor, double taper, int derivative) {
      Eigen::MatrixXd rows(points, total);
      for (Eigen::Index g = 0; g < points; ++g) {
        const auto i = static_cast<std::size_t>(g);
        rows.row(g) = std::sqrt(factor * (1 + taper * rule.points[i]) * rule.weights[i] * half) *
                      shape(element, rule.points[i], derivative);
      }
      return Eigen::MatrixXd(rows.transpose() * rows);
    };
    mass += gram(element.mass, element.taper, 0);
    slopes += gram(1, 0, 1);
  }
  Eigen::MatrixXd end(total, 2);  // values and slopes of the shape functions at the far end of the beam
  end << shape(1, 0).transpose(), shape(1, 1).transpose();
  const bool is_general = beam_.is_general();
  const Eigen::MatrixXd basis = is_general ? permitted_motions(end, slopes) : permitted(beam_, end, slopes);
  if (is_general || beam_.far_clamp || beam_.axial_force != 0) mass = basis.transpose() * mass * basis;

  // Solve M x = x / omega^2, M being the mass matrix: the low modes, which are needed, have the largest and so the most
  // accurate eigenvalues. The stiffness matrix is the unit matrix.
  const SymmetricEigen modes = symmetric_eigen(mass);
  inverse_squares_.resize(beam_.modes);
  shapes_.resize(total, beam_.modes);
  for (int i = 0; i < beam_.modes; ++i) {
    const Eigen::Index k = mass.rows() - 1 - i;
    inverse_squares_[i] = modes.values[k];
    shapes_.col(i) = basis * modes.vectors.col(k) / std::sqrt(inverse_squares_[i]);
  }
  orient();
  if (is_general) {
    all_motions_ = basis * modes.vectors;
    all_inverse_squares_ = modes.values;
  } else {
    moving_place_ = moving_place();
  }
}

bool NormalisedModes::Beam::is_general() const {
  return std::isfinite(near_rotation) || std::isfinite(near_translation) ||
         (!far_clamp && (far_rotation != 0 || far_translation != 0)) ||
         std::any_of(sections.begin(), sections.end(), [](const Section& s) { return s.taper != 0; });
}

// A stiff spring at the far end would dominate the stiffness matrix, and rounding would then make the modes inaccurate. So the
// motions that deflect the spring are separated from those that leave the far end at rest, beginning with the stiffer spring.
Eigen::MatrixXd NormalisedModes::permitted_motions(const Eigen::MatrixXd& end, const Eigen::MatrixXd& slopes) const {
  const Eigen::Index total = slopes.rows();
  Eigen::MatrixXd energy = beam_.axial_force * slopes;
  Eigen::Index at = 0;
  for (const BeamElement& element : elements_) {
    energy.diagonal().segment<functions>(at).array() += 1;
    for (int m = 0; m + 1 < functions; ++m) {
      const double coupling = element.taper * taper_coupling(m);
      energy(at + m, at + m + 1) += coupling, energy(at + m + 1, at + m) += coupling;
    }
    at += functions;
  }
  if (shift_ > 0) energy(at, at) += beam_.near_translation * shift_ * shift_, ++at;
  if (turn_ > 0) energy(at, at) += beam_.near_rotation * turn_ * turn_;

  const double translation = beam_.far_clamp ? Anchor::rigid : beam_.far_translation,
               rotation = beam_.far_clamp ? Anchor::rigid : beam_.far_rotation;
  std::vector<std::pair<double, Eigen::Index>> springs;  // springs at the far end: stiffness, and column of `end`
  std::vector<Eigen::Index> held;
  for (const auto& [stiffness, column] : {std::pair{translation, 0}, std::pair{rotation, 1}}) {
    if (std::isinf(stiffness)) held.push_back(column);
    if (stiffness > 0 && std::isfinite(stiffness)) springs.emplace_back(stiffness, column);
  }
  std::ranges::sort(springs, std::greater());
  Eigen::MatrixXd basis = Eigen::MatrixXd::Identity(total, total);
  if (!held.empty()) basis = orthogonal_complement(end(Eigen::all, held));
  const auto count = static_cast<Eigen::Index>(springs.size());
  // Column k of `along` is the motion that deflects spring k, orthonormal to the motions before it; column k of `by_spring` has
  // the deflections of spring k in all of these motions.
  Eigen::MatrixXd along(basis.cols(), count), by_spring = Eigen::MatrixXd::Zero(count, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    Eigen::VectorXd left = basis.transpose() * end.col(springs[static_cast<std::size_t>(k)].second);
    for (Eigen::Index j = 0; j < k; ++j) {
      by_spring(j, k) = along.col(j).dot(left);
      left -= by_spring(j, k) * along.col(j);
    }
    by_spring(k, k) = left.norm();
    along.col(k) = left / by_spring(k, k);
  }
  if (count > 0) {
    Eigen::MatrixXd turned(basis.cols(), basis.cols());
    turned << along, orthogonal_complement(along);
    basis = basis * turned;
  }
  Eigen::MatrixXd elastic = basis.transpose() * energy * basis;
  for (Eigen::Index k = 0; k < count; ++k) {
    elastic.topLeftCorner(count, count) +=
        springs[static_cast<std::size_t>(k)].first * by_spring.col(k) * by_spring.col(k).transpose();
  }
  std::optional<Eigen::MatrixXd> orthonormal = orthonormal_in(elastic, basis);
  require(orthonormal.has_value(), "beyond the buckling load of the beam");
  return std::move(*orthonormal);
}

Eigen::MatrixXd NormalisedModes::slope_products() const {
  const Eigen::Index bending = functions * static_cast<Eigen::Index>(elements_.size());
  if (bending == shapes_.rows()) return softland::slope_products(elements_, shapes_);
  return softland::slope_products(
      elements_, shapes_.topRows(bending),
      turn_ > 0 ? Eigen::RowVectorXd(turn_ * shapes_.bottomRows<1>()) : Eigen::RowVectorXd::Zero(shapes_.cols()));
}

bool NormalisedModes::follow(const NormalisedModes& near) {
  const int modes = beam_.modes;
  // Least length of the last element, as a share of the beam's length, for a beam with a far clamp: in a shorter element the
  // conditions of the clamp cause rounding errors.
  constexpr double least_end = 0.05;
  if (beam_.is_general() || near.beam_.is_general() || near.beam_.modes != modes || near.beam_.far_clamp != beam_.far_clamp ||
      near.beam_.sections.size() != beam_.sections.size() || (beam_.far_clamp && 2 * elements_.back().half() < least_end)) {
    return false;
  }
  moving_place_ = near.moving_place_;
  inverse_squares_.resize(modes);
  shapes_.resize(functions * static_cast<Eigen::Index>(elements_.size()), modes);
  Receptance receptance(elements_, beam_.axial_force, beam_.far_clamp);
  for (int first = 0; first < modes; first += lanes) {
    Lane squares;
    for (int k = 0; k < int{lanes}; ++k) {
      squares[k] = carried_over(1 / near.inverse_squares_[std::min(first + k, modes - 1)], near.beam_, beam_);
    }
    const Lane rounding = 1e-12 + 1e-15 * near.inverse_squares_[0] * squares;
    const std::optional<Receptance::Answer> last = nearest_poles(receptance, moving_place_, rounding, squares);
    if (!last) return false;
    for (int k = 0; k < std::min<int>(lanes, modes - first); ++k) {
      inverse_squares_[first + k] = 1 / squares[k];
      shapes_.col(first + k) = receptance.motion(k) / std::sqrt(last->inertia[k]);
    }
  }
  orient();

  // Relative differences of squared frequencies in the check that the modes found are those of lowest frequency. Neighbouring
  // modes must differ by `apart`. There must be no mode below the first one less `margin`, and no further mode below the last
  // one plus `margin`.
  constexpr double apart = 1e-7, margin = 1e-8;
  for (int i = 1; i < modes; ++i) {
    if (!(inverse_squares_[i] * (1 + apart) < inverse_squares_[i - 1])) return false;
  }
  const double first = 1 / inverse_squares_[0], last = 1 / inverse_squares_[modes - 1];
  const double low = first * (1 - margin), high = last * (1 + margin);
  const Receptance::Answer around = receptance.at({low, high, low, high}, moving_place_);
  return first > 0 && around.below[0] == 0 && around.below[1] == modes && (around.least_pivot >= least_pivot).all();
}

void NormalisedModes::orient() {
  // Position at which modes between two clamps are made positive, as a share of the length: each of the first forty modes has
  // its first zero much further from the clamp.
  constexpr double close_to_the_clamp = 1e-3;
  const bool is_held = beam_.far_clamp || beam_.far_rotation != 0 || beam_.far_translation != 0;
  const Eigen::RowVectorXd positive = shape(is_held ? close_to_the_clamp : 1, 0);
  for (Eigen::Index i = 0; i < shapes_.cols(); ++i) {
    if (positive.dot(shapes_.col(i)) < 0) shapes_.col(i) *= -1;
  }
}

double NormalisedModes::moving_place() const {
  double place = 1, most = 0;
  for (const BeamElement& e : elements_) {
    for (const double x : {e.begin + e.half(), e.end}) {
      const double least = value(x).cwiseAbs().minCoeff();
      if (least > most) place = x, most = least;
    }
  }
  return place;
}

Eigen::RowVectorXd NormalisedModes::shape(const BeamElement& element, double xi, int derivative) const {
  static const ElementRow ends[] = {element_integrals(1, 0), element_integrals(1, 1)};
  static const Eigen::Array<double, 1, functions> orders = Eigen::Array<double, 1, functions>::LinSpaced(0.5, functions - 0.5);
  const Eigen::Index bending = functions * static_cast<Eigen::Index>(elements_.size());
  Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(bending + (shift_ > 0 ? 1 : 0) + (turn_ > 0 ? 1 : 0));
  const double x = element.begin + (element.end - element.begin) * (1 + xi) / 2;
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const BeamElement& other = elements_[e];
    if (other.begin > element.begin) break;
    const double half = other.half();
    const bool inside = other.begin == element.begin;
    ElementRow local = (inside ? element_integrals(xi, derivative) : ends[derivative]) * (derivative == 0 ? half * half : half);
    // A shape function has no curvature beyond the right end of its element, so it continues there as a straight line.
    if (!inside && derivative == 0) local += (x - other.end) * half * ends[1];
    row.segment<functions>(functions * static_cast<Eigen::Index>(e)) = local.array() * (orders / (half * other.rigidity)).sqrt();
  }
  if (shift_ > 0) row[bending] = derivative == 0 ? shift_ : 0;
  if (turn_ > 0) row[row.size() - 1] = derivative == 0 ? turn_ * x : turn_;
  return row;
}

Eigen::RowVectorXd NormalisedModes::shape(double x, int derivative) const {
  const auto element =
      std::find_if(elements_.begin(), std::prev(elements_.end()), [&](const BeamElement& e) { return x <= e.end; });
  return shape(*element, 2 * (x - element->begin) / (element->end - element->begin) - 1, derivative);
}

// The receptance a (deflection at x by a unit force there, as a function of lambda = omega^2) grows from minus infinity at the
// first frequency to infinity at the second. When the second mode does not move at x, a has no zero between the frequencies;
// the second frequency is then the result. Newton's method solves (lambda_2 - lambda) a = 0, whose left side is nearly linear.
double NormalisedModes::pinned_inverse_square(double x, std::optional<double> near) const {
  // Relative width of the bracket that ends the search, and relative step after which the next step of Newton's method would be
  // rounding.
  constexpr double rounding = 1e-12, last_step = 1e-8;
  constexpr int most_steps = 100;
  if (beam_.is_general()) return general_pinned_inverse_square(shape(x, 0) * all_motions_, all_inverse_squares_);
  Receptance receptance(elements_, beam_.axial_force, beam_.far_clamp);
  const double second = beam_.modes > 1 ? 1 / inverse_squares_[1] : std::numeric_limits<double>::infinity();
  double low = 1 / inverse_squares_[0], high = second;
  const auto middle = [&] { return std::isfinite(high) ? (low + high) / 2 : 2 * low; };
  double square = near && 1 / *near > low && 1 / *near < high ? 1 / *near : middle();
  for (int i = 0; i < most_steps && high - low > 2 * rounding * low; ++i) {
    const Receptance::Answer at = receptance.at(Lane::Constant(square), x);
    (at.below[0] >= 2 || at.deflection[0] > 0 ? high : low) = square;
    const double next = square - at.deflection[0] / (at.inertia[0] - at.deflection[0] / (second - square));
    const bool between = next > low && next < high;
    if (between && std::abs(next - square) <= last_step * square) return 1 / next;
    square = between ? next : next >= second && high == second ? second * (1 - rounding) : middle();
  }
  return 1 / square;
}

BeamModes::BeamModes(const std::vector<BeamSection>& sections, int modes, const BeamSupport& support,
                     std::shared_ptr<const NormalisedModes> known) {
  require(modes >= 1 && modes <= most_static_modes,
          [&] { return fmt::format("modes = {}: must be from 1 to {}", modes, most_static_modes); });
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
                             .axial_force = support.axial_force * length_ * length_ / ei,
                             .near_rotation = support.near.rotation * length_ / ei,
                             .near_translation = support.near.translation * std::pow(length_, 3) / ei};
  if (!support.far_clamp) {
    beam.far_rotation = support.far.rotation * length_ / ei;
    beam.far_translation = support.far.translation * std::pow(length_, 3) / ei;
  }
  for (const BeamSection& s : sections)
    beam.sections.push_back({s.begin / length_, s.end / length_, s.rigidity / ei, s.mass_per_length / mu, s.taper});
  try {
    normalised_ = known && is_known(beam, known->beam()) ? std::move(known)
                                                         : std::make_shared<const NormalisedModes>(std::move(beam), known.get());
  } catch (const InvalidInput& error) {
    throw InvalidInput(fmt::format("axial force {}: {}", engineering(support.axial_force, "N"), error.what()));
  }
  frequencies_ = frequency_scale_ / normalised_->inverse_squares().array().sqrt();
}

// The modal force is the integral of m phi'', m being the moment of the piezo layer per volt. Over each part of the beam m is
// linear, so the integral is that of (m phi')' - m' phi', which has a closed form.
Eigen::VectorXd piezo_forces(const Device& device, const BeamModes& modes) {
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(modes.count());
  for (const BeamSection& s : beam_sections(device)) {
    if (s.piezo_moment == 0) continue;
    const double at_begin = s.piezo_moment * (1 - s.taper), at_end = s.piezo_moment * (1 + s.taper);
    forces += at_end * modes.slope(s.end) - at_begin * modes.slope(s.begin) -
              (at_end - at_begin) / (s.end - s.begin) * (modes.value(s.end) - modes.value(s.begin));
  }
  return forces;
}

MidPlaneStretching stretching_of(const BeamModes& beam, const Structure& s) {
  const Eigen::MatrixXd slopes = beam.slope_products();
  return {.modes = static_cast<std::size_t>(slopes.rows()),
          .slopes = std::vector<double>(slopes.data(), slopes.data() + slopes.size()),
          .stiffness = s.is_built() ? 1 / (2 * stretch_per_force(s))
                                    : part_of<Beam>(s).youngs_modulus * s.width * s.thickness / (2 * s.length)};
}

BeamModes beam_modes(const Device& device, std::shared_ptr<const NormalisedModes> known) {
  return {beam_sections(device), device.structure.modes, beam_support(device.structure, device.surface), std::move(known)};
}

}  // namespace softland
