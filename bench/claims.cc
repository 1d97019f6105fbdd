// Checks claims of Bognash's 2019 thesis ("Bouncing of MEM/NEM switches", University of Western Ontario) on the shipped
// reconstructions of its switches. bench_claims nem-voltage|casimir-size|micro-bounces FOLDER writes a figure and a table into
// FOLDER.
//
// The files depend on the program only.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <functional>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include "base/require.h"
#include "base/write_whole.h"
#include "bench/figure.h"
#include "model/closing.h"
#include "model/constants.h"
#include "model/pull_in.h"
#include "studies/closing/simulate.h"
#include "studies/search/optimize.h"
#include "version.h"

namespace softland {
namespace {

using internal::Role;

constexpr double missing = Metrics::unset;

SceneFile shipped(const std::string& name) { return SceneFile::load(std::string(SOFTLAND_SCENES) + "/" + name); }

SceneFile with(SceneFile file, const std::vector<std::string>& assignments) {
  for (const std::string& assignment : assignments) file.set(assignment);
  return file;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? missing : values[values.size() / 2];
}

std::string number(double value, int digits = 3) {
  if (!std::isfinite(value)) return "-";
  return std::abs(value) < 1000 ? fmt::format("{:.{}g}", value, digits) : fmt::format("{:.0f}", value);
}

/// The median of a figure over indistinguishable runs, with its range if that is visible: "6.9" or "6.9 (6.4 to 7.5)".
struct Cloud {
  double middle = missing, least = missing, most = missing;
  explicit Cloud(const std::vector<double>& values) : middle(median(values)) {
    if (values.empty()) return;
    least = *std::min_element(values.begin(), values.end());
    most = *std::max_element(values.begin(), values.end());
  }
  [[nodiscard]] std::string text(double unit) const {
    if (!(most - least > 0.02 * middle)) return number(middle / unit);
    return fmt::format("{} ({} to {})", number(middle / unit), number(least / unit), number(most / unit));
  }
};

/// Figures of a closing and of its neighbours, whose drives differ by parts in a million.
struct Cloudy {
  Cloud first, settled, count, height, speed;
};

Cloudy closings(const std::function<SceneFile(double)>& scaled) {
  constexpr int neighbours = 4;  // number of neighbours to either side
  std::vector<double> first, settled, count, height, speed;
  for (int k = -neighbours; k <= neighbours; ++k) {
    const Metrics m = simulate(prepare(scaled(1 + 1e-6 * k)), false).metrics;
    if (!std::isfinite(m.initial_contact_time)) continue;
    first.push_back(m.initial_contact_time);
    count.push_back(m.bounce_count);
    height.push_back(m.major_bounce_height);
    speed.push_back(m.impact_velocity);
    if (m.settled) settled.push_back(m.permanent_contact_time);
  }
  return {Cloud(first), Cloud(settled), Cloud(count), Cloud(height), Cloud(speed)};
}

void keep(const std::filesystem::path& folder, const std::string& name, const std::string& picture, const std::string& words) {
  write_whole(folder / (name + ".svg"), picture);
  write_whole(folder / (name + ".md"), words);
  std::cout << fmt::format("{0}.svg and {0}.md written\n", (folder / name).string());
}

std::string made_by(const std::string& study) {
  return fmt::format("- made by `build/bench/bench_claims {} results` (configured with `-DSOFTLAND_BENCH=ON`), softland {}\n",
                     study, version);
}

// ---- switching time and bounce against voltage, and the gain by a shaped waveform

/// Figures of steps by their height, and as curves.
struct Steps {
  std::map<int, Cloudy> by_percent;  // closings by step height [% of the dynamic pull-in voltage]
  Points first, settled, count, height, speed;

