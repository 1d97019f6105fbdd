#include "config/schema/sections.h"

namespace softland::internal {
namespace {

MetricsOptions& metrics_options(Scene& scene, std::size_t) { return scene.metrics; }
using OfMetrics = Of<metrics_options>;

}  // namespace

Section metrics_section() {
  return {.name = "metrics",
          .always_in_force = true,
          .keys = {OfMetrics::number<&MetricsOptions::significant_rebound>("significant_rebound", dimension::length, positive,
                                                                           "a rebound counts when it is higher")
                       .by_default("'1 nm'")},
          .about = "figures of merit",
          .begin = [](Scene&, const SectionReader&, std::string_view) { return std::size_t{0}; }};
}

}  // namespace softland::internal
