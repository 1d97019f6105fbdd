#include "studies/inverse/contact_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "config/scene.h"
#include "model/constants.h"
#include "model/switch.h"

namespace softland {

LaboratoryErrors usual_errors(const SceneFile& file) {
  constexpr double of_edge = 1.0 / 200, of_opening = 1.0 / 100, of_trigger = 1.0 / 48;
  const double period = 2 * pi / Switch(read_scene(file).device).basis().angular_frequencies()[0];
  LaboratoryErrors usual;
  usual.edge_error = std::min(usual.edge_error, of_edge * period);
  usual.unseen = std::min(usual.unseen, of_opening * period);
  usual.trigger_delay = std::min(usual.trigger_delay, of_trigger * period);
  return usual;
}

std::string record_fault(const ContactRecord& record, double duration) {
  if (!record.error.empty()) return {};
  if (!record.edges.empty() && record.closing_time) return "edges_s: must not stand beside closing_time_s";
  const auto late = [&](const char* key) {
    return fmt::format("{}: must be within the record, which ends at {:g} s", key, duration);
  };
  double before = 0;
  bool closed = false;
  for (const ContactEdge& edge : record.edges) {
    const bool is_first = &edge == &record.edges.front();
    if (!std::isfinite(edge.time) || edge.time < before || (is_first && edge.time == 0))
      return "edges_s: times must be finite, above 0 and in order";
    if (edge.time > duration) return late("edges_s");
    if (edge.closed == closed) return "edges_s: states must alternate, and the first edge closes the contact";
    before = edge.time, closed = edge.closed;
  }
  if (record.closing_time && !(std::isfinite(*record.closing_time) && *record.closing_time > 0))
    return "closing_time_s: must be finite and above 0";
  if (record.closing_time && *record.closing_time > duration) return late("closing_time_s");
  if (record.bounce_count && *record.bounce_count < 0) return "bounce_count: must be at least 0";
  if (record.bounce_count && *record.bounce_count > 0 && !first_touch(record))
    return "bounce_count: must be 0 for a contact that stayed open";
  if (record.loudness && !(std::isfinite(*record.loudness) && *record.loudness > 0))
    return "loudness: must be finite and above 0";
  return {};
}

std::optional<double> first_touch(const ContactRecord& record) {
  if (!record.edges.empty()) return record.edges.front().time;
  return record.closing_time;
}

std::vector<ContactOpening> openings(const ContactRecord& record) {
  std::vector<ContactOpening> all;
  for (const ContactEdge& edge : record.edges) {
    if (!edge.closed) {
      all.push_back({.begin = edge.time, .end = std::numeric_limits<double>::infinity()});
    } else if (!all.empty()) {
      all.back().end = edge.time;
    }
  }
  return all;
}

std::optional<int> bounce_count(const ContactRecord& record) {
  if (!record.edges.empty()) return static_cast<int>(openings(record).size());
  return record.bounce_count;
}

bool is_bounce_free(const ContactRecord& record) {
  return record.error.empty() && first_touch(record).has_value() && bounce_count(record) == 0;
}

}  // namespace softland
