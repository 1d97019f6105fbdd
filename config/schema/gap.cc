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

/// True when every electrode has a dielectric, on which a plate may land.
bool may_land(const Structure& structure, const SceneFile::Impl& file) {
  const std::vector<std::string> electrodes = file.names_in("electrode");
  return structure.is_rigid() && !electrodes.empty() && std::ranges::all_of(electrodes, [&](const std::string& name) {
           return file.find({"electrode", name, "dielectric"}) != nullptr;
         });
}

/// True when the beam lands on the face of a dielectric.
bool has_landing(const SceneFile::Impl& file) {
  return std::ranges::any_of(file.names_in("electrode"), [&](const std::string& name) {
    return file.find({"electrode", name, "dielectric", "landing"}) != nullptr;
  });
}

void check_gap(Scene& scene, const SectionReader& in, std::size_t) {
  const Gap& gap = scene.device.gap;
  if (in.file().is_named(*find_section("contact"))) {
    static_cast<void>(in.file().names_in("contact"));  // refuses [contact] beside [contact.NAME]
    in.require(!in.is_given("contact"), "contact", "belongs to one [contact]: every [contact.NAME] has a gap of its own");
    return;
  }
  if (has_landing(in.file())) return;  // see check_landing()
  if (!in.is_given("contact")) in.fail(R"(missing key 'contact' (a length such as "2 um"))");
  if (gap.contact <= gap.electrode && may_land(scene.device.structure, in.file())) {
    in.require(!scene.device.lands_on_dielectric() || in.file().find({"dispersion"}) == nullptr, "contact",
               "a plate that lands on a dielectric takes no dispersion force");
    return;
  }
  in.require(gap.contact < gap.electrode, "contact", "must be less than " + in.written("electrode"));
  // A run has failed when it comes within a hundredth of the electrode gap of the electrode: see Switch::gap_floor().
  constexpr double most = 0.99;
  in.require(gap.contact < most * gap.electrode, "contact",
             fmt::format("must be less than {:g} times {}: nearer than a hundredth of that gap no force law holds", most,
                         in.written("electrode")));
}

}  // namespace

Section gap_section() {
  return {
      .name = "gap",
      .required = true,
      .may_vary = true,
      .keys =
          {OfGap::number<&Gap::electrode>("electrode", dimension::length, positive, "rest distance beam to electrode").needed(),
           OfGap::number<&Gap::contact>("contact", dimension::length, positive,
                                        "rest distance contact point to contact plane; not where a [contact.NAME] has its own, "
                                        "nor where a dielectric has a landing")},
      .about = "rest distances",
      .begin = [](Scene&, const SectionReader&, std::string_view) { return std::size_t{0}; },
      .check = check_gap};
}

}  // namespace softland::internal
