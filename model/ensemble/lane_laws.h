// The force laws of closings in SIMD lanes. Two classes compute the modal forces from modal coordinates and velocities.
//
// UsualLaws: up to four modes, electrodes on the near side that do not overlap, a strip film or none, an undamped contact of
// asperities. The laws are chosen at compile time. For each quadrature point all loads are computed at once, in registers. The
// class covers a beam of several widths and thicknesses, and several contacts of any law, if `most_stretches` is above 1.
//
// AnyLaws: more modes, other laws and several contacts, chosen at run time by the LaneLayout. Each law is computed for all
// quadrature points before the next law.
//
// UsualContact and AnyContact are the corresponding laws of a contact.
//
// All code here depends on the type of the SIMD vectors: see simd_lanes.h.
#pragma once

#include <cstddef>
#include <cstring>
#include <type_traits>
#include <variant>

#include "model/contact/contact_law.h"
#include "model/ensemble/lane_closing.h"
#include "model/forces/casimir.h"
#include "model/forces/dispersion.h"
#include "model/forces/electrostatic.h"
#include "model/forces/van_der_waals.h"
#include "model/gas/gas.h"

namespace softland::simd {

/// The law `LawOf<V>` of the switches in SIMD lanes, from the law LawOf<double> of one switch.
template <class Law, class V>
struct LawInLanes;
template <template <class> class LawOf, class V>
struct LawInLanes<LawOf<double>, V> {
  using Type = LawOf<V>;
  static_assert(sizeof(LawOf<double>) <= most_parameters * sizeof(double));
  static_assert(sizeof(LawOf<V>) / sizeof(V) == sizeof(LawOf<double>) / sizeof(double));
};
/// Returns the law with these parameters, which are the members of `Law` in their order. The bytes are copied by memcpy(): GCC 12
/// makes zeros of some members by std::bit_cast of an array.
template <class Law, class V>
[[gnu::always_inline]] inline auto law_in_lanes(const V* parameters) {
  typename LawInLanes<Law, V>::Type law;
  std::memcpy(static_cast<void*>(&law), static_cast<const void*>(parameters), sizeof law);
  return law;
}
/// Sets the parameters of a law in SIMD lane `l`.
template <class V>
void set_parameters(V* lanes, const double* parameters, std::size_t l) {
  for (std::size_t i = 0; i < most_parameters; ++i) lanes[i][l] = parameters[i];
}
/// Calls `f.operator()<Law>()` for the law with this index in a variant of laws.
template <class Laws, std::size_t i = 0, class F>
[[gnu::always_inline]] inline decltype(auto) with_law(int index, F&& f) {
  if constexpr (i + 1 < std::variant_size_v<Laws>) {
    if (index != static_cast<int>(i)) return with_law<Laws, i + 1>(index, f);
  }
  return f.template operator()<std::variant_alternative_t<i, Laws>>();
}

template <class V>
class UsualContact {
 public:
  static constexpr bool has_damping = false, has_memory = false;

  /// Sets the parameters of this contact in SIMD lane `l`.
  void take(const LaneContactKind&, const LaneContactNumbers& numbers, std::size_t l) {
    set_parameters(parameters_, numbers.law, l);
    law_ = law_in_lanes<UniformAsperityContact>(parameters_);
  }

  /// Returns the contact force at the interference `depth` [N]; its rate is not needed, since there is no damping.
  template <class Rate>
  [[gnu::always_inline]] V push(V depth, Rate&&) const {
    return law_.force(depth);
  }

 private:
  V parameters_[most_parameters];
  UniformAsperityContactOf<V> law_;
};

template <class V>
class AnyContact {
 public:
  // Simulations with this class contain code for damping and memory; LaneContactKind says whether a contact uses the code.
  static constexpr bool has_damping = true, has_memory = true;

