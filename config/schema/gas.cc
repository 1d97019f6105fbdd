#include <fmt/format.h>

#include "config/schema/sections.h"
#include "config/section_reader.h"
#include "model/gas/gas_law.h"

namespace softland::internal {
namespace {

Gas& gas(Scene& scene, std::size_t) { return *scene.device.gas; }
using OfGas = Of<gas>;

std::vector<std::string_view> laws_with(std::string_view key) { return with_key(gas_laws, key); }

/// A number that belongs to the laws which list it.
template <auto member>
Key gas_number(std::string_view name, const Dimension& dimension, Range range, std::string_view about) {
  return OfGas::number<member>(name, dimension, range, about).of(laws_with(name));
}

/// A plate may be given that of all of it.
Key damping() {
  Key key =
      gas_number<&Gas::damping>("damping", dimension::viscosity, positive,
                                "constant force per length and velocity [N s/m^2]; of a plate also that of all of it [N s/m]");
  key.dimensions.push_back(dimension::damping);
  return key;
}

std::vector<Key> gas_keys() {
  constexpr Range any_path{.least = 0, .most = 1e9, .least_open = true};
  return {
      OfGas::choice<gas_laws, &Gas::model>("model", "law of the squeeze film").needed(),
      gas_number<&Gas::viscosity>("viscosity", dimension::viscosity, positive, "absent: that of air at the temperature"),
      gas_number<&Gas::pressure>("pressure", dimension::pressure, positive, "ambient").by_default("'101325 Pa'"),
      gas_number<&Gas::temperature>("temperature", dimension::temperature, positive, "of the gas").by_default("'300 K'"),
      gas_number<&Gas::mean_free_path>("mean_free_path", dimension::length, any_path,
                                       "absent: from viscosity, pressure and temperature")
          .such_as("65 nm"),
      gas_number<&Gas::film_length>("film_length", dimension::length, positive,
                                    "of one film whose ends are open; absent: much longer than wide")
          .such_as("100 um"),
      gas_number<&Gas::slit_height>("slit_height", dimension::length, positive,
                                    "of the slit through which the gas leaves at one edge")
          .needed(),
      gas_number<&Gas::slit_length>("slit_length", dimension::length, positive, "of that slit, up to ambient pressure").needed(),
      gas_number<&Gas::far_gap>("far_gap", dimension::length, positive,
                                "rest thickness of a second film on the far side; absent: none"),
      damping().needed().instead("quality_factor").such_as("0.1 N s/m^2"),
      gas_number<&Gas::quality_factor>("quality_factor", dimension::none, positive, "of the first mode, instead of damping")
          .needed()
          .instead("damping"),
  };
}

void check_gas(Scene& scene, const SectionReader& in, std::size_t) {
  const Structure& moving = scene.device.structure;
  if (in.has_value("damping") && in.quantities("damping").front().dimension == dimension::damping) {
    in.require(moving.kind == StructureKind::plate, "damping",
               "is that of a whole plate: of a beam give it per length, in N s/m^2");
    scene.device.gas->damping /= moving.length;
  }
  if (!in.is_given("quality_factor")) in.require_of_plate("model", "width");
  if (row_of(gas_laws, scene.device.gas->model).needs_thickness) in.require_of_plate("model", "thickness");
}

}  // namespace

Section gas_section() {
  return {.name = "gas",
          .may_vary = true,
          .selector = "model",
          .keys = gas_keys(),
          .about = "gas between beam and electrode; absent: none",
          .begin =
              [](Scene& scene, const SectionReader&, std::string_view) {
                scene.device.gas.emplace();
                return std::size_t{0};
              },
          .check = check_gas};
}

}  // namespace softland::internal
