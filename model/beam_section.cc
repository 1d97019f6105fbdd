#include "model/beam_section.h"

#include <algorithm>
#include <cmath>

#include "model/built_beam.h"
#include "model/constants.h"
#include "model/laminate.h"
#include "model/surface.h"

namespace softland {
namespace {

// Returns the axial force that a stress, equal everywhere before release, leaves in a beam between its anchors [N]: the
// sections stretch each other until the force is the same in all of them.
double axial_force(const Structure& s, double stress) {
  double shrinks = 0;  // shortening of the released beam by the stress if no anchor held it [m]
  for (const LocalSection& local : local_sections(s)) shrinks += stress / local.youngs_modulus * (local.end - local.begin);
  return shrinks / stretch_per_force(s);
}

// Returns the parts of a beam of sections and layers, between the edges of all sections and layers, under a stress that grows
// by `gradient` [Pa/m] over the thickness of the beam without its layers. A piezo layer lies outside of all other layers.
std::vector<BeamSection> built_sections(const Device& device, double gradient) {
  const Structure& s = device.structure;
  const Beam& beam = part_of<Beam>(s);
  std::vector<double> edges = edges_of_parts(s);
  const double piezo_begin = device.piezo ? device.piezo->begin.on(s.length) : 0,
               piezo_end = device.piezo ? std::min(device.piezo->end.on(s.length), s.length) : 0;
  if (device.piezo) edges.insert(edges.end(), {piezo_begin, piezo_end});
  std::ranges::sort(edges);
  // Two edges of sections or layers that differ by rounding are the same edge.
  const auto same = [&](double a, double b) { return b - a < 1e-9 * s.length; };
  edges.erase(std::unique(edges.begin(), edges.end(), same), edges.end());
  edges.back() = s.length;
  const auto modulus = [&](double youngs, double ratio) { return beam.plate_strain ? youngs / (1 - ratio * ratio) : youngs; };
  std::vector<BeamSection> sections;
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const double begin = edges[i], end = edges[i + 1], middle = (begin + end) / 2;
    const LocalSection local = section_at(s, middle);
    std::vector<Lamina> stack{{.modulus = modulus(local.youngs_modulus, beam.poissons_ratio),
                               .density = local.density,
                               .thickness = local.thickness,
                               .gradient = gradient}};
    for (const LayerPart& layer : beam.layers) {
      if (middle < layer.begin.on(s.length) || middle > layer.end.on(s.length)) continue;
      stack.insert(layer.face == Side::near ? stack.begin() : stack.end(),
                   {.modulus = modulus(layer.youngs_modulus, layer.poissons_ratio),
                    .density = layer.density,
                    .thickness = layer.thickness,
                    .stress = layer.stress});
    }
    const bool has_piezo = device.piezo && middle > piezo_begin && middle < piezo_end;
    double piezo_middle = 0;  // height of the middle of the piezo layer above the beam's near face [m]
    if (has_piezo) {
      for (const Lamina& l : stack) piezo_middle += l.thickness;
      piezo_middle += device.piezo->thickness / 2;
      stack.push_back(
          {.modulus = device.piezo->youngs_modulus, .density = device.piezo->density, .thickness = device.piezo->thickness});
    }
    const Laminate laminate(stack);
    const double width = local.width_at(middle), carrying = width * ligament_efficiency(local.holes);
    BeamSection section{.begin = begin,
                        .end = end,
                        .rigidity = carrying * laminate.rigidity,
                        .mass_per_length = width * area_left(local.holes) * laminate.mass,
                        .taper = local.is_even() ? 0 : local.width_at(end) / width - 1,
                        .curvature = laminate.curvature};
    if (has_piezo) {
      const Piezo& p = *device.piezo;
      const double e31 = std::isnan(p.e31) ? p.d31 * p.youngs_modulus : p.e31;
      section.piezo_moment = e31 * carrying * (piezo_middle - laminate.neutral_axis);
    }
    sections.push_back(section);
  }
  return sections;
}

}  // namespace

double stretch_per_force(const Structure& s) {
  double sum = 0;
  for (const LocalSection& local : local_sections(s)) {
    const double length = local.end - local.begin, growth = local.end_width / local.width - 1;
    const double per_width = local.youngs_modulus * local.thickness * ligament_efficiency(local.holes);
    // The elongation of a section is proportional to the mean of 1 / width, which is a logarithm for a linear width.
    const double mean = growth == 0 ? 1 / local.width : std::log1p(growth) / (growth * local.width);
    sum += length * mean / per_width;
  }
  return sum;
}

double bending_modulus(const Structure& s) {
  const Beam& beam = part_of<Beam>(s);
  return beam.plate_strain ? beam.youngs_modulus / (1 - beam.poissons_ratio * beam.poissons_ratio) : beam.youngs_modulus;
}

