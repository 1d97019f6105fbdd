#include "reports/formula.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace softland {
namespace {

std::string joined(const Formula& a, const char* sign, const Formula& b) {
  return fmt::format("({}{}{})", a.text(), sign, b.text());
}

Formula call(const char* function, const Formula& x) { return Formula::named(fmt::format("{}({})", function, x.text())); }

}  // namespace

Formula Formula::named(std::string operand) {
  Formula f(0);
  f.constant_ = false;
  f.text_ = std::move(operand);
  return f;
}

std::string Formula::text() const {
  if (!constant_) return text_;
  return value_ < 0 ? fmt::format("({})", value_) : fmt::format("{}", value_);
}

Formula operator+(const Formula& a, const Formula& b) {
  if (a.constant_ && b.constant_) return a.value_ + b.value_;
  if (a.constant_ && a.value_ == 0) return b;
  if (b.constant_ && b.value_ == 0) return a;
  return Formula::named(joined(a, "+", b));
}

Formula operator-(const Formula& a, const Formula& b) {
  if (a.constant_ && b.constant_) return a.value_ - b.value_;
  if (b.constant_ && b.value_ == 0) return a;
  return Formula::named(joined(a, "-", b));
}

Formula operator*(const Formula& a, const Formula& b) {
  if (a.constant_ && b.constant_) return a.value_ * b.value_;
  if (a.constant_ && a.value_ == 1) return b;
  if (b.constant_ && b.value_ == 1) return a;
  return Formula::named(joined(a, "*", b));
}

Formula operator/(const Formula& a, const Formula& b) {
  if (a.constant_ && b.constant_) return a.value_ / b.value_;
  if (b.constant_) return a * Formula(1 / b.value_);
  // Write a quotient as a product with a power of -1: ngspice adds 1e-32 to every divisor, and a divisor may be smaller.
  return a * pow(b, -1);
}

Formula sqrt(const Formula& x) { return call("sqrt", x); }
Formula log(const Formula& x) { return call("ln", x); }
Formula abs(const Formula& x) { return call("abs", x); }
Formula pow(const Formula& x, double exponent) {
  return Formula::named(fmt::format("pow({},{})", x.text(), Formula(exponent).text()));
}
Formula max(const Formula& a, const Formula& b) { return Formula::named(fmt::format("max({},{})", a.text(), b.text())); }

FormulaCondition operator<(const Formula& a, const Formula& b) { return {fmt::format("{}<{}", a.text(), b.text())}; }
FormulaCondition operator>(const Formula& a, const Formula& b) { return {fmt::format("{}>{}", a.text(), b.text())}; }
void assign_where(const FormulaCondition& condition, Formula& to, const Formula& from) {
  to = Formula::named(fmt::format("({} ? {} : {})", condition.text, from.text(), to.text()));
}

}  // namespace softland
