// Unit literals, so that a call in a test or a benchmark reads like a data sheet: 250_um, 78_GPa. SI inside.
#pragma once

namespace softland::literals {

#define SOFTLAND_LITERAL(suffix, factor)                                                                    \
  constexpr double operator""_##suffix(long double value) { return static_cast<double>(value) * (factor); } \
  constexpr double operator""_##suffix(unsigned long long value) { return static_cast<double>(value) * (factor); }

SOFTLAND_LITERAL(m, 1.0)
SOFTLAND_LITERAL(um, 1e-6)
SOFTLAND_LITERAL(nm, 1e-9)
SOFTLAND_LITERAL(s, 1.0)
SOFTLAND_LITERAL(ms, 1e-3)
SOFTLAND_LITERAL(us, 1e-6)
SOFTLAND_LITERAL(ns, 1e-9)
SOFTLAND_LITERAL(V, 1.0)
SOFTLAND_LITERAL(Pa, 1.0)
SOFTLAND_LITERAL(MPa, 1e6)
SOFTLAND_LITERAL(GPa, 1e9)
SOFTLAND_LITERAL(kg_m3, 1.0)
SOFTLAND_LITERAL(Pa_s, 1.0)
SOFTLAND_LITERAL(per_m2, 1.0)
SOFTLAND_LITERAL(pm_V, 1e-12)
SOFTLAND_LITERAL(N_m, 1.0)
SOFTLAND_LITERAL(rad_s, 1.0)

#undef SOFTLAND_LITERAL

}  // namespace softland::literals
