// Casimir attraction between two gold plates: the ideal law reduced by the factor eta(h) of the Lifshitz theory.
//
//   eta(h) = 15/(2 pi^4) int_0^inf dK K^2 int_0^K du sum over TM, TE of 1 / (e^K / r^2 - 1)
//   r_TE = (K - k) / (K + k),  r_TM = (eps K - k) / (eps K + k),  k^2 = K^2 + (eps - 1) u^2,  xi = u c / (2 h)
//   eps(i xi) = 1 + w_p^2 / (xi (xi + gamma)),  hbar w_p = 9 eV,  hbar gamma = 35 meV
//
// The imaginary angular frequency is xi; u is 2 h xi / c, and K and k are 2 h times the decay rates of the field in the gap and
// in gold. Reflection coefficients are r_TM and r_TE; eps is the permittivity of gold, w_p its plasma frequency, gamma its
// relaxation rate. The formula is for zero temperature, without interband terms (they raise the force by some ten per cent
// below 50 nm). eta is stored as a table from 1 nm to 10 um. A cubic spline in h between the gaps of the table, clamped to the
// slopes of the integral at the ends, makes force and stiffness smooth; it is within 2e-5 of the integral. Outside the table
// eta continues with the same value and slope (1 - eta within 1 % at 20 um):
//
//   h < h_1: eta = n_0 x + n_1 x^2, x = h / h_1      p ~ h^-3, the van der Waals limit
//   h > h_n: eta = 1 - f_0 x^(-1/2) - f_1 / x, x = h / h_n      the skin depth of a metal with losses grows like h^(1/2)
//
// Gold surfaces touch before a gap of 1 nm matters. Sources: E. M. Lifshitz 1956, Sov. Phys. JETP 2, 73, eq. 2.9; Drude
// parameters of gold: A. Lambrecht & S. Reynaud 2000, Eur. Phys. J. D 8, 309.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "base/select.h"
#include "model/forces/casimir.h"

namespace softland {

/// The reduction factor eta of the Casimir force between gold plates, as cubics between the gaps of a table, with the energy at
/// every gap of the table.
class GoldFactor {
 public:
  static constexpr std::size_t knots = 41;
  struct Piece {
    double begin = 0;  ///< gap between the plates at which the piece of the table begins [m]
    /// Coefficients of the reduction factor eta = sum of powers[n] (h / begin)^n, h the gap.
    std::array<double, 4> powers = {};
    double energy = 0;  ///< Casimir energy per area at the gap `begin` [J/m^2]
  };

  /// Returns the table of the reduction factor eta, computed at first use.
  [[nodiscard]] static const GoldFactor& table();

  /// Returns the piece of the table for a gap h: the last piece that begins at or below h; the first piece for an h below the
  /// table.
  template <class S>
  [[nodiscard]] const Piece& piece(const S& h) const {
    std::size_t low = 0, high = pieces_.size();
    while (high - low > 1) {
      const std::size_t middle = (low + high) / 2;
      (h < pieces_[middle].begin ? high : low) = middle;
    }
    return pieces_[low];
  }
  [[nodiscard]] double first() const { return pieces_.front().begin; }
  [[nodiscard]] double last() const { return pieces_.back().begin; }

  std::array<double, 2> near = {}, far = {};  ///< coefficients n of eta below the table, f above it (see header)

 private:
  GoldFactor();
  std::array<Piece, knots> pieces_;  // pieces between the gaps of the table; the last one marks its end and has no cubic
};

struct GoldCasimir {
  const GoldFactor* table = &GoldFactor::table();

  template <class S>
  S factor(S h) const {
    return one_by_one(h, [this](const auto& one) { return this->of_one(one); });
  }
  template <class S>
  S pressure(S h) const {
    return S(casimir_strength) / (h * h * h * h) * factor(h);
  }
  [[nodiscard]] double energy(double h) const;

 private:
  template <class S>
  S of_one(S h) const {
    const auto& [begin, e, energy] = table->piece(h);
    const S x = h / S(begin);
    if (h < table->first()) return x * (S(table->near[0]) + S(table->near[1]) * x);
    if (!(h < table->last())) {
      using std::sqrt;
      return S(1) - S(table->far[0]) / sqrt(x) - S(table->far[1]) / x;
    }
    return S(e[0]) + x * (S(e[1]) + x * (S(e[2]) + x * S(e[3])));
  }
};

}  // namespace softland