  void take(const LaneContactKind& kind, const LaneContactNumbers& numbers, std::size_t l) {
    kind_ = kind;
    set_parameters(parameters_, numbers.law, l);
    damping_[l] = numbers.damping, unloading_[l] = numbers.unloading_stiffness;
  }

  template <class Rate>
  V push(V depth, Rate&& rate) const {
    return with_law<InvertibleContactLaw>(kind_.law,
                                          [&]<class Law>() { return push_of(law_in_lanes<Law>(parameters_), depth, rate); });
  }
  /// Returns the force of a contact with memory while unloading [N]; `depth` is the interference less the residual
  /// interference.
  V pull_back(V depth) const { return LinearContactOf<V>{.stiffness = unloading_}.force(depth); }

 private:
  template <class Law, class Rate>
  V push_of(const Law& law, V depth, Rate&& rate) const {
    if (!kind_.damped) return law.force(depth);
    return HuntCrossley<Law, V>{.elastic = law, .damping = damping_}.force(depth, rate());
  }

  LaneContactKind kind_;
  V parameters_[most_parameters], damping_, unloading_;
};

template <class V, template <class> class FringingOf, bool has_film, int most_stretches = 1>
class UsualLaws {
  using Force = ElectrostaticForce<FringingOf<V>>;
  /// True when the fringing law is computed from h^(-1/4) of the gap h; the law of the gas film then uses this root, too.
  static constexpr bool has_root = requires(const FringingOf<V>& law, V h) { law.factor_over_square(h); };

 public:
  using Modes = std::integral_constant<int, usual_modes>;
  using Contact = std::conditional_t<most_stretches == 1, UsualContact<V>, AnyContact<V>>;
  static Modes modes(const LaneLayout&) { return {}; }
  static constexpr int capacity = usual_modes;

  explicit UsualLaws(const LaneLayout& layout) : layout_(layout) {}

  /// Sets the parameters of the switch in SIMD lane `l`.
  void take(const LaneSwitch& s, std::size_t l) {
    for (int p = 0; p < layout_.points; ++p) {
      weight_[p][l] = s.weight[p], rest_gap_[p][l] = s.rest_gap[p];
      for (int i = 0; i < capacity; ++i) shape_[p][i][l] = s.shape[p][i];
    }
    open_[l] = s.open, floor_[l] = s.floor;
    for (int k = 0; k < (most_stretches == 1 ? 1 : layout_.stretches); ++k) {
      width_[k][l] = s.width[k], thickness_[k][l] = s.thickness[k];
      if constexpr (std::is_same_v<FringingOf<V>, MeijsFokkemaFringingOf<V>>) {
        force_[k] = Force{{.width = width_[k], .thickness = thickness_[k]}};
      } else {
        force_[k] = Force{{.width = width_[k]}};
      }
      set_parameters(parameters_[k], s.film[k], l);
      film_[k] = law_in_lanes<StripSqueezeFilm>(parameters_[k]);
    }
  }

  [[nodiscard]] const V& floor() const { return floor_; }

