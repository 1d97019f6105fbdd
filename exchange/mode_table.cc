#include "exchange/mode_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/clamped_spline.h"
#include "base/engineering.h"
#include "base/printable.h"
#include "base/read_file.h"
#include "base/require.h"
#include "base/trimmed.h"
#include "exchange/cells.h"
#include "exchange/decoding.h"
#include "exchange/layout.h"
#include "exchange/local_fit.h"
#include "exchange/nodal_modes.h"
#include "exchange/own_modes.h"
#include "exchange/parsers.h"

namespace softland {
namespace {

using internal::NodalMode;
using internal::NodalModes;
using internal::Refusals;
using internal::Vector3;

constexpr int shown_digits = 6;
constexpr std::string_view axis_names = "xyz";

/// A direction of the file: which one, and its sense.
struct Way {
  std::size_t direction = 0;
  double sign = 1;
};

Way way_of(const std::string& text, const ModeKeys& keys, const char* key, const char* what) {
  const std::string_view bare = std::string_view(text).substr(text.starts_with('-') || text.starts_with('+') ? 1 : 0);
  const std::size_t direction = bare.size() == 1 ? axis_names.find(bare) : std::string_view::npos;
  require(direction != std::string_view::npos, [&] {
    return fmt::format("{} = \"{}\": must be x, y or z, with a minus where the sense is the other one: {}", keys.name(key),
                       printable_line(text), what);
  });
  return {.direction = direction, .sign = text.starts_with('-') ? -1.0 : 1.0};
}

/// Nodes at one place along the axis.
struct SectionNodes {
  double place = 0;  ///< from the clamp [m]
  std::vector<std::size_t> nodes;
};

double across_of(const Vector3& v, Way axis, Way direction) { return v[3 - axis.direction - direction.direction]; }

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
    take_widths_and_offsets();
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
      fail(fmt::format("{} = \"{}\": must be across the axis \"{}\"", keys_.name("direction"), keys_.direction, keys_.axis));
    if (!read_.holds[direction_.direction]) {
      std::vector<std::string> held;
      for (std::size_t d = 0; d < 3; ++d) {
        if (read_.holds[d]) held.emplace_back(1, axis_names[d]);
      }
      fail(fmt::format("{} = \"{}\": the file holds no motion along it, but along {}", keys_.name("direction"), keys_.direction,
                       fmt::join(held, " and ")));
    }
    if (std::any_of(read_.nodes.begin(), read_.nodes.end(), [&](const Vector3& v) { return std::isnan(v[axis_.direction]); }))
      fail(fmt::format("{} = \"{}\": the file holds no positions along it", keys_.name("axis"), keys_.axis));
  }

  void take_frequencies() {
    const auto used = static_cast<std::size_t>(
        std::count_if(read_.modes.begin(), read_.modes.end(), [](const NodalMode& m) { return m.is_used; }));
    const bool all_known =
        std::none_of(read_.modes.begin(), read_.modes.end(), [](const NodalMode& m) { return std::isnan(m.frequency); });
    if (all_known) {
      if (!keys_.frequencies.empty()) fail(fmt::format("{}: the file holds its frequencies", keys_.name("frequencies")));
      return;
    }
    if (keys_.frequencies.empty()) {
      const auto without =
          std::find_if(read_.modes.begin(), read_.modes.end(), [](const NodalMode& m) { return std::isnan(m.frequency); });
      fail(fmt::format("no frequency of {} stands in the file; {} says those of its {} modes", without->name,
                       keys_.name("frequencies"), used));
    }
    if (keys_.frequencies.size() != read_.modes.size())
      fail(fmt::format("{}: {} frequencies for {} modes", keys_.name("frequencies"), keys_.frequencies.size(),
                       read_.modes.size()));
    for (std::size_t k = 0; k < read_.modes.size(); ++k) read_.modes[k].frequency = keys_.frequencies[k];
  }

