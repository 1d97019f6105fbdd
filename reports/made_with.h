// What a result was made with, as far as it can change the last digits of its numbers: the same scene, seed and program give the
// same bits on the same kind of processor. Another compiler, other options or another instruction set round differently; so do
// the functions of the C library, which chooses among its versions by the processor it runs on.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace softland {

struct MadeWith {
  std::string program, compiler, options, instruction_set, vectors, c_library, processor;
};

/// Of this program on this machine, and the vector instructions that ensembles are closed with (model/ensemble/fleet.h); empty
/// for what the machine does not tell.
[[nodiscard]] const MadeWith& made_with();
/// {"program": ..., "compiler": ...}; null for what is not known.
[[nodiscard]] nlohmann::json made_with_json(const MadeWith& all = made_with());

namespace internal {
/// In one line; empty where nothing is known.
[[nodiscard]] std::string made_with_text(const MadeWith& all);
}  // namespace internal

}  // namespace softland
