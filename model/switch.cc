#include "model/switch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <utility>

#include "base/require.h"
#include "model/built_beam.h"
#include "model/constants.h"
#include "model/contact/contact_law.h"
#include "model/contact/face.h"
#include "model/contact/pad.h"
#include "model/far_side.h"
#include "model/forces/electrostatic.h"
#include "model/forces/gold_casimir.h"
#include "model/gas/gas_law.h"
#include "model/gas/perforated_strip.h"
#include "model/gas/reynolds_film.h"
#include "model/modal_projection.h"
#include "model/placed_laws.h"
#include "model/sampled_modes.h"

namespace softland {
namespace {

// Calls visit(range) for every range of quadrature points over an electrode on whose dielectric the beam may close.
template <class Visit>
void for_faces(const Device& device, const Eigen::ArrayXd& positions, Visit&& visit) {
  for (const Electrode& e : device.electrodes) {
    if (!e.dielectric || !e.dielectric->landing) continue;
    for (const Stretch& pad : e.pads(device.structure.length))
      for (const EvenRange& even : even_ranges(device.structure, positions, pad.begin, pad.end)) visit(even);
  }
}

// Returns the number of quadrature points over a beam's length that resolve the electric field when the beam first touches a
// dielectric's face; 0 when the beam cannot close on a face. The beam bends over the face like (g / 2) (1 - cos(2 pi x / L)), g
// being the gap at rest. So the gap of the field, least at the touching point with the value H, has doubled at a distance of L
// sqrt(H / g) / pi from there. We choose six points in this distance; three cause an error of the release voltage of 7e-4,
// measured on one bridge.
double points_to_land(const Device& device) {
  if (!device.closes_along_face()) return 0;
  constexpr double points = 6;
  return points * pi * std::sqrt(device.gap.electrode / (device.dielectric_depth() + device.landing()->begin()));
}

}  // namespace

template <class Modes>
void Switch::set_modes(const Modes& structure, double points_per_length, int fewest_points, const Switch* like) {
  SampledModes::PanelPlaces places = SampledModes::PanelPlaces::of(device_, points_per_length, fewest_points);
  const auto is_in = [&]([[maybe_unused]] const SampledModes& sampled) {
    if constexpr (std::same_as<Modes, BeamModes>) return sampled.modes == structure.normalised();
    if constexpr (std::same_as<Modes, TabulatedModes>) return sampled.table == *structure.normalised();
    return false;
  };
  if (like != nullptr && is_in(*like->sampled_) && like->sampled_->places == places) sampled_ = like->sampled_;
  if (!sampled_) {
    auto sampled = std::make_shared<SampledModes>(*structure.normalised(), structure.length(), std::move(places),
                                                  like != nullptr ? like->sampled_.get() : nullptr);
    if constexpr (std::same_as<Modes, BeamModes>) sampled->modes = structure.normalised();
    if constexpr (std::same_as<Modes, TabulatedModes>) sampled->table = *structure.normalised();
    sampled_ = std::move(sampled);
  }
  std::optional<Eigen::VectorXd> piezo;
  if constexpr (std::same_as<Modes, BeamModes>) {
    if (device_.piezo && device_.structure.is_built()) piezo = piezo_forces(device_, structure);
  }
  basis_ = ModalBasis(structure.angular_frequencies(),
                      {.length = structure.length(), .shape = structure.scale(), .frequency = structure.frequency_scale()},
                      *sampled_, device_, piezo);
  Eigen::ArrayXd gaps = Eigen::ArrayXd::Constant(sampled_->positions.size(), device_.gap.electrode);
  for (Eigen::Index p = 0; p < gaps.size(); ++p) gaps[p] += device_.rest_offset(sampled_->positions[p]);
  quadrature_ = PointQuadrature(sampled_->positions, sampled_->weights, structure.scale() * sampled_->shapes, gaps);
  if (device_.touches_along_pad()) pad_ = std::make_shared<const PadQuadrature>(device_.contacts.front().pad_length);
}

Switch::Switch(const Device& device, const SwitchOptions& options, const Switch* like) : device_(device) {
  set_face_contact(device_);
  validate(device_);
  if (options.modes && !device.structure.is_rigid()) {
    const int most = device.structure.find<Beam>() != nullptr ? most_static_modes : most_modes_of(device.structure);
    require(*options.modes >= 1 && *options.modes <= most,
            [&] { return fmt::format("modes = {}: must be from 1 to {}", *options.modes, most); });
    device_.structure.modes = *options.modes;
  }
  contact_gap_ = device_.contact_gap();
  const Structure& s = device_.structure;
  std::visit(
      [&]<class Kind>(const Kind& kind) {
        const auto modes = kind.modes(device_, like != nullptr ? like->sampled_->modes : nullptr);
        if constexpr (requires { Kind::is_rigid; }) {
          set_modes(modes, 0, 1, nullptr);  // the gap of a plate is the same everywhere, so one point per panel suffices
        } else {
          set_modes(modes, std::max(options.points_per_length, points_to_land(device_)), options.points_per_panel, like);
        }
        if constexpr (requires { kind.stretching(modes, s); }) stretching_ = kind.stretching(modes, s);
      },
      s.kind);
  const Eigen::Index n = quadrature_.points();

  // Returns the force law of an electrode or gas film on the far side, at the distance `gap` from the moving part at rest.
  const auto on_far_side = [&](const auto& law, double gap) {
    const double both_gaps = device_.gap.electrode + gap, floor = gap / 100;
    most_gap_ = std::min(most_gap_, both_gaps - floor);
    return FarSide<std::decay_t<decltype(law)>>{.law = law, .both_gaps = both_gaps, .floor = floor};
  };
  const double film_floor = device_.gap.electrode / 100;
  electrodes_ = device_.electrodes.size();
  for (const Electrode& e : device_.electrodes) {
    std::vector<std::shared_ptr<const DistributedLaw>> pads;
    for (const Stretch& pad : e.pads(s.length)) {
      for (const EvenRange& even : even_ranges(s, quadrature_.positions(), pad.begin, pad.end)) {
        const PointRange range = even.points;
        pads.push_back(electrostatic(e.fringing, even, [&](const auto& law) {
          using Law = std::decay_t<decltype(law)>;
          if (e.dielectric) {
            const ThroughDielectric<Law> through{.law = law, .depth = e.dielectric->depth()};
            const bool is_wall = e.dielectric->landing && e.dielectric->landing->is_wall();
            return is_wall ? erased(StopsAtFace<ThroughDielectric<Law>>{through}, range, gap_floor())
                           : erased(through, range, gap_floor());
          }
          if (e.side == Side::near) return erased(law, range, gap_floor());
          const auto far = on_far_side(law, e.gap);
          return e.side == Side::far ? erased(far, range, gap_floor())
                                     : erased(BothSides<Law>{.near = law, .far = far}, range, gap_floor());
        }));
      }
    }
    driven_laws_.push_back(one_law(std::move(pads)));
    neutral_voltages_.push_back(e.dielectric ? e.dielectric->neutral_voltage() : 0);
  }
  std::vector<EvenRange> everywhere{{{0, n}, s.width, s.thickness}};
  if (s.is_built()) everywhere = even_ranges(s, quadrature_.positions(), 0, s.length);
  if (device_.dispersion) {
    std::vector<std::shared_ptr<const DistributedLaw>> pads;
    for (const EvenRange& even : everywhere)
      pads.push_back(dispersion_force(*device_.dispersion, even.width, even.points, gap_floor()));
    driven_laws_.push_back(one_law(std::move(pads)));
  }
  if (device_.gas) {
    const double first_mode = (quadrature_.weights() * quadrature_.shapes().col(0).head(n).array().square()).sum();
    const double unit_quality = basis_.angular_frequencies()[0] / first_mode;
    const LocalSection contact = section_at(s, device_.contact_position());
    const double width = contact.width_at(device_.contact_position());
    gas_ = std::make_shared<const GasLaw>(gas_law(*device_.gas, width, contact.thickness, unit_quality));
    // Returns make(law), law being the law of the gas film over one range of quadrature points.
    const auto film_on = [&](const EvenRange& even, auto&& make) {
      const GasLaw law = gas_law(*device_.gas, even.full_width, even.thickness, unit_quality);
      const auto* const strip = even.holes.exist() ? std::get_if<StripSqueezeFilm>(&law) : nullptr;
      if (strip != nullptr) return make(PerforatedStripFilm(strip->viscosity, even.full_width, even.thickness, even.holes));
      return std::visit(make, law);
    };
    if (is_compressible(*device_.gas)) {
      film_ = std::make_shared<const ReynoldsFilm>(*film_of(*device_.gas), s.width, n, film_floor);
    } else {
      for (const EvenRange& even : everywhere)
        passive_laws_.push_back(film_on(even, [&](const auto& law) { return erased(law, even.points, film_floor); }));
    }
    if (const double gap = far_gap(*device_.gas); !std::isnan(gap)) {
      for (const EvenRange& even : everywhere)
        passive_laws_.push_back(
            film_on(even, [&](const auto& law) { return erased(on_far_side(law, gap), even.points, gap_floor()); }));
    }
  }
  // Find the force at the contact point that bends the beam by the contact gap.
  const double compliance = basis_.contact_shape().cwiseAbs2().cwiseQuotient(basis_.squares()).sum();
  const double force = contact_gap_ / compliance;
  bending_energy_ = force * contact_gap_ / 2;
  if (const auto face = device_.face_contact()) {
    face_at_ = *face;
    if (device_.landing()->is_wall()) {
      double area = 0;
      for_faces(device_, quadrature_.positions(), [&](const EvenRange& even) {
        area += even.width * quadrature_.weights().segment(even.points.begin, even.points.end - even.points.begin).sum();
      });
      const double depth = device_.dielectric_depth();
      std::get<LinearSpring>(device_.contacts[face_at_].model).stiffness =
          wall_stiffness(1 / compliance, device_.gap.electrode + depth, area, depth);
    }
    face_ = face_pressure();
  }
  if (device_.has_contact()) {
    const auto law_of = [&](std::size_t c) {
      const Contact& contact = device_.contacts[c];
      return std::make_shared<const ContactLaw>(contact_law(contact, width_at(s, device_.contact_position(c))));
    };
    contact_ = law_of(0);
    for (std::size_t c = 1; c < device_.contacts.size(); ++c) {
      further_.push_back({.law = law_of(c),
                          .shape = (device_.contacts[c].side == Side::far ? -1 : 1) * basis_.further_contact_shapes()[c - 1],
                          .gap = device_.contact_gap(c)});
    }
    penetration_scale_ = penetration_under(force);
  }
  rest_ = Eigen::VectorXd::Zero(modes());
  if (device_.dispersion || device_.is_charged()) rest_ = loaded_equilibrium(std::vector<double>(drives(), 0.0));
}

std::shared_ptr<const DistributedLaw> Switch::face_pressure() const {
  constexpr double no_floor = -std::numeric_limits<double>::infinity();
  const double from = device_.landing()->begin();
  const ContactModel& model = device_.contacts[face_at_].model;
  std::vector<std::shared_ptr<const DistributedLaw>> pads;
  for_faces(device_, quadrature_.positions(), [&](const EvenRange& even) {
    if (const auto* const rough = std::get_if<UniformAsperities>(&model)) {
      const ContactPad per_length{.width = even.width, .length = 1};
      pads.push_back(
          erased(RoughFacePressure{uniform_contact(rough->summits, rough->height, per_length)}, even.points, no_floor));
    } else {
      const double stiffness = std::get<LinearSpring>(model).stiffness;
      pads.push_back(erased(FacePressure{.stiffness = even.width * stiffness, .from = from}, even.points, no_floor));
    }
  });
  return one_law(std::move(pads));
}

GapField Switch::still_field(const double* q) const {
  const Eigen::ArrayXd zero = Eigen::ArrayXd::Zero(quadrature_.shapes().rows());
  GapField field{.gap = zero, .velocity = zero};
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(modes());
  quadrature_.set_field(q, still.data(), field);
  return field;
}

// Returns the interference at which the contact force has this value, by bisection, since contact forces grow with the
// interference. For a contact along the pad, the beam has the tilt that a force at the contact point causes.
double Switch::penetration_under(double force) const {
  const double plane = contact_gap_;
  const Eigen::VectorXd pushed = basis_.contact_shape().cwiseQuotient(basis_.squares()), still = Eigen::VectorXd::Zero(modes());
  const auto carried = [&](double depth) {
    if (!has_spread_contact()) return contact_force(*contact_, depth);
    const Eigen::VectorXd q = pushed * ((plane + depth) / basis_.contact_shape().dot(pushed));
    return contact_push(q.data(), still.data(), true);
  };
  double low = 0, high = plane;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (carried(middle) < force ? low : high) = middle;
  }
  return high;
}