  void take_units() {
    if (read_.needs_length_unit && !keys_.length_unit)
      fail(fmt::format("the file does not say its unit of length; {} says it (m, mm, um)", keys_.name("length_unit")));
    if (read_.length_unit && keys_.length_unit && *read_.length_unit != *keys_.length_unit)
      fail(fmt::format("{}: the file says that its unit of length is {}", keys_.name("length_unit"),
                       engineering(*read_.length_unit, "m")));
    length_unit_ = keys_.length_unit.value_or(read_.length_unit.value_or(1));
    if (!keys_.length_unit && !read_.length_unit)
      made_.notes.push_back(fmt::format("lengths are taken as m ({} says otherwise)", keys_.name("length_unit")));
  }

  [[nodiscard]] double along_axis(const Vector3& v) const { return axis_.sign * metres_of(v[axis_.direction]); }
  // To divide keeps 100 um at 1e-4 m to the bit.
  [[nodiscard]] double metres_of(double place) const { return place / (1 / length_unit_); }

  // Nodes whose places differ by no more than the digits of a file are at one place.
  void gather_sections() {
    constexpr double printed = 2e-5;  // of the length: a file with six digits
    std::vector<std::size_t> order(read_.nodes.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return along_axis(read_.nodes[a]) < along_axis(read_.nodes[b]); });
    const double first = along_axis(read_.nodes[order.front()]), last = along_axis(read_.nodes[order.back()]);
    const double clamp = keys_.clamp.value_or(first);
    clamp_ = clamp;
    if (keys_.clamp && !(clamp < first))
      fail(fmt::format("{} = \"{}\": must lie below the first node, at {}: it is for a file without a node at the clamp",
                       keys_.name("clamp"), engineering(clamp, "m"), engineering(first, "m", shown_digits)));
    const double rounding = printed * (last - first);
    double begin = first;
    for (const std::size_t node : order) {
      const double place = along_axis(read_.nodes[node]);
      if (sections_.empty() || place - begin > rounding) {
        begin = place;
        sections_.push_back({});
      }
      sections_.back().nodes.push_back(node);
    }
    for (SectionNodes& section : sections_) {
      double sum = 0;
      for (const std::size_t node : section.nodes) sum += along_axis(read_.nodes[node]);
      section.place = sum / static_cast<double>(section.nodes.size()) - clamp;
    }
    constexpr std::size_t fewest = 2;
    if (sections_.size() + (keys_.clamp ? 1 : 0) < fewest + 1)
      fail(fmt::format("the nodes stand at {} places along {}; at least three are due, the clamp among them", sections_.size(),
                       keys_.axis));
    if (is_irregular()) divide_evenly(first - clamp, last - clamp);
    for (const SectionNodes& section : sections_) made_.places.push_back(section.place);
  }

  // A mean over a section is one only where its nodes lie about its middle.
  [[nodiscard]] bool is_irregular() const {
    constexpr std::size_t enough = 3;
    const auto lonely =
        std::count_if(sections_.begin(), sections_.end(), [](const SectionNodes& s) { return s.nodes.size() < enough; });
    return 2 * lonely > static_cast<std::ptrdiff_t>(sections_.size()) && spread_across() > 0;
  }

  // The nodes of an irregular mesh, by the nearest of even places from the first node to the last one.
  void divide_evenly(double first, double last) {
    constexpr std::size_t nodes_of_a_place = 24, fewest = 12, most = 100;
    const std::size_t parts = std::min(most, read_.nodes.size() / nodes_of_a_place);
    if (parts < fewest)
      fail(fmt::format(
          "an irregular mesh of {} nodes along {}, at {} places: at least {} are due for one whose nodes do not stand in layers "
          "across the axis",
          read_.nodes.size(), keys_.axis, sections_.size(), fewest * nodes_of_a_place));
    const double step = (last - first) / static_cast<double>(parts);
    std::vector<SectionNodes> even(parts + 1);
    for (std::size_t k = 0; k <= parts; ++k) even[k].place = k == parts ? last : first + step * static_cast<double>(k);
    for (const SectionNodes& section : sections_) {
      const double nearest = std::round((section.place - first) / step);
      std::vector<std::size_t>& into = even[static_cast<std::size_t>(std::clamp(nearest, 0.0, static_cast<double>(parts)))].nodes;
      into.insert(into.end(), section.nodes.begin(), section.nodes.end());
    }
    constexpr std::size_t enough = 3;
    for (const SectionNodes& section : even) {
      if (section.nodes.size() < enough)
        fail(fmt::format("an irregular mesh with {} nodes near {} along {}: too few to tell how it moves there",
                         section.nodes.size(), engineering(section.place, "m", shown_digits), keys_.axis));
    }
    first_place_ = first, step_ = step;
    sections_ = std::move(even);
    made_.notes.push_back(fmt::format("an irregular mesh: motions on the axis are fitted at {} even places", parts + 1));
  }

  // Along the direction at an even place: by least squares over the nodes nearby, where a section turns as well.
  [[nodiscard]] double fitted(std::size_t k, const NodalMode& mode) const {
    constexpr double reach = 2.5;  // even places
    const std::size_t d = direction_.direction, q = 3 - axis_.direction - d;
    const double extent = spread_across() / length_unit_;
    const Vector3 middle = middle_of_mesh();
    std::vector<internal::NearPoint> near;
    const std::size_t begin = k < 3 ? 0 : k - 3, end = std::min(sections_.size(), k + 4);
    for (std::size_t s = begin; s < end; ++s) {
      for (const std::size_t node : sections_[s].nodes) {
        const Vector3& at = read_.nodes[node];
        const double along = (along_axis(at) - clamp_ - sections_[k].place) / (reach * step_);
        if (std::abs(along) < 1)
          near.push_back({.along = along,
                          .p = (at[d] - middle[d]) / extent,
                          .q = (at[q] - middle[q]) / extent,
                          .value = mode.motion[node][d]});
      }
    }
    const std::optional<double> value = internal::value_on_axis(near);
    if (!value)
      fail(fmt::format("an irregular mesh with too few nodes near {} along {} to tell how it moves there",
                       engineering(sections_[k].place, "m", shown_digits), keys_.axis));
    return *value;
  }
  // Whether no node at the first place moves along the direction, within the digits of a file.
  [[nodiscard]] bool stands_still_at_first(const NodalMode& mode) const {
    constexpr double printed = 2e-5;
    double most = 0, here = 0;
    for (std::size_t i = 0; i < read_.nodes.size(); ++i) {
      const double motion = std::abs(mode.motion[i][direction_.direction]);
      most = std::max(most, motion);
      if (along_axis(read_.nodes[i]) - clamp_ - first_place_ < printed * sections_.back().place) here = std::max(here, motion);
    }
    return here <= printed * most;
  }
  [[nodiscard]] Vector3 middle_of_mesh() const {
    Vector3 middle{};
    for (std::size_t d = 0; d < 3; ++d) {
      const auto [low, high] = std::minmax_element(read_.nodes.begin(), read_.nodes.end(),
                                                   [d](const Vector3& a, const Vector3& b) { return a[d] < b[d]; });
      middle[d] = ((*low)[d] + (*high)[d]) / 2;
    }
    return middle;
  }

  // Of all nodes in the two directions across the axis [m].
  [[nodiscard]] double spread_across() const {
    double most = 0;
    for (std::size_t d = 0; d < 3; ++d) {
      if (d == axis_.direction) continue;
      const auto [low, high] = std::minmax_element(read_.nodes.begin(), read_.nodes.end(),
                                                   [d](const Vector3& a, const Vector3& b) { return a[d] < b[d]; });
      if (!std::isnan((*high)[d])) most = std::max(most, (*high)[d] - (*low)[d]);
    }
    constexpr double rounding = 1e-9;
    const double length = std::abs(sections_.back().place - sections_.front().place);
    return most * length_unit_ > rounding * length ? most * length_unit_ : 0;
  }

  void take_widths_and_offsets() {
    constexpr double printed = 2e-5;  // of the length
    const double rounding = printed * sections_.back().place;
    double face_at_clamp = std::numeric_limits<double>::quiet_NaN();
    // The edges of an irregular mesh have nodes nearby.
    const std::size_t neighbours = step_ > 0 ? 3 : 0;
    for (std::size_t k = 0; k < sections_.size(); ++k) {
      double low = std::numeric_limits<double>::infinity(), high = -low, face = -low;
      for (std::size_t s = k - std::min(k, neighbours); s <= std::min(k + neighbours, sections_.size() - 1); ++s) {
        for (const std::size_t node : sections_[s].nodes) {
          const double y = across_of(read_.nodes[node], axis_, direction_) * length_unit_;
          low = std::min(low, y), high = std::max(high, y);
          face = std::max(face, direction_.sign * read_.nodes[node][direction_.direction] * length_unit_);
        }
      }
      if (std::isnan(face_at_clamp)) face_at_clamp = face;
      const double width = high - low, offset = face - face_at_clamp;
      widths_.push_back(width > rounding ? width : std::numeric_limits<double>::quiet_NaN());
      offsets_.push_back(std::abs(offset) > rounding ? offset : 0);
    }
  }

  // How far the rotation of a section about the axis moves what is as far from its middle as half the extent of the mesh.
  [[nodiscard]] double twist(const SectionNodes& section, const NodalMode& mode, const Vector3& mean) const {
    const auto count = static_cast<double>(section.nodes.size());
    const std::size_t p = direction_.direction, q = 3 - axis_.direction - p;
    double middle_p = 0, middle_q = 0, turning = 0, squares = 0;
    for (const std::size_t node : section.nodes)
      middle_p += read_.nodes[node][p] / count, middle_q += read_.nodes[node][q] / count;
    for (const std::size_t node : section.nodes) {
      const double at_p = read_.nodes[node][p] - middle_p, at_q = read_.nodes[node][q] - middle_q;
      turning += at_q * (mode.motion[node][p] - mean[p]) - at_p * (mode.motion[node][q] - mean[q]);
      squares += at_p * at_p + at_q * at_q;
    }
    return squares > 0 ? turning / squares * spread_across() / (2 * length_unit_) : 0;
  }

  // What a mode is, by the squared motions of its nodes.
  void judge(std::size_t k) {
    const NodalMode& mode = read_.modes[k];
    ModeFound found{.number = static_cast<int>(k + 1), .frequency = mode.frequency};
    double bending = 0, in_plane = 0, axial = 0, torsion = 0;
    for (const SectionNodes& section : sections_) {
      const auto count = static_cast<double>(section.nodes.size());
      Vector3 mean{};
      for (const std::size_t node : section.nodes) {
        for (std::size_t d = 0; d < 3; ++d) mean[d] += mode.motion[node][d] / count;
      }
      // What differs along the axis over a section is its rotation as it bends.
      double rest = 0;
      for (const std::size_t node : section.nodes) {
        for (std::size_t d = 0; d < 3; ++d) {
          if (d != axis_.direction) rest += std::pow(mode.motion[node][d] - mean[d], 2);
        }
      }
      found.along.push_back(direction_.sign * mean[direction_.direction]);
      found.across.push_back(across_of(mean, axis_, direction_));
      found.axial.push_back(axis_.sign * mean[axis_.direction]);
      found.twist.push_back(twist(section, mode, mean));
      bending += count * std::pow(found.along.back(), 2);
      in_plane += count * std::pow(found.across.back(), 2);
      axial += count * std::pow(found.axial.back(), 2);
      torsion += rest;
    }
    if (step_ > 0) {
      for (std::size_t s = 0; s < sections_.size(); ++s)
        found.along[s] = s == 0 && stands_still_at_first(mode) ? 0 : direction_.sign * fitted(s, mode);
    }
    const double all = bending + in_plane + axial + torsion;
    const double most = std::max({bending, in_plane, axial, torsion});
    found.kind = !mode.is_used      ? ModeKind::unused
                 : most == bending  ? ModeKind::bending
                 : most == in_plane ? ModeKind::in_plane
                 : most == torsion  ? ModeKind::torsional
                                    : ModeKind::axial;
    found.share = all > 0 ? (found.kind == ModeKind::unused ? bending : most) / all : 0;
    if (found.kind == ModeKind::bending && !(all > 0)) fail(fmt::format("{} does not move any node", mode.name));
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
    if (taken.empty()) fail(fmt::format("no mode bends along {}: {}", keys_.direction, fmt::join(made_.left_out, "; ")));
    std::stable_sort(taken.begin(), taken.end(),
                     [&](std::size_t a, std::size_t b) { return made_.found[a].frequency < made_.found[b].frequency; });
    made_.positions = made_.places;
    made_.widths = widths_;
    made_.rest_offsets = offsets_;
    if (keys_.clamp) {
      made_.positions.insert(made_.positions.begin(), 0);
      made_.widths.insert(made_.widths.begin(), widths_.front());
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

  // To a modal mass of 1 kg: by what the file says, or by the mass of an even structure.
  void normalise() {
    const double mass_unit = keys_.mass_unit.value_or(1);
    if (keys_.mass) {
      if (keys_.mass_normalised || !read_.normalised_by.empty())
        fail(fmt::format("{}: the modes of the file are mass-normalised already{}", keys_.name("mass"),
                         read_.normalised_by.empty() ? "" : ", by " + read_.normalised_by));
      for (std::vector<double>& shape : made_.shapes) scale(shape, 1 / std::sqrt(*keys_.mass * mean_square(shape)));
      made_.notes.push_back(
          fmt::format("normalised by a mass of {}, even along the axis", engineering(1e3 * *keys_.mass, "g", shown_digits)));
      return;
    }
    if (read_.normalised_by.empty() && !keys_.mass_normalised)
      fail(fmt::format(
          "the file does not say which mass its modes have; {} gives that of the structure, even along its axis; {} says "
          "that the modes are mass-normalised",
          keys_.name("mass"), keys_.name("mass_normalised")));
    for (std::size_t k = 0; k < made_.shapes.size(); ++k)
      scale(made_.shapes[k], 1 / std::sqrt(mass_unit * (read_.normalised_by.empty() ? 1 : modal_masses_[k])));
    made_.notes.push_back(
        fmt::format("mass-normalised by {}", read_.normalised_by.empty() ? keys_.name("mass_normalised") : read_.normalised_by));
    if (!keys_.mass_unit)
      made_.notes.push_back(fmt::format("masses are taken as kg ({} says otherwise)", keys_.name("mass_unit")));
  }

  static void scale(std::vector<double>& shape, double factor) {
    for (double& value : shape) value *= factor;
  }
  // Over the length, of the shape between its places as a cubic that is clamped at the first one.
  [[nodiscard]] double mean_square(const std::vector<double>& shape) const;

  NodalModes read_;
  ModeKeys keys_;
  Refusals refusals_;
  ModeTable made_;
  Way axis_, direction_;
  double length_unit_ = 1, clamp_ = 0;  // where the clamp is on the axis [m]
  double first_place_ = 0, step_ = 0;   // of the even places of an irregular mesh; 0: the mesh has sections [m]
  std::vector<SectionNodes> sections_;
  std::vector<double> widths_, offsets_, modal_masses_;
};

double TableMaker::mean_square(const std::vector<double>& shape) const {
  return ClampedSpline(made_.positions, shape).integral_of_square() / made_.positions.back();
}

constexpr double still = 1e-4;  // of the largest motion

double largest_motion(const std::vector<double>& shape) {
  double most = 0;
  for (const double value : shape) most = std::max(most, std::abs(value));
  return most;
}

// A clamped beam leaves its clamp with the square of the distance, a hinged one with the distance itself.
bool is_hinged(const ModeTable& table) {
  constexpr double near = 0.2, between = 1.2;  // shear of a thick beam leaves 1.4 to 1.5
  const std::vector<double>&x = table.positions, &y = table.shapes.front();
  if (x.size() < 4 || !(x[2] < near * x.back()) || !(y[1] * y[2] > 0)) return false;
  return std::log(y[2] / y[1]) / std::log(x[2] / x[1]) < between;
}

// What holds of every table, whatever it was read from. Modes become positive at the far end, and exactly 0 at the clamp.
void check(ModeTable& table, const ModeKeys& keys) {
  constexpr std::size_t fewest = 3;
  const auto fail = [&](const std::string& rule) { throw InvalidInput(fmt::format("{}: {}", table.file, rule)); };
  if (table.positions.size() < fewest)
    fail(fmt::format("{} positions; at least three are due, the clamp at 0 among them", table.positions.size()));
  if (table.positions.front() != 0)
    fail(fmt::format("the first position is {}; it must be 0, the clamp",
                     engineering(table.positions.front(), "m", shown_digits)));
  double last = 0;
  for (std::size_t k = 0; k < table.shapes.size(); ++k) {
    const double frequency = table.frequencies[k];
    std::vector<double>& shape = table.shapes[k];
    if (!(frequency > 0))
      fail(fmt::format("mode_{} has a frequency of {}: the structure is not held", k + 1,
                       engineering(frequency, "Hz", shown_digits)));
    if (!(frequency > last))
      fail(fmt::format("the frequencies must rise, and mode_{} is at {}", k + 1, engineering(frequency, "Hz", shown_digits)));
    last = frequency;
    const double most = largest_motion(shape);
    if (!(most > 0 && most < 1e30)) fail(fmt::format("mode_{} must move, by less than 1e30 1/sqrt(kg)", k + 1));
    if (!(std::abs(shape.front()) <= still * most)) {
      const bool other_end = std::abs(shape.back()) <= still * most;
      fail(fmt::format("mode_{} moves {:.2g} % of its largest motion at the first place, which must be the clamp{}", k + 1,
                       100 * std::abs(shape.front()) / most,
                       table.nodes == 0 ? std::string()
                       : other_end
                           ? fmt::format("; the far end stands still: {} the other way round begins there", keys.name("axis"))
                           : fmt::format("; {} says where the clamp is if the file has no node there", keys.name("clamp"))));
    }
    shape.front() = 0;
    const bool held = std::abs(shape.back()) <= still * most;
    const double sign_of =
        held ? *std::find_if(shape.begin(), shape.end(), [&](double y) { return std::abs(y) > still * most; }) : shape.back();
    if (sign_of < 0) {
      for (double& value : shape) value = value == 0 ? 0 : -value;
    }
  }
  if (is_hinged(table)) fail("mode_1 leaves the first place with a slope, as at a hinge: the first place must be a clamp");
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
  // Public readers of binary results return garbage without a word.
  const auto ends_with = [&](std::string_view end) {
    return file.size() > end.size() && internal::lower_case(file).ends_with(end);
  };
  require(!ends_with(".rst"), [&] {
    return file +
           ": a binary result of ANSYS (.rst), which is not read; export the modes as UFF 55 with the positions of the nodes, or "
           "as a table";
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
      require(!is_given,
              [&] { return fmt::format("{}: {}: the table is in m, Hz and 1/sqrt(kg) already", file, keys.name(key)); });
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
             ": polynomials of energy and capacitance of a reduced-order model of ANSYS (.pcs), no modes; they stand in the .rom "
             "beside it";
    const std::string kind = internal::refused_kind(text);
    return fmt::format(
        "{}: {}; modes are read from a table of softland (x_m, mode_1), CalculiX .frd, exports of COMSOL, UFF 55 and ANSYS .rom",
        file, kind.empty() ? "no known file of modes" : kind);
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
