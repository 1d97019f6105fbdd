// Values for the figures of merit of a closing, one for each row of their table, and the comparison of two values.
#pragma once

#include <array>
#include <cstddef>

#include "objectives/figures.h"

namespace softland {

/// Holds one value of type T, such as a number or a text, for every figure of merit in figure_table.
template <class T>
class PerFigure {
 public:
  [[nodiscard]] constexpr T& operator[](Figure::Member member) { return values_[index(member)]; }
  [[nodiscard]] constexpr const T& operator[](Figure::Member member) const { return values_[index(member)]; }
  [[nodiscard]] constexpr T& operator[](const Figure& figure) { return (*this)[figure.member]; }
  [[nodiscard]] constexpr const T& operator[](const Figure& figure) const { return (*this)[figure.member]; }

 protected:
  std::array<T, figure_table.size()> values_{};

 private:
  static constexpr std::size_t index(Figure::Member member) {
    return static_cast<std::size_t>(&figure_of(member) - figure_table.data());
  }
};

/// A number for every figure of merit: its value, or its error. NaN when the number is not known.
class FigureValues : public PerFigure<double> {
 public:
  constexpr FigureValues() { values_.fill(Metrics::unset); }
  explicit FigureValues(const Metrics& metrics);

  AskedFigures asked = {};  ///< optional figures that the scene requests: see Figure::is_asked()
};

/// Returns the relative change of a figure of merit, (value - reference) / max(|reference|, least); NaN when an argument is
/// NaN.
[[nodiscard]] double relative_change(double value, double reference, double least = 0);
/// Returns the absolute relative change of a figure of merit, for comparison with a tolerance: 0 when both values are equal or
/// both are NaN, infinite when one is NaN.
[[nodiscard]] double relative_difference(double value, double reference, double least = 0);

}  // namespace softland
