// A formula is a number that is not known yet: laws of the model that are evaluated with it leave their formula, in the syntax
// that ngspice, LTspice and Verilog-A share.
#pragma once

#include <string>

namespace softland {

class Formula {
 public:
  Formula(double constant) : constant_(true), value_(constant) {}  // NOLINT(google-explicit-constructor): as a number does
  /// Makes an operand: a name, a call, or something in parentheses.
  static Formula named(std::string operand);

  /// Returns the text, in parentheses where it is more than an operand.
  [[nodiscard]] std::string text() const;

  friend Formula operator+(const Formula& a, const Formula& b);
  friend Formula operator-(const Formula& a, const Formula& b);
  friend Formula operator*(const Formula& a, const Formula& b);
  friend Formula operator/(const Formula& a, const Formula& b);
  friend Formula operator-(const Formula& a) { return Formula(-1) * a; }
  Formula& operator+=(const Formula& b) { return *this = *this + b; }
  Formula& operator-=(const Formula& b) { return *this = *this - b; }
  Formula& operator*=(const Formula& b) { return *this = *this * b; }

 private:
  bool constant_ = false;
  double value_ = 0;
  std::string text_ = {};
};

[[nodiscard]] Formula sqrt(const Formula& x);
[[nodiscard]] Formula log(const Formula& x);
[[nodiscard]] Formula abs(const Formula& x);
[[nodiscard]] Formula pow(const Formula& x, double exponent);
/// Returns the larger of both.
[[nodiscard]] Formula max(const Formula& a, const Formula& b);

/// A relation of which it is not known yet whether it holds.
struct FormulaCondition {
  std::string text;
};
[[nodiscard]] FormulaCondition operator<(const Formula& a, const Formula& b);
[[nodiscard]] FormulaCondition operator>(const Formula& a, const Formula& b);
/// Implements the function of base/select.h: `to` becomes one or the other.
void assign_where(const FormulaCondition& condition, Formula& to, const Formula& from);

}  // namespace softland
