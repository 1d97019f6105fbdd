#include "studies/closing/checking_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "base/engineering.h"
#include "base/require.h"
#include "model/gas/gas_law.h"

namespace softland {
namespace {

struct Rerun {
  CheckingRun run;
  bool keeps_gas_law = true;
};

Rerun rerun(const PreparedScene& closing, const OtherWay& way) {
  const Switch model(way.device, quadrature_of_richer(closing.quadrature, way.device));
  const std::vector<Signal> signals = closing.signals();
  const Hold hold = hold_of(model, signals);
  Trajectory t = simulate_closing(
      model, signals,
      {.duration = closing.duration, .tolerance = way.tolerance, .steady_force = hold.steady_force(closing.scene.metrics)});
  set_hold(t, hold);
  return {.run = {.name = way.name, .varied = way.varied, .metrics = metrics(t, closing.scene.metrics)},
          .keeps_gas_law =
              std::ranges::none_of(t.warnings, [](const std::string& warning) { return warning.starts_with("gas law"); })};
}

}  // namespace

std::vector<Device> with_more_modes(const Device& device) {
  constexpr std::array more = {2, 4, 6};
  constexpr int most = 20;
  std::vector<Device> richer;
  for (const int n : more) {
    if (device.structure.modes + n > std::min(most, most_modes_of(device.structure))) break;
    richer.push_back(device);
    richer.back().structure.modes += n;
  }
  return richer;
}

SwitchOptions quadrature_of_richer(SwitchOptions quadrature, const Device& device) {
  quadrature.points_per_length =
      std::max(quadrature.points_per_length, quadrature_for(1, device.structure.modes).points_per_length);
  return quadrature;
}

std::vector<OtherWay> other_numerics(const PreparedScene& closing) {
  const Device& device = closing.scene.device;
  std::vector<OtherWay> ways{{.name = "tolerance " + engineering(tight_tolerance, ""),
                              .varied = Varied::integrator,
                              .device = device,
                              .tolerance = std::min(tight_tolerance, closing.tolerance)}};
  for (Device& richer : with_more_modes(device)) {
    std::string name = fmt::format("modes {}", richer.structure.modes);
    ways.push_back(
        {.name = std::move(name), .varied = Varied::modes, .device = std::move(richer), .tolerance = closing.tolerance});
  }
  return ways;
}

std::vector<OtherWay> other_gas_laws(const PreparedScene& closing) {
  const std::array<Gas, 3> usual{StripGas{}, VeijolaGas{}, GallisTorczynskiGas{}};
  const std::optional<Gas>& own = closing.scene.device.gas;
  std::vector<OtherWay> ways;
  if (!own || std::holds_alternative<LinearGas>(*own)) return ways;
  for (const Gas& law : usual) {
    if (law.index() == own->index()) continue;
    Device device = closing.scene.device;
    device.gas = under(*own, law);
    try {
      validate(device);
    } catch (const InvalidInput&) {
      continue;
    }
    ways.push_back({.name = fmt::format("gas {}", name_of(law)),
                    .varied = Varied::gas,
                    .device = std::move(device),
                    .tolerance = closing.tolerance});
  }
  return ways;
}

CheckingRun simulated(const PreparedScene& closing, const OtherWay& way) { return rerun(closing, way).run; }

std::vector<CheckingRun> run_checks(const PreparedScene& closing) {
  std::vector<CheckingRun> runs;
  for (const OtherWay& way : other_numerics(closing)) runs.push_back(simulated(closing, way));
  for (const OtherWay& way : other_gas_laws(closing)) {
    Rerun under = rerun(closing, way);
    if (under.keeps_gas_law) runs.push_back(std::move(under.run));
  }
  return runs;
}

}  // namespace softland
