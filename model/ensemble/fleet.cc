#include "model/ensemble/fleet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <memory>

#include "base/require.h"
#include "model/closing/tolerances.h"
#include "model/ensemble/lane_closing.h"

namespace softland {
namespace {

using fleet::LaneClosing;
using fleet::LaneLayout;
using fleet::LaneSwitch;
using fleet::Segment;

constexpr auto to_int = [](auto n) { return static_cast<int>(n); };

std::optional<fleet::LaneFringing> lane_fringing(Fringing fringing) {
  switch (fringing) {
    case Fringing::none:
      return fleet::LaneFringing::none;
    case Fringing::linear:
      return fleet::LaneFringing::linear;
    case Fringing::meijs_fokkema:
      return fleet::LaneFringing::meijs_fokkema;
    case Fringing::bao_2001:
      break;
  }
  return std::nullopt;
}

/// Points up to each end of an electrode, by the electrode that they lie over.
LaneLayout layout_of(const Switch& model) {
  const Device& device = model.device();
  LaneLayout layout{.points = to_int(model.points()),
                    .electrodes = to_int(device.electrodes.size()),
                    .piezo = model.has_piezo(),
                    .film = model.gas().has_value()};
  if (!device.electrodes.empty()) layout.fringing = *lane_fringing(device.electrodes.front().fringing);
  std::vector<std::pair<Stretch, int>> pads;  // with the electrode of each
  for (const Electrode& e : device.electrodes) {
    for (const Stretch& pad : e.pads(device.structure.length)) pads.emplace_back(pad, to_int(&e - device.electrodes.data()));
  }
  const auto over = [&](double x) {
    const auto found = std::ranges::find_if(pads, [&](const auto& one) { return one.first.holds(x); });
    return found == pads.end() ? -1 : found->second;
  };
  for (int p = 0; p < layout.points; ++p) {
    const int electrode = over(model.point_positions()[p]);
    if (p == 0 || layout.segment[layout.segments - 1].electrode != electrode)
      layout.segment[layout.segments++] = {.begin = p, .electrode = electrode};
    layout.segment[layout.segments - 1].end = p + 1;
  }
  return layout;
}

// Interference at which the contact has stored this little, far below the height of its asperities [m].
double depth_of_energy(const UniformAsperityContact& law, double energy) {
  return law.height * std::pow(energy / law.energy(law.height), 2.0 / 7);
}

LaneSwitch numbers_of(const Switch& model, double tolerance) {
  const Device& device = model.device();
  const auto& contact = std::get<UniformAsperityContact>(model.contact());
  LaneSwitch s{.modes = model.modes(),
               .open = device.gap.electrode,
               .plane = device.gap.contact,
               .floor = model.gap_floor(),
               .width = device.structure.width,
               .thickness = device.structure.thickness,
               .strength = contact.strength,
               .height = contact.height,
               .negligible_depth = depth_of_energy(contact, tolerance * model.bending_energy())};
  if (model.gas()) s.viscosity = std::get<StripSqueezeFilm>(*model.gas()).viscosity;
  std::fill_n(s.omega, fleet::most_modes, model.angular_frequencies()[0]);
  const Tolerances tolerances(model, tolerance);
  for (int i = 0; i < s.modes; ++i) {
    const auto k = static_cast<std::size_t>(i), n = static_cast<std::size_t>(s.modes);
    s.omega[i] = model.angular_frequencies()[i];
    s.at_contact[i] = model.contact_shape()[i];
    s.piezo[i] = model.piezo_shape()[i];
    s.friction[i] = 2 * device.structure.damping_ratio * s.omega[i];
    s.flying[i] = tolerances.in_flight[k], s.touching[i] = tolerances.touching[k], s.speed[i] = tolerances.in_flight[n + k];
    for (Eigen::Index p = 0; p < model.points(); ++p) s.shape[p][i] = model.point_shapes()(p, i);
  }
  for (Eigen::Index p = 0; p < model.points(); ++p) s.weight[p] = model.point_weights()[p];
  return s;
}

const UniformAsperityContact& contact_of(const FleetClosing& closing) {
  return std::get<UniformAsperityContact>(closing.model->contact());
}

// [m]
double steady_depth(const FleetClosing& closing) {
  return closing.steady_force > 0 ? contact_of(closing).interference(closing.steady_force)
                                  : std::numeric_limits<double>::infinity();
}

/// Passes on what a lane tells, with force and energy of the contact's law.
class Teller final : public fleet::LaneObserver {
 public:
  explicit Teller(const FleetClosing& closing) : law_(&contact_of(closing)), observer_(closing.observer) {}
  void touch(double begin, double end, double speed, double depth) override {
    observer_->touch({.begin = begin,
                      .end = end,
                      .impact_velocity = speed,
                      .peak_force = law_->force(depth),
                      .peak_energy = law_->energy(depth)});
  }
  void rebound(double begin, double end, double height) override { observer_->rebound(begin, end, height); }

