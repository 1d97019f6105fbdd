#include "apps/verbs.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <iterator>
#include <thread>

#include "apps/search_folder.h"
#include "base/require.h"
#include "config/units.h"
#include "model/constants.h"
#include "reports/files.h"
#include "reports/html.h"
#include "reports/result_json.h"
#include "reports/svg.h"
#include "reports/text.h"
#include "studies/optimize.h"
#include "waveforms/export.h"

namespace softland::apps {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

SceneFile load_scene(const Common& c) {
  SceneFile file = SceneFile::load(c.scene);
  for (const std::string& assignment : c.set) file.set(assignment);
  return file;
}

std::string read_text(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  require(in.good(), fmt::format("{}: cannot be read", path.string()));
  return {std::istreambuf_iterator<char>(in), {}};
}

void make_folder(const std::string& out) {
  std::error_code error;
  fs::create_directories(out, error);
  require(!error, fmt::format("--out {}: the folder cannot be created: {}", out, error.message()));
}

// Waveforms of the scene, for generators and simulators of circuits.
std::map<std::string, Signal> named_signals(const Prepared& p) {
  std::map<std::string, Signal> all;
  const std::vector<std::string> names = p.drive_names();
  const std::vector<Signal> signals = p.signals();
  for (std::size_t k = 0; k < names.size(); ++k) all.emplace(names[k], signals[k]);
  return all;
}

void write_report(const fs::path& folder, const json& result) {
  write_whole(folder / "report.html", html_report(result));
  write_whole(folder / "gap.svg", svg_gap_chart(result));
}

// Everything a result leaves behind, in one place.
void write_outputs(const Common& c, const json& result, const std::string& text) {
  if (!c.out.empty()) {
    const fs::path folder = c.out;
    write_whole(folder / "result.json", result.dump(2) + "\n");
    write_report(folder, result);
    const auto curves = result.at("curves").find("best");
    if (curves != result.at("curves").end()) write_whole(folder / "trajectory.csv", trajectory_csv(*curves));
  }
  if (c.json == "-") {
    std::cout << result.dump(2) << "\n";
    return;
  }
  if (!c.json.empty()) write_whole(c.json, result.dump(2) + "\n");
  std::cout << text;
}

// Pull-in of every electrode, without any waveform of the scene.
json pull_in_of(const Prepared& p, std::size_t k) {
  const StaticPullIn s = static_pull_in(p.device, k);
  const DynamicPullIn d = dynamic_pull_in(p.device, k, s);
  const auto number = [](double v) { return std::isfinite(v) ? json(v) : json(nullptr); };
  return {{"status", to_string(s.status == Status::done ? d.status : s.status)},
          {"pull_in",
           {{"static_V", number(s.voltage)},
            {"static_kind", to_string(s.kind)},
            {"dynamic_V", number(d.voltage)},
            {"release_V", number(release_voltage(p.device, k))}}}};
}

void print_json_or(const Common& c, const json& j, const std::string& text) {
  if (!c.json.empty() && c.json != "-") write_whole(c.json, j.dump(2) + "\n");
  std::cout << (c.json == "-" ? j.dump(2) + "\n" : text);
}

std::string volts(const json& v) { return v.is_number() ? fmt::format("{:.6g} V", v.get<double>()) : "none"; }

int status_code(Status s) {
  switch (s) {
    case Status::interrupted:
      return exit_interrupted;
    case Status::numerical_failure:
      return exit_numerical_failure;
    case Status::no_contact:
    case Status::collapsed_at_rest:
      return exit_no_success;
    default:
      return exit_done;
  }
}

// "2500" evaluations or "90 s".
void read_budget(const std::string& text, OptimizeOptions& options) {
  if (text.empty()) {
    options.max_evaluations = default_budget(options.actuator);
    return;
  }
  const auto rule = [&](bool ok) {
    require(ok, fmt::format("--budget {}: must be a whole number of evaluations such as 2500, or a time such as \"90 s\"", text));
  };
  Quantity q;
  try {
    q = parse_quantity(text);
  } catch (const InvalidInput&) {
    rule(false);
  }
  if (q.dimension == dimension::time) {
    rule(q.value > 0);
    options.max_seconds = q.value;
    options.max_evaluations = 1'000'000'000;
  } else {
    rule(q.dimension == dimension::none && q.value >= 1 && q.value <= 1e9 && q.value == std::floor(q.value));
    options.max_evaluations = static_cast<long>(q.value);
  }
}

// A line on standard error that is rewritten in place on a terminal and printed now and then elsewhere.
class Progress {
 public:
  Progress(bool quiet, long budget, double seconds)
      : terminal_(isatty(2) != 0), quiet_(quiet), budget_(budget), seconds_(seconds) {}
  void show(const OptimizeProgress& p) {
    const auto now = std::chrono::steady_clock::now();
    if (quiet_ || now - shown_ < std::chrono::milliseconds(terminal_ ? 200 : 10000)) return;
    shown_ = now;
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    const double part = std::max(static_cast<double>(p.evaluations) / static_cast<double>(budget_), elapsed / seconds_);
    constexpr int cells = 24;
    const int full = std::clamp(static_cast<int>(part * cells), 0, cells);
    const std::string line =
        fmt::format("[{}{}] {:3.0f} %  {} evaluations  best cost {:.4f}  {:.0f} s",
                    std::string(static_cast<std::size_t>(full), '#'), std::string(static_cast<std::size_t>(cells - full), '.'),
                    std::min(100.0, 100 * part), p.evaluations, p.best_cost, elapsed);
    fmt::print(stderr, "{}{}{}", terminal_ ? "\r" : "", line, terminal_ ? "\033[K" : "\n");
    std::fflush(stderr);
    open_ = terminal_;
  }
  void close() {
    if (open_) fmt::print(stderr, "\n");
    open_ = false;
  }