  /// Adds the modal forces of electric fields and gas film to `sum`, and sets `least` to the smallest gap along the beam.
  [[gnu::always_inline]] void add(const V* __restrict q, const V* __restrict v, const V* volts, V* sum, V& least) {
    V smallest = open_;
    const auto field = [&](int p, V& gap, V& velocity) __attribute__((always_inline)) {
      gap = rest_gap_[p] - shape_[p][0] * q[0];
      velocity = shape_[p][0] * v[0];
      for (int i = 1; i < capacity; ++i) gap -= shape_[p][i] * q[i], velocity += shape_[p][i] * v[i];
      smallest = min(smallest, gap);
      gap = max(gap, floor_);
    };
    const auto project = [&](int p, V load) __attribute__((always_inline)) {
      load *= weight_[p];
      for (int i = 0; i < capacity; ++i) sum[i] += load * shape_[p][i];
    };
    StripSqueezeFilmOf<V> film = film_[0];
    Force force = force_[0];
    const int segments = layout_.segments;
    for (int s = 0; s < segments; ++s) {
      const Segment segment = layout_.segment[s];
      if constexpr (most_stretches > 1) film = film_[segment.stretch], force = force_[segment.stretch];
      if (segment.electrode < 0) {
        if constexpr (has_film) {
          for (int p = segment.begin; p < segment.end; ++p) {
            V gap, velocity;
            field(p, gap, velocity);
            project(p, film.load(gap, velocity));
          }
        } else {
          for (int p = segment.begin; p < segment.end; ++p) {
            V gap, velocity;
            field(p, gap, velocity);
          }
        }
        continue;
      }
      const V drive = volts[segment.electrode] * volts[segment.electrode];
      for (int p = segment.begin; p < segment.end; ++p) {
        V gap, velocity;
        field(p, gap, velocity);
        V load = drive * force.load(gap, velocity);
        if constexpr (has_film && has_root) {
          load += film.load_by_root(inverse_fourth_root(gap), velocity);
        } else if constexpr (has_film) {
          load += film.load(gap, velocity);
        }
        project(p, load);
      }
    }
    least = smallest;
  }

  /// Returns 0, since UsualLaws do not compute the power of the electrodes on the modes [W].
  [[nodiscard]] V power() const { return 0; }

 private:
  const LaneLayout& layout_;
  V shape_[most_points][capacity], weight_[most_points], rest_gap_[most_points];
  V open_, floor_, width_[most_stretches], thickness_[most_stretches];
  Force force_[most_stretches];
  V parameters_[most_stretches][most_parameters];
  StripSqueezeFilmOf<V> film_[most_stretches];
};

template <class V>
class AnyLaws {
 public:
  using Modes = int;
  using Contact = AnyContact<V>;
  static Modes modes(const LaneLayout& layout) { return layout.modes; }
  static constexpr int capacity = most_modes;

  explicit AnyLaws(const LaneLayout& layout) : layout_(layout), modes_(layout.modes) {
    for (int s = 0; s < layout.segments; ++s)
      has_meijs_fokkema_ = has_meijs_fokkema_ || layout.segment[s].fringing == LaneFringing::meijs_fokkema;
  }

  void take(const LaneSwitch& s, std::size_t l) {
    for (int p = 0; p < layout_.points; ++p) {
      weight_[p][l] = s.weight[p], rest_gap_[p][l] = s.rest_gap[p];
      for (int i = 0; i < modes_; ++i) shape_[p * modes_ + i][l] = s.shape[p][i];
    }
    open_[l] = s.open, floor_[l] = s.floor, most_gap_[l] = s.most_gap;
    for (int k = 0; k < layout_.stretches; ++k) {
      width_[k][l] = s.width[k], thickness_[k][l] = s.thickness[k];
      set_parameters(film_[k], s.film[k], l);
      // Construct the fringing law once per switch, since its constructor computes roots of the width.
      if (has_meijs_fokkema_) meijs_fokkema_[k] = {.width = width_[k], .thickness = thickness_[k]};
    }
    for (int k = 0; k < layout_.electrodes; ++k)
      electrode_gaps_[k][l] = s.electrode_gaps[k], electrode_floor_[k][l] = s.electrode_floor[k];
    film_gaps_[l] = s.film_gaps, film_floor_[l] = s.film_floor;
    hamaker_[l] = s.hamaker_constant, distance_[l] = s.equilibrium_distance, crossover_[l] = s.crossover;
    tension_[l] = s.tension;
    for (int i = 0; i < modes_; ++i)
      for (int j = 0; j < modes_; ++j) slopes_[i * modes_ + j][l] = s.slopes[i][j];
  }

  [[nodiscard]] const V& floor() const { return floor_; }

