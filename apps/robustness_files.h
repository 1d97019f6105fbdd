// What a judgement of drives on devices leaves in a folder, by `robustness` or at the end of a robust search.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "apps/result_folder.h"
#include "reports/robustness_report.h"

namespace softland::apps {

inline constexpr std::array<const char*, 3> robustness_files{"robustness.html", "robustness.json", "devices.csv"};

/// The scene of the worst device of the box.
[[nodiscard]] std::string box_file(std::string_view key);

void write_robustness(ResultFolder& folder, const RobustnessReport& report);

}  // namespace softland::apps
