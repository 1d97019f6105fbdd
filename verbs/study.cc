#include "verbs/study.h"

#include <fmt/format.h>

#include <algorithm>

namespace softland::verbs {

Ending ending_of(Status status) {
  switch (status) {
    case Status::interrupted:
      return Ending::interrupted;
    case Status::numerical_failure:
      return Ending::numerical_failure;
    case Status::no_contact:
    case Status::collapsed_at_rest:
    case Status::collapsed_onto_electrode:
      return Ending::no_success;
    default:
      return Ending::done;
  }
}

std::string Study::keyword(std::string_view option) const {
  const auto row = std::ranges::find(options, option, &OptionRow::name);
  return row == options.end() ? keyword_of(option) : row->keyword;
}

const std::vector<Study>& scene_studies() {
  static const std::vector<Study> all{check_study(),   pull_in_study(), effects_study(),    accuracy_study(), limit_study(),
                                      release_study(), cycle_study(),   robustness_study(), fit_study(),      calibrate_study()};
  return all;
}

const std::vector<Study>& all_studies() {
  static const std::vector<Study> all = [] {
    std::vector<Study> studies{simulate_study(), optimize_study(), explore_study()};
    studies.insert(studies.end(), scene_studies().begin(), scene_studies().end());
    for (Study (*one)() : {tune_study, device_study, export_study}) studies.push_back(one());
    return studies;
  }();
  return all;
}

const Study& study_named(std::string_view name) {
  const auto found = std::ranges::find_if(all_studies(), [&](const Study& one) { return one.name == name; });
  require(found != all_studies().end(), [&] { return fmt::format("unknown verb '{}'", name); });
  return *found;
}

}  // namespace softland::verbs
