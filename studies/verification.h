// What of a search's candidates is believed: none before its run over the whole window, nor preferred where a tighter integrator
// or a richer beam undoes its landing.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "studies/optimize.h"
#include "studies/search_setting.h"

namespace softland {

/// Of the integrator, in a run that confirms another.
inline constexpr double tight_tolerance = 1e-9;
/// The richer beam of a run that confirms another; none of a plate, which has one mode.
[[nodiscard]] std::optional<Device> with_more_modes(Device device);

/// Verifies candidates, and keeps the best.
class Verification {
 public:
  /// Keeps references to `setting`.
  Verification(const SearchSetting& setting, const OptimizeOptions& options);

  /// A candidate of a family, by its number, as a scene file, with its parameters by drive.name.
  void add(const SceneFile& text, double cost, std::size_t family, std::map<std::string, double> parameters);
  /// The cost of the best so far; infinite where there is none.
  [[nodiscard]] double best_cost() const;
  /// Whether the best was confirmed by a tighter integrator and a richer beam.
  [[nodiscard]] bool confirmed() const { return best_ && best_->belief == Belief::confirmed; }
  /// Whether no candidate that costs as much or more can be better.
  [[nodiscard]] bool decided(double cost) const;
  /// The family of the best; none where there is no candidate.
  [[nodiscard]] std::optional<std::size_t> family() const;
  /// Hands the winner over, where there is one.
  void move_to(OptimizeResult& result);

 private:
  // How far a candidate is believed.
  enum class Belief { touches, settles, lands, meets_goal, confirmed };

  // A candidate after its run over the whole window, as its file says, at the accuracy the scene asks for.
  struct Verified {
    Prepared scene;
    Closing closing;
    std::vector<ConfirmingRun> checks;
    std::size_t family = 0;
    std::map<std::string, double> parameters;
    double cost = 0;
    double figure = 0;  // the target's own; rebounds that are not significant are equal
    double broken = 0;  // by how much it breaks the conditions
    Belief belief = Belief::touches;

    [[nodiscard]] bool better_than(const Verified& other) const;
  };

  [[nodiscard]] bool met(const Metrics& m) const;
  [[nodiscard]] std::vector<Criterion> known(const Metrics& m) const;

  const Prepared& given_;
  const Metrics& baseline_;
  Aim target_;
  std::vector<Criterion> conditions_;
  Watch watch_;
  std::optional<Verified> best_;
};

}  // namespace softland
