// Measures the tuning by the contact on devices that no belief has seen (results/tune.md). Each device has one mode more than
// the belief, and is simulated as accurately as its scene requests. After 1, 2, 3, 4, 6, 8 and 12 closings the kept waveform is
// fired 20 more times, and the 95th percentile of the highest rebound of the true motion is recorded.
//
// bench_tune [--KEY VALUE]...   keys and defaults are those of Arguments below; --model is that of `softland device`
//
// Prints a line with all numbers for each device, then the table.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/require.h"
#include "config/condition.h"
#include "model/constants.h"
#include "model/pull_in.h"
#include "sampling/statistics.h"
#include "studies/inverse/practice_device.h"
#include "studies/inverse/tuner.h"

namespace {

using namespace softland;

constexpr std::array marks{1, 2, 3, 4, 6, 8, 12};

struct Arguments {
  std::string scene = "mem-gold.toml", actuator = "electrostatic", method = "belief", gas;
  int devices = 20, closings = 12, jobs = 2, modes = 1, recipes = 1;
  double first_device = 1, stiffness = 1, late = 0;  // late: delay of the device's records [s]
  LaboratoryErrors laboratory = {};
  double effort = 1;
  std::string touch;  // condition on the first touch
  double most_volts =
      std::numeric_limits<double>::infinity();  // devices with a higher static pull-in voltage, over the scene's, are skipped
  double drift_of_1000 =
      0;  // relative drift of the voltages in 1000 closings; with a drift the kept waveform is fired `repeats` times
  int repeats = 1000;
  double good = 10e-9, very_good = 1e-9;
  std::vector<std::string> sets, model_sets;
  // Returns the requested latest first touch [s].
  [[nodiscard]] double latest(double step_time) const {
    return beside_step(parse_condition(touch, all_figures), step_time).limit;
  }
};

Arguments read(std::span<char*> words) {
  Arguments a;
  const std::map<std::string, std::function<void(const std::string&)>> keys{
      {"--scene", [&](const std::string& v) { a.scene = v; }},
      {"--actuator", [&](const std::string& v) { a.actuator = v; }},
      {"--method", [&](const std::string& v) { a.method = v; }},
      {"--gas", [&](const std::string& v) { a.gas = v; }},
      {"--set", [&](const std::string& v) { a.sets.push_back(v); }},
      {"--model-set", [&](const std::string& v) { a.model_sets.push_back(v); }},
      {"--devices", [&](const std::string& v) { a.devices = std::stoi(v); }},
      {"--closings", [&](const std::string& v) { a.closings = std::stoi(v); }},
      {"--jobs", [&](const std::string& v) { a.jobs = std::stoi(v); }},
      {"--modes", [&](const std::string& v) { a.modes = std::stoi(v); }},
      {"--recipes", [&](const std::string& v) { a.recipes = std::stoi(v); }},
      {"--constrain", [&](const std::string& v) { a.touch = v; }},
      {"--most-volts", [&](const std::string& v) { a.most_volts = std::stod(v); }},
      {"--effort", [&](const std::string& v) { a.effort = std::stod(v); }},
      {"--first-device", [&](const std::string& v) { a.first_device = std::stod(v); }},
      {"--edge-error", [&](const std::string& v) { a.laboratory.edge_error = std::stod(v); }},
      {"--unseen", [&](const std::string& v) { a.laboratory.unseen = std::stod(v); }},
      {"--shot-error", [&](const std::string& v) { a.laboratory.shot_error = std::stod(v); }},
      {"--gain-error", [&](const std::string& v) { a.laboratory.gain_error = std::stod(v); }},
      {"--trigger-delay", [&](const std::string& v) { a.laboratory.trigger_delay = std::stod(v); }},
      {"--late", [&](const std::string& v) { a.late = std::stod(v); }},
      {"--stiffness", [&](const std::string& v) { a.stiffness = std::stod(v); }},
      {"--drift-of-1000", [&](const std::string& v) { a.drift_of_1000 = std::stod(v); }},
      {"--repeats", [&](const std::string& v) { a.repeats = std::stoi(v); }},
      {"--good", [&](const std::string& v) { a.good = std::stod(v); }},
      {"--very-good", [&](const std::string& v) { a.very_good = std::stod(v); }}};
  for (std::size_t k = 0; k + 1 < words.size(); k += 2) {
    const auto found = keys.find(words[k]);
    require(found != keys.end(), [&] { return fmt::format("{}: no such option", words[k]); });
    found->second(words[k + 1]);
  }
  return a;
}

double quantile(const std::vector<double>& sample, double p) {
  return sample.empty() ? Metrics::unset : sample_quantile(sample, p);
}

// The results of one device.
struct Course {
  std::map<int, double> kept;        // 95th percentile of the kept waveform's highest rebound, by number of closings [m]
  std::vector<double> on_the_way;    // highest rebound of each shot [m]
  std::vector<double> touches;       // first touch of each shot [s]
  std::map<int, double> kept_touch;  // first touch of the kept waveform [s]
  std::vector<double> seconds;       // wall time of each learning and proposal [s]
  std::vector<double> expected;      // expected cost of the next shot
  std::vector<double> surprises;     // Tuner::surprises()
  int unexpected_bounces = 0;
  std::string broken;
  std::optional<BelievedQuantity> gap_ratio, delay;
  double gaps = 1;               // believed factor of the contact gap
  TouchMisfit misfit;            // the misfit that exceeds its bound by the most
  std::vector<double> repeated;  // highest rebound of each repetition [m]
  int learned = 0;               // number of repetitions whose record was learned
};

class Laboratory {
 public:
  Laboratory(const PracticeDevice& device, double hold_time) : device_(device), hold_time_(hold_time) {}
  PracticeClosing fire(const std::vector<Waveform>& waveforms) {
    return device_.close(++shots_, waveforms, last(waveforms) + hold_time_);
  }
  // Returns, over 20 more shots, the 95th percentile of the highest rebound [m] and the median first touch [s].
  std::pair<double, double> judged(const std::vector<Waveform>& waveforms) {
    constexpr int shots = 20;
    constexpr std::uint64_t others = 1'000'000;  // first shot number, beyond those of all closings
    std::vector<double> heights, touches;
    for (int k = 0; k < shots; ++k) {
      const PracticeClosing closing = device_.close(others + judged_++, waveforms, last(waveforms) + hold_time_);
      heights.push_back(height(closing));
      touches.push_back(closing.motion.initial_contact_time);
    }
    std::erase_if(touches, [](double t) { return std::isnan(t); });
    return {quantile(heights, 0.95), quantile(touches, 0.5)};
  }
  static double height(const PracticeClosing& closing) {
    const double height = closing.motion.major_bounce_height;
    return std::isnan(height) ? std::numeric_limits<double>::infinity() : height;
  }

