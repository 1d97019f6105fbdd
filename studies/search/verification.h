// Verifies the candidates of a search by simulations over the whole window. The result must also be bounce-free with a tighter
// integrator and with more modes. A bounce-free plain step is a candidate, too, so that no result closes harder than the plain
// step. Of the candidates that pass, the result is the one whose worst closing is best.
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
  PreparedScene scene;  ///< scene with the waveform, as read back from its file
  double cost = 0;
  std::string family;
  std::vector<Variable> variables;           ///< variables of the family
  std::map<std::string, double> parameters;  ///< parameters by drive.name; empty if the family cannot describe the waveform
  bool is_plain_step = false;
};

/// Verifies candidates, and stores the best one.
class Verification {
 public:
  /// Keeps references to members of `setting`.
  Verification(const SearchSetting& setting, const OptimizeOptions& options);

  void add(FoundWaveform candidate);
  /// The cost of the best candidate so far (if it is confirmed, the worst cost over numbers of modes); infinite without
  /// candidates.
  [[nodiscard]] double best_cost() const;
  /// True if the best candidate is confirmed with a tighter integrator and with more modes.
  [[nodiscard]] bool confirmed() const { return best_ && best_->confidence == Confidence::confirmed; }
  /// True if no candidate with at least this cost can be better than the best candidate so far.
  [[nodiscard]] bool decided(double cost) const;
  /// True if the best candidate meets its goal with the modes of the scene, but not with more modes.
  [[nodiscard]] bool belongs_to_modes() const { return best_ && best_->failed == Varied::modes; }
  /// Moves the best candidate to the result, if there is one.
  void move_to(OptimizeResult& result);

 private:
  // The last test that a candidate has passed; each test includes all tests before it.
  enum class Confidence { touches, settles, lands, meets_goal, confirmed };

  // A candidate after its simulation over the whole window, at the scene's accuracy.
  struct Verified {
    FoundWaveform found;
    Closing closing;
    double cost = 0;    // cost in the search; if confirmed, the worst cost over numbers of modes
    double figure = 0;  // figure of the target; rebounds that are not significant are equal
    double broken = 0;  // sum of the violations of the conditions
    double excess = 0;  // relative excess of impact figures over those under the plain step
    Confidence confidence = Confidence::touches;
    std::optional<Varied> failed = {};  // the variation of the model under which the goal is not met

    [[nodiscard]] bool better_than(const Verified& other) const;
  };

  [[nodiscard]] bool met(const Metrics& m) const;
  [[nodiscard]] double excess(const Metrics& m) const;
  [[nodiscard]] std::optional<Varied> undone_by(const PreparedScene& scene) const;
  [[nodiscard]] std::vector<Condition> known(const Metrics& m) const;

  const SearchSetting worst_;  // setting whose cost of a candidate is the worst over numbers of modes
  const PreparedScene& given_;
  const Metrics& baseline_;
  Aim target_;
  std::vector<Condition> conditions_;
  bool judges_hardness_;  // false for the user's own objective, and if the plain step breaks a condition
  Progress progress_;
  std::optional<Verified> best_;
};

}  // namespace softland