Switch::Workspace Switch::workspace() const {
  const Eigen::ArrayXd zero = Eigen::ArrayXd::Zero(quadrature_.shapes().rows());
  return {.field = {.gap = zero, .velocity = zero, .smallest_gap = 0}, .load = zero, .by_deflection = zero, .by_velocity = zero};
}

void Switch::accelerations(const double* q, const double* v, std::span<const double> volts, const ContactStates& contacts,
                           Workspace& work, double* result, const double* film) const {
  const ContactState& contact = contacts.first;
  const auto n = static_cast<std::size_t>(modes());
  quadrature_.set_field(q, v, work.field);
  using Block = PointQuadrature::Block;
  for (Eigen::Index p = 0; p < work.load.size(); p += PointQuadrature::block) Eigen::Map<Block>(work.load.data() + p).setZero();
  for (const auto& law : passive_laws_) law->add_load(work.field, 0, work.load.data());
  if (film != nullptr) film_->add_load(film, work.load.data());
  for (std::size_t k = 0; k < driven_laws_.size(); ++k) {
    if (const double drive = strength(k, volts[k]); drive != 0) driven_laws_[k]->add_load(work.field, drive, work.load.data());
  }

  if (face_acts(contacts)) face_->add_load(work.field, 1, work.load.data());

  double push = 0;
  if (contact.active && !has_spread_contact()) {
    const double d = contact_deflection(q) - contact_gap_;
    const auto rate = [&] { return contact_deflection(v); };
    push = visit_inline([&](const auto& law) { return force_of(law, d, contact, rate); }, *contact_);
  }
  const double piezo = device_.piezo ? volts.back() : 0;
  for (std::size_t i = 0; i < n; i += lanes) {
    // Compute the terms without the distributed load first: the processor can then work on them while the load is not ready.
    const Lane own = basis_.forces(i, n, q, v, piezo, push);
    store_lane(own + quadrature_.projected(work.load, i), result, i, n);
  }
  if (contact.active && pad_) add_pad_force(q, v, result);
  for_further_contacts(q, contacts, [&](const FurtherContact& c, const ContactState& state, double d) {
    const auto rate = [&] { return basis_.at(v).dot(c.shape); };
    const double force = visit_inline([&](const auto& law) { return force_of(law, d, state, rate); }, *c.law);
    add_modal_force<double>({c.shape.data(), n}, -force, result);
  });
  if (stretching_) stretching_->add_force(q, result);
}

