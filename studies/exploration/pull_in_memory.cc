#include "studies/exploration/pull_in_memory.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <exception>
#include <utility>

namespace softland {

PullInFinder PullInMemory::finder(const SceneFile& scene) {
  SceneFile same = scene;
  for (const char* path : {"title", "waveform", "driver", "metrics", "spread", "calibration", "simulate.duration"})
    same.erase(path);
  return [this, text = same.text()](const Switch& model, std::size_t electrode, Bias bias, const Progress& progress) {
    return find(text, model, electrode, bias, progress);
  };
}

ElectrodePullIn PullInMemory::find(const std::string& switch_text, const Switch& model, std::size_t electrode, Bias bias,
                                   const Progress& progress) {
  std::string key = fmt::format("{}{} {}", switch_text, electrode, fmt::join(bias, " "));
  std::promise<ElectrodePullIn> mine;
  {
    std::unique_lock lock(mutex_);
    if (const auto found = known_.find(key); found != known_.end()) {
      const std::shared_future<ElectrodePullIn> known = found->second;
      lock.unlock();
      return known.get();
    }
    known_.emplace(key, mine.get_future().share());
    order_.push_back(std::move(key));
    if (order_.size() > most_remembered) {
      known_.erase(order_.front());
      order_.pop_front();
    }
  }
  try {
    const ElectrodePullIn found = electrode_pull_in(model, electrode, bias, progress);
    mine.set_value(found);
    return found;
  } catch (...) {
    mine.set_exception(std::current_exception());
    throw;
  }
}

}  // namespace softland
