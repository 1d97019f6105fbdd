#include "config/schema/sections.h"
#include "config/section_reader.h"

namespace softland::internal {
namespace {

SimulateOptions& simulate_options(Scene& scene, std::size_t) { return scene.simulate; }
using OfSimulate = Of<simulate_options>;

constexpr std::string_view automatic = "auto";

}  // namespace

Section simulate_section() {
  Key effects = one_of("effects", {"all", automatic},
                       "auto: leave out effects that change t_i, v_i and B_H by at most effects_tolerance, alone and together");
  effects.bound.choose = [](Scene& scene, std::size_t, std::string_view chosen) {
    scene.simulate.automatic_effects = chosen == automatic;
  };
  constexpr Range useful{.least = 1e-14, .most = 0.1};
  return {.name = "simulate",
          .always_in_force = true,
          .keys = {OfSimulate::number<&SimulateOptions::duration>(
                       "duration", dimension::time, positive,
                       "simulated time; absent: six periods of the first mode, or four times the closing time under a step"),
                   OfSimulate::number<&SimulateOptions::open_at>(
                       "open_at", dimension::time, not_negative,
                       "time of the command to open, after which the closing is over; absent: found from the waveforms"),
                   OfSimulate::number<&SimulateOptions::accuracy>("accuracy", dimension::none, small_error,
                                                                  "relative error of t_i, v_i, B_H and the peak force")
                       .by_default("1e-06")
                       .instead("tolerance"),
                   OfSimulate::number<&SimulateOptions::tolerance>(
                       "tolerance", dimension::none, useful,
                       "relative tolerance of the integrator, which is then not tightened, instead of accuracy")
                       .instead("accuracy"),
                   std::move(effects).by_default("'all'"),
                   OfSimulate::number<&SimulateOptions::effects_tolerance>(
                       "effects_tolerance", dimension::none, small_error,
                       "relative change of t_i, v_i and B_H below which effects = auto leaves out an effect")
                       .by_default("1e-03")},
          .about = "the simulation",
          .begin = [](Scene&, const SectionReader&, std::string_view) { return std::size_t{0}; }};
}

}  // namespace softland::internal
