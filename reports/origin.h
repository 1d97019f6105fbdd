// The origin of a result (verb, program, machine, command line and scene), as every JSON and every page states it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "document/document.h"
#include "store/study_store.h"
#include "studies/closing/prepared.h"

namespace softland {

/// Program and machine that gave a result, with everything that can change the last digits of the result. The same scene, seed
/// and program give the same bits on the same kind of processor. Another compiler, other options or another instruction set
/// round differently; so do functions of the C library, which chooses their version by the processor.
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
class Archive;  // writes, reads or lists the members of a record: see reports/record.h
}  // namespace internal

/// The origin of the results of a study; `scene` is null if the study has no scene.
struct Origin {
  std::string kind;  ///< name of the verb that gave the results, by which the verb `report` recognises their JSON
  std::string version, command;
  MadeWith made_with;
  nlohmann::json scene = {};  ///< resolved scene (all defaults written out) as JSON, quantities as text
  /// Resolved scene (all defaults written out) as the text of a scene file; empty if no page shows it.
  std::string scene_toml = {};
};
/// Names the members of the JSON of program and machine, and of the origin, with which the JSON of every verb begins.
void members(internal::Archive& a, MadeWith& made);
void members(internal::Archive& a, Origin& origin);
[[nodiscard]] Origin origin_of(const char* kind, const std::string& command);
[[nodiscard]] Origin origin_of(const char* kind, const PreparedScene& scene, const std::string& command);
/// Makes the origin of results, with the text of the scene in scene_toml.
[[nodiscard]] Origin whole_origin_of(const char* kind, const PreparedScene& scene, const std::string& command);
/// Returns the data for computing the result of a document again: origin of the result, seed and tolerance.
[[nodiscard]] MadeAgain made_again(const Origin& origin, std::optional<std::uint64_t> seed = {},
                                   double tolerance = std::numeric_limits<double>::quiet_NaN());
/// Returns the title of the scene from which results were computed; empty if the scene has none.
[[nodiscard]] std::string title_of(const Origin& origin);

/// Returns the JSON of a result with the members version, made_with and command.
[[nodiscard]] nlohmann::json with_origin(nlohmann::json record, const std::string& command);
/// Returns the JSON of a result with the members version, made_with, command and the resolved scene.
[[nodiscard]] nlohmann::json with_origin(nlohmann::json record, const PreparedScene& scene, const std::string& command);

/// Describes the writer of a database file: this program on this machine, run with the command line `command`.
[[nodiscard]] StoredOrigin stored_origin(const std::string& command);

}  // namespace softland
