#pragma once
// Included first in sources that mutants.py rewrote: decides at every mutated place whether its mutant is active.

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

// Reads the active mutant from SOFTLAND_MUTANT at the first call, which may come from any static object. If
// SOFTLAND_MUTANTS_REACHED names a file, no mutant is active, and the numbers of all reached mutants are appended to that file
// at exit. Each source has its own copy, compiled for its own processor.
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

// True if the mutant with this number, counted from 1, is active. None is active in constant evaluation.
[[gnu::always_inline]] constexpr bool is(int mutant) {
  if (__builtin_is_constant_evaluated()) {
    return false;
  }
  const int now = chosen;
  return now >= 0 ? now == mutant : ask(mutant);
}

}  // namespace softland_mutant
