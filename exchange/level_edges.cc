#include "exchange/level_edges.h"

#include <cstddef>

namespace softland {
namespace {

// Leaves out what lasts for less than `least` from an edge to `state` on.
void merge_short(std::vector<LevelEdge>& edges, bool state, double least) {
  std::vector<LevelEdge> kept;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const bool is_short = edges[k].closed == state && k + 1 < edges.size() && edges[k + 1].time - edges[k].time < least;
    if (is_short) {
      ++k;  // its end
    } else {
      kept.push_back(edges[k]);
    }
  }
  edges = std::move(kept);
}

}  // namespace

std::vector<LevelEdge> level_edges(const Trace& trace, const ThresholdKeys& keys) {
  const double sign = keys.is_closed_below ? -1 : 1;
  const auto beyond = [&](std::size_t i) { return sign * (trace.values[i] - keys.threshold); };
  std::vector<LevelEdge> edges;
  bool closed = false;
  double crossing = 0;
  for (std::size_t i = 0; i < trace.times.size(); ++i) {
    const double now = beyond(i), before = i == 0 ? now : beyond(i - 1);
    if (i == 0) {
      crossing = trace.times[0];
    } else if ((now > 0) != (before > 0)) {
      crossing = trace.times[i - 1] + (trace.times[i] - trace.times[i - 1]) * before / (before - now);
    }
    const bool changes = closed ? now <= -keys.hysteresis / 2 : now > 0 && now >= keys.hysteresis / 2;
    if (!changes) continue;
    closed = !closed;
    edges.push_back({.time = crossing, .closed = closed});
  }
  merge_short(edges, false, keys.merge);
  merge_short(edges, true, keys.merge);
  return edges;
}

}  // namespace softland
