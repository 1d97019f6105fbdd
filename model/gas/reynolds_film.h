// Compressible gas film under a long strip: the nonlinear isothermal Reynolds equation across the width, with slip at the
// walls.
//
//   12 mu d(p h)/dt = (h^3 + 6 lambda h^2) d/dz (p dp/dz),   p = pa at z = -a/2, a/2
//   f = -integral of (p - pa) dz                                          [N/m], positive towards the electrode
//   U = h integral of [p ln(p/pa) - p + pa] dz                            [J/m], free energy of the gas above that at rest
//   D = (h^3 + 6 lambda h^2)/(12 mu) integral of (dp/dz)^2 dz             [W/m]
//
// p is the pressure [Pa], pa the ambient pressure [Pa], h the local gap [m], z across the width a [m], mu the viscosity [Pa s],
// lambda the mean free path at pa [m]. The pressure is a state of the motion: every station (point along the beam) has the
// relative pressures P = p/pa - 1 at a few points over half the width, since the pressure is symmetric. Slow motion (squeeze
// number 12 mu a^2 omega/(pa h^2) well below pi^2) gives the incompressible film mu (a/h)^3/(1 + 6 lambda/h) (slip.h), fast
// motion the spring pa a/h.
//
// Across the width the equation is solved in weak form on Gauss-Lobatto points of degree 8, which are also the quadrature
// points. So the gas is conserved, the incompressible parabola is exact, and -sum of ln(p/pa) times the flow is the
// dissipation: U' + D = -f v with v the velocity towards the electrode. Compared with the linear strip of Blech 1983 the force
// is within 1e-7 for squeeze numbers below 10, 1e-4 below 100 and 2e-2 at 1000, where a boundary layer thinner than the point
// spacing forms at the edge.
//
// Valid for strips much longer than wide (flow along the beam, of order (a/L)^2, is neglected), slip flow (lambda/h below about
// 0.1), isothermal gas. Gaps below a floor, at which a run ends, count as the floor. Source: Hung & Senturia 1999, J. MEMS
// 8(3), 280-289, eq. 2 (after Burgdorfer 1959 for the slip); Blech 1983, J. Lubr. Tech. 105, 615-620.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>

#include "model/device.h"
#include "model/distributed_law.h"

namespace softland {

namespace internal {

/// The points across half the width at which the pressure is a state, from the middle to the last point before the edge. Each
/// point also represents its mirror image.
struct StripNodes {
  static constexpr int count = 4;
  /// Quadrature weights of the points, for both halves of the width, in units of half the width.
  Eigen::Matrix<double, count, 1> weights;
  /// Matrix from the values P + P^2/2 at the points (P relative pressure) to the flow into each point, for a unit diffusion
  /// rate.
  Eigen::Matrix<double, count, count> exchange;
};
[[nodiscard]] StripNodes strip_nodes();

}  // namespace internal

/// The gas film at one station (point along the beam). `P` is the scalar type of its parameters; the scalar type S of gap,
/// velocity and pressures must be constructible from P.
template <class P>
class ReynoldsStationOf {
 public:
  static constexpr int nodes = internal::StripNodes::count;

  /// Creates the film for ambient pressure [Pa], viscosity [Pa s], mean free path [m] and width of the beam [m].
  ReynoldsStationOf(P pressure, P viscosity, P mean_free_path, P width)
      : nodes_(internal::strip_nodes()),
        ambient_(pressure),
        half_width_(width / P(2)),
        diffusion_(pressure / (P(12) * viscosity * half_width_ * half_width_)),
        slip_(P(6) * mean_free_path) {
    for (int i = 0; i < nodes; ++i) load_by_film_[static_cast<std::size_t>(i)] = -ambient_ * half_width_ * P(nodes_.weights[i]);
  }