void Switch::jacobian(const double* q, const double* v, std::span<const double> volts, const ContactStates& contacts,
                      Workspace& work, Eigen::Ref<Eigen::MatrixXd> by_q, Eigen::Ref<Eigen::MatrixXd> by_v) const {
  const ContactState& contact = contacts.first;
  quadrature_.set_field(q, v, work.field);
  work.by_deflection.setZero();
  work.by_velocity.setZero();
  for (std::size_t k = 0; k < driven_laws_.size(); ++k) {
    driven_laws_[k]->add_derivatives(work.field, strength(k, volts[k]), work.by_deflection.data(), work.by_velocity.data());
  }
  for (const auto& law : passive_laws_) law->add_derivatives(work.field, 0, work.by_deflection.data(), work.by_velocity.data());
  if (face_acts(contacts)) face_->add_derivatives(work.field, 1, work.by_deflection.data(), work.by_velocity.data());
  quadrature_.project_slopes(work.by_deflection, work.load, by_q);
  if (passive_laws_.empty()) {
    by_v.setZero();
  } else {
    quadrature_.project_slopes(work.by_velocity, work.load, by_v);
  }
  by_q.diagonal() -= basis_.squares();
  by_v.diagonal() -= 2 * device_.structure.damping_ratio * basis_.angular_frequencies();
  if (contact.active && face_at_ != 0) {
    for_contact_points(q, [&](double xi, double share, double d) {
      const Eigen::VectorXd shape = basis_.contact_shape() - xi * basis_.pad_slope();
      const double rate = contact_rate(v, xi);
      const auto slope = [&](double by_d, double by_rate) {
        return std::visit(
            [&](const auto& law) { return force_of(law, Dual(d, by_d), contact, [&] { return Dual(rate, by_rate); }).slope; },
            *contact_);
      };
      by_q.noalias() -= (share * slope(1, 0) * shape) * shape.transpose();
      if (has_damped_contact()) by_v.noalias() -= (share * slope(0, 1) * shape) * shape.transpose();
    });
  }
  for_further_contacts(q, contacts, [&](const FurtherContact& c, const ContactState& state, double d) {
    const double rate = basis_.at(v).dot(c.shape);
    const auto slope = [&](double by_d, double by_rate) {
      return std::visit(
          [&](const auto& law) { return force_of(law, Dual(d, by_d), state, [&] { return Dual(rate, by_rate); }).slope; },
          *c.law);
    };
    by_q.noalias() -= (slope(1, 0) * c.shape) * c.shape.transpose();
    if (is_rate_dependent(*c.law)) by_v.noalias() -= (slope(0, 1) * c.shape) * c.shape.transpose();
  });
  if (stretching_) stretching_->add_derivative(q, by_q);
}

