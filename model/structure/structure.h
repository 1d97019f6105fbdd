// The moving part of a switch: one of the kinds of structures, with the properties that all kinds have. To add a kind, write a
// header as model/structure/kind.h describes, and add its type to StructureKind.
#pragma once

#include <concepts>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "base/field.h"
#include "model/structure/beam.h"
#include "model/structure/plate.h"
#include "model/structure/tabulated_modes.h"

namespace softland {

/// Largest number of modes of a beam in static calculations, see SwitchOptions::modes.
inline constexpr int most_static_modes = 40;

/// The parameters of a structure of any kind. Messages and tables list the kinds in this order.
using StructureKind = std::variant<Cantilever, Bridge, Plate, ModalStructure>;

struct Structure {
  /// The largest number of modes of a beam in simulations of its motion.
  static constexpr int most_modes = 20;

  double length = 0;  ///< length of the structure [m]; area over width for a plate; length of the table for a table of modes
  double width = 0;   ///< width of the structure [m]
  double thickness = not_given;  ///< thickness of the structure [m]
  int modes = 4;                 ///< number of modes in the simulation; a plate always has one
  double damping_ratio = 0;      ///< ratio of the modal damping to critical damping, for every mode
  StructureKind kind = Cantilever{};

  /// Returns the parameters of the structure's kind if their type is `Part` or derives from `Part`; null otherwise.
  template <class Part>
  [[nodiscard]] constexpr Part* find() {
    return std::visit(
        []<class Kind>(Kind& own) -> Part* {
          if constexpr (std::derived_from<Kind, Part>) return &own;
          return nullptr;
        },
        kind);
  }
  template <class Part>
  [[nodiscard]] constexpr const Part* find() const {
    return const_cast<Structure*>(this)->find<Part>();
  }
  /// Returns the scene-file key of the damping ratio, which every kind of structure has.
  [[nodiscard]] static consteval Field<Structure> damping();

  /// Returns true for a rigid body with one mode, which moves equally at all places.
  [[nodiscard]] bool is_rigid() const;
  /// Returns true when the far end of the structure is held, by a clamp or by a compliant anchor.
  [[nodiscard]] bool has_far_clamp() const;
  /// Return the stiffnesses of the supports at x = 0 and at the far end: those of the beam's anchors if given. The default is a
  /// rigid clamp; at the far end, a clamp or a free end, as the kind has it.
  [[nodiscard]] Anchor near_hold() const;
  [[nodiscard]] Anchor far_hold() const;
  /// Returns true when the size changes along the structure: a beam with sections or layers, or a table of modes with widths.
  [[nodiscard]] bool is_built() const;
  /// Return the reason why the structure cannot have a piezo layer, or surface skins; empty when it can.
  [[nodiscard]] std::string_view why_no_layer() const;
  [[nodiscard]] std::string_view why_no_skins() const;
  /// Returns the last words of messages about a number that this kind of structure requires, such as "on a plate". Empty when
  /// the kind requires no number.
  [[nodiscard]] std::string_view whose() const;
};

inline constexpr int most_modes = Structure::most_modes;

consteval Field<Structure> Structure::damping() {
  return {
      .key = "damping_ratio",
      .about =
          "modal, the same for every mode; for 1 and more: [gas] with model = linear and quality_factor = 1 / (2 damping_ratio)",
      .in = reach<Structure, &Structure::damping_ratio>,
      .range = below_one,
      .fallback = "0.0",
      .beyond = "for more give [gas] model = \"linear\" and quality_factor = 1 / (2 damping_ratio)"};
}

/// The scene-file keys of a kind of structure, computed at compile time.
template <class Kind>
inline constexpr auto structure_fields = Kind::template fields<Structure>();
/// Returns the scene-file keys that are valid for the structure's kind.
[[nodiscard]] inline std::span<const Field<Structure>> fields_in_force(const Structure& s) {
  return std::visit([]<class Kind>(const Kind&) -> std::span<const Field<Structure>> { return structure_fields<Kind>; }, s.kind);
}

inline bool Structure::is_rigid() const {
  return std::visit(
      []<class Kind>(const Kind&) {
        return requires { Kind::is_rigid; };
      },
      kind);
}
inline Anchor Structure::near_hold() const {
  const Beam* const beam = find<Beam>();
  return beam != nullptr && beam->anchor ? *beam->anchor : Anchor{};
}
inline Anchor Structure::far_hold() const {
  if (const Beam* const beam = find<Beam>(); beam != nullptr && beam->far_anchor) return *beam->far_anchor;
  if (const auto* const modal = find<ModalStructure>())
    return modal->table && modal->table->has_far_clamp() ? Anchor{} : free_end;
  const bool is_clamped = std::visit(
      []<class Kind>(const Kind&) {
        return requires { Kind::has_far_clamp; };
      },
      kind);
  return is_clamped ? Anchor{} : free_end;
}
inline bool Structure::has_far_clamp() const { return !far_hold().is_free(); }
inline bool Structure::is_built() const {
  if (const auto* const modal = find<ModalStructure>()) return modal->table != nullptr && !modal->table->widths().empty();
  const Beam* const beam = find<Beam>();
  return beam != nullptr && beam->is_built();
}
inline std::string_view Structure::why_no_layer() const {
  if (find<Beam>() != nullptr) return has_far_clamp() ? Bridge::why_no_layer : "";
  return std::visit(
      []<class Kind>(const Kind&) -> std::string_view {
        if constexpr (requires { Kind::why_no_layer; }) return Kind::why_no_layer;
        return std::derived_from<Kind, Beam> ? "" : "a layer needs a beam";
      },
      kind);
}
inline std::string_view Structure::why_no_skins() const {
  return std::visit(
      []<class Kind>(const Kind&) -> std::string_view {
        if constexpr (requires { Kind::why_no_skins; }) return Kind::why_no_skins;
        return std::derived_from<Kind, Beam> ? "" : "a surface needs a beam";
      },
      kind);
}
inline std::string_view Structure::whose() const {
  return std::visit(
      []<class Kind>(const Kind&) -> std::string_view {
        if constexpr (requires { Kind::whose; }) return Kind::whose;
        return {};
      },
      kind);
}

/// Returns the largest number of modes that a structure may have: 1 for a plate, at most the number in the table for a table of
/// modes.
[[nodiscard]] inline int most_modes_of(const Structure& structure) {
  return std::visit(
      []<class Kind>(const Kind& kind) {
        if constexpr (requires { kind.most_modes(); }) return kind.most_modes();
        return Structure::most_modes;
      },
      structure.kind);
}

}  // namespace softland
