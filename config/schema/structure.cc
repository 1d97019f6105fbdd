#include <cmath>
#include <limits>

#include "config/modal_table.h"
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

// What devices of a file of modes cannot differ by.
constexpr std::string_view follows_no_size = "the modes of a file do not follow it; vary structure.frequency_factor";

std::vector<Key> modes_keys() {
  using namespace modal_keys;
  const std::vector<std::string_view> here{"modes"};
  Key modes{.name = "modes",
            .type = KeyType::integer,
            .range = {.least = 1, .most = most_modes},
            .about = "number of modes kept; absent: all of the file",
            .bound = {.integer = [](Scene& scene, std::size_t) -> int& { return scene.device.structure.modes; }}};
  Key shapes = numbers("shapes", {dimension::none}, any, "a list per mode: mass-normalised, in 1/sqrt(kg), at the positions");
  shapes.is_nested = true;
  return {
      words(file, "table of modes, CalculiX .frd, export of COMSOL, UFF 55 or ANSYS .rom, relative to the scene")
          .needed()
          .instead(positions)
          .of(here),
      words(axis, "of the file, from the clamp to the far end: x, -y").of(here),
      words(direction, "of the file, towards the near electrode: -z").of(here),
      words(length_unit, "of the file's positions, where it does not say").of(here).such_as("mm"),
      words(mass_unit, "of the model behind the file").of(here).such_as("t"),
      number(mass, {dimension::mass}, positive, "of the structure, even along its axis: normalises modes that are not")
          .of(here)
          .fixed("it normalises the modes of a file; vary structure.frequency_factor"),
      Key{.name = mass_normalised, .type = KeyType::flag, .about = "the modes of the file are, though it does not say so"}.of(
          here),
      number(clamp, {dimension::length}, any, "where the clamp is on the axis of the file, if there is no node")
          .of(here)
          .fixed("it is a place in the file"),
      numbers(positions, {dimension::length}, not_negative, "instead of a file: places from the clamp on, which is the first")
          .instead(file)
          .of(here),
      numbers(frequencies, {dimension::frequency}, positive,
              "of the modes at these positions, or of a file that does not hold them")
          .of(here),
      std::move(shapes).of(here),
      OfStructure::number<&Structure::frequency_factor>("frequency_factor", dimension::none, {.least = 0.01, .most = 100},
                                                        "of all natural frequencies, over those of the file")
          .by_default("1.0")
          .of(here),
      OfStructure::number<&Structure::width>("width", dimension::length, positive,
                                             "across the axis, the same everywhere; absent: that of the file")
          .of(here)
          .fixed(follows_no_size),
      OfStructure::number<&Structure::thickness>("thickness", dimension::length, positive,
                                                 "needed by fringing and gas laws that depend on it, and by nothing else")
          .of(here)
          .fixed(follows_no_size),
      std::move(modes).of(here),
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
  if (s.kind == StructureKind::modes) return read_modal_table(scene, in);
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
  for (Key& key : modes_keys()) keys.push_back(std::move(key));
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