void Switch::drive_forces(Workspace& work, Eigen::Ref<Eigen::MatrixXd> by_strength) const {
  for (std::size_t k = 0; k < driven_laws_.size(); ++k) {
    work.load.setZero();
    driven_laws_[k]->add_load(work.field, 1, work.load.data());
    const auto n = static_cast<std::size_t>(modes());
    double* forces = by_strength.col(static_cast<Eigen::Index>(k)).data();
    for (std::size_t i = 0; i < n; i += lanes) store_lane(quadrature_.projected(work.load, i), forces, i, n);
  }
  if (device_.piezo) by_strength.rightCols<1>() = basis_.piezo_shape();
}

void Switch::add_film_derivatives(const double* state, const Workspace& work, Eigen::Ref<Eigen::MatrixXd> derivatives) const {
  constexpr int nodes = ReynoldsFilm::nodes;
  const Eigen::Index n = modes();
  const double* film = state + 2 * n;
  for (Eigen::Index s = 0; s < quadrature_.points(); ++s, film += nodes) {
    const Eigen::Index at = 2 * n + nodes * s;
    const ReynoldsFilm::Derivatives d = film_->derivatives(work.field.gap[s], work.field.velocity[s], film);
    derivatives.block(n, at, n, nodes) += quadrature_.weighted_shapes().row(s).transpose() * film_->load_by_film().transpose();
    // Minus sign: a positive deflection reduces the gap.
    derivatives.block(at, 0, nodes, n) -= d.by_gap * quadrature_.shapes().row(s);
    derivatives.block(at, n, nodes, n) += d.by_velocity * quadrature_.shapes().row(s);
    derivatives.block(at, at, nodes, nodes) += d.by_film;
  }
}

