// Every law over the three scalars of its state and parameters: a number, a lane with one number for each device, and a dual
// number with a direction for each parameter and for the state.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <experimental/simd>
#include <utility>

#include "model/contact/contact_law.h"
#include "model/dual.h"
#include "model/far_side.h"
#include "model/forces/casimir.h"
#include "model/forces/dispersion.h"
#include "model/forces/electrostatic.h"
#include "model/forces/gold_casimir.h"
#include "model/gas/gas_law.h"
#include "model/gas/reynolds_film.h"
#include "model/stretching.h"

namespace softland::scalars_test {
namespace {

constexpr std::size_t devices = 4;
using DeviceLane = std::experimental::fixed_size_simd<double, devices>;

/// State of a law: gap or interference [m], velocity or rate [m/s].
using State = std::pair<double, double>;

constexpr std::array gaps{State{2e-6, 0.1}, State{0.29e-6, -0.02}, State{61e-9, 0.3}, State{8e-9, 0.05}};
// Deep, at the crushing limit, shallow, and above the plane.
constexpr std::array interferences{State{70e-9, 0.05}, State{210e-9, -0.03}, State{1.5e-9, 0.02}, State{-2e-9, 0.01}};

template <class Derived>
struct PerLength {
  static constexpr auto& states = gaps;
  template <class P, class S>
  static S act(const auto& parameters, S gap, S velocity) {
    return Derived::template make<P>(parameters).load(gap, velocity);
  }
};
template <class Derived>
struct AtContact {
  static constexpr auto& states = interferences;
  template <class P, class S>
  static S act(const auto& parameters, S d, S) {
    return Derived::template make<P>(parameters).force(d);
  }
};

struct Strip : PerLength<Strip> {
  static constexpr std::array parameters{1.8e-5, 20e-6};
  template <class P>
  static auto make(const std::array<P, 2>& p) {
    return StripSqueezeFilmOf<P>{.viscosity = p[0], .width = p[1]};
  }
};
struct Slit : PerLength<Slit> {
  static constexpr std::array parameters{1.8e-5, 20e-6, 2e-6, 3e-6};
  template <class P>
  static auto make(const std::array<P, 4>& p) {
    return StripOverSlitOf<P>{.viscosity = p[0], .width = p[1], .slit_height = p[2], .slit_length = p[3]};
  }
};
template <template <class> class Law>
struct Rarefied : PerLength<Rarefied<Law>> {
  static constexpr std::array parameters{1.8e-5, 65e-9, 20e-6};
  template <class P>
  static auto make(const std::array<P, 3>& p) {
    return Law<P>{.viscosity = p[0], .mean_free_path = p[1], .width = p[2]};
  }
};
struct GuoAlexeenko : PerLength<GuoAlexeenko> {
  static constexpr std::array parameters{65e-9, 20e-6, 2e-6};
  template <class P>
  static auto make(const std::array<P, 3>& p) {
    return GuoAlexeenkoFilmOf<P>{.mean_free_path = p[0], .width = p[1], .thickness = p[2]};
  }
};
/// A rate of the film's own states, or its load; they depend on different parameters.
template <bool rate>
struct Compressible {
  static constexpr std::array parameters{101325.0, 1.8e-5, 65e-9, 20e-6};
  static constexpr auto& states = gaps;
  template <class P, class S>
  static S act(const std::array<P, 4>& p, S gap, S velocity) {
    const ReynoldsStationOf<P> station(p[0], p[1], p[2], p[3]);
    const std::array<S, 4> film{S(0.3), S(0.2), velocity, S(-0.1)};
    std::array<S, 4> rates;
    station.rates(gap, velocity, film.data(), rates.data());
    S load = S(0);
    station.add_load(film.data(), load);
    return rate ? rates[1] : load;
  }
};
struct Damper : PerLength<Damper> {
  static constexpr std::array parameters{0.02};
  template <class P>
  static auto make(const std::array<P, 1>& p) {
    return LinearDamperOf<P>{.damping = p[0]};
  }
};

template <template <class> class Law>
struct OfWidth : PerLength<OfWidth<Law>> {
  static constexpr std::array parameters{20e-6};
  template <class P>
  static auto make(const std::array<P, 1>& p) {
    return ElectrostaticForce<Law<P>>{{.width = p[0]}};
  }
};
template <template <class> class Law>
struct OfSection : PerLength<OfSection<Law>> {
  static constexpr std::array parameters{20e-6, 2e-6};
  template <class P>
  static auto make(const std::array<P, 2>& p) {
    return ElectrostaticForce<Law<P>>{{.width = p[0], .thickness = p[1]}};
  }
};
/// At the last of the gaps the law is its tangent.
struct OnBothSides : PerLength<OnBothSides> {
  static constexpr std::array parameters{20e-6, 2e-6, 2.015e-6, 40e-9};
  template <class P>
  static auto make(const std::array<P, 4>& p) {
    using Law = ElectrostaticForce<MeijsFokkemaFringingOf<P>>;
    const Law law{{.width = p[0], .thickness = p[1]}};
    return BothSides<Law, P>{.near = law, .far = {.law = law, .both_gaps = p[2], .floor = p[3]}};
  }
};
struct FarFilm : PerLength<FarFilm> {
  static constexpr std::array parameters{1.8e-5, 20e-6, 2.015e-6, 40e-9};
  template <class P>
  static auto make(const std::array<P, 4>& p) {
    const StripSqueezeFilmOf<P> law{.viscosity = p[0], .width = p[1]};
    return FarSide<StripSqueezeFilmOf<P>, P>{.law = law, .both_gaps = p[2], .floor = p[3]};
  }
};

template <class Casimir>
struct Retarded : PerLength<Retarded<Casimir>> {
  static constexpr std::array parameters{20e-6};
  template <class P>
  static auto make(const std::array<P, 1>& p) {
    return DispersionForce<Casimir, P>{.law = {}, .width = p[0]};
  }
};
struct Hamaker : PerLength<Hamaker> {
  static constexpr std::array parameters{4e-19, 0.2e-9, 20e-6};
  template <class P>
  static auto make(const std::array<P, 3>& p) {
    return DispersionForce<VanDerWaalsOf<P>, P>{.law = {.hamaker_constant = p[0], .equilibrium_distance = p[1]}, .width = p[2]};
  }
};
template <class Casimir>
struct SmallerOne : PerLength<SmallerOne<Casimir>> {
  static constexpr std::array parameters{4e-19, 0.2e-9, 20e-6};
  template <class P>
  static auto make(const std::array<P, 3>& p) {
    using Law = SmallerOfBoth<Casimir, P>;
    return DispersionForce<Law, P>{
        .law = {.casimir = {}, .van_der_waals = {.hamaker_constant = p[0], .equilibrium_distance = p[1]}}, .width = p[2]};
  }
};

struct Spring : AtContact<Spring> {
  static constexpr std::array parameters{900.0};
  template <class P>
  static auto make(const std::array<P, 1>& p) {
    return LinearContactOf<P>{.stiffness = p[0]};
  }
};
struct Uniform : AtContact<Uniform> {
  static constexpr std::array parameters{3e13, 150e-9};
  template <class P>
  static auto make(const std::array<P, 2>& p) {
    return UniformAsperityContactOf<P>{.strength = p[0], .height = p[1]};
  }
};
struct Gaussian : AtContact<Gaussian> {
  static constexpr std::array parameters{2e-3, 40e-9};
  template <class P>
  static auto make(const std::array<P, 2>& p) {
    return GaussianAsperityContactOf<P>{.strength = p[0], .deviation = p[1]};
  }
};
struct Adhesive : AtContact<Adhesive> {
  static constexpr std::array parameters{3e13, 150e-9, 20.0};
  template <class P>
  static auto make(const std::array<P, 3>& p) {
    return AdhesiveAsperityContactOf<P>{.repulsion = {.strength = p[0], .height = p[1]}, .attraction = p[2]};
  }
};
struct Damped : AtContact<Damped> {
  static constexpr std::array parameters{3e13, 150e-9, 40.0};
  template <class P>
  static auto make(const std::array<P, 3>& p) {
    return HuntCrossley<UniformAsperityContactOf<P>, P>{.elastic = {.strength = p[0], .height = p[1]}, .damping = p[2]};
  }
  template <class P, class S>
  static S act(const auto& p, S d, S rate) {
    return make<P>(p).force(d, rate);
  }
};
template <class Asperity>
struct Yielding : AtContact<Yielding<Asperity>> {
  static constexpr std::array parameters{1e4, 150e-9, 0.5e-6, 2e9, 60e9};
  template <class P>
  static auto make(const std::array<P, 5>& p) {
    return PlasticAsperityLoading<Asperity, P>(p[0], p[1], p[2], p[3], p[4]);
  }
};
/// A law with memory, which unloads if the rate is negative; each device has its own dent.
struct Remembering : AtContact<Remembering> {
  static constexpr std::array parameters{500.0, 900.0, 30e-9};
  template <class P>
  static auto make(const std::array<P, 3>& p) {
    return ContactWithMemory<LinearContactOf<P>, LinearContactOf<P>, true>{.loading = {.stiffness = p[0]},
                                                                           .elastic = {.stiffness = p[1]}};
  }
  template <class P, class S>
  static S act(const auto& p, S d, S rate) {
    const auto back = rate < 0;
    ContactStateOf<P, std::decay_t<decltype(back)>> state;
    state.unloading = back;
    state.shift = p[2];
    return make<P>(p).force(d, state);
  }
};
struct Repulsive : AtContact<Repulsive> {
  static constexpr SurfacePressure usual = {};
  static constexpr std::array parameters{usual.asperity_pressure,
                                         usual.asperity_distance,
                                         usual.wall_pressure,
                                         usual.wall_range,
                                         usual.adhesion_pressure,
                                         usual.adhesion_range,
                                         usual.hamaker_constant,
                                         usual.reach,
                                         2e-10};
  static constexpr std::array<State, 4> states{State{70e-9, 0}, State{30e-9, 0}, State{1.5e-9, 0}, State{-2e-9, 0}};
  template <class P>
  static auto make(const std::array<P, 9>& p) {
    const SurfacePressureOf<P> law = pressure(p);
    if constexpr (std::same_as<P, double>) {
      return AdhesiveRepulsiveContact(law, p[8]);
    } else if constexpr (LaneOfNumbers<P>) {
      const P touch([&](auto i) {
        std::array<double, 9> own;
        for (std::size_t k = 0; k < own.size(); ++k) own[k] = p[k][i];
        return AdhesiveRepulsiveContact(pressure(own), 1).touch_distance();
      });
      return AdhesiveRepulsiveContactOf<P>(law, p[8], touch);
    } else {
      return AdhesiveRepulsiveContactOf<P>(law, p[8], P(AdhesiveRepulsiveContact(usual, 1).touch_distance()));
    }
  }

