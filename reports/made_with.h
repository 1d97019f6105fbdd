// Program and machine that gave a result, with everything that can change the last digits of the result. The same scene, seed
// and program give the same bits on the same kind of processor. Another compiler, other options or another instruction set
// round differently; so do functions of the C library, which chooses their version by the processor.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace softland {

struct MadeWith {
  std::string program, compiler, options, instruction_set, vectors, c_library, processor;
};

/// Describes this program, this machine, and the vector instructions that simulate ensembles
/// (model/ensemble/ensemble_closings.h); unknown members are empty.
[[nodiscard]] const MadeWith& made_with();
/// Returns program and machine as JSON, {"program": ..., "compiler": ...}; an unknown member is null.
[[nodiscard]] nlohmann::json made_with_json(const MadeWith& all = made_with());

namespace internal {
/// Returns program and machine as text on one line; empty if nothing is known.
[[nodiscard]] std::string made_with_text(const MadeWith& all);
}  // namespace internal

}  // namespace softland
