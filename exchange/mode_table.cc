#include "exchange/mode_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/clamped_spline.h"
#include "base/engineering.h"
#include "base/printable.h"
#include "base/read_file.h"
#include "base/require.h"
#include "base/trimmed.h"
#include "exchange/cells.h"
#include "exchange/decoding.h"
#include "exchange/layout.h"
#include "exchange/mesh_sections.h"
#include "exchange/nodal_modes.h"
#include "exchange/own_modes.h"
#include "exchange/parsers.h"

namespace softland {
namespace {

using internal::NodalMode;
using internal::NodalModes;
using internal::Refusals;
using internal::SectionMotion;
using internal::Vector3;
using internal::Way;

constexpr int shown_digits = 6;
constexpr std::string_view axis_names = "xyz";

Way way_of(const std::string& text, const ModeKeys& keys, const char* key, const char* what) {
  const std::string_view bare = std::string_view(text).substr(text.starts_with('-') || text.starts_with('+') ? 1 : 0);
  const std::size_t direction = bare.size() == 1 ? axis_names.find(bare) : std::string_view::npos;
  require(direction != std::string_view::npos, [&] {
    return fmt::format("{} = \"{}\": must be x, y or z, with a minus for the opposite direction: {}", keys.name(key),
                       printable_line(text), what);
  });
  return {.direction = direction, .sign = text.starts_with('-') ? -1.0 : 1.0};
}

class TableMaker {
 public:
  TableMaker(NodalModes modes, const std::string& file, const ModeKeys& keys)
      : read_(std::move(modes)), keys_(keys), refusals_(file) {
    made_.file = file;
    made_.format = read_.format;
    made_.nodes = read_.nodes.size();
    made_.left_out = read_.left_out;
    made_.notes = read_.notes;
  }

  ModeTable make() {
    take_ways();
    take_frequencies();
    take_units();
    gather_sections();
    for (std::size_t k = 0; k < read_.modes.size(); ++k) judge(k);
    take_shapes();
    normalise();
    return std::move(made_);
  }

 private:
  [[noreturn]] void fail(const std::string& rule) const { refusals_.fail(rule); }

  void take_ways() {
    const auto needed = [&](const std::string& text, const char* key, const char* what) {
      if (text.empty()) fail(fmt::format("{} is needed: {}", keys_.name(key), what));
    };
    constexpr const char* along = "the axis of the structure, from the clamp to the far end";
    constexpr const char* towards = "the direction of motion, towards the near electrode";
    needed(keys_.axis, "axis", along);
    needed(keys_.direction, "direction", towards);
    axis_ = way_of(keys_.axis, keys_, "axis", along);
    direction_ = way_of(keys_.direction, keys_, "direction", towards);
    if (axis_.direction == direction_.direction)
      fail(fmt::format("{} = \"{}\": must be perpendicular to the axis \"{}\"", keys_.name("direction"), keys_.direction,
                       keys_.axis));
    if (!read_.holds[direction_.direction]) {
      std::vector<std::string> held;
      for (std::size_t d = 0; d < 3; ++d) {
        if (read_.holds[d]) held.emplace_back(1, axis_names[d]);
      }
      fail(fmt::format("{} = \"{}\": must be a direction of motion in the file: {}", keys_.name("direction"), keys_.direction,
                       fmt::join(held, " and ")));
    }
    if (std::any_of(read_.nodes.begin(), read_.nodes.end(), [&](const Vector3& v) { return std::isnan(v[axis_.direction]); }))
      fail(fmt::format("{} = \"{}\": must be a direction in which the file holds positions", keys_.name("axis"), keys_.axis));
  }