 private:
  template <class P>
  static SurfacePressureOf<P> pressure(const std::array<P, 9>& p) {
    return {.asperity_pressure = p[0],
            .asperity_distance = p[1],
            .wall_pressure = p[2],
            .wall_range = p[3],
            .adhesion_pressure = p[4],
            .adhesion_range = p[5],
            .hamaker_constant = p[6],
            .reach = p[7]};
  }
};

/// Stretching with two modes: the force on the second one, or the energy.
template <bool energy>
struct Stretched {
  static constexpr std::array parameters{3e5, -2e4, 8e5, 40.0};
  static constexpr std::array states{State{2e-9, 3e-9}, State{1e-9, -2e-9}, State{-4e-9, 1e-9}, State{0.5e-9, 5e-9}};
  template <class P, class S>
  static S act(const std::array<P, 4>& p, S first, S second) {
    const MidPlaneStretchingOf<P> law{.modes = 2, .slopes = {p[0], p[1], p[1], p[2]}, .stiffness = p[3]};
    const std::array<S, 2> q{first, second};
    std::array<S, 2> force{S(0), S(0)};
    law.add_force(q.data(), force.data());
    return energy ? law.energy(q.data()) : force[1];
  }
};

template <class Law>
class ScalarsOf : public testing::Test {};
using Laws =
    testing::Types<Strip, Slit, Rarefied<VeijolaFilmOf>, Rarefied<GallisTorczynskiFilmOf>, Rarefied<NearContactFilmOf>,
                   Rarefied<SlipFilmOf>, GuoAlexeenko, Compressible<true>, Compressible<false>, Stretched<true>, Stretched<false>,
                   Damper, OfWidth<NoFringingOf>, OfWidth<LinearFringingOf>, OfSection<MeijsFokkemaFringingOf>,
                   OfSection<Bao2001FringingOf>, OnBothSides, FarFilm, Retarded<IdealCasimir>, Retarded<GoldCasimir>, Hamaker,
                   SmallerOne<IdealCasimir>, SmallerOne<GoldCasimir>, Spring, Uniform, Gaussian, Adhesive, Damped,
                   Yielding<ZmcAsperity>, Yielding<KogutEtsionAsperity>, Remembering, Repulsive>;
TYPED_TEST_SUITE(ScalarsOf, Laws);

/// Returns the parameters of a law for a device, which differ by some per cent from those of the device before.
template <class Law>
auto parameters_of(std::size_t device) {
  auto p = Law::parameters;
  for (std::size_t k = 0; k < p.size(); ++k) p[k] *= 1 + 0.01 * static_cast<double>(device) * (k % 2 == 0 ? 1 : -0.5);
  return p;
}

template <class Law>
double of_one(const auto& p, const State& at) {
  return Law::template act<double>(p, at.first, at.second);
}

TYPED_TEST(ScalarsOf, EveryDeviceOfALaneHasItsOwnAnswer) {
  constexpr std::size_t count = TypeParam::parameters.size();
  for (std::size_t turn = 0; turn < devices; ++turn) {
    const auto state_of = [turn](std::size_t i) { return TypeParam::states[(i + turn) % devices]; };
    std::array<DeviceLane, count> parameters;
    for (std::size_t k = 0; k < count; ++k) {
      parameters[k] = DeviceLane([&](auto i) { return parameters_of<TypeParam>(i)[k]; });
    }
    const DeviceLane all = TypeParam::template act<DeviceLane>(parameters, DeviceLane([&](auto i) { return state_of(i).first; }),
                                                               DeviceLane([&](auto i) { return state_of(i).second; }));
    for (std::size_t i = 0; i < devices; ++i) {
      const double alone = of_one<TypeParam>(parameters_of<TypeParam>(i), state_of(i));
      EXPECT_NEAR(all[i], alone, 1e-11 * std::abs(alone)) << "device " << i << ", state " << state_of(i).first;
    }
  }
}

TYPED_TEST(ScalarsOf, SlopesAreThoseOfEveryParameterAndOfTheState) {
  constexpr std::size_t count = TypeParam::parameters.size();
  using G = Gradient<count + 2>;
  using D = Directions<count + 2>;
  for (const State& at : TypeParam::states) {
    std::array<G, count> parameters;
    for (std::size_t k = 0; k < count; ++k) parameters[k] = G(TypeParam::parameters[k], D::unit(k));
    const G all = TypeParam::template act<G>(parameters, G(at.first, D::unit(count)), G(at.second, D::unit(count + 1)));
    const double alone = of_one<TypeParam>(TypeParam::parameters, at);
    EXPECT_NEAR(all.value, alone, 1e-13 * std::abs(alone)) << at.first;
    for (std::size_t k = 0; k < count + 2; ++k) {
      const double size = k < count ? TypeParam::parameters[k] : k == count ? at.first : at.second;
      if (size == 0) continue;
      // Central differences, extrapolated to remove the error of second order.
      const auto moved = [&](double share) {
        auto p = TypeParam::parameters;
        State there = at;
        (k < count ? p[k] : k == count ? there.first : there.second) += share * size;
        return of_one<TypeParam>(p, there);
      };
      const auto central = [&](double share) { return (moved(share) - moved(-share)) / (2 * share); };
      const double expected = (4 * central(1e-4) - central(2e-4)) / 3;
      EXPECT_NEAR(all.slope.along[k] * size, expected, 1e-8 * (std::abs(expected) + std::abs(alone)))
          << "parameter " << k << ", state " << at.first;
    }
  }
}

}  // namespace
}  // namespace softland::scalars_test
