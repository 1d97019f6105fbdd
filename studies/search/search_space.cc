#include "studies/search/search_space.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "base/decompositions.h"
#include "base/engineering.h"
#include "base/require.h"
#include "base/split.h"
#include "studies/search/searched_families.h"

namespace softland {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double rounding =
    1e-9;  // relative tolerance of a bound, as a share of the variable's range, since numbers in a scene file are rounded

/// The waveform family of each drive, from a text like "pulse" or "main=step,pzt=pulse".
class FamilyOfDrives {
 public:
  explicit FamilyOfDrives(const std::string& text) : text_(text) {
    if (text.find('=') == std::string::npos) {
      for_others_ = text;
      return;
    }
    for (const std::string& part : split(text, ',')) {
      const std::size_t equals = part.find('=');
      if (equals == std::string::npos) {
        require_request(for_others_.empty() && !part.empty(), [&] {
          return fmt::format("{} {}: '{}' is not of the form DRIVE=FAMILY, or a second family for all other drives",
                             requested("waveform"), text, part);
        });
        for_others_ = part;
      } else {
        const std::string drive = part.substr(0, equals) == "pzt" ? std::string(piezo_drive) : part.substr(0, equals);
        require_request(named_.emplace(drive, part.substr(equals + 1)).second,
                        [&] { return fmt::format("{} {}: drive '{}' has two families", requested("waveform"), text, drive); });
      }
    }
    if (for_others_.empty()) for_others_ = "pulse";
  }

  [[nodiscard]] const std::string& of(const std::string& drive) const {
    const auto found = named_.find(drive);
    return found == named_.end() ? for_others_ : found->second;
  }

  void check_all_used(const std::vector<DriveSearch>& drives) const {
    for (const auto& [name, family] : named_) {
      const auto is_it = [&](const DriveSearch& drive) { return drive.drive == name; };
      require_request(std::any_of(drives.begin(), drives.end(), is_it), [&] {
        std::string searched;
        for (const DriveSearch& drive : drives) searched += (searched.empty() ? "" : ", ") + drive.drive;
        return fmt::format("{} {}: drive '{}' is not searched (searched: {})", requested("waveform"), text_, name, searched);
      });
    }
  }

 private:
  std::string text_, for_others_;
  std::map<std::string, std::string> named_;
};

// Minimises the sum of squares of apart(x), the vector of residuals at x, within the bounds of the variables. Source of the
// damped Gauss-Newton steps: Marquardt (1963).
template <class Apart>
std::vector<double> fitted(std::vector<double> x, const std::vector<Variable>& variables, const Apart& apart) {
  constexpr int most_steps = 40;
  constexpr double step_of_range = 1e-6, enough = 1e-4, hardest = 1e6;
  const auto n = static_cast<Eigen::Index>(x.size());
  VectorXd left = apart(x);
  double damping = 1e-3;
  for (int step = 0; step < most_steps && damping < hardest; ++step) {
    MatrixXd slopes(left.size(), n);
    std::vector<double> near = x;
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const double range = variables[i].upper - variables[i].lower;
      slopes.col(k).setZero();
      if (!(range > 0)) continue;
      near[i] = x[i] + (x[i] + step_of_range * range <= variables[i].upper ? 1 : -1) * step_of_range * range;
      slopes.col(k) = (apart(near) - left) * (range / (near[i] - x[i]));
      near[i] = x[i];
    }
    const MatrixXd squares = slopes.transpose() * slopes;
    const VectorXd downhill = -slopes.transpose() * left;
    const double size = squares.diagonal().maxCoeff();
    for (bool helps = false; !helps && damping < hardest;) {
      const MatrixXd damped = squares + damping * size * MatrixXd::Identity(n, n);
      const VectorXd move = solve_semidefinite(damped, downhill);
      for (std::size_t i = 0; i < x.size(); ++i) {
        const double range = variables[i].upper - variables[i].lower;
        near[i] = std::clamp(x[i] + range * move[static_cast<Eigen::Index>(i)], variables[i].lower, variables[i].upper);
      }
      const VectorXd nearer = apart(near);
      helps = nearer.squaredNorm() < left.squaredNorm();
      if (!helps) {
        damping = std::max(1e-9, 10 * damping);
        continue;
      }
      const bool is_enough = nearer.squaredNorm() > (1 - enough) * left.squaredNorm();
      x = near, left = nearer, damping /= 10;
      if (is_enough) return x;
    }
  }
  return x;
}

}  // namespace

Shaped shaped_drives(const SceneFile& scene, Actuator actuator) {
  if (actuator == Actuator::pzt) return Shaped::piezo;
  if (actuator == Actuator::both) return Shaped::several;
  for (const std::string& name : scene.keys("electrode")) {
    if (scene.written("electrode." + name + ".side") == "far" && scene.written("driver." + name)) return Shaped::several;
  }
  return Shaped::electrode;
}