  /// Adds the load of the gas film on the beam to `load` [N/m]; `film` has the relative pressures of the station.
  template <class S>
  void add_load(const S* film, S& load) const {
    for (std::size_t i = 0; i < nodes; ++i) load = load + S(load_by_film_[i]) * film[i];
  }
  /// Computes the time derivatives of the station's relative pressures (pressure / ambient - 1) [1/s].
  template <class S>
  void rates(const S& gap, const S& velocity, const S* film, S* result) const {
    const S squeezing = velocity / gap, mixing = diffusion(gap);
    flow(film, result);
    for (int i = 0; i < nodes; ++i) result[i] = (S(1) + film[i]) * squeezing + mixing * result[i];
  }
  /// Computes the flow into every point across the width from the relative pressures `film`, for a unit diffusion rate.
  template <class S>
  void flow(const S* film, S* result) const {
    std::array<S, nodes> half_squares;
    for (std::size_t j = 0; j < nodes; ++j) half_squares[j] = film[j] + S(0.5) * film[j] * film[j];
    for (std::size_t i = 0; i < nodes; ++i) {
      S sum(0);
      for (std::size_t j = 0; j < nodes; ++j) {
        sum = sum + S(nodes_.exchange(static_cast<int>(i), static_cast<int>(j))) * half_squares[j];
      }
      result[i] = sum;
    }
  }
  /// Returns the rate at which pressure diffuses across half the width a [1/s]: pa (h^2 + 6 lambda h)/(12 mu (a/2)^2), with
  /// ambient pressure pa, gap h, mean free path lambda, viscosity mu.
  template <class S>
  [[nodiscard]] S diffusion(const S& gap) const {
    return S(diffusion_) * gap * (gap + S(slip_));
  }

  [[nodiscard]] const P& ambient() const { return ambient_; }
  [[nodiscard]] const P& half_width() const { return half_width_; }
  /// Returns the quadrature weights of the points across the width, for both halves of the width, in units of half the width.
  [[nodiscard]] const Eigen::Matrix<double, nodes, 1>& weights() const { return nodes_.weights; }
  /// Returns the derivatives of the film's load on the beam by the relative pressures at the points across the width [N/m].
  [[nodiscard]] const std::array<P, nodes>& load_by_film() const { return load_by_film_; }

 private:
  internal::StripNodes nodes_;
  P ambient_, half_width_, diffusion_, slip_;
  std::array<P, nodes> load_by_film_;
};

class ReynoldsFilm {
 public:
  using Station = ReynoldsStationOf<double>;
  static constexpr int nodes = Station::nodes;  ///< number of pressures across the width at each station along the beam

  /// `stations` is the number of points along the beam at which the film is computed. Gaps below `floor` [m] count as `floor`.
  ReynoldsFilm(const FilmState& gas, double width, Eigen::Index stations, double floor);

  /// Returns the number of pressure states: all relative pressures of the first station, then those of the second, and so on.
  [[nodiscard]] std::size_t states() const { return static_cast<std::size_t>(stations_) * nodes; }
  /// Adds the load of the gas film on the beam at every station to `load` [N/m].
  void add_load(const double* film, double* load) const;
  /// Computes the time derivatives of the relative pressures (pressure / ambient - 1) at all stations [1/s].
  void rates(const GapField& field, const double* film, double* result) const;
  /// Derivatives of the pressure rates of one station by gap [1/(m s)], by velocity [1/m] and by the station's relative
  /// pressures [1/s]. Each row belongs to one pressure rate.
  struct Derivatives {
    Eigen::Matrix<double, nodes, 1> by_gap, by_velocity;
    Eigen::Matrix<double, nodes, nodes> by_film;
  };
  [[nodiscard]] Derivatives derivatives(double gap, double velocity, const double* film) const;
  /// Returns the derivatives of the film's load on the beam by the relative pressures [N/m], equal at every station.
  [[nodiscard]] Eigen::Matrix<double, nodes, 1> load_by_film() const {
    return Eigen::Map<const Eigen::Matrix<double, nodes, 1>>(station_.load_by_film().data());
  }
  /// Returns the free energy of the gas film above that at rest [J]; `weights` are the quadrature weights of the stations [m].
  [[nodiscard]] double energy(const GapField& field, const Eigen::ArrayXd& weights, const double* film) const;
  /// Returns the power that the gas film dissipates [W]; `weights` are the quadrature weights of the stations along the beam
  /// [m].
  [[nodiscard]] double dissipated_power(const GapField& field, const Eigen::ArrayXd& weights, const double* film) const;
  /// Returns the ambient pressure of the gas [Pa].
  [[nodiscard]] double ambient() const { return station_.ambient(); }

 private:
  [[nodiscard]] double above_floor(double gap) const { return std::max(gap, floor_); }

  Eigen::Index stations_;
  double floor_;
  Station station_;
};

}  // namespace softland
