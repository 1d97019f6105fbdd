#include <cmath>
#include <limits>

#include "config/schema/sections.h"
#include "config/section_reader.h"
#include "model/beam.h"

namespace softland::internal {
namespace {

Structure& structure(Scene& scene, std::size_t) { return scene.device.structure; }
using OfStructure = Of<structure>;

std::vector<Key> beam_keys() {
  Key modes{.name = "modes",
            .type = KeyType::integer,
            .range = {.least = 1, .most = most_modes},
            .words = {"auto"},
            .about = "number of modes kept; auto: until the figures stop moving",
            .bound = {.integer = [](Scene& scene, std::size_t) -> int& { return scene.device.structure.modes; }}};
  constexpr Range possible_ratio{.least = -1, .most = 0.5, .least_open = true, .most_open = true};
  return {
      OfStructure::number<&Structure::length>("length", dimension::length, positive, "along the beam")
          .needed()
          .of(beams)
          .such_as("250 um"),
      OfStructure::number<&Structure::width>("width", dimension::length, positive, "across the beam")
          .needed()
          .of(beams)
          .such_as("20 um"),
      OfStructure::number<&Structure::thickness>("thickness", dimension::length, positive, "in the direction of motion")
          .needed()
          .of(beams),
      OfStructure::number<&Structure::youngs_modulus>("youngs_modulus", dimension::pressure, positive,
                                                      "used as given unless plate_strain is on")
          .needed()
          .of(beams),
      OfStructure::number<&Structure::density>("density", dimension::density, positive, "of the beam").needed().of(beams),
      std::move(modes).by_default("4").of(beams),
      OfStructure::number<&Structure::damping_ratio>("damping_ratio", dimension::none, below_one,
                                                     "modal, the same for every mode")
          .by_default("0.0")
          .or_else("for more give [gas] model = \"linear\" and quality_factor = 1 / (2 damping_ratio)"),
      OfStructure::flag<&Structure::plate_strain>("plate_strain", "use E / (1 - nu^2) for a wide beam")
          .by_default("false")
          .of(beams),
      OfStructure::number<&Structure::poissons_ratio>("poissons_ratio", dimension::none, possible_ratio,
                                                      "needed by plate_strain and biaxial")
          .of(beams),
      OfStructure::number<&Structure::residual_stress>("residual_stress", dimension::pressure, any,
                                                       "along the beam before it bends, positive in tension")
          .by_default("'0 Pa'")
          .such_as("20 MPa")
          .of({"clamped-clamped"}),
      OfStructure::flag<&Structure::biaxial>(
          "biaxial", "residual_stress is that of the unreleased film: the beam keeps residual_stress (1 - nu)")
          .by_default("false")
          .of({"clamped-clamped"}),
      OfStructure::flag<&Structure::stretching>("stretching", "bending stretches the beam: a cubic stiffness")
          .by_default("true")
          .of({"clamped-clamped"}),
  };
}

std::vector<Key> plate_keys() {
  return {
      OfStructure::number<&Structure::mass>("mass", dimension::mass, positive, "moving mass").needed().of({"plate"}),
      OfStructure::number<&Structure::stiffness>("stiffness", dimension::stiffness, positive, "of all springs together")
          .needed()
          .of({"plate"}),
      number("area", {dimension::area}, positive, "of the plate").needed().of({"plate"}),
      OfStructure::number<&Structure::width>("width", dimension::length, positive,
                                             "needed by gas films, fringing and rough contacts; the length is area / width")
          .of({"plate"})
          .such_as("100 um"),
      OfStructure::number<&Structure::thickness>("thickness", dimension::length, positive,
                                                 "needed by fringing laws that depend on it")
          .of({"plate"}),
  };
}

void check_plate(Structure& plate, const SectionReader& in) {
  const double area = in.number("area");
  // Where no law needs its width a plate is as good as square.
  if (!in.is_given("width")) plate.width = std::sqrt(area);
  if (!in.is_given("thickness")) plate.thickness = std::numeric_limits<double>::quiet_NaN();
  plate.length = area / plate.width;
  plate.modes = 1;
}

void check_structure(Scene& scene, const SectionReader& in, std::size_t) {
  Structure& s = scene.device.structure;
  scene.auto_modes = in.is_word("modes");
  if (s.kind == StructureKind::plate) return check_plate(s, in);
  for (const char* key : {"plate_strain", "biaxial"}) {
    if (!in.has_value(key)) continue;
    in.require(!in.flag(key) || in.is_given("poissons_ratio"), key, "needs structure.poissons_ratio");
  }
  if (s.kind != StructureKind::clamped_clamped || in.file().find({"surface"})) return;  // with a surface the load is another one
  const std::string buckled = why_buckled(s);
  in.require(buckled.empty(), "residual_stress", buckled);
}

}  // namespace

Section structure_section() {
  std::vector<Key> keys{OfStructure::choice<structure_kinds, &Structure::kind>("kind", "what moves").needed()};
  for (Key& key : beam_keys()) keys.push_back(std::move(key));
  for (Key& key : plate_keys()) keys.push_back(std::move(key));
  return {.name = "structure",
          .required = true,
          .may_vary = true,
          .selector = "kind",
          .keys = std::move(keys),
          .about = "the moving part",
          .begin = [](Scene&, const SectionReader&, std::string_view) { return std::size_t{0}; },
          .check = check_structure};
}

}  // namespace softland::internal
