#include "model/built_beam.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/engineering.h"
#include "base/straight_lines.h"

namespace softland {
namespace {

double given_or(double value, double otherwise) { return std::isnan(value) ? otherwise : value; }

bool is_number_above_zero(double value) { return value > 0 && value < 1e30; }

std::optional<PartConflict> section_conflict(const Structure& s, std::size_t i) {
  const SectionPart& part = part_of<Beam>(s).sections[i];
  const std::string path = fmt::format("sections[{}]", i + 1);
  const LocalSection local = local_sections(s)[i];
  const auto positive_or = [&](double value, const char* key, const char* unit) -> std::optional<PartConflict> {
    if (is_number_above_zero(value)) return std::nullopt;
    if (std::isnan(value)) return PartConflict{path, fmt::format("needs {}, which [structure] does not give either", key)};
    return PartConflict{path + "." + key, fmt::format("is {}: must be above 0", engineering(value, unit))};
  };
  for (const auto& conflict :
       {positive_or(part.length, "length", "m"), positive_or(local.width, "width", "m"),
        positive_or(local.end_width, "width", "m"), positive_or(local.thickness, "thickness", "m"),
        positive_or(local.youngs_modulus, "youngs_modulus", "Pa"), positive_or(local.density, "density", "kg/m^3")}) {
    if (conflict) return conflict;
  }
  const Holes& holes = part.holes;
  if (!std::isnan(holes.pitch) || !std::isnan(holes.size)) {
    if (!is_number_above_zero(holes.size) || !(holes.size < holes.pitch && holes.pitch < 1e30))
      return PartConflict{path + ".holes", "needs a size above 0 and a pitch above the size"};
    if (holes.pitch > std::min({local.width, local.end_width, part.length}) * (1 + 1e-12))
      return PartConflict{path + ".holes",
                          fmt::format("the pitch must not exceed length and width of the section, {} and {}",
                                      engineering(part.length, "m"), engineering(std::min(local.width, local.end_width), "m"))};
  }
  return std::nullopt;
}

std::optional<PartConflict> layer_conflict(const Device& d, std::size_t i) {
  const Beam& beam = part_of<Beam>(d.structure);
  const LayerPart& layer = beam.layers[i];
  const std::string path = fmt::format("layers[{}]", i + 1);
  const double length = d.structure.length, begin = layer.begin.on(length), end = layer.end.on(length);
  if (layer.face == Side::both) return PartConflict{path + ".face", "must be \"near\" or \"far\""};
  if (!(begin >= 0 && end > begin && end <= length * (1 + 1e-12)))
    return PartConflict{path + ".span", fmt::format("from {} to {}: must increase and lie on the beam, from 0 m to {}",
                                                    engineering(begin, "m"), engineering(end, "m"), engineering(length, "m"))};
  for (const auto& [value, key] : {std::pair{layer.thickness, "thickness"}, std::pair{layer.youngs_modulus, "youngs_modulus"},
                                   std::pair{layer.density, "density"}}) {
    if (!is_number_above_zero(value)) return PartConflict{path + "." + key, "must be above 0"};
  }
  if (!(std::abs(layer.stress) < layer.youngs_modulus))
    return PartConflict{path + ".stress", "must be smaller than youngs_modulus of the layer"};
  if (beam.plate_strain && !(layer.poissons_ratio > -1 && layer.poissons_ratio < 0.5))
    return PartConflict{path, "needs poissons_ratio, between -1 and 0.5: plate_strain goes into each layer by its own"};
  return std::nullopt;
}

/// Returns true when the anchors leave the beam free to move as a rigid body: such a beam is refused.
bool is_mechanism(const Anchor& near, const Anchor& far) {
  const auto holds = [](double stiffness) { return stiffness > 0; };
  const bool turns = holds(near.rotation) || holds(far.rotation);
  if (holds(near.translation)) return !turns && !holds(far.translation);
  return !holds(far.translation) || !turns;
}

std::optional<PartConflict> rest_shape_conflict(const Device& d) {
  const Structure& s = d.structure;
  const Beam& beam = part_of<Beam>(s);
  const RestShape& shape = *beam.rest_shape;
  const std::vector<double> places = shape.places(s.length);
  const auto falls = [](double a, double b) { return !(a < b && b < 1e30); };
  if (places.size() < 2 || places.front() != 0 || std::ranges::adjacent_find(places, falls) != places.end())
    return PartConflict{"rest_shape.positions", "must be two at least and rise from 0 m, the near end"};
  if (shape.heights.size() != places.size())
    return PartConflict{"rest_shape.heights", fmt::format("must be one per position: there are {} heights and {} positions",
                                                          shape.heights.size(), places.size())};
  if (!std::ranges::all_of(shape.heights, [](double height) { return std::abs(height) < 1; }))
    return PartConflict{"rest_shape.heights", "must be between -1 m and 1 m"};
  const auto beside = [](const std::string& key) {
    return PartConflict{"rest_shape", fmt::format("cannot stand beside {}, which curls the beam as well", key)};
  };
  const auto* const cantilever = s.find<Cantilever>();
  if (cantilever != nullptr && cantilever->stress_gradient != 0) return beside("stress_gradient");
  for (std::size_t i = 0; i < beam.layers.size(); ++i) {
    if (beam.layers[i].stress != 0) return beside(fmt::format("layers[{}].stress", i + 1));
  }
  const auto* const bridge = s.find<Bridge>();
  if (bridge != nullptr && bridge->stretches && s.has_far_clamp())
    return PartConflict{"rest_shape",
                        "needs stretching = false between two anchors: a curved beam stretches there as an arch, which is not "
                        "simulated"};
  return std::nullopt;
}

std::optional<PartConflict> anchor_conflict(const Device& d) {
  const Structure& s = d.structure;
  const Beam& beam = part_of<Beam>(s);
  if (!beam.anchor && !beam.far_anchor) return std::nullopt;
  const Anchor near = s.near_hold(), far = s.far_hold();
  for (const auto& [anchor, key] : {std::pair{&beam.anchor, "anchor"}, std::pair{&beam.far_anchor, "far_anchor"}}) {
    if (*anchor && !((*anchor)->rotation >= 0 && (*anchor)->translation >= 0))
      return PartConflict{key, "stiffnesses must not be negative"};
  }
  if (is_mechanism(near, far))
    return PartConflict{beam.anchor ? "anchor" : "far_anchor", "nothing holds the beam: it could move without bending"};
  return std::nullopt;
}

}  // namespace

double area_left(const Holes& holes) {
  const double ratio = holes.size / holes.pitch;
  return holes.exist() ? 1 - ratio * ratio : 1;
}

double ligament_efficiency(const Holes& holes) {
  const double ratio = holes.size / holes.pitch;
  return holes.exist() ? (1 - ratio) * (1 + 1 / (1 - ratio + ratio * ratio)) / 2 : 1;
}

std::vector<LocalSection> local_sections(const Structure& s) {
  if (const auto* const modal = s.find<ModalStructure>(); modal != nullptr && s.is_built()) {
    const std::vector<double>&x = modal->table->positions(), &widths = modal->table->widths();
    std::vector<LocalSection> all;
    for (std::size_t k = 0; k + 1 < x.size(); ++k)
      all.push_back({.begin = x[k], .end = x[k + 1], .width = widths[k], .end_width = widths[k + 1], .thickness = s.thickness});
    return all;
  }
  const Beam* const beam = s.find<Beam>();
  LocalSection whole{.end = s.length, .width = s.width, .end_width = s.width, .thickness = s.thickness};
  if (beam != nullptr) whole.youngs_modulus = beam->youngs_modulus, whole.density = beam->density;
  if (beam == nullptr || beam->sections.empty()) return {whole};
  const auto known = [](double value) { return value > 0 ? value : not_given; };
  std::vector<LocalSection> all;
  double begin = 0;
  for (const SectionPart& part : beam->sections) {
    LocalSection& local = all.emplace_back(whole);
    local.begin = begin;
    local.end = begin += part.length;
    local.width = given_or(part.width, known(s.width));
    local.end_width = given_or(part.end_width, local.width);
    local.thickness = given_or(part.thickness, known(s.thickness));
    local.youngs_modulus = given_or(part.youngs_modulus, known(beam->youngs_modulus));
    local.density = given_or(part.density, known(beam->density));
    local.holes = part.holes;
  }
  all.back().end = s.length;  // the sum of the sections' lengths may differ from the length by rounding
  return all;
}

LocalSection section_at(const Structure& s, double x) {
  const std::vector<LocalSection> all = local_sections(s);
  const auto found = std::find_if(all.begin(), std::prev(all.end()), [&](const LocalSection& one) { return x < one.end; });
  return *found;
}

double width_at(const Structure& s, double x) { return s.is_built() ? section_at(s, x).width_at(x) : s.width; }

std::vector<double> edges_of_parts(const Structure& s) {
  std::set<double> edges{0, s.length};
  if (const Beam* const beam = s.find<Beam>()) {
    for (const LocalSection& local : local_sections(s)) edges.insert(local.end);
    for (const LayerPart& layer : beam->layers)
      edges.insert({layer.begin.on(s.length), std::min(layer.end.on(s.length), s.length)});
  }
  return {edges.begin(), edges.end()};
}

std::vector<double> kinks_at_rest(const Structure& s) {
  const Beam* const beam = s.find<Beam>();
  if (beam == nullptr || !beam->rest_shape) return {};
  std::vector<double> places = beam->rest_shape->places(s.length);
  std::erase_if(places, [&](double x) { return x <= 0 || x >= s.length; });
  return places;
}

std::vector<double> RestShape::places(double length) const {
  std::vector<double> all;
  for (const Place& position : positions) all.push_back(position.on(length));
  return all;
}

double RestShape::height(double x, double length) const { return along_lines(places(length), heights, x); }

double RestShape::lowest(double length) const {
  double least = height(length, length);
  for (std::size_t k = 0; k < positions.size(); ++k) {
    if (positions[k].on(length) < length) least = std::min(least, heights[k]);
  }
  return least;
}

std::optional<PartConflict> part_conflict(const Device& d) {
  const Structure& s = d.structure;
  const Beam& beam = part_of<Beam>(s);
  double length = 0;
  for (std::size_t i = 0; i < beam.sections.size(); ++i) {
    if (auto conflict = section_conflict(s, i)) return conflict;
    length += beam.sections[i].length;
  }
  if (!beam.sections.empty() && !(std::abs(length - s.length) <= 1e-9 * s.length))
    return PartConflict{"sections", fmt::format("have a length of {} together, which must be the length of the beam, {}",
                                                engineering(length, "m"), engineering(s.length, "m"))};
  for (std::size_t i = 0; i < beam.layers.size(); ++i) {
    if (auto conflict = layer_conflict(d, i)) return conflict;
  }
  if (!beam.layers.empty() && s.has_far_clamp())
    return PartConflict{"layers", "need a beam whose far end is free: between two anchors the stress of a layer is not released"};
  if (const auto conflict = anchor_conflict(d)) return conflict;
  const Cantilever* const cantilever = s.find<Cantilever>();
  if (cantilever != nullptr && cantilever->stress_gradient != 0 && s.has_far_clamp())
    return PartConflict{"stress_gradient", "needs a free far end: far_anchor would hold the curl"};
  if (beam.rest_shape) return rest_shape_conflict(d);
  return std::nullopt;
}

}  // namespace softland
