#include <algorithm>

#include "config/schema/laws.h"
#include "config/schema/sections.h"
#include "config/section_reader.h"
#include "model/gas/gas_law.h"

namespace softland::internal {
namespace {

Gas& gas(Scene& scene, std::size_t) { return *scene.device.gas; }

std::vector<Key> gas_keys() {
  std::vector<Key> keys = keys_of_laws<Gas, gas>("law of the squeeze film; linear: a constant damper");
  std::ranges::find(keys, "damping", &Key::name)
      ->dimensions.push_back(dimension::damping);  // a plate may give the damping of the whole plate [N s/m]
  return keys;
}

void check_gas(Scene& scene, const SectionReader& in, std::size_t) {
  const Structure& moving = scene.device.structure;
  if (in.has_value("damping") && in.quantities("damping").front().dimension == dimension::damping) {
    in.require(moving.is_rigid(), "damping", "is in N s/m, as for a whole plate: give it per length of the beam, in N s/m^2");
    std::get<LinearGas>(*scene.device.gas).damping /= moving.length;
  }
  if (!in.is_given("quality_factor")) in.require_of_structure("model", "width", moving);
  if (limits_of(*scene.device.gas).needs_thickness) in.require_of_structure("model", "thickness", moving);
}

}  // namespace

Section gas_section() {
  return {.name = "gas",
          .may_vary = true,
          .selector = "model",
          .keys = gas_keys(),
          .about = "gas between beam and electrode; absent: none",
          .begin =
              [](Scene& scene, const SectionReader& in, std::string_view) {
                scene.device.gas = law_of<Gas>(in);
                return std::size_t{0};
              },
          .check = check_gas};
}

}  // namespace softland::internal