  void take_frequencies() {
    const auto used = static_cast<std::size_t>(
        std::count_if(read_.modes.begin(), read_.modes.end(), [](const NodalMode& m) { return m.is_used; }));
    const bool all_known =
        std::none_of(read_.modes.begin(), read_.modes.end(), [](const NodalMode& m) { return std::isnan(m.frequency); });
    if (all_known) {
      if (!keys_.frequencies.empty())
        fail(fmt::format("{}: must be omitted, because the file holds frequencies", keys_.name("frequencies")));
      return;
    }
    if (keys_.frequencies.empty()) {
      const auto without =
          std::find_if(read_.modes.begin(), read_.modes.end(), [](const NodalMode& m) { return std::isnan(m.frequency); });
      fail(fmt::format("the file does not hold the frequency of {}; give {} with those of its {} modes", without->name,
                       keys_.name("frequencies"), used));
    }
    if (keys_.frequencies.size() != read_.modes.size())
      fail(fmt::format("{}: {} frequencies for {} modes", keys_.name("frequencies"), keys_.frequencies.size(),
                       read_.modes.size()));
    for (std::size_t k = 0; k < read_.modes.size(); ++k) read_.modes[k].frequency = keys_.frequencies[k];
  }

  void take_units() {
    if (read_.needs_length_unit && !keys_.length_unit)
      fail(fmt::format("the file does not give its unit of length; give {} (m, mm, um)", keys_.name("length_unit")));
    if (read_.length_unit && keys_.length_unit && *read_.length_unit != *keys_.length_unit)
      fail(fmt::format("{}: must be the unit of length that the file gives, {}, or be omitted", keys_.name("length_unit"),
                       engineering(*read_.length_unit, "m")));
    length_unit_ = keys_.length_unit.value_or(read_.length_unit.value_or(1));
    if (!keys_.length_unit && !read_.length_unit)
      made_.notes.push_back(fmt::format("lengths are taken as m ({} changes this)", keys_.name("length_unit")));
  }

  void gather_sections() {
    sections_.emplace(read_.nodes, axis_, direction_, length_unit_, keys_.clamp, refusals_);
    if (keys_.clamp && !(*keys_.clamp < sections_->first()))
      fail(fmt::format("{} = \"{}\": must be below the first node, at {}: the key is for a file without a node at the clamp",
                       keys_.name("clamp"), engineering(*keys_.clamp, "m"), engineering(sections_->first(), "m", shown_digits)));
    made_.places = sections_->places();
    if (sections_->is_irregular())
      made_.notes.push_back(
          fmt::format("an irregular mesh: motions on the axis are fitted at {} even places", made_.places.size()));
  }

  // Classifies mode `k` of the file as bending, in-plane, axial or torsional: the kind with the largest squared motion of the
  // nodes.
  void judge(std::size_t k) {
    const NodalMode& mode = read_.modes[k];
    SectionMotion motion = sections_->motion(mode);
    const double most = std::max({motion.bending, motion.in_plane, motion.axial_share, motion.torsion});
    ModeFound found{.number = static_cast<int>(k + 1), .frequency = mode.frequency};
    found.kind = !mode.is_used             ? ModeKind::unused
                 : most == motion.bending  ? ModeKind::bending
                 : most == motion.in_plane ? ModeKind::in_plane
                 : most == motion.torsion  ? ModeKind::torsional
                                           : ModeKind::axial;
    found.share = motion.all() > 0 ? (found.kind == ModeKind::unused ? motion.bending : most) / motion.all() : 0;
    if (found.kind == ModeKind::bending && !(motion.all() > 0)) fail(fmt::format("{} does not move any node", mode.name));
    found.along = std::move(motion.along), found.across = std::move(motion.across);
    found.axial = std::move(motion.axial), found.twist = std::move(motion.twist);
    constexpr double pure = 0.9;
    if (found.kind == ModeKind::bending && found.share < pure)
      made_.notes.push_back(fmt::format("{} at {} is mixed: {:.0f} % of its squared motion is bending along {}", mode.name,
                                        engineering(mode.frequency, "Hz", shown_digits), 100 * found.share, keys_.direction));
    made_.found.push_back(std::move(found));
  }

