#include "base/engineering.h"
#include "config/schema/sections.h"
#include "config/section_reader.h"

namespace softland::internal {
namespace {

MetricsOptions& metrics_options(Scene& scene, std::size_t) { return scene.metrics; }
using OfMetrics = Of<metrics_options>;

void check_metrics(Scene& scene, const SectionReader& in, std::size_t) {
  const double rebound = scene.metrics.significant_rebound;
  if (rebound < scene.device.gap.contact) return;
  const SectionReader gap(in.file(), "gap");
  in.require(!in.is_given("significant_rebound"), "significant_rebound", "must be less than " + gap.written("contact"));
  gap.require(false, "contact", "must exceed metrics.significant_rebound, which is " + engineering(rebound, "m"));
}

}  // namespace

Section metrics_section() {
  return {.name = "metrics",
          .always_in_force = true,
          .keys = {OfMetrics::number<&MetricsOptions::significant_rebound>("significant_rebound", dimension::length, positive,
                                                                           "a rebound counts when it is higher")
                       .by_default("'1 nm'"),
                   OfMetrics::number<&MetricsOptions::steady_force>(
                       "steady_force", dimension::none, {.least = 0, .most = 1, .least_open = true, .most_open = true},
                       "of the hold force, default 10 %: from there on the contact force is steady")
                       .such_as("10 %")},
          .about = "figures of merit",
          .begin = [](Scene&, const SectionReader&, std::string_view) { return std::size_t{0}; },
          .check = check_metrics};
}

}  // namespace softland::internal
