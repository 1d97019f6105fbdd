#include "exchange/mesh_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "base/engineering.h"
#include "exchange/local_fit.h"

namespace softland::internal {
namespace {

constexpr double printed = 2e-5;             // rounding error of positions with six digits, over the length of the structure
constexpr std::size_t nodes_of_section = 3;  // fewest nodes of a section whose mean motion is used
constexpr std::size_t nearby = 3;            // a local fit uses the nodes of this many places on either side
constexpr int place_digits = 6;

}  // namespace

MeshSections::MeshSections(const std::vector<Vector3>& nodes, Way axis, Way direction, double length_unit,
                           std::optional<double> clamp, const Refusals& refusals)
    : nodes_(nodes), axis_(axis), direction_(direction), length_unit_(length_unit), refusals_(refusals) {
  constexpr std::size_t fewest = 3;
  if (nodes_.empty()) refusals_.fail("there are no nodes");
  gather();
  clamp_ = clamp.value_or(first_);
  for (Section& section : sections_) section.place -= clamp_;
  if (sections_.size() + (clamp ? 1 : 0) < fewest)
    refusals_.fail(fmt::format("the nodes must have at least three places along the axis, including the clamp, but have {}",
                               sections_.size()));
  measure_extent();
  if (lacks_sections()) divide_evenly();
}

// Dividing by 1 / length unit instead of multiplying by the unit makes 100 um exactly 1e-4 m.
double MeshSections::along_axis(const Vector3& v) const { return axis_.sign * v[axis_.direction] / (1 / length_unit_); }

void MeshSections::gather() {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < nodes_.size(); ++i) order.emplace_back(along_axis(nodes_[i]), i);
  std::sort(order.begin(), order.end());
  first_ = order.front().first;
  const double rounding = printed * (order.back().first - first_);
  double begin = first_;
  for (const auto& [place, node] : order) {
    if (sections_.empty() || place - begin > rounding) {
      begin = place;
      sections_.emplace_back();
    }
    sections_.back().nodes.push_back(node);
    sections_.back().place += place;
  }
  for (Section& section : sections_) section.place /= static_cast<double>(section.nodes.size());
}

void MeshSections::measure_extent() {
  constexpr double rounding = 1e-9;  // rounding tolerance of a position, as a share of the structure's length
  for (std::size_t d = 0; d < 3; ++d) {
    const auto [low, high] =
        std::minmax_element(nodes_.begin(), nodes_.end(), [d](const Vector3& a, const Vector3& b) { return a[d] < b[d]; });
    middle_[d] = ((*low)[d] + (*high)[d]) / 2;
    if (d != axis_.direction && !std::isnan((*high)[d])) extent_ = std::max(extent_, (*high)[d] - (*low)[d]);
  }
  if (extent_ * length_unit_ <= rounding * (sections_.back().place - sections_.front().place)) extent_ = 0;
}

bool MeshSections::lacks_sections() const {
  const auto lonely =
      std::count_if(sections_.begin(), sections_.end(), [](const Section& s) { return s.nodes.size() < nodes_of_section; });
  return 2 * lonely > static_cast<std::ptrdiff_t>(sections_.size()) && extent_ > 0;
}

void MeshSections::divide_evenly() {
  constexpr std::size_t nodes_of_place = 24, fewest = 12, most = 100;
  const std::size_t parts = std::min(most, nodes_.size() / nodes_of_place);
  if (parts < fewest)
    refusals_.fail(
        fmt::format("an irregular mesh of {} nodes at {} places along the axis: "
                    "a mesh without layers across the axis must have at least {} nodes",
                    nodes_.size(), sections_.size(), fewest * nodes_of_place));
  const double first = sections_.front().place, last = sections_.back().place;
  step_ = (last - first) / static_cast<double>(parts);
  std::vector<Section> even(parts + 1);
  for (std::size_t k = 0; k <= parts; ++k) even[k].place = k == parts ? last : first + step_ * static_cast<double>(k);
  for (const Section& section : sections_) {
    const double nearest = std::round((section.place - first) / step_);
    std::vector<std::size_t>& into = even[static_cast<std::size_t>(std::clamp(nearest, 0.0, static_cast<double>(parts)))].nodes;
    into.insert(into.end(), section.nodes.begin(), section.nodes.end());
  }
  for (const Section& section : even) {
    if (section.nodes.size() < nodes_of_section)
      refusals_.fail(fmt::format("an irregular mesh with {} nodes near {} along the axis: too few to find the motion there",
                                 section.nodes.size(), engineering(section.place, "m", place_digits)));
  }
  sections_ = std::move(even);
}

std::vector<double> MeshSections::places() const {
  std::vector<double> all;
  for (const Section& section : sections_) all.push_back(section.place);
  return all;
}

std::vector<double> MeshSections::widths() const {
  const double rounding = printed * sections_.back().place;
  std::vector<double> all;
  for (std::size_t k = 0; k < sections_.size(); ++k) {
    // In an irregular mesh (most places have fewer than three nodes), the width at a place includes the nodes of nearby places.
    const std::size_t reach = is_irregular() ? nearby : 0;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t s = k - std::min(k, reach); s <= std::min(k + reach, sections_.size() - 1); ++s) {
      for (const std::size_t node : sections_[s].nodes) {
        low = std::min(low, across_of(nodes_[node])), high = std::max(high, across_of(nodes_[node]));
      }
    }
    const double width = (high - low) * length_unit_;
    all.push_back(width > rounding ? width : std::numeric_limits<double>::quiet_NaN());
  }
  return all;
}