 private:
  static double last(const std::vector<Waveform>& waveforms) {
    double end = 0;
    for (const Waveform& waveform : waveforms) end = std::max(end, signal(waveform).breakpoints().back());
    return end;
  }
  const PracticeDevice& device_;
  double hold_time_;
  std::uint64_t shots_ = 0, judged_ = 0;
};

bool is_mark(int closings) { return std::ranges::find(marks, closings) != marks.end(); }

void mark(Course& course, Laboratory& lab, int closings, const std::vector<Waveform>& kept) {
  if (is_mark(closings)) std::tie(course.kept[closings], course.kept_touch[closings]) = lab.judged(kept);
}

Course by_belief(const Arguments& a, const Tuner& fresh, Laboratory& lab) {
  Course course;
  Tuner tuner = fresh.restarted();
  for (int k = 1; k <= a.closings; ++k) {
    const PracticeClosing closing = lab.fire(tuner.next().waveforms);
    course.on_the_way.push_back(Laboratory::height(closing));
    course.touches.push_back(closing.motion.initial_contact_time);
    const auto begin = std::chrono::steady_clock::now();
    ContactRecord record = closing.record;
    if (!record.error.empty()) record = {};  // the beam collapsed onto the electrode: a laboratory has no usable record
    tuner.learn(record);
    if (const TouchMisfit now = tuner.belief().touch_misfit;
        k == 1 || now.least * course.misfit.bound > course.misfit.least * now.bound)
      course.misfit = now;
    course.seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    course.expected.push_back(tuner.next().expected_cost);
    mark(course, lab, k, tuner.kept().waveforms);
  }
  course.surprises = tuner.surprises();
  course.unexpected_bounces = tuner.unexpected_bounces();
  course.broken = tuner.broken_assumption().value_or("");
  const BeliefSummary believed = tuner.belief();
  course.gap_ratio = believed.gap_ratio;
  for (const BelievedQuantity& one : believed.quantities) {
    if (one.name == "trigger delay") course.delay = one;
    if (one.name == "gap.contact") course.gaps = one.mean;
  }
  for (int k = 0; a.drift_of_1000 != 0 && k < a.repeats; ++k) {
    const PracticeClosing closing = lab.fire(tuner.next().waveforms);
    course.repeated.push_back(Laboratory::height(closing));
    const std::size_t before = tuner.surprises().size();
    tuner.learn(closing.record);
    course.learned += static_cast<int>(tuner.surprises().size() - before);
  }
  return course;
}

// Baselines without a model of the device, as in laboratories, starting from the nominal recipe. They keep the waveform with
// the shortest open time.

double open_time(const ContactRecord& record) {
  constexpr double never = 1e3;  // [s]
  if (!record.error.empty() || !first_touch(record)) return never;
  double sum = 0;
  for (const ContactOpening& o : openings(record)) sum += std::min(o.end, never) - o.begin;
  return sum;
}

std::vector<Waveform> in_volts(const std::vector<Waveform>& recipe, double factor) {
  std::vector<Waveform> own = recipe;
  for (Waveform& waveform : own) waveform = scaled(std::move(waveform), factor, 1);
  return own;
}

// Returns the recipe with another pulse length and coast of the closing electrode. All later edges are shifted.
std::vector<Waveform> in_times(const std::vector<Waveform>& recipe, std::size_t drive, double pulse, double coast) {
  std::vector<Waveform> own = recipe;
  auto& catching = std::get<Pulse>(own[drive]);
  const std::vector<double> old = catching.times;
  catching.times[0] = old[0] * pulse;
  for (std::size_t k = 1; k < old.size(); ++k)
    catching.times[k] = catching.times[k - 1] + (old[k] - old[k - 1]) * (k == 1 ? coast : 1);
  return own;
}

struct Best {
  std::vector<Waveform> waveforms;
  double open = std::numeric_limits<double>::infinity();
};

void shoot(Course& course, Laboratory& lab, Best& best, const std::vector<Waveform>& waveforms, ContactRecord& record) {
  const PracticeClosing closing = lab.fire(waveforms);
  record = closing.record;
  course.on_the_way.push_back(Laboratory::height(closing));
  course.touches.push_back(closing.motion.initial_contact_time);
  if (open_time(record) < best.open) best = {.waveforms = waveforms, .open = open_time(record)};
}

// Scales all voltages by s. The first s follows from a step, the next ones by a secant on the touch time of the nominal device.
Course by_one_knob(const Arguments& a, const PreparedScene& p, const std::vector<Waveform>& recipe, double limit,
                   Laboratory& lab) {
  Course course;
  const PullInMeter meter(p, {.closing_time = true});
  std::vector<Waveform> step(recipe.size(), Step{.level = 0});
  step[meter.electrode()] = Step{.level = closing_step * meter.pull_in()};
  ContactRecord record;
  Best best;
  shoot(course, lab, best, step, record);
  double s = std::min(limit, first_touch(record) ? meter.units_by_time(*first_touch(record)).volts : 1);
  best = {.waveforms = in_volts(recipe, s)};
  mark(course, lab, 1, best.waveforms);
  const Trajectory nominal = simulate_closing(p.model, p.applied(recipe), {.duration = p.duration, .after_contact = 0});
  const double due = nominal.touches.front().begin;
  double last_s = 0, last_time = 0;
  for (int k = 2; k <= a.closings; ++k) {
    shoot(course, lab, best, in_volts(recipe, s), record);
    mark(course, lab, k, best.waveforms);
    if (open_time(record) == 0 || !first_touch(record)) continue;
    const double time = *first_touch(record);
    double slope = -17 * due;
    if (last_s > 0 && std::abs(s - last_s) > 2e-4) slope = std::clamp((time - last_time) / (s - last_s), -80 * due, -4 * due);
    last_s = s, last_time = time;
    double change = std::clamp((due - time) / slope, -0.01, 0.01);
    if (std::abs(change) < 3e-4) change = (k % 2 == 0 ? 1 : -1) * 3e-4 * (k / 2);
    s = std::min(limit, s + change);
  }
  return course;
}

// Scales times by a step, then finds the pulse length by a secant: the time from braking to touch must be that of the nominal
// device.
Course by_secant(const Arguments& a, const PreparedScene& p, const std::vector<Waveform>& recipe, double hold_step,
                 Laboratory& lab) {
  Course course;
  const std::size_t drive = searched_drive(p.scene.device);
  std::vector<Waveform> step(recipe.size(), Step{.level = 0});
  step[drive] = Step{.level = hold_step};
  const auto touch_of = [&](const std::vector<Waveform>& waveforms) {
    return simulate_closing(p.model, p.applied(waveforms), {.duration = p.duration, .after_contact = 0}).touches.front().begin;
  };
  const double step_time = touch_of(step), pulse = std::get<Pulse>(recipe[drive]).times[0],
               coast = std::get<Pulse>(recipe[drive]).times[1] - pulse, due = touch_of(recipe) - pulse - coast;
  ContactRecord record;
  Best best;
  shoot(course, lab, best, step, record);
  const double time = first_touch(record).value_or(step_time) / step_time;
  double length = time, last_length = 0, last_error = 0;
  best = {.waveforms = in_times(recipe, drive, length, time)};
  mark(course, lab, 1, best.waveforms);
  for (int k = 2; k <= a.closings; ++k) {
    shoot(course, lab, best, in_times(recipe, drive, length, time), record);
    mark(course, lab, k, best.waveforms);
    const double error = first_touch(record).value_or(2 * step_time) - length * pulse - time * coast - time * due;
    double slope = -3 * pulse;
    if (last_length > 0 && std::abs(length - last_length) > 1e-7)
      slope = std::clamp((error - last_error) / (length - last_length), -20 * pulse, -0.3 * pulse);
    last_length = length, last_error = error;
    length -= std::clamp(error / slope, -0.05, 0.05);
    if (std::abs(length - last_length) < 3e-4) length = last_length + (open_time(record) > 0 ? 6e-4 : 0);
  }
  return course;
}

// Minimises the open time of the contact over pulse and coast by Nelder and Mead's method.
Course by_nelder_mead(const Arguments& a, const PreparedScene& p, const std::vector<Waveform>& recipe, Laboratory& lab) {
  Course course;
  const std::size_t drive = searched_drive(p.scene.device);
  Best best;
  int shots = 0;
  const auto open = [&](std::span<const double> x) {
    ContactRecord record;
    shoot(course, lab, best, in_times(recipe, drive, x[0], x[1]), record);
    mark(course, lab, ++shots, best.waveforms);
    return open_time(record);
  };
  Problem problem;
  problem.variables = {{"pulse", 0.5, 1.5}, {"coast", 0.5, 1.5}};
  problem.objective = open;
  problem.starts = {{1, 1}};
  (void)minimize(problem, {.optimizer = "nelder-mead", .max_evaluations = a.closings, .step = 0.03});
  return course;
}

void print_row(const char* name, const std::function<std::string(int)>& value, int closings) {
  fmt::print("| {} |", name);
  for (const int n : marks) {
    if (n <= closings) fmt::print(" {} |", value(n));
  }
  fmt::print("\n");
}

void print_table(const Arguments& a, const std::vector<Course>& all, double step_time) {
  fmt::print("\n| closings |");
  for (const int n : marks) {
    if (n <= a.closings) fmt::print(" {} |", n);
  }
  fmt::print("\n");
  const auto kept = [&](int n) {
    std::vector<double> v;
    for (const Course& c : all) v.push_back(c.kept.at(n));
    return v;
  };
  const auto share = [&](int n, double below) {
    const std::vector<double> v = kept(n);
    return fmt::format("{:.1f} %", 100.0 * static_cast<double>(std::ranges::count_if(v, [&](double h) { return h < below; })) /
                                       static_cast<double>(v.size()));
  };
  const auto of_kept_touch = [&](int n) {
    std::vector<double> v;
    for (const Course& c : all) v.push_back(c.kept_touch.at(n) / step_time);
    std::erase_if(v, [](double t) { return std::isnan(t); });
    return fmt::format("{:.2f} / {:.2f}", quantile(v, 0.5), quantile(v, 0.95));
  };
  const auto in_time = [&](int n) {
    const double latest = a.latest(step_time);
    return fmt::format("{:.1f} %",
                       100.0 *
                           static_cast<double>(std::ranges::count_if(
                               all, [&](const Course& c) { return c.kept_touch.at(n) <= latest && c.kept.at(n) < a.good; })) /
                           static_cast<double>(all.size()));
  };
  const auto on_the_way = [&](int n) {
    std::vector<double> v;
    for (const Course& c : all) v.push_back(c.on_the_way[static_cast<std::size_t>(n - 1)]);
    return fmt::format("{:.2g}", 1e9 * quantile(v, 0.95));
  };
  const auto median = [&](int n) {
    return fmt::format("{:.2g} / {:.2g}", 1e9 * quantile(kept(n), 0.5), 1e9 * quantile(kept(n), 0.95));
  };
  print_row(
      fmt::format("below {:g} nm", 1e9 * a.good).c_str(), [&](int n) { return share(n, a.good); }, a.closings);
  print_row(
      fmt::format("below {:g} nm", 1e9 * a.very_good).c_str(), [&](int n) { return share(n, a.very_good); }, a.closings);
  if (!a.touch.empty()) print_row(fmt::format("below {:g} nm, and {}", 1e9 * a.good, a.touch).c_str(), in_time, a.closings);
  print_row("highest rebound, median / 95 %, nm", median, a.closings);
  print_row("first touch over the step's, median / 95 %", of_kept_touch, a.closings);
  print_row("highest rebound of the shot itself, 95 %, nm", on_the_way, a.closings);
}

}  // namespace

