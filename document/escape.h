// Escaping makes text from scene files and command lines safe inside HTML, SVG and scripts.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace softland::internal {

/// Writes & < > " ' as entities, so that the text is safe in elements and quoted attributes of HTML and XML. Control
/// characters, which XML forbids, become the escapes of printable().
[[nodiscard]] std::string escaped(std::string_view text);

/// Returns JSON for the inside of `<script type="application/json">`: every `<` is written `\u003c`, so that neither `</script`
/// nor `<!--` can occur. Bytes that are not UTF-8 become U+FFFD.
[[nodiscard]] std::string script_json(const nlohmann::json& value);

}  // namespace softland::internal