std::string_view default_families(Shaped drives) {
  switch (drives) {
    case Shaped::electrode:
      return "knots+dual-pulse+staircase:5+knots:8";
    case Shaped::piezo:
      return "bspline:16+bspline:18+catch+knots:12";
    case Shaped::several:
      break;
  }
  return "bspline:16+dual-pulse+knots:12";
}

std::vector<std::string> families_of(const std::string& text) {
  std::vector<std::string> all;
  for (const std::string& family : split(text, '+')) {
    require_request(!family.empty() || text.empty(),
                    [&] { return fmt::format("{} {}: a family before or after '+' is missing", requested("waveform"), text); });
    require_request(std::find(all.begin(), all.end(), family) == all.end(),
                    [&] { return fmt::format("{} {}: '{}' is named twice", requested("waveform"), text, family); });
    all.push_back(family);
  }
  return all;
}

std::string prefix_of(const std::string& families, const std::string& family) {
  return families.find('+') == std::string::npos ? std::string() : family + ".";
}

Waveform DriveSearch::waveform(std::span<const double> x) const {
  if (own) return Own{.waveform = own, .x = {x.begin(), x.end()}};
  return family->at(*this, x);
}

bool DriveSearch::is_within_bounds(const std::vector<double>& x) const {
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double lower = variables[k].lower, upper = variables[k].upper;
    if (!(std::abs(x[k] - std::clamp(x[k], lower, upper)) <= rounding * (upper - lower))) return false;
  }
  return true;
}

std::optional<std::vector<double>> DriveSearch::parameters(const Waveform& waveform) const {
  std::optional<std::vector<double>> x;
  if (own) {
    const Own* given = std::get_if<Own>(&waveform);
    if (given == nullptr || given->waveform != own || given->volts != 1 || given->time != 1) return std::nullopt;
    x = given->x;
  } else {
    if (softland::family(waveform) != family->waveform) return std::nullopt;
    x = family->parameters(*this, waveform);
  }
  if (!x || !is_within_bounds(*x)) return std::nullopt;
  for (std::size_t k = 0; k < x->size(); ++k) (*x)[k] = std::clamp((*x)[k], variables[k].lower, variables[k].upper);
  return x;
}

namespace {

constexpr int instants = 250;  // number of instants at which two waveforms are compared

// Returns samples of a drive signal until `end` [s]: of the square of an electrode's voltage, with its sign, or of a piezo's
// voltage.
VectorXd course_of(const DriveSearch& drive, const Signal& signal, double end) {
  VectorXd all(instants);
  for (int i = 0; i < instants; ++i) {
    const double volts = signal.voltage((i + 0.5) / instants * end);
    all[i] = drive.drive == piezo_drive ? volts : volts * std::abs(volts);
  }
  return all;
}

double end_of_course(const DriveSearch& drive, const Signal& given) {
  // Two waveforms are compared until the later of two times: `beyond` times the last breakpoint of the given waveform, and
  // `least` times the first contact under the plain step.
  constexpr double beyond = 1.25, least = 2.5;
  return std::max(beyond * given.breakpoints().back(), least * drive.first_touch);
}

// Returns the point of a waveform family whose samples course(x) differ least from the samples `wanted` of a waveform. The
// remaining difference is compared with `about_hold`, the mean square of `wanted` about its hold level.
template <class Course>
std::vector<double> nearest_point(const std::vector<Variable>& variables, const std::vector<std::vector<double>>& starts,
                                  const Course& course, const VectorXd& wanted, double about_hold) {
  constexpr double near_enough = 0.01;
  constexpr long evaluations = 3000;
  const auto apart = [&](std::span<const double> x) -> VectorXd { return course(x) - wanted; };
  const auto difference = [&](std::span<const double> x) { return apart(x).squaredNorm() / instants; };
  std::vector<double> best;
  double fewest = std::numeric_limits<double>::infinity();
  const auto fit_from = [&](const std::vector<double>& start) {
    std::vector<double> fit = fitted(start, variables, apart);
    const double left = difference(fit);
    if (left < fewest) fewest = left, best = std::move(fit);
  };
  for (const std::vector<double>& start : starts) fit_from(start);
  // Search without derivatives if the difference is still large: samples of steps have no derivatives by the times of the
  // steps.
  if (fewest > near_enough * about_hold) {
    Problem problem;
    problem.variables = variables;
    problem.objective = difference;
    problem.starts = starts;
    fit_from(minimize(problem, {.max_evaluations = evaluations}).x);
  }
  return best;
}

double about_hold(const VectorXd& course) { return (course.array() - course[instants - 1]).matrix().squaredNorm() / instants; }

}  // namespace