std::size_t Switch::film_states() const { return film_ ? film_->states() : 0; }

void Switch::rates(const double* state, std::span<const double> volts, const ContactStates& contacts, Workspace& work,
                   double* result) const {
  const double* film = film_ ? state + 2 * modes() : nullptr;
  accelerations(state, state + modes(), volts, contacts, work, result, film);
  if (film_) film_->rates(work.field, film, result + modes());
}

double Switch::film_scale() const {
  return 2 * bending_energy_ / (contact_gap_ * device_.structure.width * device_.structure.length * film_->ambient());
}

double Switch::contact_reach(std::size_t c) const { return contact_ ? softland::contact_reach(contact(c)) : 0; }

const RigidContact* Switch::rigid_contact() const { return contact_ ? std::get_if<RigidContact>(contact_.get()) : nullptr; }

template <class F>
void Switch::for_contact_points(const double* q, F&& f) const {
  const double d = contact_deflection(q) - contact_gap_;
  if (!pad_) return f(0.0, 1.0, d);
  pad_->over_contact(d, basis_.pad_tilt(q), f);
}

template <class F>
void Switch::for_further_contacts(const double* q, const ContactStates& contacts, F&& f) const {
  for (std::size_t k = 0; k < further_.size(); ++k) {
    if (k + 1 == face_at_) continue;
    const FurtherContact& c = further_[k];
    const double d = basis_.at(q).dot(c.shape) - c.gap;
    const ContactState state =
        contacts.further.empty() ? ContactState(d > -softland::contact_reach(*c.law)) : contacts.further[k];
    if (state.active) f(c, state, d);
  }
}

