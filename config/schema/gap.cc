#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "config/schema/sections.h"
#include "config/section_reader.h"

namespace softland::internal {
namespace {

Gap& gap(Scene& scene, std::size_t) { return scene.device.gap; }
using OfGap = Of<gap>;

/// Returns true for a plate whose electrodes all have a dielectric: the plate may then close onto the dielectric.
bool may_land(const Structure& structure, const SceneFile::Impl& file) {
  const std::vector<std::string> electrodes = file.names_in("electrode");
  return structure.is_rigid() && !electrodes.empty() && std::ranges::all_of(electrodes, [&](const std::string& name) {
           return file.find({"electrode", name, "dielectric"}) != nullptr;
         });
}

/// Returns true if the beam of the scene closes on the face of a dielectric.
bool has_landing(const SceneFile::Impl& file) {
  return std::ranges::any_of(file.names_in("electrode"), [&](const std::string& name) {
    return file.find({"electrode", name, "dielectric", "landing"}) != nullptr;
  });
}

void check_gap(Scene& scene, const SectionReader& in, std::size_t) {
  const Gap& gap = scene.device.gap;
  if (in.file().is_named(*find_section("contact"))) {
    static_cast<void>(in.file().names_in("contact"));  // throws InvalidInput for [contact] together with [contact.NAME]
    in.require(!in.is_given("contact"), "contact", "belongs to a single [contact]: every [contact.NAME] has its own gap");
    return;
  }
  if (has_landing(in.file())) return;  // check_landing() sets the contact gap to the rest distance of the dielectric's face
  if (!in.is_given("contact")) in.fail(R"(missing key 'contact' (a length such as "2 um"))");
  if (gap.contact <= gap.electrode && may_land(scene.device.structure, in.file())) {
    in.require(!scene.device.closes_on_dielectric() || in.file().find({"dispersion"}) == nullptr, "contact",
               "a plate that lands on a dielectric must not have a dispersion force: remove [dispersion]");
    return;
  }
  in.require(gap.contact < gap.electrode, "contact", "must be less than " + in.written("electrode"));
  // Largest contact gap as a share of the electrode gap. A simulation fails if the gap falls below 1/100 of the electrode gap:
  // see Switch::gap_floor().
  constexpr double most = 0.99;
  in.require(gap.contact < most * gap.electrode, "contact",
             fmt::format("must be less than {:g} times {}: force laws do not hold below 1/100 of that gap", most,
                         in.written("electrode")));
}

}  // namespace

Section gap_section() {
  return {.name = "gap",
          .required = true,
          .may_vary = true,
          .keys = {OfGap::number<&Gap::electrode>("electrode", dimension::length, positive, "rest gap between beam and electrode")
                       .needed(),
                   OfGap::number<&Gap::contact>(
                       "contact", dimension::length, positive,
                       "rest gap between contact point and contact plane; required, "
                       "but not for [contact.NAME], which has its own, nor for a dielectric with a landing")},
          .about = "gaps at rest",
          .begin = [](Scene&, const SectionReader&, std::string_view) { return std::size_t{0}; },
          .check = check_gap};
}

}  // namespace softland::internal
