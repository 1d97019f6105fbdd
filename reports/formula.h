// A symbolic number. Laws of the model that are evaluated with the type Formula give their formula as text, in the syntax that
// ngspice, LTspice and Verilog-A share.
#pragma once

#include <string>

namespace softland {

class Formula {
 public:
  // NOLINT(google-explicit-constructor): a number converts to a formula.
  Formula(double constant) : constant_(true), value_(constant) {}
  /// Makes an operand from a text: a name, a call, or an expression in parentheses.
  static Formula named(std::string operand);

  /// Returns the formula as text, in parentheses unless it is a single operand.
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
/// Returns the formula of the larger of two numbers.
[[nodiscard]] Formula max(const Formula& a, const Formula& b);

/// A comparison of formulas, whose truth depends on the values of the operands.
struct FormulaCondition {
  std::string text;
};
[[nodiscard]] FormulaCondition operator<(const Formula& a, const Formula& b);
[[nodiscard]] FormulaCondition operator>(const Formula& a, const Formula& b);
/// Implements the function of base/select.h: `to` becomes a formula that is `from` where the condition holds, and `to`
/// elsewhere.
void assign_where(const FormulaCondition& condition, Formula& to, const Formula& from);

}  // namespace softland
