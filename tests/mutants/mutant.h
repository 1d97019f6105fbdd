#pragma once
// Included before all else where mutants.py rewrote the sources: which mutant runs, asked at every place that has one.

#include <cstdio>
#include <cstdlib>

namespace softland_mutant {

inline constexpr int highest = 9999;
inline constexpr int not_read = -1, none_but_tell = -2;
inline int chosen = not_read;
inline bool reached[highest + 1] = {};

[[maybe_unused]] static void tell_reached() {
  if (std::FILE* const file = std::fopen(std::getenv("SOFTLAND_MUTANTS_REACHED"), "a")) {
    for (int mutant = 1; mutant <= highest; ++mutant) {
      if (reached[mutant]) {
        std::fprintf(file, "%d\n", mutant);
      }
    }
    std::fclose(file);
  }
}

// Reads SOFTLAND_MUTANT, the one that runs: at the first call, whichever static object makes it. With SOFTLAND_MUTANTS_REACHED, a
// file, none does, and at exit those that were asked for are appended to it. Each source has its own, compiled for its own
// processor.
[[maybe_unused, gnu::noinline, gnu::cold]] static bool ask(int mutant) {
  if (chosen == not_read) {
    const char* const text = std::getenv("SOFTLAND_MUTANT");
    chosen = text == nullptr ? 0 : std::atoi(text);
    if (std::getenv("SOFTLAND_MUTANTS_REACHED") != nullptr) {
      chosen = none_but_tell;
      std::atexit(tell_reached);
    }
  }
  reached[mutant] = true;
  return chosen == mutant;
}

// True if the mutant of this number, from 1, runs. None does where the compiler works out constants.
[[gnu::always_inline]] constexpr bool is(int mutant) {
  if (__builtin_is_constant_evaluated()) {
    return false;
  }
  const int now = chosen;
  return now >= 0 ? now == mutant : ask(mutant);
}

}  // namespace softland_mutant