 private:
  bool terminal_, quiet_, open_ = false;
  long budget_;
  double seconds_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now(), shown_ = start_;
};

// Where the shipped scenes are: beside the sources, or beside the program in an unpacked tree.
fs::path shipped_scene(const std::string& name) {
  const fs::path from_source = fs::path(SOFTLAND_SCENES) / name;
  std::error_code error;
  if (fs::exists(from_source, error)) return from_source;
  for (fs::path up = fs::read_symlink("/proc/self/exe", error).parent_path(); up.has_relative_path(); up = up.parent_path()) {
    if (fs::exists(up / "scenes" / name, error)) return up / "scenes" / name;
  }
  throw InvalidInput(fmt::format("scenes/{} was not found beside the program; name a scene file", name));
}

// The scene text of a result: a folder of optimize, a result.json, or a scene file itself.
SceneFile scene_of_result(const std::string& result) {
  const fs::path path = fs::is_directory(result) ? fs::path(result) / "best.toml" : fs::path(result);
  if (path.extension() != ".json") return SceneFile::load(path);
  const json j = json::parse(read_text(path), nullptr, false);
  require(j.is_object() && j.contains("scene_toml") && j["scene_toml"].is_string(),
          fmt::format("{}: is not a result.json of softland", result));
  return SceneFile::parse(j["scene_toml"].get<std::string>(), result);
}

}  // namespace

int simulate_verb(const Common& c) {
  const Prepared prepared = prepare(load_scene(c));
  if (!c.out.empty()) make_folder(c.out);
  const Closing closing = simulate(prepared, true, c.stop);
  const json result = result_json(prepared, closing, {.command = c.command});
  write_outputs(c, result, text_report(result));
  if (!closing.trajectory.message.empty())
    fmt::print(stderr, "softland: {} ({})\n", closing.trajectory.message, to_string(closing.metrics.status));
  return status_code(closing.metrics.status);
}

