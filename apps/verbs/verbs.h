// Verbs that the command line runs by other code than Python does, and verbs that only the command line has, in the order of
// --help. Each verb has a file in this folder, with its options and its action.
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

/// Makes the text of the verb `modes` again from its JSON, for the verb `report`. Throws InvalidInput for other JSON.
[[nodiscard]] verbs::Outcome modes_shown_again(const nlohmann::json& json);

// Actions of the verbs whose description in verbs/study.h has no computation: each returns the exit status of the program.
[[nodiscard]] int run_optimize(const Common& common, const verbs::Arguments& arguments);
[[nodiscard]] int run_explore(const Common& common, const verbs::Arguments& arguments);
[[nodiscard]] int run_tune(const Common& common, const verbs::Arguments& arguments);
[[nodiscard]] int run_device(const Common& common, const verbs::Arguments& arguments);

struct RunRow {
  std::string_view name;
  RunTold run;
};
inline constexpr std::array runs{RunRow{"optimize", run_optimize}, RunRow{"explore", run_explore}, RunRow{"tune", run_tune},
                                 RunRow{"device", run_device}};

struct VerbRow {
  const char* name;
  const char* about;
  void (*add)(Verb& verb);  ///< declares the options and the action of the verb
};

/// Verbs that only the program has; --help lists them after the verbs of verbs/study.h.
inline constexpr std::array other_verbs{
    VerbRow{"modes", "compute natural frequencies, or convert modes of another program into a table for a scene", add_modes},
    VerbRow{"table", "print the rows of a store as a table or as CSV", add_table},
    VerbRow{"status", "show the progress of studies, and the processes that write to their stores", add_status},
    VerbRow{"merge", "merge the parts of a study into one store", add_merge},
    VerbRow{"slurm", "print the job script of a study for a Slurm cluster", add_slurm},
    VerbRow{"new", "print a commented example scene to start from", add_new},
    VerbRow{"report", "make text, pages and plots again from the JSON of a verb or from the store of an exploration", add_report},
    VerbRow{"read", "show the channels in a file of an oscilloscope or another instrument", add_read},
};

}  // namespace softland::apps