  /// Returns the median settling time of steps of about this height: that of single heights jumps.
  [[nodiscard]] double usual(int percent) const {
    constexpr int around = 3;
    std::vector<double> times;
    for (int k = percent - around; k <= percent + around; ++k) {
      if (by_percent.contains(k)) times.push_back(by_percent.at(k).settled.middle);
    }
    return median(times);
  }
};

/// Runs the scenes at(h) for step heights h over the dynamic pull-in voltage.
Steps steps_of(const std::function<SceneFile(double)>& at) {
  constexpr int lowest = 101, highest = 200;
  Steps steps;
  for (int percent = lowest; percent <= highest; ++percent) {
    const double r = percent / 100.0;
    const Cloudy& c = steps.by_percent.emplace(percent, closings([&](double part) { return at(part * r); })).first->second;
    steps.first.push_back({r, c.first.middle});
    steps.settled.push_back({r, c.settled.middle});
    steps.count.push_back({r, c.count.middle});
    steps.height.push_back({r, c.height.middle});
    steps.speed.push_back({r, c.speed.middle});
  }
  return steps;
}

struct Shaped {
  std::string family, label;
  Role pen;
  Points settled, gain, saved;
};

std::vector<Panel> nem_panels(const Steps& steps, const std::vector<Shaped>& shaped) {
  const std::string x = "Step height over dynamic pull-in voltage";
  return {{.title = "Permanent contact (dots: first)",
           .x_label = x,
           .y_label = "Time",
           .y_unit = "s",
           .curves = {{"", steps.first, Role::evaluations},
                      {"step", steps.settled, Role::baseline},
                      {"dither", shaped[0].settled, Role::third},
                      {"pulse", shaped[1].settled, Role::fourth}}},
          {.title = "Settling time saved",
           .x_label = x,
           .y_label = "Time",
           .y_unit = "s",
           .curves = {{"dither", shaped[0].saved, Role::third}, {"pulse", shaped[1].saved, Role::fourth}}},
          {.title = "Part of the settling time saved",
           .x_label = x,
           .y_label = "Gain in %",
           .curves = {{"dither", shaped[0].gain, Role::third}, {"pulse", shaped[1].gain, Role::fourth}}},
          {.title = "Impact velocity of the step",
           .x_label = x,
           .y_label = "Speed",
           .y_unit = "m/s",
           .curves = {{"step", steps.speed, Role::baseline}}},
          {.title = "Rebounds of the step",
           .x_label = x,
           .y_label = "Rebounds above 0.01 nm",
           .curves = {{"step", steps.count, Role::baseline}}},
          {.title = "Highest rebound of the step",
           .x_label = x,
           .y_label = "Height",
           .y_unit = "m",
           .curves = {{"step", steps.height, Role::baseline}}}};
}

void nem_voltage(const std::filesystem::path& folder) {
  const SceneFile scene = shipped("nem-tin.toml");
  const double dynamic = prepare(scene, true).voltage_units().at("main").dynamic_pull_in;
  constexpr double window = 40e-9;
  constexpr double room = 1.2;  // peak of the shaped waveforms over their hold voltage: 1.2, as for the dither of the thesis
  const auto at = [&](double level) {
    return with(scene,
                {fmt::format("waveform.main.level={:.17g} V", level),
                 fmt::format("driver.main.max_voltage={:.17g} V", room * level), fmt::format("simulate.duration={} s", window)});
  };

  const Steps steps = steps_of([&](double r) { return at(r * dynamic); });
  std::vector<Shaped> shaped{{"harmonic", "dither", Role::third, {}, {}, {}}, {"pulse", "pulse", Role::fourth, {}, {}, {}}};
  std::vector<std::vector<std::string>> rows{{"V / V_dp", "t_i [ns]", "v_i [m/s]", "t_p [ns]", "t_p around [ns]", "N_B",
                                              "B_H [nm]", "dither: t_p [ns]", "N_B", "gain", "pulse: t_p [ns]", "N_B", "gain"}};
  std::string finding;
  for (const int percent : {105, 110, 115, 120, 125, 130, 135, 140, 145, 150, 160, 170, 180, 190, 200}) {
    const double r = percent / 100.0, reference = steps.usual(percent);
    const Cloudy& step = steps.by_percent.at(percent);
    rows.push_back({fmt::format("{:.2f}", r), step.first.text(1e-9), step.speed.text(1), step.settled.text(1e-9),
                    number(reference / 1e-9), step.count.text(1), step.height.text(1e-9)});
    for (Shaped& s : shaped) {
      const OptimizeResult found = optimize(at(r * dynamic), {.target = Target::settling, .family = s.family});
      const double own = found.best && found.best->metrics.settled ? found.best->metrics.permanent_contact_time : missing;
      s.settled.push_back({r, own});
      s.gain.push_back({r, 100 * (1 - own / reference)});
      s.saved.push_back({r, reference - own});
      rows.back().insert(rows.back().end(),
                         {number(own / 1e-9), found.best ? std::to_string(found.best->metrics.bounce_count) : "-",
                          std::isfinite(own) ? fmt::format("{:.0f} %", s.gain.back()[1]) : "-"});
      std::cerr << fmt::format("{} at {:.2f} Vdp: t_p {} ns, gain {:.0f} %\n", s.family, r, number(own / 1e-9), s.gain.back()[1]);
    }
  }
  for (const Shaped& s : shaped) {
    const auto most = std::max_element(s.saved.begin(), s.saved.end(), [](const auto& a, const auto& b) { return a[1] < b[1]; });
    const auto gain = s.gain.begin() + (most - s.saved.begin());
    finding += fmt::format("{} {} saves most time at {:.2f} Vdp: {:.1f} ns, {:.0f} %.", finding.empty() ? "A searched" : " A",
                           s.label, (*most)[0], (*most)[1] / 1e-9, (*gain)[1]);
  }
  const std::string words =
      "Titanium nitride nano-switch (scenes/nem-tin.toml, a reconstruction). Steps: medians of nine runs whose voltage differs "
      "by parts "
      "in a million. Dither and pulse: searched for early settling, at most 20 % above the level they hold; compared with the "
      "median "
      "of the steps within 0.03 Vdp.";
  keep(folder, "nem-voltage", figure(finding, words, nem_panels(steps, shaped)),
       fmt::format("# The nano-switch against its voltage\n\n{}\n\n"
                   "{}- scene `scenes/nem-tin.toml`, a reconstruction of the titanium nitride switch: V_dp = {:.4f} V\n"
                   "- step: medians of nine runs whose voltage differs by parts in a million, with their range where it matters; "
                   "\"t_p around\": "
                   "median of the steps within 0.03 V_dp, since t_p of single heights jumps\n"
                   "- dither (a sine that fades, on top of the step) and pulse: searched with `--target settling`, 2500 "
                   "evaluations, seed 1, at "
                   "most {:.0f} % above the level they hold; gain: part of \"t_p around\" that is saved\n\n"
                   "![Times, gain, rebounds and their height against voltage](nem-voltage.svg)\n\n{}",
                   finding, made_by("nem-voltage"), dynamic, 100 * (room - 1), markdown_table(rows)));
}

// ---- the switch closed by the Casimir force: size and bounce

struct SizedSwitches {
  double critical;  // factor of the force at rest at which the switch closes quasi-statically
  std::string label;
  Role pen;
  Points height, relative, count, time;
};

/// Returns the length at which a beam closes quasi-statically under `critical` times its force at rest [m]. `length` is a first
/// value.
double critical_length(const std::function<SceneFile(double)>& sized, double length, double critical) {
  // The force that a beam can balance decreases with the fourth power of its length.
  for (int i = 0; i < 4; ++i) {
    const double bears = 1 + static_pull_in(prepare(sized(length)).model, 0).voltage;
    length *= std::pow(bears / critical, 0.25);
  }
  return length;
}

void write_casimir_size(const std::filesystem::path& folder, const std::vector<SizedSwitches>& kinds,
                        const std::vector<std::vector<std::string>>& rows) {
  const auto panel = [&](const std::string& title, const std::string& label, const std::string& unit,
                         Points SizedSwitches::*points) {
    Panel p{.title = title, .x_label = "Gap at rest", .x_unit = "m", .y_label = label, .y_unit = unit};
    for (const SizedSwitches& kind : kinds) p.curves.push_back({kind.label, kind.*points, kind.pen});
    return p;
  };
  const auto& middle = kinds[1];
  const bool less = middle.count.front()[1] < middle.count.back()[1] && middle.height.front()[1] < middle.height.back()[1];
  const std::string finding = fmt::format(
      "{}: from a gap of {:.0f} nm to one of {:.0f} nm {} rebounds become {}, and the highest goes from {} to {} nm.",
      less ? "Shorter beams over smaller gaps bounce less" : "Shorter beams over smaller gaps do not bounce less",
      middle.height.back()[0] / 1e-9, middle.height.front()[0] / 1e-9, number(middle.count.back()[1]),
      number(middle.count.front()[1]), number(middle.height.back()[1] / 1e-9, 2), number(middle.height.front()[1] / 1e-9, 2));
  const std::string words =
      "Gold cantilevers closed by a Casimir force that grows from 1 to 1.25 (scenes/nem-casimir.toml scaled, a reconstruction). "
      "The "
      "beams of a curve lose their open state at the same factor, so that the smaller gaps have the shorter beams: 8.5 µm at 80 "
      "nm, "
      "2.5 µm at 25 nm.";
  keep(folder, "casimir-size",
       figure(finding, words,
              {panel("Highest rebound", "Height", "m", &SizedSwitches::height),
               panel("Highest rebound over contact gap", "Height in % of the gap", "", &SizedSwitches::relative),
               panel("Rebounds above 0.1 nm", "Rebounds", "", &SizedSwitches::count),
               panel("Bounce time", "First to permanent contact", "s", &SizedSwitches::time)}),
       fmt::format("# The Casimir switch against its size\n\n{}\n\n{}"
                   "- scene `scenes/nem-casimir.toml`, a reconstruction, with other gaps and lengths; contact at 60 % of the "
                   "gap; the force "
                   "grows from 1 to 1.25 at t = 0\n"
                   "- critical factor: how far the force may grow slowly before the open state is lost; it fixes the length, "
                   "since beam and "
                   "gap cannot be chosen freely: too short a beam does not close, too long a one closes by itself\n"
                   "- medians of nine runs whose factor differs by parts in a million, with their range where it matters\n\n"
                   "![Height, number and duration of rebounds against the gap](casimir-size.svg)\n\n{}",
                   finding, made_by("casimir-size"), markdown_table(rows)));
}

void casimir_size(const std::filesystem::path& folder) {
  const SceneFile scene = shipped("nem-casimir.toml");
  const double own_length = prepare(scene).scene.device.structure.length;
  std::vector<SizedSwitches> kinds{{1.06, "closes at 1.06", Role::fourth, {}, {}, {}, {}},
                                   {1.12, "at 1.12", Role::best, {}, {}, {}, {}},
                                   {1.18, "at 1.18", Role::third, {}, {}, {}, {}}};
  std::vector<std::vector<std::string>> rows{{"gap [nm]", "contact gap [nm]", "critical factor", "length [um]", "t_i [ns]",
                                              "v_i [mm/s]", "N_B", "B_H [nm]", "B_H / contact gap", "t_p - t_i [ns]"}};
  for (const double gap : {25e-9, 30e-9, 35e-9, 40e-9, 45e-9, 50e-9, 55e-9, 60e-9, 65e-9, 70e-9, 75e-9, 80e-9}) {
    const double contact = 0.6 * gap;
    const auto sized = [&](double length) {
      return with(scene, {fmt::format("gap.electrode={:.17g} m", gap), fmt::format("gap.contact={:.17g} m", contact),
                          fmt::format("structure.length={:.17g} m", length)});
    };
    for (SizedSwitches& kind : kinds) {
      const double length = critical_length(sized, own_length, kind.critical);
      const double period = 2 * pi / prepare(sized(length)).model.basis().angular_frequencies()[0];
      const auto scaled = [&](double part) {
        return with(sized(length), {fmt::format("waveform.dispersion.level={:.17g}", 1 + 0.25 * part),
                                    fmt::format("simulate.duration={:.17g} s", 20 * period)});
      };
      const Cloudy c = closings(scaled);
      kind.height.push_back({gap, c.height.middle});
      kind.relative.push_back({gap, 100 * c.height.middle / contact});
      kind.count.push_back({gap, c.count.middle});
      kind.time.push_back({gap, c.settled.middle - c.first.middle});
      rows.push_back({number(gap / 1e-9), number(contact / 1e-9), number(kind.critical), number(length / 1e-6, 4),
                      c.first.text(1e-9), c.speed.text(1e-3), c.count.text(1), c.height.text(1e-9),
                      fmt::format("{} %", number(100 * c.height.middle / contact)),
                      number((c.settled.middle - c.first.middle) / 1e-9)});
    }
  }
  write_casimir_size(folder, kinds, rows);
}

// ---- small rebounds inside the first large one, and the modes that make them

struct Flight {
  double begin, end, height;
};

/// Returns the rebounds that are higher than `significant` [m].
std::vector<Flight> flights(const Trajectory& t, double significant) {
  std::vector<Flight> rebounds;
  for (std::size_t k = 0; k + 1 < t.touches.size(); ++k) {
    Flight r{t.touches[k].end, t.touches[k + 1].begin, 0};
    for (const TrajectoryPoint& point : t.points) {
      if (point.time > r.begin && point.time < r.end) r.height = std::max(r.height, t.contact_gap - point.position);
    }
    if (r.height > significant) rebounds.push_back(r);
  }
  return rebounds;
}

void micro_bounces(const std::filesystem::path& folder) {
  constexpr double window = 100e-6;
  constexpr double significant = 1e-9;
  std::vector<Panel> panels;
  std::vector<std::vector<std::string>> rows{{"modes", "t_i [us]", "first large rebound [nm]", "begins [us]", "lasts [us]",
                                              "small ones before it", "the highest [nm]", "they last [us]"}};
  std::vector<int> before;
  for (const int modes : {1, 2, 3, 4, 5, 6}) {
    const PreparedScene p =
        prepare(with(shipped("mem-gold.toml"), {fmt::format("structure.modes={}", modes), "waveform.main.level=17.771 V",
                                                "simulate.duration=100 us", "simulate.accuracy=1e-7"}));
    const Trajectory t = simulate_closing(p.model, p.signals(), {.duration = window, .tolerance = p.tolerance});
    const std::vector<Flight> rebounds = flights(t, significant);
    const auto highest =
        std::max_element(rebounds.begin(), rebounds.end(), [](const auto& a, const auto& b) { return a.height < b.height; });
    double small = 0, shortest = missing, longest = 0;
    for (auto r = rebounds.begin(); r != highest; ++r) {
      small = std::max(small, r->height);
      shortest = std::fmin(shortest, r->end - r->begin);
      longest = std::max(longest, r->end - r->begin);
    }
    before.push_back(static_cast<int>(highest - rebounds.begin()));
    rows.push_back({std::to_string(modes), number(t.touches.front().begin / 1e-6, 4), number(highest->height / 1e-9, 4),
                    number(highest->begin / 1e-6, 4), number((highest->end - highest->begin) / 1e-6),
                    std::to_string(before.back()), before.back() > 0 ? number(small / 1e-9) : "-",
                    before.back() > 0 ? fmt::format("{} to {}", number(shortest / 1e-6, 2), number(longest / 1e-6, 2)) : "-"});
    if (modes != 1 && modes != 2 && modes != 4) continue;
    Points gap;
    for (const TrajectoryPoint& point : t.points) {
      if (point.time > 30e-6 && point.time < 80e-6) gap.push_back({point.time, t.contact_gap - point.position});
    }
    panels.push_back({.title = fmt::format("{} mode{}", modes, modes == 1 ? "" : "s"),
                      .x_label = "Time",
                      .x_unit = "s",
                      .y_label = "Tip above the contact",
                      .y_unit = "m",
                      .curves = {{"", gap, Role::best}}});
  }
  const bool found = before.front() == 0 && before[1] > 0 && before[3] > 0;
  const std::string finding = fmt::format(
      "{}: {} small rebounds come before the first large one with one mode, {} with two, {} with four.",
      found ? "Micro-bounces need a second mode" : "Micro-bounces are not a matter of modes", before[0], before[1], before[3]);
  keep(folder, "micro-bounces",
       figure(finding,
              "Gold switch (scenes/mem-gold.toml, a reconstruction), step of 17.771 V, about 1.25 Vdp: first contact at 34 µs.",
              panels, 1),
       fmt::format("# Bounces within a bounce\n\n{}\n\n{}"
                   "- scene `scenes/mem-gold.toml`, a reconstruction, step of 17.771 V, window 100 us; rebounds above 1 nm, "
                   "counted before the highest one\n"
                   "- measured on real switches by Tung, Fruehling, Peroulis & Raman, J. MEMS 23 (2014) 137: rebounds of about "
                   "0.1 and of about 10 us\n\n"
                   "![Height of the tip above the contact with one, two and four modes](micro-bounces.svg)\n\n{}",
                   finding, made_by("micro-bounces"), markdown_table(rows)));
}

int run(const std::string& study, const std::filesystem::path& folder) {
  const std::map<std::string, void (*)(const std::filesystem::path&)> studies{
      {"nem-voltage", nem_voltage}, {"casimir-size", casimir_size}, {"micro-bounces", micro_bounces}};
  const auto found = studies.find(study);
  require(found != studies.end(), fmt::format("{}: must be nem-voltage, casimir-size or micro-bounces", study));
  found->second(folder);
  return 0;
}

}  // namespace
}  // namespace softland

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: bench_claims nem-voltage|casimir-size|micro-bounces FOLDER\n";
    return 2;
  }
  try {
    return softland::run(argv[1], argv[2]);
  } catch (const std::exception& error) {
    std::cerr << "bench_claims: " << error.what() << "\n";
    return 2;
  }
}