std::vector<double> DriveSearch::nearest(const Waveform& waveform) const {
  if (std::optional<std::vector<double>> exact = parameters(waveform)) return *exact;
  const Signal given = signal(waveform, before);
  const double end = end_of_course(*this, given);
  const VectorXd wanted = course_of(*this, given, end);
  const auto course = [&](std::span<const double> x) { return course_of(*this, signal(this->waveform(x), before), end); };
  return nearest_point(variables, starts, course, wanted, about_hold(wanted));
}

bool DriveSearch::holds(const Signal& signal) const {
  return std::abs(signal.hold_level() - hold) <= rounding * (limits.max_voltage - limits.min_voltage);
}

std::string DriveSearch::misfit(const Waveform& waveform) const {
  const Signal from_zero = signal(waveform);
  const double held = from_zero.hold_level();
  if (!holds(from_zero))
    return fmt::format("drive '{}' ends on {}, and the scene holds {}, which no search changes", drive, engineering(held, "V", 6),
                       engineering(hold, "V", 6));
  const std::string broken = violation(signal(waveform, before), limits_for(waveform, limits));
  return broken.empty() ? broken : fmt::format("drive '{}': {}", drive, broken);
}

namespace {

// Returns the waveform from the user's code that has this name; null if there is no such waveform.
std::shared_ptr<const OwnWaveform> own_of(const OwnWaveforms& all, const std::string& name) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& one) { return one != nullptr && one->name() == name; });
  return found == all.end() ? nullptr : *found;
}

void add_own(DriveSearch& s) {
  const Own start = softland::own(s.own);
  require(!start.x.empty(), [&] { return described(start) + " has no parameters that a search could vary"; });
  for (const OwnParameter& p : s.own->parameters()) s.variables.push_back({p.name, p.lower, p.upper});
  s.starts = {start.x};
  const std::string reason = s.misfit(start);
  require(reason.empty(), [&] { return fmt::format("{}, where its search begins: {}", described(start), reason); });
}

}  // namespace

SearchSpace::SearchSpace(const PreparedScene& prepared, Actuator actuator, const std::string& family, double first_touch,
                         const OwnWaveforms& own) {
  if (is_quasi_static(family)) {
    add_quasi_static(prepared, actuator, family, first_touch);
    return;
  }
  FamilyOfDrives families(family);
  const auto add = [&](const std::string& drive, bool brakes) {
    const Drive& given = prepared.drives.at(drive);
    require(
        given.limits.has_value(),
        fmt::format("optimize needs [driver.{}] with min_voltage and max_voltage: it never searches an unlimited drive", drive));
    DriveSearch s{.drive = drive,
                  .hold = given.hold_level(),
                  .before = given.value_before(),
                  .brakes = brakes,
                  .first_touch = first_touch,
                  .limits = *given.limits,
                  .variables = {},
                  .starts = {}};
    require(s.limits.max_voltage > s.limits.min_voltage,
            fmt::format("driver.{}: max_voltage must exceed min_voltage to search between them", drive));
    s.own = own_of(own, families.of(drive));
    if (s.own) {
      add_own(s);
    } else {
      choose_family(s, families.of(drive));
      s.family->add(s, prepared, first_touch);
    }
    for (std::vector<double>& start : s.starts) {
      for (std::size_t k = 0; k < start.size(); ++k) start[k] = std::clamp(start[k], s.variables[k].lower, s.variables[k].upper);
    }
    drives_.push_back(std::move(s));
  };
  if (actuator != Actuator::pzt) {
    add(searched_electrode(prepared.scene.device), false);
    for (const std::string& name : braking_electrodes(prepared)) add(name, true);
  }
  if (actuator != Actuator::electrostatic) {
    require_request(prepared.model.has_piezo(), [] {
      return "optimize " + requested("actuator") + " pzt|both needs a [piezo] section, and the scene has none";
    });
    add(std::string(piezo_drive), false);
  }
  families.check_all_used(drives_);
}

void SearchSpace::add_quasi_static(const PreparedScene& prepared, Actuator actuator, const std::string& family,
                                   double first_touch) {
  const std::size_t impulses = number_of(family, usual_impulses);
  const std::optional<StableApproach> approach = stable_approach(prepared, actuator);
  require_request(approach.has_value(), [&] {
    return fmt::format(
        "{} {}: no drive that {} {} shapes carries the switch to its contact through stable equilibria within "
        "the limits of its driver",
        requested("waveform"), family, requested("actuator"), name_of(actuators, actuator));
  });
  joint_.emplace(prepared, actuator, *approach, impulses, first_touch);
  for (const std::string& name : joint_->drives()) {
    const Drive& given = prepared.drives.at(name);
    drives_.push_back({.drive = name,
                       .hold = given.hold_level(),
                       .before = given.value_before(),
                       .first_touch = first_touch,
                       .limits = given.limits.value_or(DriverLimits{.min_voltage = 0, .max_voltage = given.hold_level()}),
                       .variables = {},
                       .starts = {}});
  }
}

