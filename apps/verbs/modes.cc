// Verb `modes`: shows the natural frequencies of a scene, or converts the modes of another program into a table for a scene.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "apps/exit_status.h"
#include "apps/output.h"
#include "apps/progress.h"
#include "apps/scenes.h"
#include "apps/streams.h"
#include "apps/verbs/verbs.h"
#include "base/require.h"
#include "base/shell_word.h"
#include "base/split.h"
#include "base/write_whole.h"
#include "config/quantity_argument.h"
#include "config/units.h"
#include "document/text.h"
#include "exchange/mode_table.h"
#include "reports/mode_table_report.h"
#include "studies/closing/auto_settings.h"

namespace softland::apps {
namespace {

struct ModesRequest {
  std::string from, axis, direction, length_unit, mass_unit, mass, clamp, frequencies, plot;
  bool mass_normalised = false;
};

int frequencies_of_scene(const Common& c) {
  const SceneFile file = load_scene_or_result(c);
  const PreparedScene prepared = prepare_and_choose(file, false, ShownWork(c.quiet, c.stop).progress());
  static_cast<void>(reserve_outputs(c, {}));
  const Eigen::VectorXd& omega = prepared.model.basis().angular_frequencies();
  const ModesRecord record{
      .origin = origin_of("modes", c.command), .frequencies = {omega.begin(), omega.end()}, .warnings = prepared.scene.warnings};
  print_json_or(c, json_of(record), text_of(record));
  return exit_done;
}

/// Returns the value of a unit in SI units; `unit` is a symbol without a number, such as "mm".
std::optional<double> unit_of(const char* option, const std::string& unit, const Dimension& due) {
  if (unit.empty()) return std::nullopt;
  const double size = quantity_argument(option, "1 " + unit, due);
  require(size > 0, [&] { return fmt::format("{} {}: must be greater than 0", option, unit); });
  return size;
}

ModeKeys keys_of(const ModesRequest& r) {
  ModeKeys keys{
      .axis = r.axis, .direction = r.direction, .mass_normalised = r.mass_normalised, .prefix = "--", .word_separator = '-'};
  keys.length_unit = unit_of("--length-unit", r.length_unit, dimension::length);
  // The unit t is allowed because a model in mm, s and N has masses in tonnes.
  keys.mass_unit = r.mass_unit == "t" ? std::optional(1e3) : unit_of("--mass-unit", r.mass_unit, dimension::mass);
  if (!r.mass.empty()) {
    keys.mass = quantity_argument("--mass", r.mass, dimension::mass);
    require(*keys.mass > 0, [&] { return fmt::format("--mass {}: must be greater than 0", r.mass); });
  }
  if (!r.clamp.empty()) {
    const bool is_negative = r.clamp.starts_with('-');
    keys.clamp =
        quantity_argument("--clamp", is_negative ? r.clamp.substr(1) : r.clamp, dimension::length) * (is_negative ? -1 : 1);
  }
  if (!r.frequencies.empty()) {
    for (const std::string& one : split(r.frequencies, ','))
      keys.frequencies.push_back(quantity_argument("--frequencies", one, dimension::frequency));
  }
  return keys;
}

// Checks that an output file can be written and is none of the `others`, the other outputs of the run.
void claim_file(const char* option, const std::string& file, const std::vector<std::string>& others) {
  if (file.empty()) return;
  for (const std::string& other : others) {
    require(other.empty() || std::filesystem::weakly_canonical(file) != std::filesystem::weakly_canonical(other),
            [&] { return fmt::format("{} {}: is another output of this run; name another file", option, file); });
  }
  check_writable(file);
}

int table_of_file(const Common& c, const ModesRequest& r) {
  require(c.scene.empty(), [&] { return fmt::format("--from {}: replaces a scene: omit {}", r.from, c.scene); });
  require(c.set.empty(), "--set: changes a scene, which --from replaces: omit --set");
  const ModeTable table = read_mode_table(r.from, keys_of(r));
  const std::string json = c.json == "-" ? std::string() : c.json;
  claim_file("--json", json, {});
  claim_file("--out", c.out, {json});
  claim_file("--plot", r.plot, {json, c.out});
  const ModesRecord record = record_of(table, c.command);
  std::string text = text_of(record);
  if (!c.out.empty()) {
    write_whole(c.out, mode_table_csv(table));
    text += "\n" +
            wrapped(fmt::format("In {}: the table, for structure = {{ kind = \"modes\", file = \"{}\"{} }}", c.out,
                                std::filesystem::path(c.out).filename().string(),
                                table.far_end == SplineEnd::clamped ? ", far_anchor = \"clamped\"" : "")) +
            "\n";
  }
  if (!r.plot.empty()) {
    write_whole(r.plot, mode_table_svg(table));
    text += wrapped(fmt::format("In {}: a plot of the modes", r.plot)) + "\n";
  }
  print_json_or(c, json_of(record), text);
  return exit_done;
}

int modes_verb(const Common& c, const ModesRequest& r) {
  if (!r.from.empty()) return table_of_file(c, r);
  require(!c.scene.empty(), "modes: requires a scene, or --from with a file of modes");
  const auto refuse = [](bool is_given, const char* option) {
    require(!is_given, [&] { return fmt::format("{}: describes the file of --from: give --from too", option); });
  };
  for (const auto& [option, value] : {std::pair{"--axis", &r.axis},
                                      {"--direction", &r.direction},
                                      {"--length-unit", &r.length_unit},
                                      {"--mass-unit", &r.mass_unit},
                                      {"--mass", &r.mass},
                                      {"--clamp", &r.clamp},
                                      {"--frequencies", &r.frequencies},
                                      {"--plot", &r.plot},
                                      {"--out", &c.out}})
    refuse(!value->empty(), option);
  refuse(r.mass_normalised, "--mass-normalised");
  return frequencies_of_scene(c);
}

}  // namespace

verbs::Outcome modes_shown_again(const nlohmann::json& json) {
  const ModesRecord record = read_modes(json);
  return {.json = json_of(record), .text = text_of(record)};
}

void add_modes(Verb& verb) {
  const auto r = std::make_shared<ModesRequest>();
  verb.with_scene("SCENE", verbs::scene_or_result, false);
  verb.with_set(verbs::usual_change);
  verb.with_quiet();
  verb.option("--from", r->from, "FILE",
              "file of modes, instead of a scene: a table of softland, CalculiX .frd, a COMSOL export, "
              "UFF 55 or ANSYS .rom (docs/modes.md)");
  verb.option("--axis", r->axis, "AXIS", "axis of FILE that points from the clamp to the far end: x, -y and so on");
  verb.option("--direction", r->direction, "AXIS", "axis of FILE that points towards the near electrode: -z and so on");
  verb.option("--length-unit", r->length_unit, "UNIT",
              "length unit of FILE, if the file does not give it: m (default), mm or um");
  verb.option("--mass-unit", r->mass_unit, "UNIT",
              "mass unit of the model of FILE, if the file does not give it: kg (default), g or t (tonnes)");
  verb.option("--mass", r->mass, "MASS",
              "mass of a structure whose mass per length is constant; normalises modes that are not mass-normalised");
  verb.flag("--mass-normalised", r->mass_normalised, "the modes of FILE are mass-normalised, although the file does not say so");
  verb.option("--clamp", r->clamp, "PLACE", "position of the clamp on the axis, such as \"0 um\", if FILE has no node there");
  verb.option("--frequencies", r->frequencies, "LIST",
              "natural frequencies of the modes, such as \"27.5 kHz,172 kHz\", if FILE does not hold them");
  verb.option("--plot", r->plot, "FILE", "write a plot of the modes of --from (SVG)");
  verb.with_out_file("write the modes of --from as a table for [structure] kind = \"modes\" (CSV)");
  verb.with_json();
  verb.footer(
      "Examples:\n  softland modes scenes/mem-gold-pzt.toml --set structure.modes=8\n"
      "  softland modes --from beam.frd --axis x --direction -z --out modes.csv --plot modes.svg\n"
      "  softland modes --from line.txt --axis x --direction -z --mass \"193 ng\" --out modes.csv");
  verb.runs([r](const Common& common) { return modes_verb(common, *r); });
}

}  // namespace softland::apps
