#include "model/ensemble/ensemble_closings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/require.h"
#include "model/built_beam.h"
#include "model/closing/connection.h"
#include "model/closing/force_record.h"
#include "model/closing/tolerances.h"
#include "model/contact/contact_law.h"
#include "model/ensemble/lane_closing.h"
#include "model/ensemble/lane_drives.h"
#include "model/forces/casimir.h"
#include "model/forces/dispersion.h"
#include "model/gas/gas_law.h"
#include "model/piezo_layer.h"

namespace softland {
namespace {

using simd::LaneClosing;
using simd::LaneLayout;
using simd::LanePiece;
using simd::LaneSwitch;
using simd::Segment;

constexpr auto to_int = [](auto n) { return static_cast<int>(n); };

std::optional<simd::LaneFringing> lane_fringing(Fringing fringing) {
  switch (fringing) {
    case Fringing::none:
      return simd::LaneFringing::none;
    case Fringing::linear:
      return simd::LaneFringing::linear;
    case Fringing::meijs_fokkema:
      return simd::LaneFringing::meijs_fokkema;
    default:
      return std::nullopt;
  }
}

std::optional<simd::LaneDispersion> lane_dispersion(const std::optional<Dispersion>& force) {
  if (!force) return simd::LaneDispersion::none;
  if (force->model == DispersionModel::van_der_waals) return simd::LaneDispersion::van_der_waals;
  if (force->conductor == Conductor::gold) return std::nullopt;
  return force->model == DispersionModel::casimir ? simd::LaneDispersion::casimir : simd::LaneDispersion::smaller;
}

/// A contact law of closings in SIMD lanes: the law without damping and memory, and what is added to it.
struct LaneContactLaw {
  InvertibleContactLaw elastic;
  double damping = 0;                 // damping constant [s/m]
  double loading = 0, unloading = 0;  // stiffness of a contact with memory [N/m]; 0 without memory
};
std::optional<LaneContactLaw> lane_contact(const ContactLaw& law) {
  return std::visit(
      []<class Law>(const Law& own) -> std::optional<LaneContactLaw> {
        if constexpr (InvertibleContact<Law>) return LaneContactLaw{.elastic = own};
        if constexpr (is_damped_invertible<Law>) return LaneContactLaw{.elastic = own.elastic, .damping = own.damping};
        if constexpr (std::is_same_v<Law, HystereticContact>)
          return LaneContactLaw{.elastic = own.loading, .loading = own.loading.stiffness, .unloading = own.elastic.stiffness};
        return std::nullopt;
      },
      law);
}
/// Copies the members of a law, all of which are numbers, to the parameters that SIMD lanes take.
template <class Law>
void copy_parameters(const Law& law, double (&to)[simd::most_parameters]) {
  static_assert(sizeof law <= sizeof to);
  std::memcpy(to, &law, sizeof law);
}

/// Returns the reason why closings in SIMD lanes do not support the contacts of the switch; empty when they do.
std::string why_not_contacts(const Switch& model) {
  if (!model.has_contact()) return "no contact";
  for (std::size_t c = 0; c < model.contacts(); ++c) {
    if (model.has_spread_contact(c)) return "a contact along its pad";
    if (!lane_contact(model.contact(c))) return fmt::format("the contact law {}", name_of(model.device().contacts[c].model));
  }
  return {};
}

/// Returns true when simd::UsualLaws, the fast code for common force laws, supports all force laws of the switch.
bool is_usual(const Switch& model) {
  const Device& device = model.device();
  const std::vector<Electrode>& all = device.electrodes;
  const auto alike = [&](const Electrode& e) { return e.side == Side::near && e.fringing == all.front().fringing; };
  const bool is_plate = device.structure.is_rigid();  // electrodes of a plate share all points; UsualLaws needs separate ones
  const bool film = !device.gas || (std::holds_alternative<StripGas>(*device.gas) && std::isnan(far_gap(*device.gas)));
  const bool usual_field = model.modes() <= simd::usual_modes && !device.dispersion && !model.stretching() && film &&
                           std::ranges::all_of(all, alike) && !(is_plate && all.size() > 1) &&
                           !electrode_conflict(device.structure, all);
  // For several contacts simd::UsualLaws is compiled only with a gas film and the fringing law of van der Meijs and Fokkema.
  if (model.contacts() > 1) return usual_field && device.gas && !all.empty() && all.front().fringing == Fringing::meijs_fokkema;
  return usual_field && !device.structure.is_built() && std::holds_alternative<UniformAsperityContact>(model.contact());
}

/// Returns the pads (ranges along the beam) of all electrodes, each with the number of its electrode.
std::vector<std::pair<Stretch, int>> pads_of(const Device& device) {
  std::vector<std::pair<Stretch, int>> pads;
  for (const Electrode& e : device.electrodes) {
    for (const Stretch& pad : e.pads(device.structure.length)) pads.emplace_back(pad, to_int(&e - device.electrodes.data()));
  }
  return pads;
}

/// Divides the quadrature points into segments. Within a segment the beam has one width and thickness, and the points are over
/// the same electrode, or all over none.
std::vector<Segment> segments_between(const Switch& model, const LaneLayout& layout) {
  const std::vector<std::pair<Stretch, int>> pads = pads_of(model.device());
  const auto over = [&](double x) {
    const auto found = std::ranges::find_if(pads, [&](const auto& one) { return one.first.holds(x); });
    return found == pads.end() ? -1 : found->second;
  };
  std::vector<Segment> segments;
  int stretch = 0;
  for (int p = 0; p < to_int(model.quadrature().points()); ++p) {
    const int electrode = over(model.quadrature().positions()[p]);
    while (layout.stretch[stretch].end <= p) ++stretch;
    if (p == 0 || segments.back().electrode != electrode || segments.back().stretch != stretch)
      segments.push_back({.begin = p, .electrode = electrode, .stretch = stretch});
    segments.back().end = p + 1;
  }
  return segments;
}

/// Returns the ranges of quadrature points over every electrode pad; an electrode on both sides of the beam has a range for
/// each side.
std::vector<Segment> faces_of(const Switch& model) {
  const Eigen::ArrayXd& x = model.quadrature().positions();
  const auto first_at = [&](double place) { return to_int(std::lower_bound(x.begin(), x.end(), place) - x.begin()); };
  std::vector<Segment> faces;
  for (const auto& [pad, electrode] : pads_of(model.device())) {
    const Electrode& e = model.device().electrodes[static_cast<std::size_t>(electrode)];
    Segment face{.begin = first_at(pad.begin),
                 .end = first_at(pad.end),
                 .electrode = electrode,
                 .fringing = lane_fringing(e.fringing).value_or(simd::LaneFringing::none)};
    if (face.begin == face.end) continue;
    if (e.side != Side::far) faces.push_back(face);
    face.far = true;
    if (e.side != Side::near) faces.push_back(face);
  }
  return faces;
}

/// Range of quadrature points with equal width and thickness of the beam; holes reduce the width by their share of the area.
struct LaneStretch {
  simd::PointStretch points;
  double width, thickness;
};
std::vector<LaneStretch> stretches_of(const Switch& model) {
  const Structure& s = model.device().structure;
  const int points = to_int(model.quadrature().points());
  if (!s.is_built()) return {{{0, points}, s.width, s.thickness}};
  const Eigen::ArrayXd& x = model.quadrature().positions();
  const std::vector<LocalSection> sections = local_sections(s);
  std::vector<LaneStretch> stretches;
  std::size_t last = sections.size();
  for (int p = 0; p < points; ++p) {
    std::size_t k = 0;
    while (k + 1 < sections.size() && x[p] >= sections[k].end) ++k;
    if (k != last || !sections[k].is_even())
      stretches.push_back({{p, p}, sections[k].width_at(x[p]) * area_left(sections[k].holes), sections[k].thickness});
    stretches.back().points.end = p + 1;
    last = k;
  }
  return stretches;
}

LaneLayout layout_of(const Switch& model, bool measures_work) {
  const Device& device = model.device();
  LaneLayout layout{.usual = is_usual(model) && !measures_work,
                    .modes = model.modes(),
                    .points = to_int(model.quadrature().points()),
                    .electrodes = to_int(device.electrodes.size()),
                    .drives = to_int(model.drives()),
                    .piezo = model.has_piezo(),
                    .stretching = model.stretching().has_value(),
                    .film = model.gas() ? to_int(model.gas()->index()) : -1,
                    .far_film = device.gas && !std::isnan(far_gap(*device.gas)),
                    .dispersion = *lane_dispersion(device.dispersion),
                    .contacts = to_int(model.contacts()),
                    .needs_all = device.connection == Connection::all,
                    .measures_work = measures_work};
  for (std::size_t c = 0; c < model.contacts(); ++c) {
    const LaneContactLaw contact = *lane_contact(model.contact(c));
    layout.contact[c] = {.law = to_int(contact.elastic.index()),
                         .damped = contact.damping > 0,
                         .remembers = contact.unloading > 0,
                         .near = device.contacts[c].side == Side::near,
                         .connects = device.contacts[c].connects};
  }
  if (!device.electrodes.empty()) layout.fringing = *lane_fringing(device.electrodes.front().fringing);
  const std::vector<LaneStretch> stretches = stretches_of(model);
  layout.stretches = to_int(stretches.size());
  for (std::size_t k = 0; k < stretches.size(); ++k) layout.stretch[k] = stretches[k].points;
  const std::vector<Segment> segments = layout.usual ? segments_between(model, layout) : faces_of(model);
  layout.segments = to_int(segments.size());
  std::ranges::copy(segments, layout.segment);
  return layout;
}

/// Sets the numbers with which the gaps on the far side of the moving part are computed and checked, for the electrodes and the
/// gas film there.
void set_far_side(LaneSwitch& s, const Device& device) {
  s.most_gap = std::numeric_limits<double>::infinity();
  const auto set = [&](double gap, double& both, double& floor) {
    both = device.gap.electrode + gap, floor = gap / 100;
    s.most_gap = std::min(s.most_gap, both - floor);
  };
  for (std::size_t k = 0; k < device.electrodes.size(); ++k) {
    if (const Electrode& e = device.electrodes[k]; e.side != Side::near) set(e.gap, s.electrode_gaps[k], s.electrode_floor[k]);
  }
  if (device.gas && !std::isnan(far_gap(*device.gas))) set(far_gap(*device.gas), s.film_gaps, s.film_floor);
}

void set_dispersion(LaneSwitch& s, const Dispersion& force) {
  s.hamaker_constant = force.hamaker_constant, s.equilibrium_distance = force.equilibrium_distance;
  if (force.model != DispersionModel::automatic) return;
  const VanDerWaals near{.hamaker_constant = force.hamaker_constant, .equilibrium_distance = force.equilibrium_distance};
  s.crossover = SmallerOfBoth<IdealCasimir>{IdealCasimir{}, near}.crossover;
}

void set_stretching(LaneSwitch& s, const MidPlaneStretching& stretching) {
  s.tension = stretching.stiffness;
  for (std::size_t i = 0; i < stretching.modes; ++i)
    for (std::size_t j = 0; j < stretching.modes; ++j) s.slopes[i][j] = stretching.slopes[i * stretching.modes + j];
}

LaneSwitch numbers_of(const Switch& model, double tolerance) {
  const Device& device = model.device();
  LaneSwitch s{.modes = model.modes(), .open = model.quadrature().rest_gaps().maxCoeff(), .floor = model.gap_floor()};
  for (std::size_t c = 0; c < model.contacts(); ++c) {
    const LaneContactLaw contact = *lane_contact(model.contact(c));
    const double negligible = tolerance * model.bending_energy();
    s.contact[c] = {
        .plane = model.contact_gap(c),
        .damping = contact.damping,
        .loading_stiffness = contact.loading,
        .unloading_stiffness = contact.unloading,
        .negligible_depth = std::visit([&](const auto& law) { return law.interference_of_energy(negligible); }, contact.elastic)};
    std::visit([&](const auto& law) { copy_parameters(law, s.contact[c].law); }, contact.elastic);
    std::ranges::copy(model.contact_shape(c), s.contact[c].shape);
  }
  const std::vector<LaneStretch> stretches = stretches_of(model);
  for (std::size_t k = 0; k < stretches.size(); ++k) {
    s.width[k] = stretches[k].width, s.thickness[k] = stretches[k].thickness;
    if (!model.gas()) continue;
    // The gas law of a beam of several widths differs from stretch to stretch.
    const bool is_local = device.structure.is_built() && film_of(*device.gas) != nullptr;
    std::visit([&](const auto& law) { copy_parameters(law, s.film[k]); },
               is_local ? gas_law(*device.gas, s.width[k], s.thickness[k], 1) : *model.gas());
  }
  if (device.dispersion) set_dispersion(s, *device.dispersion);
  if (model.stretching()) set_stretching(s, *model.stretching());
  set_far_side(s, device);
  std::fill_n(s.omega, simd::most_modes, model.basis().angular_frequencies()[0]);
  const Tolerances tolerances(model, tolerance);
  for (int i = 0; i < s.modes; ++i) {
    const auto k = static_cast<std::size_t>(i), n = static_cast<std::size_t>(s.modes);
    s.omega[i] = model.basis().angular_frequencies()[i];
    s.piezo[i] = model.basis().piezo_shape()[i];
    s.friction[i] = 2 * device.structure.damping_ratio * s.omega[i];
    s.flying[i] = tolerances.in_flight[k], s.touching[i] = tolerances.touching[k], s.speed[i] = tolerances.in_flight[n + k];
    for (Eigen::Index p = 0; p < model.quadrature().points(); ++p) s.shape[p][i] = model.quadrature().shapes()(p, i);
  }
  for (Eigen::Index p = 0; p < model.quadrature().points(); ++p) {
    s.weight[p] = model.quadrature().weights()[p];
    s.rest_gap[p] = model.quadrature().rest_gaps()[p];
  }
  return s;
}

/// Returns the interference at which the static force of a contact is EnsembleClosing::steady_force [m]; infinite if not given.
double steady_depth(const EnsembleClosing& closing, std::size_t c) {
  if (!(closing.steady_force > 0)) return std::numeric_limits<double>::infinity();
  return std::visit([&](const auto& law) { return law.interference(closing.steady_force); },
                    lane_contact(closing.model->contact(c))->elastic);
}

/// Adds forces and energies to the touches (intervals in contact) of a closing in a SIMD lane, and passes them to an observer.
/// The observer receives the touches of the connection when there are several contacts.
class ContactAdapter final : public simd::LaneObserver {
 public:
  explicit ContactAdapter(const EnsembleClosing& closing) : model_(closing.model), observer_(closing.observer) {}
  void touch(int contact, double begin, double end, double speed, double depth, double force) override {
    const auto c = static_cast<std::size_t>(contact);
    const ContactLaw& law = model_->contact(c);
    const Touch touch{
        .begin = begin,
        .end = end,
        .impact_velocity = speed,
        .peak_force = std::max(contact_force(law, depth), force),
        .peak_energy = has_memory(law) ? stored_energy(law, depth, ContactState(true)) : contact_energy(law, depth)};
    if (model_->contacts() == 1) {
      observer_->touch(touch);
    } else if (model_->device().contacts[c].connects) {
      touches_.take(touch);
    }
  }
  void closes(double time, double speed) override { tell(touches_.close(time, speed)); }
  void opens(double time) override { touches_.open(time); }
  void rebound(double begin, double end, double height) override { observer_->rebound(begin, end, height); }