int pull_in_verb(const Common& c) {
  const Prepared prepared = prepare(load_scene(c));
  const auto& electrodes = prepared.scene.device.electrodes;
  require(!electrodes.empty(), fmt::format("{}: there is no electrode to pull in", c.scene));
  json all = json::object();
  std::string text;
  bool failed = false;
  for (std::size_t k = 0; k < electrodes.size(); ++k) {
    json one = pull_in_of(prepared, k);
    const json& p = one["pull_in"];
    text += fmt::format("electrode {}\n  static pull-in   {} ({})\n  dynamic pull-in  {}\n  release          {}\n",
                        electrodes[k].name, volts(p["static_V"]),
                        p["static_kind"].get<std::string>() == "fold" ? "fold of the static branch"
                                                                      : "the contact point reaches the contact first",
                        volts(p["dynamic_V"]), volts(p["release_V"]));
    failed = failed || one["status"] != "done";
    if (electrodes.size() == 1) {
      all = std::move(one);
    } else {
      all[electrodes[k].name] = std::move(one);
    }
  }
  print_json_or(c, all, text);
  return failed ? exit_numerical_failure : exit_done;
}

int modes_verb(const Common& c) {
  const Prepared prepared = prepare(load_scene(c));
  json list = json::array();
  std::string text = "mode  angular frequency      frequency\n";
  for (const double omega : prepared.device.angular_frequencies()) {
    list.push_back(omega);
    text += fmt::format("{:>4}  {:>12.8g} rad/s  {:>10.6g} kHz\n", list.size(), omega, omega / (2e3 * pi));
  }
  print_json_or(c, {{"natural_frequencies_rad_s", list}}, text);
  return exit_done;
}

int check_verb(const Common& c) {
  const Prepared p = prepare(load_scene(c), true);
  const Structure& s = p.scene.device.structure;
  std::string text = fmt::format("{}: valid{}\n\n", c.scene, p.scene.title.empty() ? "" : " (" + p.scene.title + ")");
  text += "natural frequencies  ";
  for (const double omega : p.device.angular_frequencies()) text += fmt::format("{:.6g} kHz  ", omega / (2e3 * pi));
  text += fmt::format("\nin-contact period    {:.4g} us\n", p.device.in_contact_period() * 1e6);
  for (std::size_t k = 0; k < p.scene.device.electrodes.size(); ++k) {
    const auto found = pull_in_of(p, k);
    const json& v = found["pull_in"];
    text += fmt::format("electrode {}: Vsp {}, Vdp {}, release {}\n", p.scene.device.electrodes[k].name, volts(v["static_V"]),
                        volts(v["dynamic_V"]), volts(v["release_V"]));
  }
  if (p.scene.device.gas) {
    const double g = p.scene.device.gap.electrode;
    text += fmt::format(
        "squeeze number       {:.3g} (first mode, rest gap, 101325 Pa; the strip film holds below about 10)\n",
        12 * p.scene.device.gas->viscosity * s.width * s.width * p.device.angular_frequencies()[0] / (101325 * g * g));
    text +=
        fmt::format("Knudsen number       {:.3g} at the rest gap, {:.3g} closed (mean free path 65 nm: air, 101325 Pa, 300 K)\n",
                    65e-9 / g, 65e-9 / (g - p.scene.device.gap.contact));
  }
  for (const auto& [name, signal] : named_signals(p))
    text += fmt::format("drive {}: hold {:.6g} V, peak {:.6g} V\n", name, signal.hold_level(), signal.peak());
  text += fmt::format("window               {:.4g} us, integrator tolerance {:.3g}\n", p.duration * 1e6, p.tolerance);
  for (const std::string& w : p.scene.warnings) text += "warning: " + w + "\n";
  std::cout << text;
  return exit_done;
}