 private:
  const UniformAsperityContact* law_;
  LandingObserver* observer_;
};

fleet::LaneRunner runner(Vectors vectors) {
#ifdef SOFTLAND_LANES
  if (vectors == Vectors::avx512) return fleet::run_avx512;
  if (vectors == Vectors::avx2) return fleet::run_avx2;
#else
  static_cast<void>(vectors);
#endif
  return nullptr;
}

}  // namespace

bool has(Vectors vectors) {
#ifdef SOFTLAND_LANES
  __builtin_cpu_init();
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
  if (vectors == Vectors::avx2) return avx2;
  if (vectors == Vectors::avx512) {
    return avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd");
  }
#endif
  return vectors == Vectors::none;
}

Vectors vectors_in_use() {
  constexpr const char* variable = "SOFTLAND_VECTORS";
  const char* asked = std::getenv(variable);
  if (asked == nullptr || *asked == '\0') {
    for (const Vectors widest : {Vectors::avx512, Vectors::avx2})
      if (has(widest)) return widest;
    return Vectors::none;
  }
  for (const VectorsRow& row : vector_instructions) {
    if (row.name != asked) continue;
    require(has(row.value),
            [&] { return fmt::format("{} = {}: this processor, or this build, does not have them", variable, asked); });
    return row.value;
  }
  throw InvalidInput(fmt::format("{} = {}: must be none, avx2 or avx512", variable, asked));
}

std::string why_not_in_lanes(const Switch& model) {
  const Device& device = model.device();
  if (model.modes() > fleet::most_modes) return fmt::format("more than {} modes", fleet::most_modes);
  if (model.points() > fleet::most_points) return fmt::format("more than {} quadrature points", fleet::most_points);
  if (model.drives() > fleet::most_drives) return fmt::format("more than {} drives", fleet::most_drives);
  if (device.dispersion) return "a dispersion force";
  if (device.structure.kind == StructureKind::clamped_clamped && device.structure.stretching) return "mid-plane stretching";
  if (!model.has_contact() || model.has_pad_contact() || !std::holds_alternative<UniformAsperityContact>(model.contact()))
    return "a contact other than undamped asperity-uniform at the contact point";
  if (model.gas() &&
      (model.film_states() > 0 || !std::isnan(device.gas->far_gap) || !std::holds_alternative<StripSqueezeFilm>(*model.gas())))
    return "a gas film other than strip on the near side";
  for (const Electrode& e : device.electrodes) {
    if (e.side != Side::near) return "an electrode on the far side";
    if (e.fringing != device.electrodes.front().fringing) return "electrodes of different fringing";
    if (!lane_fringing(e.fringing)) return "fringing by bao-2001";
  }
  const bool is_plate = device.structure.kind == StructureKind::plate;  // whose electrodes lie over the same points
  if ((is_plate && device.electrodes.size() > 1) || electrode_conflict(device.structure, device.electrodes))
    return "electrodes that overlap";
  return {};
}

/// Whether a drive is more than straight lines and sines.
bool has_terms(std::span<const Signal> drives) {
  return std::any_of(drives.begin(), drives.end(), [](const Signal& drive) {
    return std::any_of(drive.pieces().begin(), drive.pieces().end(),
                       [](const SignalPiece& piece) { return !piece.terms.empty(); });
  });
}

std::vector<FleetEnd> close_in_lanes(std::span<const FleetClosing> closings, double tolerance, Vectors vectors) {
  std::vector<FleetEnd> ends(closings.size());
  const fleet::LaneRunner run = runner(vectors);
  if (run == nullptr) return ends;

  std::optional<LaneLayout> layout;
  std::vector<std::size_t> places;     // of those that run
  std::vector<Eigen::VectorXd> rests;  // from which they start
  for (std::size_t i = 0; i < closings.size(); ++i) {
    if (!why_not_in_lanes(*closings[i].model).empty() || has_terms(closings[i].drives)) continue;
    const std::optional<Eigen::VectorXd> rest = closings[i].model->open_equilibrium(values_before(closings[i].drives));
    if (!rest) continue;
    const LaneLayout own = layout_of(*closings[i].model);
    if (!layout) layout = own;
    if (*layout != own) continue;
    places.push_back(i);
    rests.push_back(*rest);
  }
  if (places.empty()) return ends;

  std::vector<LaneSwitch> switches;
  std::vector<Teller> tellers;
  std::vector<LaneClosing> followed(places.size());
  std::vector<std::vector<double>> longest;  // steps, piece by piece
  switches.reserve(places.size()), tellers.reserve(places.size()), longest.reserve(places.size() * fleet::most_drives);
  for (std::size_t n = 0; n < places.size(); ++n) {
    const FleetClosing& c = closings[places[n]];
    switches.push_back(numbers_of(*c.model, tolerance));
    tellers.emplace_back(c);
    LaneClosing& lane = followed[n];
    lane = {.numbers = &switches.back(),
            .duration = c.duration,
            .after_contact = c.after_contact,
            .no_end_before = c.no_end_before,
            .no_contact_before = c.no_contact_before,
            .steady_depth = steady_depth(c),
            .observer = &tellers.back()};
    std::copy(rests[n].begin(), rests[n].end(), lane.start);
    for (std::size_t k = 0; k < c.drives.size(); ++k) {
      const std::vector<SignalPiece>& pieces = c.drives[k].pieces();
      lane.pieces[k] = pieces.data();
      lane.piece_count[k] = to_int(pieces.size());
      std::vector<double>& steps = longest.emplace_back();
      for (const SignalPiece& piece : pieces) steps.push_back(c.drives[k].resolving_step(piece.begin));
      lane.longest_step[k] = steps.data();
    }
  }
  run(*layout, followed.data(), followed.size());
  for (std::size_t n = 0; n < places.size(); ++n) {
    const LaneClosing& lane = followed[n];
    ends[places[n]] = {.followed = lane.followed,
                       .time = lane.end,
                       .steady_force_time = lane.steady_from,
                       .least_force_after_touch = contact_of(closings[places[n]]).force(lane.least_depth)};
  }
  return ends;
}

}  // namespace softland
