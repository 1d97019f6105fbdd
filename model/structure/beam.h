// Beams of rectangular section (Euler-Bernoulli), supported at x = 0: the parameters of the kinds of structure "cantilever" and
// "clamped-clamped" in a scene. model/beam.h computes their modes.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/structure/beam_parts.h"
#include "model/structure/kind.h"

namespace softland {

/// The parameters of a cantilever or a beam between two clamps, except length, width and thickness (see Structure).
struct Beam {
  double youngs_modulus = 0;  ///< Young's modulus E of the beam [Pa]
  double density = 0;         ///< density of the beam [kg/m^3]
  bool plate_strain = false;  ///< true: E / (1 - nu^2) replaces E in bending (wide beam), nu Poisson's ratio
  double poissons_ratio = not_given;
  std::vector<SectionPart> sections = {};  ///< sections of the beam from x = 0 on; empty for a uniform beam
  std::vector<LayerPart> layers = {};      ///< layers on the faces of the beam
  std::optional<Anchor> anchor = {};       ///< compliant anchor of the beam at x = 0; a rigid clamp if empty
  std::optional<Anchor> far_anchor = {};   ///< compliant anchor at the far end; by default the kind's free end or clamp
  std::optional<RestShape> rest_shape = {};

  /// Returns true when the beam has sections or layers.
  [[nodiscard]] bool is_built() const { return !sections.empty() || !layers.empty(); }

  static constexpr std::array usual_spread{UsualSpread{"thickness", "2 %"}, UsualSpread{"youngs_modulus", "3 %"}};
  static constexpr std::string_view why_no_list =
      "sections describe a beam that changes along it: sections = [{ length = \"60 um\", width = \"10 um\" }, { length = "
      "\"190 um\", width = [\"40 um\", \"20 um\"] }]";

  template <class S>
  static consteval auto fields() {
    constexpr Range possible_ratio{.least = -1, .most = 0.5, .least_open = true, .most_open = true};
    // clang-format off
    return std::to_array<Field<S>>({
        {.key = "length", .unit = "m", .about = "along the beam", .in = reach<S, &S::length>, .required = true, .instead_of = "sections", .such_as = "250 um"},
        {.key = "width", .unit = "m", .about = "across the beam", .in = reach<S, &S::width>, .required = true, .unless = "sections", .such_as = "20 um", .if_list = Beam::why_no_list},
        {.key = "thickness", .unit = "m", .about = "in the direction of motion", .in = reach<S, &S::thickness>, .required = true, .unless = "sections", .if_list = Beam::why_no_list},
        {.key = "youngs_modulus", .unit = "Pa", .about = "used as given unless plate_strain is on", .in = within<S, Beam, &Beam::youngs_modulus>, .required = true, .unless = "sections"},
        {.key = "density", .unit = "kg/m^3", .about = "of the beam", .in = within<S, Beam, &Beam::density>, .required = true, .unless = "sections"},
        {.key = "modes", .about = "number of modes kept; auto: as many as the figures of the own closing need", .count = reach<S, &S::modes>, .or_word = "auto", .range = {.least = 1, .most = S::most_modes}, .fallback = "4"},
        S::damping(),
        {.key = "plate_strain", .about = "use E / (1 - nu^2) for a wide beam; needs poissons_ratio", .flag = within<S, Beam, &Beam::plate_strain>, .fallback = "false"},
        {.key = "poissons_ratio", .about = "needed by plate_strain and biaxial", .in = within<S, Beam, &Beam::poissons_ratio>, .range = possible_ratio},
    });
    // clang-format on
  }
  template <class Device, class Known>
  [[nodiscard]] auto modes(const Device& device, const Known& known) const {
    return beam_modes(device, known);
  }
  template <class Device>
  [[nodiscard]] std::string why_invalid(const Device& device) const {
    return why_no_beam(device);
  }
  template <class Device>
  [[nodiscard]] double rest_offset(const Device& device, double x) const {
    return rest_shape ? rest_shape->height(x, device.structure.length) : 0;
  }
  template <class Device>
  [[nodiscard]] double lowest_rest_offset(const Device& device) const {
    return rest_shape ? rest_shape->lowest(device.structure.length) : 0;
  }
};

struct Cantilever : Beam {
  static constexpr std::string_view name = "cantilever";

