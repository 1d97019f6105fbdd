// The verbs of the command line, in the order of --help: each is a file here that says what it may be told and does it.
#pragma once

#include <array>

#include "apps/options.h"

namespace softland::apps {

void add_simulate(Verb& verb);
void add_pull_in(Verb& verb);
void add_modes(Verb& verb);
void add_check(Verb& verb);
void add_effects(Verb& verb);
void add_accuracy(Verb& verb);
void add_optimize(Verb& verb);
void add_limit(Verb& verb);
void add_release(Verb& verb);
void add_explore(Verb& verb);
void add_robustness(Verb& verb);
void add_calibrate(Verb& verb);
void add_fit(Verb& verb);
void add_tune(Verb& verb);
void add_device(Verb& verb);
void add_table(Verb& verb);
void add_status(Verb& verb);
void add_merge(Verb& verb);
void add_slurm(Verb& verb);
void add_new(Verb& verb);
void add_export(Verb& verb);
void add_report(Verb& verb);
void add_read(Verb& verb);

struct VerbRow {
  const char* name;
  const char* about;
  void (*add)(Verb& verb);  ///< says what the verb may be told, and what it runs
};

inline constexpr std::array all_verbs{
    VerbRow{"simulate", "simulate the closing that a scene describes", add_simulate},
    VerbRow{"pull-in", "static and dynamic pull-in voltage and release voltage of every electrode", add_pull_in},
    VerbRow{"modes", "natural frequencies; modes of another program as a table for a scene", add_modes},
    VerbRow{"check", "validate a scene and print derived numbers and warnings", add_check},
    VerbRow{"effects", "which effects matter in a scene, by how much, and what each costs", add_effects},
    VerbRow{"accuracy", "what accuracy costs in time: errors of the figures for every integrator and setting", add_accuracy},
    VerbRow{"optimize", "search the drive waveform that closes without bounce", add_optimize},
    VerbRow{"limit", "the least time in which any waveform can close the switch softly", add_limit},
    VerbRow{"release", "search the drive waveform that opens the closed switch without leaving it to swing", add_release},
    VerbRow{"explore", "compute many points of a design space into a store", add_explore},
    VerbRow{"robustness", "how drives do on devices that differ as [spread] says", add_robustness},
    VerbRow{"calibrate", "which measurable figures of a device pin its waveform best", add_calibrate},
    VerbRow{"fit", "fit a scene to what was measured on devices", add_fit},
    VerbRow{"tune", "tune the waveform on a device, by nothing but the state of its contact", add_tune},
    VerbRow{"device", "a simulated device that answers as one in a laboratory, to practise on", add_device},
    VerbRow{"table", "print the rows of a store, as CSV or for people", add_table},
    VerbRow{"status", "how far studies are, and who writes into their stores", add_status},
    VerbRow{"merge", "make one store of the parts of a study", add_merge},
    VerbRow{"slurm", "print the script of a study for a cluster with Slurm", add_slurm},
    VerbRow{"new", "print a commented scene to start from", add_new},
    VerbRow{"export", "print the waveforms of a result for a generator or a circuit simulator", add_export},
    VerbRow{"report", "make the report of a result.json again, or the page of an exploration", add_report},
    VerbRow{"read", "what a file of an oscilloscope or another instrument holds", add_read},
};

}  // namespace softland::apps
