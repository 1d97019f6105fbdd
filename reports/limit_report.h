// What `softland limit` found: JSON with SI units in the names, a table for a terminal, and a picture.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "reports/result_maker.h"
#include "studies/search/limit.h"

namespace softland {

[[nodiscard]] nlohmann::json limit_json(const Limit& limit, const Provenance& provenance);
[[nodiscard]] std::string limit_text(const Limit& limit);
/// The landing's gap and waveforms, and the least time against the peak voltage and against the permitted speed, as far as they
/// were found.
[[nodiscard]] std::string limit_svg(const Limit& limit);

}  // namespace softland
