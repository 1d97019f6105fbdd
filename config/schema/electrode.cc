#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/engineering.h"
#include "config/schema/laws.h"
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

Landing& landing(Scene& scene, std::size_t k) {
  std::optional<Landing>& one = dielectric(scene, k).landing;
  if (!one) one.emplace();
  return *one;
}
using OfLanding = Of<landing>;

// The keys of the asperities are set in any order, so the setter of each key creates the asperities if they do not exist.
UniformAsperities& asperities(Scene& scene, std::size_t k) {
  std::optional<UniformAsperities>& one = landing(scene, k).asperities;
  if (!one) one.emplace();
  return *one;
}

/// Returns the keys of asperities on the face of the dielectric: those of an asperity contact without its damping.
std::vector<Key> asperity_keys() {
  std::vector<Key> keys;
  const auto add = [&]<std::size_t i>(std::integral_constant<std::size_t, i>) {
    static constexpr const Field<UniformAsperities>& field = fields_of<UniformAsperities>[i];
    if (field.key == "damping") return;
    Key key = described(field);
    key.bound.number = [](Scene& scene, std::size_t k) -> double& { return field.in(asperities(scene, k)); };
    keys.push_back(std::move(key).of({UniformAsperities::name}));
  };
  [&]<std::size_t... i>(std::index_sequence<i...>) { (add(std::integral_constant<std::size_t, i>()), ...); }
  (std::make_index_sequence<fields_of<UniformAsperities>.size()>());
  return keys;
}

const Section* landing_keys() {
  static const Section keys = [] {
    Key model = one_of("model", {"wall", "linear", UniformAsperities::name},
                       "law of the face; wall: it does not yield; linear: springs distributed on the face; "
                       "asperity-uniform: summits on the face")
                    .needed();
    model.bound.choose = [](Scene& scene, std::size_t k, std::string_view) { static_cast<void>(landing(scene, k)); };
    Key stiffness = OfLanding::number<&Landing::stiffness>("stiffness", dimension::stress_gradient, positive,
                                                           "pressure on the face per depth of indentation, such as 1e17 Pa/m")
                        .needed()
                        .such_as("1e17 Pa/m");
    Key from = OfLanding::number<&Landing::from>("from", dimension::length, not_negative,
                                                 "height above the face at which the pressure begins; default 0")
                   .such_as("30 nm");
    stiffness.only_for = {"linear"};
    from.only_for = {"linear"};
    Section section{.name = "landing",
                    .selector = "model",
                    .keys = {std::move(model), std::move(stiffness), std::move(from)},
                    .about = "law by which the beam lands on the face",
                    .advice = {{"damping", "the face of a dielectric dissipates no energy"},
                               {"pad", "the pad is the whole face above the electrode"}}};
    std::ranges::move(asperity_keys(), std::back_inserter(section.keys));
    return section;
  }();
  return &keys;
}

const Section* dielectric_keys() {
  static constexpr std::string_view relative_permittivity = "'permittivity' is the relative permittivity of the insulator";
  static const Section keys{
      .name = "dielectric",
      .keys = {OfDielectric::number<&Dielectric::thickness>("thickness", dimension::length, positive,
                                                            "thickness of the insulator")
                   .needed()
                   .such_as("0.2 um"),
               OfDielectric::number<&Dielectric::permittivity>("permittivity", dimension::none, {.least = 1, .most = 1e6},
                                                               "relative permittivity of the insulator")
                   .needed(),
               OfDielectric::number<&Dielectric::roughness>("roughness", dimension::length, not_negative,
                                                            "air that its summits leave where the faces touch")
                   .by_default("'0 m'"),
               OfDielectric::number<&Dielectric::charge>(
                   "charge", dimension::charge_density, any,
                   "charge per area on its face, of either sign, as after dielectric charging")
                   .by_default("'0 C/m^2'")
                   .such_as("-0.1 mC/m^2"),
               Key{.name = "landing",
                   .type = KeyType::table,
                   .about = "law by which the beam lands on its face, which is then the contact; "
                            "absent: a beam that reaches the face has failed",
                   .like = "{ model = \"wall\" }",
                   .part = landing_keys}},
      .about = "an insulator on the electrode",
      .advice = {{"eps", relative_permittivity}, {"relative", relative_permittivity}, {"constant", relative_permittivity}}};
  return &keys;
}

std::size_t begin_electrode(Scene& scene, const SectionReader&, std::string_view name) {
  scene.device.electrodes.push_back({.name = std::string(name)});
  return scene.device.electrodes.size() - 1;
}