  void take_shapes() {
    std::vector<std::size_t> taken;
    std::vector<std::string> unused;
    for (std::size_t k = 0; k < made_.found.size(); ++k) {
      const ModeFound& found = made_.found[k];
      if (found.kind == ModeKind::bending) {
        taken.push_back(k);
      } else if (found.kind == ModeKind::unused) {
        unused.push_back(fmt::format("{}", found.number));
      } else {
        made_.left_out.push_back(
            fmt::format("{} at {}, {}", read_.modes[k].name, engineering(found.frequency, "Hz", shown_digits), found.name()));
      }
    }
    if (!unused.empty())
      made_.left_out.push_back(fmt::format("modes {}, not used by the reduced-order model", fmt::join(unused, ", ")));
    if (taken.empty())
      fail(fmt::format("the file must have a mode that bends along {}: {}", keys_.direction, fmt::join(made_.left_out, "; ")));
    std::stable_sort(taken.begin(), taken.end(),
                     [&](std::size_t a, std::size_t b) { return made_.found[a].frequency < made_.found[b].frequency; });
    made_.positions = made_.places;
    made_.widths = sections_->widths();
    made_.rest_offsets = sections_->offsets();
    if (keys_.clamp) {
      made_.positions.insert(made_.positions.begin(), 0);
      made_.widths.insert(made_.widths.begin(), made_.widths.front());
      made_.rest_offsets.insert(made_.rest_offsets.begin(), 0);
    }
    for (const std::size_t k : taken) {
      std::vector<double> shape = made_.found[k].along;
      if (keys_.clamp) shape.insert(shape.begin(), 0);
      made_.shapes.push_back(std::move(shape));
      made_.frequencies.push_back(made_.found[k].frequency);
      modal_masses_.push_back(read_.modes[k].modal_mass);
    }
  }

  // Normalises the modes to a modal mass of 1 kg, by the unit of mass of the file or by the mass of a uniform structure.
  void normalise() {
    const double mass_unit = keys_.mass_unit.value_or(1);
    if (keys_.mass) {
      if (keys_.mass_normalised || !read_.normalised_by.empty())
        fail(fmt::format("{}: must be omitted, because the modes of the file are mass-normalised{}", keys_.name("mass"),
                         read_.normalised_by.empty() ? "" : ", by " + read_.normalised_by));
      for (std::vector<double>& shape : made_.shapes) scale(shape, 1 / std::sqrt(*keys_.mass * mean_square(shape)));
      made_.notes.push_back(
          fmt::format("normalised by a mass of {}, constant per length", engineering(1e3 * *keys_.mass, "g", shown_digits)));
      return;
    }
    if (read_.normalised_by.empty() && !keys_.mass_normalised)
      fail(
          fmt::format("the file does not give the modal masses; give {}, the mass of a structure of constant mass per length, "
                      "or {} for mass-normalised modes",
                      keys_.name("mass"), keys_.name("mass_normalised")));
    for (std::size_t k = 0; k < made_.shapes.size(); ++k)
      scale(made_.shapes[k], 1 / std::sqrt(mass_unit * (read_.normalised_by.empty() ? 1 : modal_masses_[k])));
    made_.notes.push_back(
        fmt::format("mass-normalised by {}", read_.normalised_by.empty() ? keys_.name("mass_normalised") : read_.normalised_by));
    if (!keys_.mass_unit) made_.notes.push_back(fmt::format("masses are taken as kg ({} changes this)", keys_.name("mass_unit")));
  }

  static void scale(std::vector<double>& shape, double factor) {
    for (double& value : shape) value *= factor;
  }
  // Returns the mean square of a mode shape over the length. The shape is a cubic spline through its values, with slope 0 at
  // the first one, the clamp.
  [[nodiscard]] double mean_square(const std::vector<double>& shape) const;

