// The readers of text from outside, as functions of that text. libFuzzer calls them with texts of its own making (libfuzzer.cc,
// run_fuzzers). The test suite calls them with the kept ones (replay_test.cc).
//
// A target refuses its input with InvalidInput, which it catches itself. Every other exception that leaves it is a find.
#pragma once

#include <array>
#include <stdexcept>
#include <string>
#include <string_view>

#include "base/require.h"

namespace softland::fuzz {

/// A scene file, --set assignments to a scene (separated by NUL), a quantity, a table of voltages, a file of an instrument, a
/// file of modes, a result.json, a line between a tuning and a device.
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
/// Targets for files that softland writes for itself.
inline constexpr std::array written_targets{Target{"result", result}, Target{"lines", lines}};

/// Throws logic_error unless `holds`.
inline void check(bool holds, const std::string& what) {
  if (!holds) throw std::logic_error(what);
}

/// Returns true if `read` took its input. Refusing it, with a message, is the only other way out.
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