  void add(const V* __restrict q, const V* __restrict v, const V* volts, V* sum, V& least) {
    find_field(q, v, least);
    power_ = 0;
    if (layout_.film >= 0) {
      add_film(gap_);
      if (layout_.far_film) {
        check_far_gap(0, layout_.points, film_gaps_, film_floor_);
        add_film(far_gap_);
      }
    }
    for (int s = 0; s < layout_.segments; ++s) add_electrode(layout_.segment[s], volts);
    if (layout_.dispersion != LaneDispersion::none) add_dispersion(V(1) + volts[layout_.electrodes]);
    project(sum);
    if (layout_.stretching) stretch(q, sum);
  }

  [[nodiscard]] const V& power() const { return power_; }

 private:
  // Calls f.operator()<n>() with the number of modes n as a compile-time constant, so that the modes' data stays in registers.
  template <int n = 1, class F>
  [[gnu::always_inline]] void with_modes(F&& f) const {
    if constexpr (n < capacity) {
      if (modes_ != n) return with_modes<n + 1>(f);
    }
    f.template operator()<n>();
  }

  void find_field(const V* __restrict q, const V* __restrict v, V& least) {
    with_modes([&]<int n>() { this->template find_field_of<n>(q, v, least); });
  }
  template <int n>
  void find_field_of(const V* __restrict q, const V* __restrict v, V& least) {
    V at[n], rate[n];
    for (int i = 0; i < n; ++i) at[i] = q[i], rate[i] = v[i];
    const V floor = floor_;
    V smallest = open_, largest = open_;
    for (int p = 0; p < layout_.points; ++p) {
      const V* shape = shape_ + p * n;
      V gap = rest_gap_[p] - shape[0] * at[0], velocity = shape[0] * rate[0];
      for (int i = 1; i < n; ++i) gap -= shape[i] * at[i], velocity += shape[i] * rate[i];
      smallest = min(smallest, gap), largest = max(largest, gap);
      gap_[p] = max(gap, floor), velocity_[p] = velocity, load_[p] = 0;
    }
    // A run fails when `least`, the smallest gap, is below its limit `floor`. The second argument of min() is below `floor`
    // when a gap on the far side is too small, so that the run then fails as well.
    least = min(smallest, floor + (most_gap_ - largest));
  }

  void check_far_gap(int begin, int end, const V& both, const V& floor) {
    for (int p = begin; p < end; ++p) far_gap_[p] = max(both - gap_[p], floor);
  }

  template <class Law>
  void add_law(Law law, const V* gap, int begin, int end, V drive) {
    for (int p = begin; p < end; ++p) load_[p] += drive * law.load(gap[p], velocity_[p]);
  }

  template <class Law>
  void add_law_and_power(Law law, const V* gap, int begin, int end, V drive) {
    for (int p = begin; p < end; ++p) {
      const V load = drive * law.load(gap[p], velocity_[p]);
      load_[p] += load;
      power_ += weight_[p] * load * velocity_[p];
    }
  }

  // Calls f(first, last, k) for every PointStretch k (points with equal beam size), whose points in [begin, end) are [first,
  // last).
  template <class F>
  [[gnu::always_inline]] void on_stretches(int begin, int end, F&& f) const {
    for (int k = 0; k < layout_.stretches; ++k) {
      const PointStretch stretch = layout_.stretch[k];
      const int first = stretch.begin > begin ? stretch.begin : begin, last = stretch.end < end ? stretch.end : end;
      if (first < last) f(first, last, k);
    }
  }

  // Adds the load of a gas film. For a film on the far side, velocity and force both have the opposite sign, so the load is the
  // same function of its gap.
  void add_film(const V* gap) {
    on_stretches(0, layout_.points, [&](int begin, int end, int k) { add_film(gap, begin, end, k); });
  }
  void add_film(const V* gap, int begin, int end, int k) {
    with_law<GasLaw::variant>(layout_.film, [&]<class Law>() { add_law(law_in_lanes<Law>(film_[k]), gap, begin, end, V(1)); });
  }