SearchSpace SearchSpace::paced(double steady) const {
  SearchSpace own = *this;
  own.joint_ = own.joint_->paced(steady);
  return own;
}

const DriveSearch& SearchSpace::drive(const std::string& name) const {
  return *std::find_if(drives_.begin(), drives_.end(), [&](const DriveSearch& one) { return one.drive == name; });
}

std::vector<Variable> SearchSpace::variables() const {
  if (joint_) return joint_->variables();
  std::vector<Variable> all;
  for (const DriveSearch& d : drives_) {
    for (const Variable& v : d.variables) all.push_back({d.drive + "." + v.name, v.lower, v.upper});
  }
  return all;
}

std::vector<std::vector<double>> SearchSpace::starts() const {
  if (joint_) return joint_->starts();
  std::vector<std::vector<double>> all{{}};
  for (const DriveSearch& d : drives_) {
    std::vector<std::vector<double>> longer;
    for (const auto& head : all) {
      for (const auto& tail : d.starts) {
        longer.push_back(head);
        longer.back().insert(longer.back().end(), tail.begin(), tail.end());
      }
    }
    all = std::move(longer);
  }
  return all;
}

DriveWaveforms SearchSpace::waveforms(std::span<const double> x) const {
  if (joint_) return joint_->waveforms(x);
  DriveWaveforms result;
  std::size_t at = 0;
  for (const DriveSearch& d : drives_) {
    result.emplace(d.drive, d.waveform(x.subspan(at, d.variables.size())));
    at += d.variables.size();
  }
  return result;
}

std::optional<std::vector<double>> SearchSpace::parameters(const DriveWaveforms& waveforms) const {
  // The waveforms of the quasi-static family are tables of voltage over time, from which its parameters cannot be found.
  if (joint_) return std::nullopt;
  std::vector<double> all;
  for (const DriveSearch& d : drives_) {
    const auto found = waveforms.find(d.drive);
    const auto part = found == waveforms.end() ? std::nullopt : d.parameters(found->second);
    if (!part) return std::nullopt;
    all.insert(all.end(), part->begin(), part->end());
  }
  return all;
}

std::vector<double> SearchSpace::nearest(const DriveWaveforms& waveforms) const {
  if (joint_) return nearest_of_all(waveforms);
  std::vector<double> all;
  for (const DriveSearch& d : drives_) {
    const std::vector<double> part = d.nearest(waveforms.at(d.drive));
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

// Search the point at which the waveforms of all drives together differ least from the given ones. The samples of each drive
// (course_of()) are divided by their largest value.
std::vector<double> SearchSpace::nearest_of_all(const DriveWaveforms& given) const {
  std::vector<double> scales;
  double end = 0, hold = 0;
  for (const DriveSearch& d : drives_) end = std::max(end, end_of_course(d, signal(given.at(d.drive), d.before)));
  const auto count = static_cast<Eigen::Index>(drives_.size());
  VectorXd wanted(count * instants);
  for (Eigen::Index k = 0; k < count; ++k) {
    const DriveSearch& d = drives_[static_cast<std::size_t>(k)];
    const VectorXd course = course_of(d, signal(given.at(d.drive), d.before), end);
    scales.push_back(std::max(course.cwiseAbs().maxCoeff(), 1e-300));
    hold += about_hold(course / scales.back());
    wanted.segment(k * instants, instants) = course / scales.back();
  }
  const auto course = [&](std::span<const double> x) {
    const DriveWaveforms all = joint_->waveforms(x);
    VectorXd own(count * instants);
    for (Eigen::Index k = 0; k < count; ++k) {
      const DriveSearch& d = drives_[static_cast<std::size_t>(k)];
      own.segment(k * instants, instants) =
          course_of(d, signal(all.at(d.drive), d.before), end) / scales[static_cast<std::size_t>(k)];
    }
    return own;
  };
  return nearest_point(variables(), starts(), course, wanted, hold);
}

DriveWaveforms SearchSpace::searched(const DriveWaveforms& waveforms) const {
  DriveWaveforms chosen;
  for (const DriveSearch& d : drives_) {
    if (const auto found = waveforms.find(d.drive); found != waveforms.end()) chosen.insert(*found);
  }
  return chosen;
}

std::string SearchSpace::misfit(const DriveWaveforms& waveforms) const {
  for (const DriveSearch& d : drives_) {
    const auto found = waveforms.find(d.drive);
    if (found == waveforms.end()) return fmt::format("there is no waveform of the searched drive '{}'", d.drive);
    if (std::string reason = d.misfit(found->second); !reason.empty()) return reason;
  }
  return {};
}

}  // namespace softland