  /// Returns the result of a closing whose simulation in a SIMD lane has ended.
  [[nodiscard]] EnsembleEnd end(const LaneClosing& lane) {
    tell(touches_.finish());
    auto forces = std::to_array(lane.force);
    for (std::size_t c = 0; c < model_->contacts(); ++c) {
      const double least = lane.least_depth[c];
      forces[c].least_force_after_touch = std::isnan(least) ? least : contact_force(model_->contact(c), least);
    }
    return {.followed = true,
            .time = lane.end,
            .force = force_of_connection(model_->device(), {forces.data(), model_->contacts()}),
            .first_touch = touches_.first_touch()};
  }

 private:
  void tell(const std::optional<Touch>& touch) {
    if (touch) observer_->touch(*touch);
  }

  const Switch* model_;
  LandingObserver* observer_;
  ConnectionTouches touches_;
};

/// Returns true when a contact other than the first, such as a back stop, is closed in the open equilibrium `rest`. Closings in
/// SIMD lanes must start with all contacts open.
bool rests_on_contact(const Switch& model, const Eigen::VectorXd& rest) {
  for (std::size_t c = 1; c < model.contacts(); ++c)
    if (model.contact_deflection(rest.data(), c) > model.contact_gap(c)) return true;
  return false;
}

/// Returns true when a drive changes the dispersion force in the run. Its work is not part of drive_energy(), so the closing is
/// not simulated in a SIMD lane if the energy is needed.
bool drives_dispersion(const EnsembleClosing& c) {
  for (std::size_t k = 0; k < c.drives.size(); ++k) {
    if (c.model->drive_kind(k) == DriveKind::dispersion && !c.drives[k].is_zero()) return true;
  }
  return false;
}

/// Returns the energy stored in the fields of the electrodes [J].
double field_energy(const Switch& model, std::span<const double> volts, const double* q) {
  Switch::Workspace work = model.workspace();
  double energy = 0;
  for (std::size_t k = 0; k < volts.size(); ++k) energy += model.capacitance(k, q, work) * volts[k] * volts[k] / 2;
  return energy;
}

/// Returns the energy that the sources deliver, the integral of V dQ over all drives [J]: the gain of the electric fields'
/// energy, the work on the modes, and the charging of a piezo layer at rest. The charge that motion moves in a piezo layer is
/// part of the work on the modes.
double drive_energy(const EnsembleClosing& c, const LaneClosing& lane) {
  std::vector<double> at_end;
  for (std::size_t k = 0; k < c.drives.size(); ++k) at_end.push_back(lane.gain[k] * c.drives[k].voltage(lane.end));
  const double of_layer =
      std::pow(lane.gain[c.drives.size() - 1], 2) * layer_charging_energy(c.model->device(), c.drives, lane.end);
  return field_energy(*c.model, at_end, lane.final) - field_energy(*c.model, values_before(c.drives), lane.start) + lane.work +
         of_layer;
}

}  // namespace

std::string why_not_in_lanes(const Switch& model) {
  const Device& device = model.device();
  if (device.gas && !std::holds_alternative<LinearGas>(*device.gas) &&
      std::ranges::any_of(local_sections(device.structure), [](const LocalSection& one) { return one.holes.exist(); }))
    return "a gas film under holes";
  if (model.modes() > simd::most_modes) return fmt::format("more than {} modes", simd::most_modes);
  if (model.quadrature().points() > simd::most_points) return fmt::format("more than {} quadrature points", simd::most_points);
  if (model.drives() > simd::most_drives) return fmt::format("more than {} drives", simd::most_drives);
  if (std::ranges::any_of(device.electrodes, [](const Electrode& e) { return e.dielectric.has_value(); }))
    return "a dielectric on an electrode";
  if (!lane_dispersion(device.dispersion)) return "a dispersion force between gold";
  if (std::string why = why_not_contacts(model); !why.empty()) return why;
  if (model.contacts() > simd::most_contacts) return fmt::format("more than {} contacts", simd::most_contacts);
  // Only simulate_closing() determines the times at which the connection is electrically closed.
  if (device.electrical.is_asked()) return "a key that says when the connection is electrically closed";
  if (model.film_states() > 0) return "a compressible gas film";
  for (const Electrode& e : device.electrodes) {
    if (!lane_fringing(e.fringing)) return fmt::format("fringing by {}", name_of(fringing_laws, e.fringing));
  }
  if (faces_of(model).size() > simd::most_segments) return fmt::format("more than {} faces of electrodes", simd::most_segments);
  return {};
}

std::vector<EnsembleEnd> close_in_lanes(std::span<const EnsembleClosing> closings, double tolerance, Vectors vectors) {
  std::vector<EnsembleEnd> ends(closings.size());
  const simd::LaneRunner run = simd::lane_runner(vectors);
  if (run == nullptr) return ends;

  simd::LaneDrives drives;
  std::optional<LaneLayout> layout;
  std::vector<std::size_t> places;     // indices of the closings that are simulated in SIMD lanes
  std::vector<Eigen::VectorXd> rests;  // equilibria from which the closings in SIMD lanes start
  for (std::size_t i = 0; i < closings.size(); ++i) {
    if (!why_not_in_lanes(*closings[i].model).empty() || !drives.go_in_lanes(closings[i].drives)) continue;
    const std::optional<Eigen::VectorXd> rest = closings[i].model->open_equilibrium(values_before(closings[i].drives));
    if (!rest || rests_on_contact(*closings[i].model, *rest)) continue;
    if (closings[i].measures_drive_energy && drives_dispersion(closings[i])) continue;
    const LaneLayout own = layout_of(*closings[i].model, closings[i].measures_drive_energy);
    if (!layout) layout = own;
    if (*layout != own) continue;
    places.push_back(i);
    rests.push_back(*rest);
  }
  if (places.empty()) return ends;

  std::vector<LaneSwitch> switches;
  std::vector<ContactAdapter> adapters;
  std::vector<LaneClosing> followed(places.size());
  switches.reserve(places.size()), adapters.reserve(places.size());
  for (std::size_t n = 0; n < places.size(); ++n) {
    const EnsembleClosing& c = closings[places[n]];
    switches.push_back(numbers_of(*c.model, tolerance));
    adapters.emplace_back(c);
    LaneClosing& lane = followed[n];
    lane = LaneClosing{.numbers = &switches.back(),
                       .duration = c.duration,
                       .after_contact = c.after_contact,
                       .no_end_before = c.no_end_before,
                       .no_contact_before = c.no_contact_before,
                       .observer = &adapters.back()};
    for (std::size_t k = 0; k < c.model->contacts(); ++k) lane.steady_depth[k] = steady_depth(c, k);
    std::copy(rests[n].begin(), rests[n].end(), lane.start);
    for (std::size_t k = 0; k < c.drives.size(); ++k) {
      const std::vector<LanePiece>& own = drives.of(c.drives[k], c.model->basis().angular_frequencies().maxCoeff());
      lane.pieces[k] = own.data();
      lane.piece_count[k] = to_int(own.size());
      lane.gain[k] = c.gains.empty() ? 1 : c.gains[k];
    }
  }
  run(*layout, followed.data(), followed.size());
  for (std::size_t n = 0; n < places.size(); ++n) {
    const LaneClosing& lane = followed[n];
    const EnsembleClosing& c = closings[places[n]];
    if (!lane.followed) continue;
    EnsembleEnd& end = ends[places[n]];
    end = adapters[n].end(lane);
    if (c.measures_drive_energy) end.drive_energy = drive_energy(c, lane);
  }
  return ends;
}

}  // namespace softland
