#include <fmt/format.h>

#include <algorithm>

#include "config/schema/sections.h"
#include "config/section_reader.h"
#include "model/beam.h"
#include "model/built_beam.h"

namespace softland::internal {
namespace {

template <class Part>
Part& at(std::vector<Part>& all, std::size_t number) {
  all.resize(std::max(all.size(), number + 1));
  return all[number];
}
Beam& beam(Scene& scene) { return part_of<Beam>(scene.device.structure); }

SectionPart& section_part(Scene& scene, std::size_t number) { return at(beam(scene).sections, number); }
Holes& holes(Scene& scene, std::size_t number) { return section_part(scene, number).holes; }
LayerPart& layer_part(Scene& scene, std::size_t number) { return at(beam(scene).layers, number); }
using OfSection = Of<section_part>;
using OfHoles = Of<holes>;
using OfLayer = Of<layer_part>;

template <std::optional<Anchor> Beam::*member>
Anchor& anchor(Scene& scene, std::size_t) {
  std::optional<Anchor>& one = beam(scene).*member;
  if (!one) one.emplace();
  return *one;
}

const Section* holes_keys() {
  static const Section keys{
      .name = "holes",
      .keys = {OfHoles::number<&Holes::pitch>("pitch", dimension::length, positive,
                                              "distance between the centres of adjacent holes, along and across the beam")
                   .needed()
                   .such_as("20 um"),
               OfHoles::number<&Holes::size>("size", dimension::length, positive, "side of a hole").needed().such_as("8 um")},
      .about = "square holes in a square pattern",
      .check = [](Scene& scene, const SectionReader& in, std::size_t number) {
        const Holes& h = holes(scene, number);
        in.require(h.size < h.pitch, "size", "must be less than " + in.written("pitch"));
      }};
  return &keys;
}

// Returns the width at the begin (element 0) or the end (element 1) of a beam section with linear width.
double& width_of_section(Scene& scene, std::size_t number, std::size_t element) {
  SectionPart& part = section_part(scene, number);
  return element == 0 ? part.width : part.end_width;
}

const Section* section_keys() {
  static const Section keys = [] {
    Key width =
        numbers("width", {dimension::length}, positive, "width, or a list of the widths at begin and end, linear between");
    width.may_be_one = true;
    width.like = "20 um";
    width.bound.element = width_of_section;
    Key of_holes{.name = "holes",
                 .type = KeyType::table,
                 .about = "square holes in a square pattern",
                 .like = "{ pitch = \"20 um\", size = \"8 um\" }",
                 .part = holes_keys};
    return Section{
        .name = "sections",
        .keys = {number("length", {dimension::length}, positive, "length along the beam").needed(), std::move(width),
                 OfSection::number<&SectionPart::thickness>("thickness", dimension::length, positive,
                                                            "thickness in the direction of motion"),
                 OfSection::number<&SectionPart::youngs_modulus>(
                     "youngs_modulus", dimension::pressure, positive,
                     "Young's modulus; absent: that of [structure], as for every key but length and holes that a section omits"),
                 OfSection::number<&SectionPart::density>("density", dimension::density, positive, "density of the section"),
                 std::move(of_holes)},
        .about = "section of the beam with its own width, thickness or material",
        .check = [](Scene& scene, const SectionReader& in, std::size_t part) {
          section_part(scene, part).length = in.number("length");
          in.require(!in.has_value("width") || in.quantities("width").size() <= 2, "width",
                     "must be one width, or a list of two widths, at the begin and at the end of the section");
        }};
  }();
  return &keys;
}

const Section* layer_keys() {
  static const Section keys = [] {
    Key face = one_of("face", {"near", "far"}, "face of the beam; near: that of the contact").needed();
    face.bound.choose = [](Scene& scene, std::size_t number, std::string_view word) {
      layer_part(scene, number).face = find_named(sides, word)->value;
    };
    return Section{
        .name = "layers",
        .keys = {std::move(face),
                 OfLayer::span<&LayerPart::begin, &LayerPart::end>("span", "begin and end, from x = 0, on the beam").needed(),
                 OfLayer::number<&LayerPart::thickness>("thickness", dimension::length, positive, "of the layer").needed(),
                 OfLayer::number<&LayerPart::youngs_modulus>("youngs_modulus", dimension::pressure, positive, "of the layer")
                     .needed(),
                 OfLayer::number<&LayerPart::density>("density", dimension::density, positive, "of the layer").needed(),
                 OfLayer::number<&LayerPart::stress>(
                     "stress", dimension::pressure, any,
                     "stress along the beam before its release, positive in tension: it curls the beam")
                     .by_default("'0 Pa'")
                     .such_as("50 MPa"),
                 OfLayer::number<&LayerPart::poissons_ratio>(
                     "poissons_ratio", dimension::none, Range{.least = -1, .most = 0.5, .least_open = true, .most_open = true},
                     "Poisson's ratio of the layer, needed by plate_strain")},
        .about = "a layer on a face of the beam",
        .check = [](Scene&, const SectionReader&, std::size_t) {}};
  }();
  return &keys;
}

RestShape& rest_shape(Scene& scene) {
  std::optional<RestShape>& shape = beam(scene).rest_shape;
  if (!shape) shape.emplace();
  return *shape;
}

const Section* rest_shape_keys() {
  static const Section keys = [] {
    Key positions = numbers("positions", {dimension::length, dimension::none}, not_negative,
                            "positions along the beam, rising, from 0 m to the tip")
                        .needed();
    positions.words = {tip};
    positions.bound.place = [](Scene& scene, std::size_t, std::size_t element) -> Place& {
      return at(rest_shape(scene).positions, element);
    };
    Key heights = numbers("heights", {dimension::length}, any,
                          "heights of the face above the straight shape, "
                          "one per position, away from the near electrode")
                      .needed();
    heights.bound.element = [](Scene& scene, std::size_t, std::size_t element) -> double& {
      return at(rest_shape(scene).heights, element);
    };
    return Section{.name = "rest_shape",
                   .keys = {std::move(positions), std::move(heights)},
                   .about = "the shape of the released beam",
                   .check = [](Scene&, const SectionReader& in, std::size_t) {
                     const std::size_t places = in.quantities("positions").size(), heights = in.quantities("heights").size();
                     in.require(places >= 2, "positions", "must be at least two positions, from 0 m to the tip");
                     in.require(
                         heights == places, "heights",
                         fmt::format("must be one height for each position, but there are {} for {} positions", heights, places));
                   }};
  }();
  return &keys;
}

template <std::optional<Anchor> Beam::*member>
const Section* anchor_keys() {
  using OfAnchor = Of<anchor<member>>;
  static const Section keys{
      .name = "anchor",
      .keys = {OfAnchor::template number<&Anchor::rotation>("rotation", dimension::rotational_stiffness, not_negative,
                                                            "rotational stiffness, moment per angle; absent: rigid"),
               OfAnchor::template number<&Anchor::translation>("translation", dimension::stiffness, not_negative,
                                                               "translational stiffness, force per deflection; absent: rigid")},
      .about = "how an end of the beam is held",
      .check = [](Scene&, const SectionReader& in, std::size_t) {
        if (!in.has_value("rotation") && !in.has_value("translation"))
          in.fail("needs rotation, translation or both; one that is not given is rigid");
      }};
  return &keys;
}

template <std::optional<Anchor> Beam::*member>
Key anchor_key(std::string_view name, std::vector<std::string_view> words, std::string_view about) {
  Key key{.name = name,
          .type = KeyType::table,
          .words = std::move(words),
          .about = about,
          .like = "{ rotation = \"1e-7 N m/rad\" }",
          .part = anchor_keys<member>};
  key.bound.choose = [](Scene& scene, std::size_t number, std::string_view word) {
    anchor<member>(scene, number) = word == "free" ? free_end : Anchor{};
  };
  return key;
}

}  // namespace

std::vector<Key> beam_part_keys() {
  return {{.name = "sections",
           .type = KeyType::tables,
           .instead_of = {"length"},
           .about = "sections of the beam, in order from x = 0",
           .like = "[{ length = \"60 um\", width = \"10 um\" }, { length = \"190 um\", width = [\"40 um\", \"20 um\"] }]",
           .part = section_keys},
          {.name = "layers",
           .type = KeyType::tables,
           .about = "layers on the faces of the beam, whose far end must be free; a later layer on the same face lies outside",
           .like = "[{ face = \"far\", span = [\"0 um\", \"tip\"], thickness = \"0.2 um\", youngs_modulus = \"70 GPa\", "
                   "density = \"2200 kg/m^3\" }]",
           .part = layer_keys},
          anchor_key<&Beam::anchor>("anchor", {"clamped"}, "anchor at x = 0; absent: clamped"),
          anchor_key<&Beam::far_anchor>("far_anchor", {"free", "clamped"}, "anchor of the far end; absent: according to kind"),
          {.name = "rest_shape",
           .type = KeyType::table,
           .instead_of = {"stress_gradient"},
           .about = "shape of the released beam as it was measured: straight lines between "
                    "heights at positions along it; absent: straight",
           .like = "{ positions = [\"0 um\", \"50 %\", \"tip\"], heights = [\"0 nm\", \"20 nm\", \"80 nm\"] }",
           .part = rest_shape_keys}};
}

std::vector<Advice> part_advice() {
  constexpr std::string_view sections =
      "'sections' describes a beam whose width, thickness or material changes along it, "
      "such as a hinge narrower than the plate: sections = [{ length = \"60 um\", width = \"10 um\" }, { length = \"190 um\", "
      "width = \"40 um\" }]";
  constexpr std::string_view layers = "'layers' describes films on the faces of a beam, with their stress";
  constexpr std::string_view holes =
      "holes stand in a section: sections = [{ length = \"250 um\", holes = { pitch = \"20 um\", size = \"8 um\" } }]";
  constexpr std::string_view anchor =
      "'anchor' and 'far_anchor' describe compliant ends: anchor = { rotation = \"1e-7 N m/rad\" }";
  constexpr std::string_view shape = "'stress_gradient' and 'rest_shape' describe a beam that is not straight at rest";
  return {{"hinge", sections}, {"taper", sections},  {"plate_w", sections}, {"plate_t", sections}, {"plate_l", sections},
          {"film", layers},    {"coating", layers},  {"hole", holes},       {"perforat", holes},   {"spring", anchor},
          {"support", anchor}, {"complian", anchor}, {"curl", shape},       {"curvature", shape},  {"bow", shape},
          {"warp", shape},     {"height", shape}};
}

}  // namespace softland::internal
