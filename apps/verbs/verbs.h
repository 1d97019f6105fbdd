// The command line alone runs these: the verbs of verbs/study.h without a computation, and its own verbs in the order of
// --help. Each of the latter is a file here that declares its options and runs it.
#pragma once

#include <array>
#include <string_view>

#include "apps/studies.h"

namespace softland::apps {

void add_modes(Verb& verb);
void add_table(Verb& verb);
void add_status(Verb& verb);
void add_merge(Verb& verb);
void add_slurm(Verb& verb);
void add_new(Verb& verb);
void add_report(Verb& verb);
void add_read(Verb& verb);

/// Shows the JSON of `modes` again, as `report` does; verbs/study.h does not list that verb. Throws InvalidInput for other
/// JSON.
[[nodiscard]] verbs::Outcome modes_shown_again(const nlohmann::json& json);

// The program runs these verbs of verbs/study.h in its own way.
[[nodiscard]] int run_optimize(const Common& common, const verbs::Told& told);
[[nodiscard]] int run_explore(const Common& common, const verbs::Told& told);
[[nodiscard]] int run_tune(const Common& common, const verbs::Told& told);
[[nodiscard]] int run_device(const Common& common, const verbs::Told& told);

struct RunRow {
  std::string_view name;
  RunTold run;
};
inline constexpr std::array runs{RunRow{"optimize", run_optimize}, RunRow{"explore", run_explore}, RunRow{"tune", run_tune},
                                 RunRow{"device", run_device}};

struct VerbRow {
  const char* name;
  const char* about;
  void (*add)(Verb& verb);  ///< declares the options of the verb, and its action
};

/// These verbs stand behind those of verbs/study.h in --help.
inline constexpr std::array other_verbs{
    VerbRow{"modes", "natural frequencies; modes of another program as a table for a scene", add_modes},
    VerbRow{"table", "print the rows of a store, as CSV or for people", add_table},
    VerbRow{"status", "how far studies are, and who writes into their stores", add_status},
    VerbRow{"merge", "make one store of the parts of a study", add_merge},
    VerbRow{"slurm", "print the script of a study for a cluster with Slurm", add_slurm},
    VerbRow{"new", "print a commented scene to start from", add_new},
    VerbRow{"report", "make text, pages and pictures again: of the JSON of a verb, or of an exploration", add_report},
    VerbRow{"read", "what a file of an oscilloscope or another instrument holds", add_read},
};

}  // namespace softland::apps
