#include "config/schema/sections.h"

namespace softland::internal {

Section title_section() {
  Key title = words("title", "name of the switch, one line").by_default("''");
  title.bound.text = [](Scene& scene, std::size_t) -> std::string& { return scene.title; };
  return {.name = "",
          .always_in_force = true,
          .keys = {std::move(title)},
          .begin = [](Scene&, const SectionReader&, std::string_view) { return std::size_t{0}; }};
}

}  // namespace softland::internal
