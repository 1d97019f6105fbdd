// Verifies the candidate waveforms of a search by simulations over the scene's whole simulated time. The result must also be
// bounce-free with a tighter integrator and with more modes. A bounce-free plain step is a candidate, too, so that no result
// closes harder than the plain step. Of the candidates that pass, the result is the one with the best worst closing over
// several numbers of modes.
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
  std::vector<Variable> variables;  ///< variables (waveform parameters with bounds) of the waveform's waveform family
  /// Waveform parameters by drive.name; empty if the waveform family cannot describe the waveform.
  std::map<std::string, double> parameters;
  bool is_plain_step = false;
};

/// Verifies candidate waveforms, and stores the best one.
class Verification {
 public:
  /// Keeps references to members of `setting`, which must outlive this object.
  Verification(const SearchSetting& setting, const OptimizeOptions& options);

  void add(FoundWaveform candidate);
  /// Returns the cost of the best candidate so far: its worst cost over several numbers of modes if confirmed, otherwise its
  /// cost in the search. Infinite without candidates.
  [[nodiscard]] double best_cost() const;
  /// True if the best candidate waveform is confirmed with a tighter integrator and with more modes.
  [[nodiscard]] bool confirmed() const { return best_ && best_->confidence == Confidence::confirmed; }
  /// True if the best candidate is confirmed and costs at most `cost`: no further candidate with this cost or more can be
  /// better.
  [[nodiscard]] bool decided(double cost) const;
  /// True if the best candidate meets its goal with the scene's number of modes, but not with more modes.
  [[nodiscard]] bool belongs_to_modes() const { return best_ && best_->failed == Varied::modes; }
  /// Moves the best candidate waveform to the result, if there is one.
  void move_to(OptimizeResult& result);

 private:
  // The last test that a candidate waveform has passed; each test includes all tests before it.
  enum class Confidence { touches, settles, bounce_free, meets_goal, confirmed };

  // A candidate waveform after its simulation over the scene's whole simulated time, at the scene's accuracy.
  struct Verified {
    FoundWaveform found;
    Closing closing;
    double cost = 0;    // cost in the search; if confirmed, worst cost over numbers of modes
    double figure = 0;  // figure of merit of the target; equal for all rebounds that are not significant
    double broken = 0;  // sum of the relative violations of the search's conditions
    double excess = 0;  // relative excess of the impact figures over those under the plain step
    Confidence confidence = Confidence::touches;
    // The change of the simulation (integrator, modes) under which the candidate misses its goal; none if it meets the goal
    // under all.
    std::optional<Varied> failed = {};

    [[nodiscard]] bool better_than(const Verified& other) const;
  };

  [[nodiscard]] bool met(const Metrics& m) const;
  [[nodiscard]] double excess(const Metrics& m) const;
  [[nodiscard]] std::optional<Varied> undone_by(const PreparedScene& scene) const;
  [[nodiscard]] std::vector<Condition> known(const Metrics& m) const;

  const SearchSetting worst_;  // setting whose cost is the worst over closings with several numbers of modes
  const PreparedScene& given_;
  const Metrics& baseline_;
  Aim target_;
  std::vector<Condition> conditions_;
  // True if a candidate is worse for closing harder than the plain step. False for a user's own objective, and if the plain
  // step violates a condition.
  bool judges_hardness_;
  Progress progress_;
  std::optional<Verified> best_;
};

// Keeps a search from closings that are bounce-free only with the number of modes in its scene. A real beam has more modes,
// which a waveform must not excite.

/// Returns the settings of a search with slower voltage edges: searched drives need at least one period of the highest mode of
/// the model from one end of their range to the other. Empty if no edge changes: for a plate, which has one mode, and if all
/// searched voltage sources have their own max_slew. Waveform families that cannot have such slow edges keep their limits.
[[nodiscard]] std::vector<SearchSetting> with_gentle_edges(const std::vector<SearchSetting>& settings, Actuator actuator,
                                                           const std::string& families, const OwnWaveforms& own = {});
/// True if the search may use slower voltage edges from its start: it varies a piezo, whose edges excite every mode, and no
/// starting waveform has quicker edges.
[[nodiscard]] bool begins_gently(const std::vector<SearchSetting>& gentle, const std::vector<StartingWaveforms>& starts);
/// Returns a setting whose cost is the worst over closings with the scene's number of modes and with more modes: see
/// with_more_modes().
[[nodiscard]] SearchSetting by_the_worst_of_modes(SearchSetting setting);

}  // namespace softland