/// Checks the keys span (of a beam) and area (of a plate). For a plate, sets begin and end so that the electrode has this area.
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
  // In a beam built of sections, the fringing field uses the thickness of each section; structure.thickness may be missing.
  const bool lacks_thickness = law.needs_thickness && std::isnan(s.thickness) && !s.is_built();
  const std::string fringing =
      fmt::format("fringing = {}{}", toml_string(law.name), in.is_given("fringing") ? "" : ", the default,");
  if (!s.is_rigid()) {
    if (lacks_thickness)
      in.fail(fmt::format("{} needs structure.thickness {}; fringing = \"linear\" does not", fringing, s.whose()));
  } else if (lacks_thickness || (law.needs_width && !structure.is_given("width"))) {
    in.fail(fmt::format("{} needs structure.width{} {}; fringing = \"none\" does not", fringing,
                        law.needs_thickness ? " and structure.thickness" : "", s.whose()));
  }
}

/// Checks the face of a dielectric on which a beam closes: the face becomes a contact of the scene.
void check_landing(Device& d, const Electrode& e, const SectionReader& in) {
  if (!e.dielectric || !e.dielectric->landing) return;
  const SectionReader gap(in.file(), "gap");
  const bool has_contacts = in.file().find({"contact"}) != nullptr;
  if (has_contacts && !in.file().is_named(*find_section("contact"))) {
    in.file().fail_section(
        "contact", "must have a name, as in [contact.tip], and a 'gap', because the face of a dielectric is a contact as well");
  }
  in.require(!has_contacts || in.file().find({"contact", std::string(face_name)}) == nullptr, "dielectric",
             fmt::format("has a landing, whose contact is called {0}: [contact.{0}] must have another name", face_name));
  in.require(in.file().find({"dispersion"}) == nullptr, "dielectric",
             "must not have a landing together with [dispersion]: remove one of them");
  const Landing& landing = *e.dielectric->landing;
  const double plane = d.gap.electrode - landing.begin();
  in.require(plane > 0, "dielectric",
             fmt::format("has a landing that begins at the beam: '{}' must be less than {}",
                         landing.asperities ? "asperity_height" : "from", gap.written("electrode")));
  if (gap.is_given("contact")) {
    gap.require(std::abs(d.gap.contact - plane) <= 1e-9 * d.gap.electrode, "contact",
                "must be omitted or " + engineering(plane, "m") + ", where the landing begins");
  }
  if (!has_contacts) d.gap.contact = plane;  // a scene with other contacts gets the face as a contact in check_metrics()
}

void check_electrode(Scene& scene, const SectionReader& in, std::size_t k) {
  Electrode& e = scene.device.electrodes[k];
  check_extent(scene.device.structure, e, in);
  check_fringing(scene.device.structure, e, in);
  in.require(!e.dielectric || e.side == Side::near, "dielectric", "belongs to an electrode on the near side alone");
  for (std::size_t i = 0; i < k; ++i) {
    const Electrode& other = scene.device.electrodes[i];
    if (e.side != Side::far && other.side != Side::far && !have_equal_landings(other, e)) in.fail(unequal_landings);
  }
  check_landing(scene.device, e, in);
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
                   "span",
                   "begin and end, rising, from the clamped end (x = 0), or a list of these for several pads; "
                   "required for beams, and only for beams"),
               number("area", {dimension::area}, positive,
                      "for plates only; absent: that of the plate, which the electrodes of one side together must not exceed"),
               OfElectrode::choice<sides, &Electrode::side>(
                   "side",
                   "side of the beam; near: that of the contact; far: pulls away from it, voltages in V; "
                   "both: one electrode with a face on either side")
                   .by_default("'near'"),
               OfElectrode::number<&Electrode::gap>(
                   "gap", dimension::length, positive,
                   "for side far or both, and required there: rest gap between the beam and the face on the far side"),
               OfElectrode::choice<fringing_laws, &Electrode::fringing>("fringing", "law of the fringing field")
                   .by_default("'meijs-fokkema'"),
               Key{.name = "dielectric",
                   .type = KeyType::table,
                   .about = "insulator on the electrode, on the near side; "
                            "all gaps of the scene are measured to its face; absent: bare metal",
                   .like = "{ thickness = \"0.2 um\", permittivity = 7.6 }",
                   .part = dielectric_keys}},
      .about = "an electrode under the beam",
      .advice = {{"permittiv", dielectric_advice}, {"nitride", dielectric_advice}, {"oxide", dielectric_advice}},
      .begin = begin_electrode,
      .check = check_electrode};
}

}  // namespace softland::internal
