// Progress that never runs back, whatever a computation tells of itself.
#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <utility>

namespace softland {

/// Makes of what a Watch is told (base/watch.h) something that only grows: a part that comes late, from another thread, is the
/// one before; what begins again is another round of the same name, "closing (2)".
class MonotoneProgress {
 public:
  /// The name to show, and the part of it that is done, 0 to 1.
  [[nodiscard]] std::pair<std::string, double> told(std::string_view what, double part) {
    constexpr double begins_again = 0.5;  // a part below this share of the one before
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