CompositeSection plain_section(const Structure& s, const std::optional<Surface>& surface) {
  const double skins = surface ? surface_rigidity(*surface, s) : 0;
  return {.rigidity = bending_modulus(s) * s.width * std::pow(s.thickness, 3) / 12 + skins,
          .mass_per_length = part_of<Beam>(s).density * s.width * s.thickness};
}

CompositeSection layered_section(const Structure& s, const Piezo& p) {
  const double eb = bending_modulus(s), b = s.thickness, ep = p.youngs_modulus, bp = p.thickness, a = s.width;
  const double zc = (eb * bp * b + ep * bp * bp / 2 + eb * b * b / 2) / (ep * bp + eb * b);
  return {.neutral_axis = zc,
          .rigidity = a * (ep * bp * bp * bp / 12 + eb * b * b * b / 12 + ep * bp * std::pow(zc - bp / 2, 2) +
                           eb * b * std::pow(bp + b / 2 - zc, 2)),
          .mass_per_length = a * (part_of<Beam>(s).density * b + p.density * bp)};
}

double piezo_moment_per_volt(const Structure& s, const Piezo& p) {
  const double e31 = std::isnan(p.e31) ? p.d31 * p.youngs_modulus : p.e31;
  return e31 * s.width * (layered_section(s, p).neutral_axis - p.thickness / 2);
}

double axial_stress(const Bridge& bridge) { return bridge.residual_stress * (bridge.biaxial ? 1 - bridge.poissons_ratio : 1); }

BeamSupport beam_support(const Structure& s, const std::optional<Surface>& surface) {
  const double pull = surface ? surface_pull(*surface, s) : 0;
  const Anchor near = s.near_hold(), far = s.far_hold();
  const auto* const bridge = s.find<Bridge>();
  if (bridge != nullptr && s.has_far_clamp()) {
    const double force = s.is_built() ? axial_force(s, axial_stress(*bridge)) : axial_stress(*bridge) * s.width * s.thickness;
    return {.far_clamp = far.is_clamp(), .axial_force = force + pull, .near = near, .far = far};
  }
  if (s.has_far_clamp()) return {.far_clamp = far.is_clamp(), .near = near, .far = far};
  return {.axial_force = surface && surface->cantilever_load == ResidualLoad::compression ? -pull : 0, .near = near};
}

double buckling_stress(const Structure& s, const std::optional<Surface>& surface) {
  const double slenderness = (s.has_far_clamp() ? 2 * pi : pi / 2) / s.length;
  return slenderness * slenderness * plain_section(s, surface).rigidity / (s.width * s.thickness);
}

std::vector<BeamSection> beam_sections(const Device& device) {
  const Structure& s = device.structure;
  if (s.is_built()) return built_sections(device, 0);
  const CompositeSection plain = plain_section(s, device.surface);
  std::vector<BeamSection> sections;
  const auto add = [&](double begin, double end, const CompositeSection& c) {
    if (end > begin)
      sections.push_back({.begin = begin, .end = end, .rigidity = c.rigidity, .mass_per_length = c.mass_per_length});
  };
  if (!device.piezo) {
    add(0, s.length, plain);
    return sections;
  }
  const double begin = device.piezo->begin.on(s.length), end = device.piezo->end.on(s.length);
  add(0, begin, plain);
  add(begin, end, layered_section(s, *device.piezo));
  add(end, s.length, plain);
  return sections;
}

double curl(const Device& device, double gradient, double x) {
  const Structure& s = device.structure;
  const double moment = gradient * s.width * std::pow(s.thickness, 3) / 12;
  double offset = 0;
  for (const BeamSection& section : s.is_built() ? built_sections(device, gradient) : beam_sections(device)) {
    if (section.begin >= x) break;
    // Distances of x from begin and end of the section [m]; 0 for the end if x is within the section. A constant curvature k
    // adds k (near^2 - far^2) / 2 to the deflection at x.
    const double near = x - section.begin, far = std::max(0.0, x - section.end);
    offset += (s.is_built() ? section.curvature : moment / section.rigidity) * (near * near - far * far) / 2;
  }
  return offset;
}

double lowest_curl(const Device& device, double gradient) {
  double lowest = 0, offset = 0, slope = 0;
  for (const BeamSection& section : built_sections(device, gradient)) {
    // Distance from the begin of the section at which the slope of the curl is 0 [m].
    const double length = section.end - section.begin, flat = -slope / section.curvature;
    if (flat > 0 && flat < length) lowest = std::min(lowest, offset + slope * flat / 2);
    offset += (slope + section.curvature * length / 2) * length;
    slope += section.curvature * length;
    lowest = std::min(lowest, offset);
  }
  return lowest;
}

}  // namespace softland