  void add_electrode(const Segment& pad, const V* volts) {
    V drive = volts[pad.electrode] * volts[pad.electrode];
    const V* gap = gap_;
    if (pad.far) {
      check_far_gap(pad.begin, pad.end, electrode_gaps_[pad.electrode], electrode_floor_[pad.electrode]);
      drive = -drive, gap = far_gap_;
    }
    const auto with = [&](auto law_of) {
      on_stretches(pad.begin, pad.end, [&](int begin, int end, int k) {
        const auto law = law_of(k);
        const ElectrostaticForce<std::remove_const_t<decltype(law)>> force{law};
        if (layout_.measures_work) {
          add_law_and_power(force, gap, begin, end, drive);
        } else {
          add_law(force, gap, begin, end, drive);
        }
      });
    };
    switch (pad.fringing) {
      case LaneFringing::none:
        return with([&](int k) { return NoFringingOf<V>{.width = width_[k]}; });
      case LaneFringing::linear:
        return with([&](int k) { return LinearFringingOf<V>{.width = width_[k]}; });
      case LaneFringing::meijs_fokkema:
        return with([&](int k) { return meijs_fokkema_[k]; });
    }
  }

  void add_dispersion(V factor) {
    const VanDerWaalsOf<V> near{.hamaker_constant = hamaker_, .equilibrium_distance = distance_};
    const auto with = [&](auto law) {
      on_stretches(0, layout_.points, [&](int begin, int end, int k) {
        add_law(DispersionForce<decltype(law), V>{.law = law, .width = width_[k]}, gap_, begin, end, factor);
      });
    };
    switch (layout_.dispersion) {
      case LaneDispersion::none:
        return;
      case LaneDispersion::van_der_waals:
        return with(near);
      case LaneDispersion::casimir:
        return with(IdealCasimir{});
      case LaneDispersion::smaller:
        return with(SmallerOfBoth<IdealCasimir, V>{.casimir = {}, .van_der_waals = near, .crossover = crossover_});
    }
  }

  void project(V* sum) const {
    with_modes([&]<int n>() { this->template project_of<n>(sum); });
  }
  template <int n>
  void project_of(V* sum) const {
    V part[n];
    for (int i = 0; i < n; ++i) part[i] = 0;
    for (int p = 0; p < layout_.points; ++p) {
      const V load = load_[p] * weight_[p];
      const V* shape = shape_ + p * n;
      for (int i = 0; i < n; ++i) part[i] += load * shape[i];
    }
    for (int i = 0; i < n; ++i) sum[i] += part[i];
  }

  // Adds the modal forces of mid-plane stretching (model/stretching.h).
  void stretch(const V* q, V* sum) const {
    V pull[capacity], strain = 0;
    for (int i = 0; i < modes_; ++i) {
      pull[i] = 0;
      for (int j = 0; j < modes_; ++j) pull[i] += slopes_[i * modes_ + j] * q[j];
      strain += q[i] * pull[i];
    }
    const V force = tension_ * strain;
    for (int i = 0; i < modes_; ++i) sum[i] -= force * pull[i];
  }

  const LaneLayout& layout_;
  const int modes_;
  V shape_[most_points * capacity], weight_[most_points], rest_gap_[most_points];
  V gap_[most_points], far_gap_[most_points], velocity_[most_points], load_[most_points];
  V open_, floor_, most_gap_, width_[most_points], thickness_[most_points];
  V film_[most_points][most_parameters];
  MeijsFokkemaFringingOf<V> meijs_fokkema_[most_points];
  bool has_meijs_fokkema_ = false;
  V electrode_gaps_[most_drives], electrode_floor_[most_drives], film_gaps_, film_floor_;
  V hamaker_, distance_, crossover_;
  V tension_, slopes_[capacity * capacity];
  V power_;
};

}  // namespace softland::simd