  NodalModes read_;
  ModeKeys keys_;
  Refusals refusals_;
  ModeTable made_;
  Way axis_, direction_;
  double length_unit_ = 1;  // length unit of the file [m]
  std::optional<internal::MeshSections> sections_;
  std::vector<double> modal_masses_;
};

constexpr double still = 1e-4;  // motion that counts as zero, as a share of the largest in the mode

double largest_motion(const std::vector<double>& shape) {
  double most = 0;
  for (const double value : shape) most = std::max(most, std::abs(value));
  return most;
}

SplineEnd far_end_of(const ModeTable& table) {
  const bool is_held = std::ranges::all_of(
      table.shapes, [](const std::vector<double>& shape) { return std::abs(shape.back()) <= still * largest_motion(shape); });
  return is_held && !is_hinged_at_end(table.positions, table.shapes.front()) ? SplineEnd::clamped : SplineEnd::free;
}

double TableMaker::mean_square(const std::vector<double>& shape) const {
  return ClampedSpline(made_.positions, shape, far_end_of(made_)).integral_of_square() / made_.positions.back();
}

// Checks a table of modes, and makes its mode shapes positive at the far end and exactly 0 at the clamp.
void check(ModeTable& table, const ModeKeys& keys) {
  constexpr std::size_t fewest = 3;
  const auto fail = [&](const std::string& rule) { throw InvalidInput(fmt::format("{}: {}", table.file, rule)); };
  if (table.positions.size() < fewest)
    fail(fmt::format("must have at least three positions, including the clamp at 0, but has {}", table.positions.size()));
  if (table.positions.front() != 0)
    fail(fmt::format("the first position is {}; it must be 0, the clamp",
                     engineering(table.positions.front(), "m", shown_digits)));
  double last = 0;
  for (std::size_t k = 0; k < table.shapes.size(); ++k) {
    const double frequency = table.frequencies[k];
    std::vector<double>& shape = table.shapes[k];
    if (!(frequency > 0))
      fail(fmt::format("mode_{} has a frequency of {}; it must be above 0, as of a clamped structure", k + 1,
                       engineering(frequency, "Hz", shown_digits)));
    if (!(frequency > last))
      fail(fmt::format("the frequencies must increase, but mode_{} is at {}", k + 1, engineering(frequency, "Hz", shown_digits)));
    last = frequency;
    const double most = largest_motion(shape);
    if (!(most > 0 && most < 1e30)) fail(fmt::format("mode_{} must move, by less than 1e30 1/sqrt(kg)", k + 1));
    if (!(std::abs(shape.front()) <= still * most)) {
      const bool other_end = std::abs(shape.back()) <= still * most;
      fail(fmt::format(
          "mode_{} moves {:.2g} % of its largest motion at the first place, which must be the clamp{}", k + 1,
          100 * std::abs(shape.front()) / most,
          table.nodes == 0 ? std::string()
          : other_end      ? fmt::format("; the far end does not move: reverse {} to begin there", keys.name("axis"))
                      : fmt::format("; give {}, the position of the clamp, if the file has no node there", keys.name("clamp"))));
    }
    shape.front() = 0;
    const bool held = std::abs(shape.back()) <= still * most;
    const double sign_of =
        held ? *std::find_if(shape.begin(), shape.end(), [&](double y) { return std::abs(y) > still * most; }) : shape.back();
    if (sign_of < 0) {
      for (double& value : shape) value = value == 0 ? 0 : -value;
    }
  }
  table.far_end = far_end_of(table);
  if (table.far_end == SplineEnd::clamped) table.notes.emplace_back("the far end does not move in any mode, as at a clamp");
  if (is_hinged(table.positions, table.shapes.front()))
    fail("the first place must be a clamp, but mode_1 has a slope there, as at a hinge");
}

}  // namespace

std::string ModeFound::name() const {
  switch (kind) {
    case ModeKind::bending:
      return "bending";
    case ModeKind::in_plane:
      return "in-plane";
    case ModeKind::axial:
      return "axial";
    case ModeKind::torsional:
      return "torsional";
    case ModeKind::unused:
      return "not used by the reduced-order model";
  }
  return {};
}

ModeTable read_mode_table(const std::string& file, const ModeKeys& keys) {
  // Binary results of ANSYS are refused: open-source readers of this format may return wrong numbers without an error.
  const auto ends_with = [&](std::string_view end) {
    return file.size() > end.size() && internal::lower_case(file).ends_with(end);
  };
  require(!ends_with(".rst"), [&] {
    return file +
           ": a binary result of ANSYS (.rst), which is not read; "
           "export the modes as UFF 55 with the positions of the nodes, or as a table";
  });
  return parse_mode_table(read_file(file), file, keys);
}

ModeTable parse_mode_table(std::string_view content, const std::string& file, const ModeKeys& keys) {
  require(!content.empty(), [&] { return file + ": the file is empty"; });
  std::string storage;
  std::vector<std::string> left_out;
  const std::string_view text = internal::decoded(content, storage, left_out);
  require(!internal::is_binary(text), [&] { return file + ": binary data; modes are read from text"; });
  if (internal::is_mode_csv(text)) {
    const auto refuse = [&](bool is_given, const char* key) {
      require(!is_given, [&] {
        return fmt::format("{}: {}: must be omitted, because the table is in m, Hz and 1/sqrt(kg)", file, keys.name(key));
      });
    };
    refuse(keys.length_unit.has_value(), "length_unit");
    refuse(keys.mass_unit.has_value(), "mass_unit");
    refuse(keys.mass.has_value(), "mass");
    refuse(keys.clamp.has_value(), "clamp");
    refuse(!keys.frequencies.empty(), "frequencies");
    ModeTable table = internal::read_mode_csv(text, file);
    check(table, keys);
    return table;
  }
  const bool is_uff = internal::is_uff(text);
  require(is_uff || internal::is_frd(text) || internal::is_comsol(text) || internal::is_ansys_rom(text), [&] {
    if (trimmed(text.substr(0, 40)).starts_with('$'))
      return file +
             ": polynomials of energy and capacitance of a reduced-order model of ANSYS (.pcs), no modes; "
             "they stand in the .rom beside it";
    const std::string kind = internal::refused_kind(text);
    return fmt::format(
        "{}: {}; modes are read from a table of softland (x_m, mode_1), CalculiX .frd, exports of COMSOL, UFF 55 and ANSYS .rom",
        file, kind.empty() ? "unknown kind of file" : kind);
  });
  NodalModes modes = is_uff                      ? internal::read_uff55(text, file)
                     : internal::is_frd(text)    ? internal::read_frd(text, file)
                     : internal::is_comsol(text) ? internal::read_comsol(text, file)
                                                 : internal::read_ansys_rom(text, file);
  modes.left_out.insert(modes.left_out.begin(), left_out.begin(), left_out.end());
  ModeTable table = TableMaker(std::move(modes), file, keys).make();
  check(table, keys);
  return table;
}

std::string summary(const ModeTable& table) {
  constexpr int few_digits = 5;
  std::vector<std::string> frequencies;
  for (const double frequency : table.frequencies) frequencies.push_back(engineering(frequency, "Hz", few_digits));
  const bool is_mesh = table.nodes > 0;
  std::string text = fmt::format(
      "{}: {}{} places over {}, {} mode{} at {}", table.format, is_mesh ? fmt::format("{} nodes at ", table.nodes) : "",
      is_mesh ? table.places.size() : table.positions.size(), engineering(table.positions.back(), "m", few_digits),
      table.frequencies.size(), table.frequencies.size() == 1 ? "" : "s", fmt::join(frequencies, ", "));
  for (const std::string& note : table.notes) text += "; " + note;
  for (const std::string& what : table.left_out) text += "; left out: " + what;
  return text;
}

}  // namespace softland
