// Pull-in voltages that are found once and remembered: many points of an exploration have the same switch and differ only in
// what drives it.
#pragma once

#include <deque>
#include <future>
#include <map>
#include <mutex>
#include <string>

#include "studies/closing/prepared.h"

namespace softland {

class PullInMemory {
 public:
  /// Finds those of the switch that `scene` describes, which must be the one it is then called for, in the memory where another
  /// scene has left them: one that differs only in waveforms (but for what the other drives stand at), limits of the drivers,
  /// window and what is reported. May be called on any thread; one that needs what another is just computing waits for it. The
  /// memory must live as long.
  [[nodiscard]] PullInFinder finder(const SceneFile& scene);

 private:
  [[nodiscard]] ElectrodePullIn find(const std::string& switch_text, const Switch& model, std::size_t electrode, Bias bias,
                                     const Watch& watch);

  // The oldest are forgotten: a plan comes to the points of one switch together, or again after those of a thousand others.
  static constexpr std::size_t most_remembered = 16384;
  std::mutex mutex_;
  std::map<std::string, std::shared_future<ElectrodePullIn>> known_;
  std::deque<std::string> order_;
};

}  // namespace softland
