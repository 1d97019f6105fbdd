#include "verbs/study.h"

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

const std::vector<Study>& all_studies() {
  static const std::vector<Study> all{check_study(),   pull_in_study(),    effects_study(), accuracy_study(), limit_study(),
                                      release_study(), robustness_study(), fit_study(),     calibrate_study()};
  return all;
}

}  // namespace softland::verbs
