// What a result was made with, as far as it can change the last digits of its numbers: the same scene, seed and program give the
// same bits on the same kind of processor. Another compiler, other options or another instruction set round differently; so do
// the functions of the C library, which chooses among its versions by the processor it runs on.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace softland {

/// {"program": build id, a fingerprint of the program's code; "compiler", "options", "instruction_set", "c_library",
/// "processor"}; null for what the machine does not tell.
[[nodiscard]] nlohmann::json made_with();

namespace internal {
/// The same in one line; empty for a result that does not say.
[[nodiscard]] std::string made_with_text(const nlohmann::json& result);
}  // namespace internal

}  // namespace softland