int main(int count, char** words) try {
  const Arguments a = read(std::span(words, static_cast<std::size_t>(count)).subspan(1));
  const bool is_path = a.scene.find('/') != std::string::npos;
  SceneFile file = SceneFile::load(is_path ? a.scene : std::string(SOFTLAND_SCENES) + "/" + a.scene);
  for (const std::string& set : a.sets) file.set(set);
  const auto actuator = find_named(actuators, a.actuator);
  require(actuator != nullptr, "--actuator: must be electrostatic, pzt or both");
  const auto begin = std::chrono::steady_clock::now();
  const auto since = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(); };
  TunerOptions options{
      .actuator = actuator->value, .jobs = a.jobs, .laboratory = a.laboratory, .most_recipes = a.recipes, .effort = a.effort};
  if (!a.touch.empty()) options.touch = parse_condition(a.touch, all_figures);
  const Tuner fresh(file, options);
  const std::vector<Waveform> recipe = fresh.next().waveforms;
  fmt::print("ready after {:.1f} s; expected cost {:.3f}; step touches at {:.2f} us\n", since(), fresh.next().expected_cost,
             1e6 * fresh.step_closing_time());
  double limit = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < recipe.size(); ++k) {
    if (const double peak = signal(recipe[k]).peak(); peak > 0)
      limit = std::min(limit, fresh.scene().limits(k).max_voltage / peak);
  }
  std::vector<Course> all;
  std::vector<double> seconds;
  int broken = 0;
  for (int n = 0; static_cast<int>(all.size()) < a.devices; ++n) {
    const PracticeDevice device(file,
                                {.seed = static_cast<std::uint64_t>(a.first_device) + static_cast<std::uint64_t>(n),
                                 .laboratory = a.laboratory,
                                 .drift = (n % 2 == 0 ? 1 : -1) * a.drift_of_1000 / 1000,
                                 .trigger_delay = a.late,
                                 .model = {.more_modes = a.modes, .gas = a.gas, .stiffness = a.stiffness, .set = a.model_sets}});
    const PreparedScene& p = fresh.scene();
    const auto volts = [](const Switch& model, std::size_t drive) { return static_pull_in(model, drive).voltage; };
    if (std::isfinite(a.most_volts)) {
      const std::size_t drive = searched_drive(p.scene.device);
      if (volts(*device.device().model, drive) > a.most_volts * volts(p.model, drive)) continue;
    }
    Laboratory lab(device, fresh.next().hold_time);
    all.push_back(a.method == "knob"     ? by_one_knob(a, p, recipe, limit, lab)
                  : a.method == "secant" ? by_secant(a, p, recipe, p.signals()[searched_drive(p.scene.device)].hold_level(), lab)
                  : a.method == "nelder-mead" ? by_nelder_mead(a, p, recipe, lab)
                                              : by_belief(a, fresh, lab));
    const Course& c = all.back();
    fmt::print("device {}:", static_cast<std::uint64_t>(a.first_device) + static_cast<std::uint64_t>(n));
    for (std::size_t k = 0; k < c.on_the_way.size(); ++k) {
      fmt::print(" {:.3g}@{:.2f}", 1e9 * c.on_the_way[k], 1e6 * c.touches[k]);
      if (k < c.expected.size()) fmt::print(" e{:.3f} {:.2f}s", c.expected[k], c.seconds[k]);
      if (const auto kept = c.kept.find(static_cast<int>(k) + 1); kept != c.kept.end())
        fmt::print(" <{:.3g}>", 1e9 * kept->second);
    }
    if (!c.repeated.empty()) {
      const auto below = [&](double h) { return std::ranges::count_if(c.repeated, [&](double one) { return one < h; }); };
      fmt::print(" repeated {}: {} below {:g} nm, {} below {:g} nm, learned from {}", c.repeated.size(), below(a.good),
                 1e9 * a.good, below(a.very_good), 1e9 * a.very_good, c.learned);
    }
    fmt::print(" surprises {:.1f}, {} bounces", fmt::join(c.surprises, " "), c.unexpected_bounces);
    if (c.gap_ratio) fmt::print(", gap ratio {:.4f} +- {:.4f}", c.gap_ratio->mean, c.gap_ratio->deviation);
    if (c.delay) fmt::print(", gap {:.4f}, late {:.3f} +- {:.3f} us", c.gaps, 1e6 * c.delay->mean, 1e6 * c.delay->deviation);
    fmt::print(", misfit {:.2f} of {:.2f}", c.misfit.least, c.misfit.bound);
    fmt::print("{}\n", c.broken.empty() ? "" : " BROKEN " + c.broken);
    std::fflush(stdout);
    broken += !c.broken.empty();
    constexpr double repeats = 1e-3;  // [s]; repeated shots take less, since nothing is learned
    std::ranges::copy_if(c.seconds, std::back_inserter(seconds), [](double one) { return one > repeats; });
  }
  print_table(a, all, fresh.step_closing_time());
  if (!seconds.empty())
    fmt::print("\nseconds per learning and proposal on {} threads: median {:.2f}, 95 % {:.2f}, largest {:.2f}\n", a.jobs,
               quantile(seconds, 0.5), quantile(seconds, 0.95), quantile(seconds, 1));
  fmt::print("said to be broken: {} of {}\n", broken, a.devices);
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "{}\n", error.what());
  return 2;
}
