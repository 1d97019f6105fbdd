// Turns progress reports from several threads into a progress that never decreases.
#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <utility>

namespace softland {

/// Turns the reports to a Progress (base/progress.h) into a progress that only grows. A thread may report a smaller completed
/// part late, which then does not change the progress. A computation that begins again is shown with a count, "closing (2)".
class MonotoneProgress {
 public:
  /// Returns the name of the computation to show, and its completed part, 0 to 1.
  [[nodiscard]] std::pair<std::string, double> updated(std::string_view what, double part) {
    // A report below this share of the part shown so far means that the computation began again; a report between the two is
    // late.
    constexpr double begins_again = 0.5;
    Round& round = rounds_[std::string(what)];
    if (part < begins_again * round.part) {
      ++round.number;
      round.part = 0;
    }
    round.part = std::max(round.part, std::clamp(part, 0.0, 1.0));
    std::string name(what);
    if (round.number > 1) name += " (" + std::to_string(round.number) + ")";
    return {std::move(name), round.part};
  }

 private:
  struct Round {
    int number = 1;
    double part = 0;
  };
  std::map<std::string, Round> rounds_;
};

}  // namespace softland