  /// Gradient of the residual stress over the thickness [Pa/m]; a positive gradient curls the beam away from the near
  /// electrode.
  double stress_gradient = 0;

  template <class S>
  static consteval auto fields() {
    // clang-format off
    return joined(Beam::fields<S>(), std::to_array<Field<S>>({
        {.key = "stress_gradient", .unit = "Pa/m", .about = "of the released film over its thickness; positive: the free end rests further from the electrode; \"0 Pa/m\" may vary about a straight beam", .in = within<S, Cantilever, &Cantilever::stress_gradient>, .range = {}, .instead_of = "rest_shape", .such_as = "0.5 MPa/um"},
    }));
    // clang-format on
  }
  template <class Device>
  [[nodiscard]] double rest_offset(const Device& device, double x) const {
    if (rest_shape) return Beam::rest_offset(device, x);
    return is_straight() ? 0 : curl(device, stress_gradient, x);
  }
  template <class Device>
  [[nodiscard]] double lowest_rest_offset(const Device& device) const {
    if (rest_shape) return Beam::lowest_rest_offset(device);
    if (is_built()) return is_straight() ? 0 : lowest_curl(device, stress_gradient);
    return stress_gradient < 0 ? rest_offset(device, device.structure.length) : 0;
  }

  /// Returns true when no residual stress curls the cantilever.
  [[nodiscard]] bool is_straight() const {
    return stress_gradient == 0 &&
           std::none_of(layers.begin(), layers.end(), [](const LayerPart& layer) { return layer.stress != 0; });
  }

  template <class S>
  [[nodiscard]] static S example() {
    return {.length = 250e-6, .width = 20e-6, .thickness = 2e-6, .kind = Cantilever{{.youngs_modulus = 78e9, .density = 19300}}};
  }
};

/// A beam between two clamps.
struct Bridge : Beam {
  static constexpr std::string_view name = "clamped-clamped";
  static constexpr bool has_far_clamp = true;
  static constexpr std::string_view why_no_layer =
      "between two clamps the layer's axial force is not released: it would stretch or buckle the beam, and pull off its middle "
      "line; a layer needs a cantilever";

  double residual_stress = 0;  ///< residual stress before the beam bends, positive in tension [Pa]
  bool biaxial = false;        ///< true: biaxial stress of a film, of which residual_stress (1 - nu) remains in the beam
  bool stretches = true;       ///< true when bending stretches the beam (cubic stiffness)

  template <class S>
  static consteval auto fields() {
    // clang-format off
    return joined(Beam::fields<S>(), std::to_array<Field<S>>({
        {.key = "residual_stress", .unit = "Pa", .about = "along the straight beam, positive in tension; above the stress at which the beam buckles", .in = within<S, Bridge, &Bridge::residual_stress>, .range = {}, .fallback = "'0 Pa'", .such_as = "20 MPa"},
        {.key = "biaxial", .about = "residual_stress is that of the film before release: the beam keeps residual_stress (1 - nu); needs poissons_ratio", .flag = within<S, Bridge, &Bridge::biaxial>, .fallback = "false"},
        {.key = "stretching", .about = "bending stretches the beam: a cubic stiffness", .flag = within<S, Bridge, &Bridge::stretches>, .fallback = "true"},
    }));
    // clang-format on
  }
  template <class S>
  [[nodiscard]] static S example() {
    return {.length = 400e-6, .width = 20e-6, .thickness = 2e-6, .kind = Bridge{{.youngs_modulus = 78e9, .density = 19300}, 2e6}};
  }
  /// Returns the stiffness of mid-plane stretching; empty when the model neglects stretching or an end of the beam is free.
  template <class Modes, class S>
  [[nodiscard]] auto stretching(const Modes& modes, const S& structure) const {
    return stretches && structure.has_far_clamp() ? std::optional(stretching_of(modes, structure)) : std::nullopt;
  }
};

}  // namespace softland
