// The record of program and machine holds all that can change the last digits of a result: the same scene, seed and program
// give the same bits on the same kind of processor. Another compiler, other options or another instruction set round
// differently; so do the functions of the C library, which chooses among its versions by the processor it runs on.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace softland {

struct MadeWith {
  std::string program, compiler, options, instruction_set, vectors, c_library, processor;
};

/// Describes this program on this machine, and the vector instructions that close ensembles
/// (model/ensemble/ensemble_closings.h); empty where the machine does not tell.
[[nodiscard]] const MadeWith& made_with();
/// Returns {"program": ..., "compiler": ...}; null for unknown members.
[[nodiscard]] nlohmann::json made_with_json(const MadeWith& all = made_with());

namespace internal {
/// Returns one line; empty where nothing is known.
[[nodiscard]] std::string made_with_text(const MadeWith& all);
}  // namespace internal

}  // namespace softland
