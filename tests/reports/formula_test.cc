// Evaluates the formulas of laws from their text, and compares with the laws.
#include "reports/formula.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

#include "model/contact/contact_law.h"
#include "model/far_side.h"
#include "model/forces/casimir.h"
#include "model/forces/dispersion.h"
#include "model/forces/electrostatic.h"
#include "model/gas/gas.h"

namespace softland {
namespace {

// Evaluates numbers, names, + - * ( ), max, pow, sqrt, ln, abs, and "a<b ? x : y".
class Evaluator {
 public:
  Evaluator(std::string text, std::map<std::string, double> names) : text_(std::move(text)), names_(std::move(names)) {}
  double value() {
    const double result = choice();
    EXPECT_EQ(at_, text_.size()) << text_;
    return result;
  }

 private:
  char next() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  bool take(char c) {
    if (next() != c) return false;
    ++at_;
    return true;
  }
  double choice() {
    const double left = sum();
    const char sign = next();
    if (sign != '<' && sign != '>') return left;
    ++at_;
    const double right = sum();
    EXPECT_TRUE(take('?'));
    const double then = choice();
    EXPECT_TRUE(take(':'));
    const double otherwise = choice();
    return (sign == '<' ? left < right : left > right) ? then : otherwise;
  }
  double sum() {
    double total = product();
    for (;;) {
      if (take('+')) {
        total += product();
      } else if (take('-')) {
        total -= product();
      } else {
        return total;
      }
    }
  }
  double product() {
    double total = operand();
    while (take('*')) total *= operand();
    return total;
  }
  double operand() {
    if (take('-')) return -operand();
    if (take('(')) {
      const double inner = choice();
      EXPECT_TRUE(take(')')) << text_.substr(at_);
      return inner;
    }
    if (std::isalpha(static_cast<unsigned char>(next())) != 0) return call();
    double number = 0;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), number);
    EXPECT_EQ(error, std::errc()) << text_.substr(at_);
    at_ = static_cast<std::size_t>(end - text_.data());
    return number;
  }
  double call() {
    std::string name;
    while (at_ < text_.size() && std::isalnum(static_cast<unsigned char>(text_[at_])) != 0) name += text_[at_++];
    if (!take('(')) return names_.at(name);
    std::vector<double> x{choice()};
    while (take(',')) x.push_back(choice());
    EXPECT_TRUE(take(')'));
    if (name == "max") return std::max(x.at(0), x.at(1));
    if (name == "pow") return std::pow(x.at(0), x.at(1));
    if (name == "sqrt") return std::sqrt(x.at(0));
    if (name == "ln") return std::log(x.at(0));
    EXPECT_EQ(name, "abs");
    return std::abs(x.at(0));
  }

  std::string text_;
  std::map<std::string, double> names_;
  std::size_t at_ = 0;
};

// Expects the formula of a function of gap and velocity to have the values of the function.
template <class F>
void expect_same(F f, const std::vector<double>& gaps) {
  const Formula made = f(Formula::named("h"), Formula::named("v"));
  for (const double h : gaps) {
    for (const double v : {-0.3, 0.07}) {
      const double right = f(h, v);
      EXPECT_NEAR(Evaluator(made.text(), {{"h", h}, {"v", v}}).value(), right, 1e-12 * std::abs(right))
          << h << ": " << made.text();
    }
  }
}

const std::vector<double> gaps{3e-8, 2.5e-7, 3.1e-6};

TEST(Formula, OfEveryGasLawHasItsValue) {
  const Film film{.width = 20e-6, .thickness = 2e-6, .viscosity = 1.86e-5, .mean_free_path = 65e-9, .unit_quality = 1};
  for_each_law<Gas>([&]<class Law>(std::type_identity<Law>) {
    const auto law = Law::example().law(film);
    SCOPED_TRACE(Law::name);
    expect_same([&](auto h, auto v) { return law.load(h, v); }, gaps);
    const FarSide<std::decay_t<decltype(law)>> far{.law = law, .both_gaps = 3.5e-6, .floor = 1e-7};
    expect_same([&](auto h, auto v) { return far.load(h, v); }, {1e-6, 3.45e-6});
  });
}

TEST(Formula, OfElectrodesHasTheirForceAndCapacitance) {
  const auto check = [](const char* name, const auto& law) {
    SCOPED_TRACE(name);
    const ElectrostaticForce<std::decay_t<decltype(law)>> force{law};
    expect_same([&](auto h, auto v) { return force.load(h, v); }, gaps);
    expect_same([&](auto h, auto) { return force.capacitance(h); }, gaps);
  };
  check("none", NoFringing{.width = 20e-6});
  check("linear", LinearFringing{.width = 20e-6});
  check("meijs-fokkema", MeijsFokkemaFringing{.width = 20e-6, .thickness = 2e-6});
}

TEST(Formula, OfDispersionForcesAndContactsHasTheirValue) {
  const VanDerWaals near{.hamaker_constant = 4e-19, .equilibrium_distance = 1.6e-10};
  const auto along = [](const char* name, auto pressure) {
    SCOPED_TRACE(name);
    const DispersionForce<decltype(pressure)> force{.law = pressure, .width = 1e-6};
    expect_same([&](auto h, auto v) { return force.load(h, v); }, {2e-9, 4e-8, 9e-8});
  };
  along("van-der-waals", near);
  along("casimir", IdealCasimir{});
  along("auto", SmallerOfBoth<IdealCasimir>{IdealCasimir{}, near});
  const UniformAsperityContact rough{.strength = 1e14, .height = 1e-7};
  expect_same([&](auto d, auto) { return rough.force(d); }, {1e-9, 9e-8, 1.4e-7});
  const HuntCrossley<LinearContact> damped{.elastic = {.stiffness = 200}, .damping = 5};
  expect_same([&](auto d, auto v) { return damped.force(d, v); }, {1e-9, 1e-7});
}

TEST(Formula, FoldsNumbers) {
  const Formula x = Formula::named("x");
  EXPECT_EQ((Formula(2) * Formula(3) + Formula(1)).text(), "7");
  EXPECT_EQ((x * Formula(1) + Formula(0)).text(), "x");
  EXPECT_EQ((x / Formula(4)).text(), "(x*0.25)");
  EXPECT_EQ((Formula(1) / x).text(), "pow(x,(-1))");
  EXPECT_EQ((-x).text(), "((-1)*x)");
}

}  // namespace
}  // namespace softland
