#include "config/schema/sections.h"
#include "config/section_reader.h"

namespace softland::internal {
namespace {

SwitchedLoad& load(Scene& scene, std::size_t) { return scene.device.load; }
using OfLoad = Of<load>;

}  // namespace

Section load_section() {
  return {.name = "load",
          .keys = {OfLoad::number<&SwitchedLoad::voltage>("voltage", dimension::voltage, positive,
                                                          "open-circuit voltage of its "
                                                          "source")
                       .needed()
                       .such_as("5 V"),
                   OfLoad::number<&SwitchedLoad::resistance>("resistance", dimension::resistance, positive,
                                                             "resistance in series with the contact")
                       .needed()
                       .such_as("50 ohm")},
          .about = "the circuit that the contact switches; absent: none",
          .begin = [](Scene&, const SectionReader&, std::string_view) { return std::size_t{0}; },
          .check =
              [](Scene& scene, const SectionReader& in, std::size_t) {
                if (!scene.device.has_contact()) in.fail("needs a [contact], which switches the load");
              }};
}

}  // namespace softland::internal