std::vector<double> MeshSections::offsets() const {
  const double rounding = printed * sections_.back().place;
  std::vector<double> faces;
  for (std::size_t k = 0; k < sections_.size(); ++k) {
    const std::size_t reach = is_irregular() ? nearby : 0;
    double face = -std::numeric_limits<double>::infinity();
    for (std::size_t s = k - std::min(k, reach); s <= std::min(k + reach, sections_.size() - 1); ++s) {
      for (const std::size_t node : sections_[s].nodes)
        face = std::max(face, direction_.sign * nodes_[node][direction_.direction]);
    }
    faces.push_back(face * length_unit_);
  }
  std::vector<double> all;
  for (const double face : faces) all.push_back(std::abs(face - faces.front()) > rounding ? face - faces.front() : 0);
  return all;
}

SectionMotion MeshSections::motion(const NodalMode& mode) const {
  SectionMotion motion;
  for (const Section& section : sections_) add_motion(section, mode, motion);
  if (is_irregular()) {
    for (std::size_t k = 0; k < sections_.size(); ++k)
      motion.along[k] = k == 0 && stands_still_at_first(mode) ? 0 : direction_.sign * fitted(k, mode);
  }
  return motion;
}

void MeshSections::add_motion(const Section& section, const NodalMode& mode, SectionMotion& motion) const {
  const auto count = static_cast<double>(section.nodes.size());
  Vector3 mean{};
  for (const std::size_t node : section.nodes) {
    for (std::size_t d = 0; d < 3; ++d) mean[d] += mode.motion[node][d] / count;
  }
  for (const std::size_t node : section.nodes) {
    for (std::size_t d = 0; d < 3; ++d) {
      // In bending, sections rotate and their nodes move along the axis differently. This does not count as torsion.
      if (d != axis_.direction) motion.torsion += std::pow(mode.motion[node][d] - mean[d], 2);
    }
  }
  motion.along.push_back(direction_.sign * mean[direction_.direction]);
  motion.across.push_back(across_of(mean));
  motion.axial.push_back(axis_.sign * mean[axis_.direction]);
  motion.twist.push_back(twist(section, mode, mean));
  motion.bending += count * std::pow(motion.along.back(), 2);
  motion.in_plane += count * std::pow(motion.across.back(), 2);
  motion.axial_share += count * std::pow(motion.axial.back(), 2);
}

double MeshSections::twist(const Section& section, const NodalMode& mode, const Vector3& mean) const {
  const auto count = static_cast<double>(section.nodes.size());
  const std::size_t p = direction_.direction, q = 3 - axis_.direction - p;
  double middle_p = 0, middle_q = 0, turning = 0, squares = 0;
  for (const std::size_t node : section.nodes) middle_p += nodes_[node][p] / count, middle_q += nodes_[node][q] / count;
  for (const std::size_t node : section.nodes) {
    const double at_p = nodes_[node][p] - middle_p, at_q = nodes_[node][q] - middle_q;
    turning += at_q * (mode.motion[node][p] - mean[p]) - at_p * (mode.motion[node][q] - mean[q]);
    squares += at_p * at_p + at_q * at_q;
  }
  return squares > 0 ? turning / squares * extent_ / 2 : 0;
}

double MeshSections::fitted(std::size_t place, const NodalMode& mode) const {
  constexpr double reach = 2.5;  // half the width of the fit window in spacings of the places; must be below `nearby`
  const std::size_t p = direction_.direction, q = 3 - axis_.direction - p;
  std::vector<NearPoint> near;
  for (std::size_t s = place - std::min(place, nearby); s <= std::min(place + nearby, sections_.size() - 1); ++s) {
    for (const std::size_t node : sections_[s].nodes) {
      const Vector3& at = nodes_[node];
      const double along = (along_axis(at) - clamp_ - sections_[place].place) / (reach * step_);
      if (std::abs(along) < 1)
        near.push_back({.along = along,
                        .p = (at[p] - middle_[p]) / extent_,
                        .q = (at[q] - middle_[q]) / extent_,
                        .value = mode.motion[node][p]});
    }
  }
  const std::optional<double> value = value_on_axis(near);
  if (!value)
    refusals_.fail(fmt::format("an irregular mesh with too few nodes near {} along the axis to find the motion there",
                               engineering(sections_[place].place, "m", place_digits)));
  return *value;
}

// Returns true if the nodes at the first place along the axis move by less than the rounding error of the file's numbers.
bool MeshSections::stands_still_at_first(const NodalMode& mode) const {
  const double rounding = printed * (sections_.back().place - sections_.front().place);
  double most = 0, here = 0;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const double motion = std::abs(mode.motion[i][direction_.direction]);
    most = std::max(most, motion);
    if (along_axis(nodes_[i]) - first_ < rounding) here = std::max(here, motion);
  }
  return here <= printed * most;
}

}  // namespace softland::internal
