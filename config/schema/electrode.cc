#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "config/schema/sections.h"
#include "config/section_reader.h"
#include "model/forces/electrostatic.h"

namespace softland::internal {
namespace {

Electrode& electrode(Scene& scene, std::size_t k) { return scene.device.electrodes[k]; }
using OfElectrode = Of<electrode>;

Dielectric& dielectric(Scene& scene, std::size_t k) {
  std::optional<Dielectric>& one = electrode(scene, k).dielectric;
  if (!one) one.emplace();
  return *one;
}
using OfDielectric = Of<dielectric>;

const Section* dielectric_keys() {
  static const Section keys{
      .name = "dielectric",
      .keys = {OfDielectric::number<&Dielectric::thickness>("thickness", dimension::length, positive, "of the insulator")
                   .needed()
                   .such_as("0.2 um"),
               OfDielectric::number<&Dielectric::permittivity>("permittivity", dimension::none, {.least = 1, .most = 1e6},
                                                               "of the insulator, relative")
                   .needed(),
               OfDielectric::number<&Dielectric::roughness>("roughness", dimension::length, not_negative,
                                                            "air that is left where its summits touch")
                   .by_default("'0 m'")},
      .about = "an insulator on the electrode"};
  return &keys;
}

std::size_t begin_electrode(Scene& scene, const SectionReader&, std::string_view name) {
  scene.device.electrodes.push_back({.name = std::string(name)});
  return scene.device.electrodes.size() - 1;
}

/// A plate counts the length that gives the electrode's area.
void check_extent(const Structure& s, Electrode& e, const SectionReader& in) {
  if (s.is_rigid()) {
    in.require(!in.is_given("span"), "span", "belongs to a beam; the electrode of a plate has an area");
    e.begin = 0;
    e.end = s.length;
    if (!in.is_given("area")) return;
    const SectionReader structure(in.file(), "structure");
    in.require(in.number("area") <= structure.number("area"), "area", "must not exceed " + structure.written("area"));
    e.end = in.number("area") / s.width;
    return;
  }
  in.require(!in.is_given("area"), "area", "belongs to a plate; the electrode of a beam has a span");
  if (!in.is_given("span")) in.fail(R"(missing key 'span' (a list such as ["10 um", "tip"]))");
  in.require_on_beam("span", s);
}

void check_fringing(const Structure& s, const Electrode& e, const SectionReader& in) {
  const FringingRow& law = row_of(fringing_laws, e.fringing);
  const SectionReader structure(in.file(), "structure");
  const bool lacks_thickness = law.needs_thickness && std::isnan(s.thickness);
  if (!s.is_rigid()) {
    if (lacks_thickness)
      in.fail(fmt::format("fringing = {} needs structure.thickness {}; fringing = \"linear\" does not", toml_string(law.name),
                          s.whose()));
  } else if (lacks_thickness || (law.needs_width && !structure.is_given("width"))) {
    in.fail(fmt::format("fringing = {} needs structure.width{} {}; fringing = \"none\" does not", toml_string(law.name),
                        law.needs_thickness ? " and structure.thickness" : "", s.whose()));
  }
}

void check_electrode(Scene& scene, const SectionReader& in, std::size_t k) {
  Electrode& e = scene.device.electrodes[k];
  check_extent(scene.device.structure, e, in);
  check_fringing(scene.device.structure, e, in);
  in.require(!e.dielectric || e.side == Side::near, "dielectric", "belongs to an electrode on the near side alone");
  in.require(e.side != Side::near || !in.is_given("gap"), "gap",
             "belongs to side = \"far\" or \"both\"; on the near side the distance is gap.electrode");
  if (e.side != Side::near && !in.is_given("gap")) {
    in.fail(fmt::format("side = {} needs 'gap' (a length such as \"2 um\"): the rest distance on the far side",
                        toml_string(name_of(sides, e.side))));
  }
}

}  // namespace

Section electrode_section() {
  return {
      .name = "electrode",
      .is_named = true,
      .may_vary = true,
      .keys = {OfElectrode::spans<&Electrode::begin, &Electrode::end, &Electrode::further>(
                   "span", "begin and end, from the clamped end; of several pads a list of these; beams only and required there"),
               number("area", {dimension::area}, positive, "plates only; absent: that of the plate"),
               OfElectrode::choice<sides, &Electrode::side>("side",
                                                            "of the beam: near is that of the contact; far pulls away from it")
                   .by_default("'near'"),
               OfElectrode::number<&Electrode::gap>(
                   "gap", dimension::length, positive,
                   "far, both: rest distance of the face on the far side to the beam; required there"),
               OfElectrode::choice<fringing_laws, &Electrode::fringing>("fringing", "law of the fringing field")
                   .by_default("'meijs-fokkema'"),
               Key{.name = "dielectric",
                   .type = KeyType::table,
                   .about = "an insulator on it, at whose face all gaps of the scene end",
                   .like = "{ thickness = \"0.2 um\", permittivity = 7.6 }",
                   .part = dielectric_keys}},
      .about = "an electrode under the beam",
      .advice = {{"permittiv", dielectric_advice}, {"nitride", dielectric_advice}, {"oxide", dielectric_advice}},
      .begin = begin_electrode,
      .check = check_electrode};
}

}  // namespace softland::internal
