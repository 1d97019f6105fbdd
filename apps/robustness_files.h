// What a judgement of drives on devices leaves in a folder, by `robustness` or at the end of a robust search.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "apps/result_folder.h"
#include "base/watch.h"
#include "reports/robustness_report.h"

namespace softland::apps {

inline constexpr std::array<const char*, 3> robustness_files{"robustness.html", "robustness.json", "devices.csv"};

/// The scene of the worst device of the box.
[[nodiscard]] std::string box_file(std::string_view key);

/// What is known of the last drive beside its figures, `other_ways_too` at the cost of further searches; nothing where the work
/// was interrupted.
void add_details(RobustnessReport& report, bool other_ways_too, const Watch& watch);

void write_robustness(ResultFolder& folder, const RobustnessReport& report);

}  // namespace softland::apps
