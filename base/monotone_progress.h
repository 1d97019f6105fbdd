// Progress that never decreases.
#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <utility>

namespace softland {

/// Turns the reports to a Progress (base/progress.h) into progress that only grows. A smaller part, which another thread
/// reports late, does not change the progress. A computation that begins again is shown with a count, "closing (2)".
class MonotoneProgress {
 public:
  /// Returns the name to show, and the completed part, 0 to 1.
  [[nodiscard]] std::pair<std::string, double> updated(std::string_view what, double part) {
    constexpr double begins_again = 0.5;  // a part below this share of the reported part means a new beginning
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
