#include "config/modal_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "base/engineering.h"
#include "base/require.h"
#include "config/schema/sections.h"
#include "exchange/mode_table.h"

namespace softland::internal {
namespace {

namespace keys = modal_keys;

constexpr std::string_view clamped = "clamped";

double one_of_unit(const SectionReader& in, std::string_view key, const Dimension& due) {
  const std::string& unit = in.text(key);
  if (due == dimension::mass && unit == "t") return 1e3;  // t is a tonne here, the mass unit of models in mm, s and N
  Quantity one;
  try {
    one = parse_quantity("1 " + unit);
  } catch (const InvalidInput& error) {
    in.file().fail(in.path(key), error.what());
  }
  in.require(one.dimension == due, key, fmt::format("must be the unit of {}", describe(due)));
  return one.value;
}

ModeKeys mode_keys(const SectionReader& in) {
  ModeKeys made{.prefix = "structure.", .word_separator = '_'};
  if (in.is_given(keys::axis)) made.axis = in.text(keys::axis);
  if (in.is_given(keys::direction)) made.direction = in.text(keys::direction);
  if (in.is_given(keys::length_unit)) made.length_unit = one_of_unit(in, keys::length_unit, dimension::length);
  if (in.is_given(keys::mass_unit)) made.mass_unit = one_of_unit(in, keys::mass_unit, dimension::mass);
  if (in.is_given(keys::mass)) made.mass = in.number(keys::mass);
  if (in.is_given(keys::mass_normalised)) made.mass_normalised = in.flag(keys::mass_normalised);
  if (in.is_given(keys::clamp)) made.clamp = in.number(keys::clamp);
  if (in.is_given(keys::frequencies)) made.frequencies = in.numbers(keys::frequencies);
  return made;
}

// Sets the width of the structure from the file of modes or the key `width`, which must agree if both give it. Returns the
// widths at the positions of the mode shapes if the width varies, otherwise none.
std::vector<double> take_width(Structure& s, const ModeTable& table, const SectionReader& in) {
  constexpr double even = 1e-3;
  double low = std::numeric_limits<double>::infinity(), high = 0;
  for (const double width : table.widths) {
    if (!std::isnan(width)) low = std::min(low, width), high = std::max(high, width);
  }
  if (high == 0) {
    if (!in.is_given("width"))
      in.fail("missing key 'width' (a length such as \"20 um\"): the file does not say how wide the structure is");
    return {};
  }
  constexpr int digits = 4;
  const bool is_even = high <= (1 + even) * low;
  if (!in.is_given("width")) {
    s.width = high;
    if (is_even) return {};
    in.require(std::ranges::none_of(table.widths, [](double width) { return std::isnan(width); }), keys::file,
               "the width changes along the axis, and the file does not give it everywhere");
    return table.widths;
  }
  in.require(is_even, "width",
             fmt::format("must be omitted: the width in the file varies from {} to {} along the axis, and is used",
                         engineering(low, "m", digits), engineering(high, "m", digits)));
  in.require(std::abs(s.width - high) <= even * high, "width",
             fmt::format("must equal the width in the file, {}, or be omitted", engineering(high, "m", digits)));
  return {};
}

SplineEnd far_end_of(const SectionReader& in) {
  return in.is_given(keys::far_anchor) && in.text(keys::far_anchor) == clamped ? SplineEnd::clamped : SplineEnd::free;
}

// Returns the offsets of the structure's face at rest [m], one per position of the table; empty if all offsets are 0.
std::vector<double> offsets_of(ModeTable& table) {
  const bool is_straight = std::ranges::all_of(table.rest_offsets, [](double offset) { return offset == 0; });
  return is_straight ? std::vector<double>() : std::move(table.rest_offsets);
}

std::shared_ptr<const ModalTable> table_of_file(Scene& scene, const SectionReader& in) {
  const std::string& name = in.text(keys::file);
  in.require(!name.empty() && name.find('\0') == std::string::npos, keys::file, "must be the name of a file");
  const ModeKeys said = mode_keys(in);
  ModeTable table;
  try {
    table = read_mode_table((in.file().directory / name).string(), said);
  } catch (const InvalidInput& error) {
    in.file().fail(in.path(keys::file), error.what());
  }
  std::vector<double> widths = take_width(scene.device.structure, table, in);
  if (table.nodes > 0) scene.file_notes.push_back(fmt::format("{}: {}", in.written(keys::file), summary(table)));
  std::vector<double> offsets = offsets_of(table);
  const SplineEnd far_end = far_end_of(in);
  in.require(far_end == SplineEnd::free || table.far_end == SplineEnd::clamped, keys::far_anchor,
             "requires a far end that does not move in any mode of the file");
  return std::make_shared<const ModalTable>(std::move(table.positions), std::move(table.frequencies), std::move(table.shapes),
                                            std::move(offsets), std::move(widths), far_end);
}

std::shared_ptr<const ModalTable> table_of_scene(Structure& s, const SectionReader& in) {
  for (const std::string_view key :
       {keys::axis, keys::direction, keys::length_unit, keys::mass_unit, keys::mass, keys::mass_normalised, keys::clamp})
    in.require(!in.is_given(key), key, "describes a file of modes, but this scene holds its modes itself: omit the key");
  for (const std::string_view key : {keys::frequencies, keys::shapes, std::string_view("width")}) {
    if (!in.is_given(key) && !(key == "width" && in.is_given(keys::widths)))
      in.fail(fmt::format("missing key '{}': beside positions there must be frequencies, shapes and width", key));
  }
  std::vector<double> positions = in.numbers(keys::positions), frequencies = in.numbers(keys::frequencies),
                      all = in.numbers(keys::shapes);
  in.require(in.is_nested(keys::shapes) && all.size() == positions.size() * frequencies.size(), keys::shapes,
             fmt::format("must hold {} lists of {} numbers, a list per frequency and a number per position", frequencies.size(),
                         positions.size()));
  std::vector<std::vector<double>> shapes;
  for (std::size_t k = 0; k < frequencies.size(); ++k) {
    const auto begin = all.begin() + static_cast<std::ptrdiff_t>(k * positions.size());
    shapes.emplace_back(begin, begin + static_cast<std::ptrdiff_t>(positions.size()));
  }
  std::vector<double> offsets;
  if (in.is_given(keys::rest_offsets)) offsets = in.numbers(keys::rest_offsets);
  in.require(offsets.empty() || offsets.size() == positions.size(), keys::rest_offsets, "must hold a number per position");
  std::vector<double> widths;
  if (in.is_given(keys::widths)) {
    widths = in.numbers(keys::widths);
    in.require(widths.size() == positions.size(), keys::widths, "must hold a number per position");
    s.width = std::ranges::max(widths);
  }
  try {
    return std::make_shared<const ModalTable>(std::move(positions), std::move(frequencies), std::move(shapes), std::move(offsets),
                                              std::move(widths), far_end_of(in));
  } catch (const InvalidInput& error) {
    in.file().fail(in.path(keys::shapes), error.what());
  }
}

}  // namespace

std::vector<Key> modal_table_keys() {
  constexpr std::string_view rest_is_of_file = "it belongs to the modes";
  Key shapes = numbers(keys::shapes, {dimension::none}, any, "a list per mode: mass-normalised, in 1/sqrt(kg), at the positions");
  shapes.is_nested = true;
  Key normalised{.name = keys::mass_normalised,
                 .type = KeyType::flag,
                 .about = "the modes of the file are mass-normalised, although the file does not say so"};
  return {
      words(keys::file, "table of modes, CalculiX .frd, export of COMSOL, UFF 55 or ANSYS .rom, relative to the scene")
          .needed()
          .instead(keys::positions),
      words(keys::axis, "axis of the file that points from the clamp to the far end, such as x or -y; required but for a table"),
      words(keys::direction, "axis of the file that points towards the near electrode, such as -z; required but for a table"),
      words(keys::length_unit, "unit of the positions, if the file does not give it; absent: m").such_as("mm"),
      words(keys::mass_unit, "mass unit of the model in the file, if the file does not give it; absent: kg").such_as("t"),
      number(keys::mass, {dimension::mass}, positive,
             "mass of a structure with constant mass per length; normalises modes that are not mass-normalised")
          .fixed("it normalises the modes of a file; vary structure.frequency_factor"),
      std::move(normalised),
      number(keys::clamp, {dimension::length}, any, "position of the clamp on the axis of the file, if there is no node")
          .fixed("it is a place in the file"),
      numbers(keys::positions, {dimension::length}, not_negative,
              "instead of a file: positions along the axis, from 0 m on; the first is the clamp")
          .instead(keys::file),
      numbers(keys::frequencies, {dimension::frequency}, positive,
              "natural frequencies of the modes, given with positions, or alone beside a file without frequencies"),
      std::move(shapes),
      numbers(keys::rest_offsets, {dimension::length}, any,
              "offset of the face at the positions, towards the near electrode; absent: straight at rest")
          .fixed(rest_is_of_file),
      numbers(keys::widths, {dimension::length}, positive,
              "width across the axis at the positions, linear between them; instead of width")
          .instead("width")
          .fixed("it belongs to the modes"),
      one_of(keys::far_anchor, {"free", clamped},
             "how the far end is held; clamped, required if no mode moves it: the "
             "contact is in the middle unless it says at; absent: free"),
  };
}

void read_modal_table(Scene& scene, const SectionReader& in) {
  Structure& s = scene.device.structure;
  std::shared_ptr<const ModalTable>& table = part_of<ModalStructure>(s).table;
  if (in.is_given(keys::positions)) {
    table = table_of_scene(s, in);
  } else {
    for (const std::string_view key : {keys::shapes, keys::rest_offsets, keys::widths})
      in.require(!in.is_given(key), key, "must be given with positions, not with a file: omit it");
    table = table_of_file(scene, in);
  }
  if (!table->has_far_clamp() && table->is_held_at_both_ends())
    in.fail("the far end does not move in any mode: set far_anchor = \"clamped\"");
  if (in.is_given("axial_stiffness")) {
    in.require(table->has_far_clamp(), "axial_stiffness",
               "needs far_anchor = \"clamped\": a structure stretches between two clamps only");
    in.require(
        table->rest_offsets().empty(), "axial_stiffness",
        "cannot stand beside rest offsets: a curved structure stretches between two clamps as an arch, which is not simulated");
  }
  s.length = table->length();
  if (!in.is_given("modes")) s.modes = most_modes_of(s);
  in.require(s.modes <= table->count(), "modes", fmt::format("must not exceed {}, the modes of the file", table->count()));
}

void hold_table(toml::table& root, const Structure& s) {
  const auto* const modal = s.find<ModalStructure>();
  if (modal == nullptr) return;
  toml::table& section = *root["structure"].as_table();
  for (const std::string_view key :
       {keys::file, keys::axis, keys::direction, keys::length_unit, keys::mass_unit, keys::mass, keys::mass_normalised,
        keys::clamp, keys::positions, keys::frequencies, keys::shapes, keys::rest_offsets, keys::widths})
    section.erase(key);
  toml::array positions, frequencies, shapes;
  for (const double x : modal->table->positions()) positions.push_back(quantity_text(x, dimension::length));
  for (const double f : modal->table->frequencies()) frequencies.push_back(quantity_text(f, dimension::frequency));
  for (const std::vector<double>& shape : modal->table->shapes()) {
    toml::array one;
    for (const double value : shape) one.push_back(value);
    shapes.push_back(std::move(one));
  }
  section.insert_or_assign(keys::positions, std::move(positions));
  section.insert_or_assign(keys::frequencies, std::move(frequencies));
  section.insert_or_assign(keys::shapes, std::move(shapes));
  if (const std::vector<double>& offsets = modal->table->rest_offsets(); !offsets.empty()) {
    toml::array all;
    for (const double offset : offsets) all.push_back(quantity_text(offset, dimension::length));
    section.insert_or_assign(keys::rest_offsets, std::move(all));
  }
  if (const std::vector<double>& widths = modal->table->widths(); !widths.empty()) {
    toml::array all;
    for (const double width : widths) all.push_back(quantity_text(width, dimension::length));
    section.insert_or_assign(keys::widths, std::move(all));
    return;
  }
  if (!section.contains("width")) section.insert("width", quantity_text(s.width, dimension::length));
}

}  // namespace softland::internal
