#include "exchange/level_edges.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "base/require.h"

namespace softland {
namespace {

// Removes the intervals in which the contact is closed (`state` true) or open (false) for less than `least` [s].
void merge_short(std::vector<LevelEdge>& edges, bool state, double least) {
  std::vector<LevelEdge> kept;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const bool is_short = edges[k].closed == state && k + 1 < edges.size() && edges[k + 1].time - edges[k].time < least;
    if (is_short) {
      ++k;  // omit the edge at the end of the short interval as well as the edge at its begin
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

void shift_times(Trace& trace, const TimeShift& shift) {
  const double by = shift.first_is_zero ? -trace.times.front() : shift.shift;
  for (double& time : trace.times) time += by;
}

std::vector<LevelEdge> contact_edges(const std::string& file, const ContactTraceKeys& keys) {
  constexpr const char* usual = "contact";
  constexpr double between_states = 0.5;
  const Recording recording = read_recording(file, keys.file);
  ThresholdKeys contact = keys.contact;
  if (std::isnan(contact.threshold)) {
    const bool has_states = std::ranges::any_of(recording.channels, &Channel::is_state);
    require(has_states && channel_of(recording, keys.file, usual).is_state, [&] {
      return file + ": missing key 'threshold': the voltage beyond which the contact is closed, such as \"1.5 V\"";
    });
    contact.threshold = between_states;
  }
  Trace trace = trace_of(recording, keys.file, usual);
  shift_times(trace, keys.shift);
  return contact_edges(trace, contact, file);
}

std::vector<LevelEdge> contact_edges(const Trace& trace, const ThresholdKeys& keys, const std::string& name) {
  std::vector<LevelEdge> edges = level_edges(trace, keys);
  std::size_t before = 0;
  while (before < edges.size() && (edges[before].time < 0 || (before == 0 && edges[0].time <= trace.times.front()))) ++before;
  require(before == 0 || !edges[before - 1].closed, [&] {
    return fmt::format(
        "{}: the contact must be open at t = 0; closed = \"below\" if it is closed below the threshold; "
        "shift moves t = 0 to the beginning of the drives",
        name);
  });
  edges.erase(edges.begin(), edges.begin() + static_cast<std::ptrdiff_t>(before));
  return edges;
}

}  // namespace softland