int optimize_verb(const Common& given, const OptimizeRequest& request) {
  Common c = given;
  if (c.scene.empty()) c.scene = shipped_scene("mem-gold-pzt.toml").string();
  if (c.out.empty()) c.out = "softland-out";
  const auto target = target_from(request.target);
  require(target.has_value(),
          fmt::format("--target {}: must be bounce, settling, rebound, count, impact or energy", request.target));
  OptimizeOptions options{
      .target = *target, .family = request.waveform, .optimizer = request.optimizer, .seed = request.seed, .stop = c.stop};
  if (request.actuator == "pzt") {
    options.actuator = Actuator::pzt;
  } else if (request.actuator == "both") {
    options.actuator = Actuator::both;
  } else {
    require(request.actuator == "electrostatic",
            fmt::format("--actuator {}: must be electrostatic, pzt or both", request.actuator));
  }
  const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
  require(request.jobs >= 0, fmt::format("--jobs {}: must be at least 1", request.jobs));
  options.jobs = request.jobs > 0 ? request.jobs : static_cast<int>(cores);
  read_budget(request.budget, options);

  const SceneFile file = load_scene(c);
  SearchFolder folder(c.out);
  if (!c.quiet)
    fmt::print(stderr, "softland: searching a {} drive for {}, {} waveform; results go to {}\n", request.actuator, c.scene,
               request.waveform, c.out);
  Progress progress(c.quiet, options.max_evaluations, options.max_seconds);
  options.on_variables = [&](const std::vector<std::string>& names) { folder.name_variables(names); };
  options.on_evaluation = [&](const Evaluation& e, const OptimizeProgress& p) {
    folder.evaluated(e);
    progress.show(p);
  };
  options.on_improvement = [&](const Evaluation&, const SceneFile& best) { folder.improved(best); };
  const OptimizeResult result = optimize(file, options);
  progress.close();
  folder.flush();

  json j = result_json(result, options, {.command = c.command});
  for (const auto& [index, e] : folder.evaluations()) {
    j["search"]["evaluations"].push_back({index, std::isfinite(e.value) ? json(e.value) : json(nullptr)});
  }
  j["reproduce"] = {c.command, fmt::format("softland simulate {}", (fs::path(c.out) / "best.toml").string())};
  const auto leave = [&](const char* name, const std::string& text) { write_whole(folder.path() / name, text); };
  if (result.best_scene) {
    leave("best.toml", result.best_scene->scene.file.text());
    leave("best.csv", csv(named_signals(*result.best_scene), result.best_scene->duration));
  }
  write_outputs(c, j, text_report(j));
  if (c.json != "-") {
    std::cout << fmt::format(
        "\nIn {}: report.html, gap.svg, best.toml (run it with `softland simulate`), best.csv, trajectory.csv, result.json, "
        "evaluations.csv\n",
        c.out);
  }
  if (result.search.termination == Termination::interrupted) return exit_interrupted;
  return result.best && result.better_than_baseline ? exit_done : exit_no_success;
}

int new_verb(const std::string& kind) {
  if (kind == "cantilever" || kind == "cantilever-pzt") {
    std::cout << read_text(shipped_scene(kind == "cantilever" ? "mem-gold.toml" : "mem-gold-pzt.toml"));
    return exit_done;
  }
  throw InvalidInput(fmt::format("new {}: must be cantilever or cantilever-pzt", kind));
}

int export_verb(const std::string& result, const std::string& format) {
  const Prepared p = prepare(scene_of_result(result));
  require(format == "csv" || format == "spice-pwl", fmt::format("--format {}: must be csv or spice-pwl", format));
  std::cout << (format == "csv" ? csv(named_signals(p), p.duration) : spice_pwl(named_signals(p), p.duration));
  return exit_done;
}

int report_verb(const std::string& result, const std::string& out) {
  const fs::path path = fs::is_directory(result) ? fs::path(result) / "result.json" : fs::path(result);
  const json j = json::parse(read_text(path), nullptr, false);
  require(j.is_object() && j.contains("kind"), fmt::format("{}: is not a result.json of softland", path.string()));
  const fs::path folder = out.empty() ? path.parent_path() : fs::path(out);
  if (!out.empty()) make_folder(out);
  write_report(folder, j);
  std::cout << text_report(j) << fmt::format("\nIn {}: report.html, gap.svg\n", folder.empty() ? "." : folder.string());
  return exit_done;
}

}  // namespace softland::apps
