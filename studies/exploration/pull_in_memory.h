// Remembers pull-in voltages, since many points of an exploration have the same switch and differ only in their drives.
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
  /// Returns a finder of the pull-in voltages of the switch of `scene`, for that switch only. The finder reuses voltages that
  /// were found for a scene with the same switch. The two scenes may differ in waveforms (except voltages of the other drives),
  /// limits of the voltage sources, simulated time and reported figures. May be called on any thread: a thread waits while
  /// another thread computes the same voltages. The finder must not outlive this object.
  [[nodiscard]] PullInFinder finder(const SceneFile& scene);

 private:
  [[nodiscard]] ElectrodePullIn find(const std::string& switch_text, const Switch& model, std::size_t electrode, Bias bias,
                                     const Progress& progress);

  // Largest number of remembered results; the oldest are dropped. An exploration computes the points of one switch one after
  // another, or after up to a thousand other points.
  static constexpr std::size_t most_remembered = 16384;
  std::mutex mutex_;
  std::map<std::string, std::shared_future<ElectrodePullIn>> known_;
  std::deque<std::string> order_;
};

}  // namespace softland
