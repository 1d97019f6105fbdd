// What of a search's candidates is believed: none before its run over the whole window, nor preferred where a tighter integrator
// or a richer beam undoes its landing. A plain step that lands is a candidate, too, so that no winner is then harder than it. The
// best is, among those that stand up to all this, the one whose worst is best.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "studies/search/optimize.h"
#include "studies/search/search_setting.h"

namespace softland {

/// What a search came upon.
struct FoundWaveform {
  PreparedScene scene;  ///< as its file says
  double cost = 0;
  std::string family;
  std::vector<Variable> variables;           ///< of the family
  std::map<std::string, double> parameters;  ///< by drive.name; empty where the family cannot describe it
  bool is_plain_step = false;
};

/// Verifies candidates, and keeps the best.
class Verification {
 public:
  /// Keeps references to `setting`.
  Verification(const SearchSetting& setting, const OptimizeOptions& options);

  void add(FoundWaveform candidate);
  /// The cost of the best so far, by the worst of beams where it is confirmed; infinite where there is none.
  [[nodiscard]] double best_cost() const;
  /// Whether the best was confirmed by a tighter integrator and a richer beam.
  [[nodiscard]] bool confirmed() const { return best_ && best_->belief == Belief::confirmed; }
  /// Whether no candidate that costs as much or more can be better.
  [[nodiscard]] bool decided(double cost) const;
  /// Whether the best meets its goal with the modes of the scene, and not with more of them.
  [[nodiscard]] bool belongs_to_modes() const { return best_ && best_->failed == Varied::modes; }
  /// Hands the winner over, where there is one.
  void move_to(OptimizeResult& result);

 private:
  // How far a candidate is believed.
  enum class Belief { touches, settles, lands, meets_goal, confirmed };

  // A candidate after its run over the whole window, at the accuracy the scene asks for.
  struct Verified {
    FoundWaveform found;
    Closing closing;
    double cost = 0;    // the search's own; of what is confirmed the worst of beams
    double figure = 0;  // the target's own; rebounds that are not significant are equal
    double broken = 0;  // by how much it breaks the conditions
    double excess = 0;  // by how much it is harder than the plain step, as a share of the step's figures
    Belief belief = Belief::touches;
    std::optional<Varied> failed = {};  // what meets the goal no more, where this is varied

    [[nodiscard]] bool better_than(const Verified& other) const;
  };

  [[nodiscard]] bool met(const Metrics& m) const;
  [[nodiscard]] double excess(const Metrics& m) const;
  [[nodiscard]] std::optional<Varied> undone_by(const PreparedScene& scene) const;
  [[nodiscard]] std::vector<Criterion> known(const Metrics& m) const;

  const SearchSetting worst_;  // prices candidates by the worst of beams
  const PreparedScene& given_;
  const Metrics& baseline_;
  Aim target_;
  std::vector<Criterion> conditions_;
  bool judges_hardness_;  // an own objective does not, nor conditions that the plain step breaks
  Watch watch_;
  std::optional<Verified> best_;
};

}  // namespace softland
