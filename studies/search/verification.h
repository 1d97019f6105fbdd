// Verifies the candidates of a search by a run over the whole window. A tighter integrator and a richer beam must not undo a
// landing. A plain step that lands is a candidate, too, so that no winner is harder than it. The best candidate is the one
// whose worst closing is best, among those that pass all this.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "studies/search/optimize.h"
#include "studies/search/search_setting.h"

namespace softland {

/// A waveform that a search found.
struct FoundWaveform {
  PreparedScene scene;  ///< scene as its file says
  double cost = 0;
  std::string family;
  std::vector<Variable> variables;           ///< variables of the family
  std::map<std::string, double> parameters;  ///< parameters by drive.name; empty if the family cannot describe it
  bool is_plain_step = false;
};

/// Verifies candidates, and keeps the best.
class Verification {
 public:
  /// Keeps references to `setting`.
  Verification(const SearchSetting& setting, const OptimizeOptions& options);

  void add(FoundWaveform candidate);
  /// The cost of the best so far, by the worst of beams if it is confirmed; infinite if no candidate was added.
  [[nodiscard]] double best_cost() const;
  /// True if the best was confirmed by a tighter integrator and a richer beam.
  [[nodiscard]] bool confirmed() const { return best_ && best_->confidence == Confidence::confirmed; }
  /// True if no candidate that costs as much or more can be better.
  [[nodiscard]] bool decided(double cost) const;
  /// True if the best meets its goal with the modes of the scene, but not with more of them.
  [[nodiscard]] bool belongs_to_modes() const { return best_ && best_->failed == Varied::modes; }
  /// Moves the winner to the result, if there is one.
  void move_to(OptimizeResult& result);

 private:
  // The tests that a candidate has passed.
  enum class Confidence { touches, settles, lands, meets_goal, confirmed };

  // A candidate after its run over the whole window, at the accuracy the scene asks for.
  struct Verified {
    FoundWaveform found;
    Closing closing;
    double cost = 0;    // the search's own cost; by the worst of beams if confirmed
    double figure = 0;  // the target's own figure; rebounds that are not significant are equal
    double broken = 0;  // violation of the conditions
    double excess = 0;  // excess over the plain step, as a share of the step's figures
    Confidence confidence = Confidence::touches;
    std::optional<Varied> failed = {};  // the variation under which the goal is not met

    [[nodiscard]] bool better_than(const Verified& other) const;
  };

  [[nodiscard]] bool met(const Metrics& m) const;
  [[nodiscard]] double excess(const Metrics& m) const;
  [[nodiscard]] std::optional<Varied> undone_by(const PreparedScene& scene) const;
  [[nodiscard]] std::vector<Condition> known(const Metrics& m) const;

  const SearchSetting worst_;  // prices candidates by the worst of beams
  const PreparedScene& given_;
  const Metrics& baseline_;
  Aim target_;
  std::vector<Condition> conditions_;
  bool judges_hardness_;  // false for an own objective, and for conditions that the plain step breaks
  Progress progress_;
  std::optional<Verified> best_;
};

}  // namespace softland
