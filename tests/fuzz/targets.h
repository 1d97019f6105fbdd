// The readers of text from outside, as functions of the text (targets). libFuzzer calls them with generated texts
// (libfuzzer.cc, run_fuzzers), and the test suite with the kept texts (replay_test.cc).
//
// A target catches the InvalidInput by which it refuses its input. Any other exception that leaves it is a fault.
#pragma once

#include <array>
#include <stdexcept>
#include <string>
#include <string_view>

#include "base/require.h"

namespace softland::fuzz {

/// A target each for a scene file, --set assignments to a scene (separated by NUL), a quantity, a table of voltages, a file of
/// an instrument, a file of modes, a result.json, and a line between a tuning and a device.
void scene(std::string_view input);
void set(std::string_view input);
void units(std::string_view input);
void table(std::string_view input);
void recording(std::string_view input);
void modes(std::string_view input);
void result(std::string_view input);
void lines(std::string_view input);

struct Target {
  std::string_view name;
  void (*read)(std::string_view);
};
inline constexpr std::array targets{Target{"scene", scene},         Target{"set", set},
                                    Target{"units", units},         Target{"table", table},
                                    Target{"recording", recording}, Target{"modes", modes}};
/// Targets for files that softland itself writes.
inline constexpr std::array written_targets{Target{"result", result}, Target{"lines", lines}};

/// Throws logic_error unless `holds`.
inline void check(bool holds, const std::string& what) {
  if (!holds) throw std::logic_error(what);
}

/// Returns true if `read` accepted its input, and false if it refused it with a message. Throws logic_error for any other
/// outcome.
template <class Read>
bool accepted(const Read& read) {
  try {
    read();
    return true;
  } catch (const InvalidInput& refusal) {
    check(!std::string_view(refusal.what()).empty(), "a refusal without a message");
    return false;
  }
}

}  // namespace softland::fuzz