bool Switch::has_damped_contact() const {
  return (contact_ && is_rate_dependent(*contact_)) ||
         std::ranges::any_of(further_, [](const FurtherContact& c) { return is_rate_dependent(*c.law); });
}

double Switch::contact_rate(const double* v, double xi) const { return contact_deflection(v) - xi * basis_.pad_tilt(v); }

void Switch::add_pad_force(const double* q, const double* v, double* result) const {
  double force = 0, moment = 0;
  for_contact_points(q, [&](double xi, double share, double d) {
    const auto rate = [&] { return contact_rate(v, xi); };
    const double push = share * visit_inline([&](const auto& law) { return force_of(law, d, true, rate); }, *contact_);
    force += push;
    moment += push * xi;
  });
  const auto n = static_cast<std::size_t>(modes());
  add_modal_force<double>({basis_.contact_shape().data(), n}, -force, result);
  add_modal_force<double>({basis_.pad_slope().data(), n}, moment, result);
}

double Switch::contact_push(const double* q, const double* v, const ContactState& contact, std::size_t c) const {
  if (c == face_at_) {
    Eigen::ArrayXd load = Eigen::ArrayXd::Zero(quadrature_.shapes().rows());
    face_->add_load(still_field(q), 1, load.data());
    return -(quadrature_.weights() * load.head(quadrature_.points())).sum();
  }
  if (c > 0) {
    return contact_force(this->contact(c), contact_deflection(q, c) - contact_gap(c), contact, contact_deflection(v, c));
  }
  double sum = 0;
  for_contact_points(
      q, [&](double xi, double share, double d) { sum += share * contact_force(*contact_, d, contact, contact_rate(v, xi)); });
  return sum;
}

double Switch::contact_stored(const double* q, const ContactState& contact, std::size_t c) const {
  if (c == face_at_) return face_->potential(still_field(q), quadrature_.weights());
  if (c > 0) return stored_energy(this->contact(c), contact_deflection(q, c) - contact_gap(c), contact);
  double sum = 0;
  for_contact_points(q, [&](double, double share, double d) { sum += share * stored_energy(*contact_, d, contact); });
  return sum;
}

double Switch::contact_dissipation(const double* q, const double* v, std::size_t c) const {
  if (c == face_at_) return 0;
  if (c > 0) {
    return softland::contact_dissipation(contact(c), contact_deflection(q, c) - contact_gap(c), contact_deflection(v, c));
  }
  double sum = 0;
  for_contact_points(q, [&](double xi, double share, double d) {
    sum += share * softland::contact_dissipation(*contact_, d, contact_rate(v, xi));
  });
  return sum;
}

double Switch::potential(const double* q, std::span<const double> volts, const ContactStates& contacts, Workspace& work) const {
  const ContactState& contact = contacts.first;
  double energy = elastic_energy(q);
  for (std::size_t k = 0; k < driven_laws_.size(); ++k) {
    if (const double drive = strength(k, volts[k]); drive != 0) energy += drive * law_potential(k, q, work);
  }
  if (device_.piezo) energy -= volts.back() * basis_.piezo_charge(q);
  if (face_acts(contacts)) energy += contact_stored(q, contact, face_at_);
  if (contact.active && face_at_ != 0) {
    for_contact_points(q, [&](double, double share, double d) {
      energy += share * (contact.unloading ? stored_energy(*contact_, d, contact) : contact_energy(*contact_, d));
    });
  }
  for_further_contacts(q, contacts, [&](const FurtherContact& c, const ContactState& state, double d) {
    energy += state.unloading ? stored_energy(*c.law, d, state) : contact_energy(*c.law, d);
  });
  return energy;
}

}  // namespace softland
