// What `softland pull-in --sweep` leaves: the points as CSV, and a picture of them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "studies/closing/sweep.h"

namespace softland {

/// "voltage_V,deflection_m,capacitance_F,branch,status" and a row to each point, every digit; branch is up or down, status that
/// of to_string(SweepState). Deflection and capacitance of a beam that lies on the electrode are not known, and empty.
[[nodiscard]] std::string sweep_csv(const std::vector<SweepPoint>& points);

/// The same as a list of objects with these keys; what is not known is null.
[[nodiscard]] nlohmann::json sweep_json(const std::vector<SweepPoint>& points);

/// Deflection and capacitance against the voltage, up and down, with the pull-in voltage marked where it is in the sweep; `of`
/// says of what, in words: "Electrode main of ...".
[[nodiscard]] std::string sweep_svg(const std::vector<SweepPoint>& points, const std::string& of, const StaticPullIn& pull_in,
                                    double release);

}  // namespace softland
