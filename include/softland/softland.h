// softland as a library: what is meant to be called from outside. docs/library.md is the way in, examples/ its programs.
//
// Numbers are in SI units. Names are in the namespace `softland`; `softland::internal` is not for callers, nor is any header that
// is not reached from here.
//
// Threads. Objects are values that share nothing that changes: one object may be read by several threads at once, and different
// objects used by different threads. Exceptions are said where they are: Switch::Workspace, steppers and observers belong to one
// thread. Functions with a `jobs` start that many threads by themselves, and what they find does not depend on it. What is
// handed to them is called from these: OwnWaveform, OwnObjective, OwnContactLaw, EvaluationMemory and `Progress`.
//
// Errors. InvalidInput: what was given breaks a rule; the message names value and rule, of a scene file, line and key, too.
// Interrupted: a Progress asked to stop. Trouble of the computation is a Status in a result, whose figures are then NaN.
// Nothing else is thrown on purpose but what a user's own class throws, and std::bad_alloc.
#pragma once

#include "base/engineering.h"  // engineering(2.5e-05, "s"): "25 us"
#include "base/progress.h"     // Progress, Interrupted
#include "base/require.h"      // InvalidInput, InvalidParameter, InvalidRequest

// A scene: from a file, from text, or from a Device made here.
#include "config/aim.h"                       // parse_aim("0.7 bounce + 0.3 energy")
#include "config/assumed_spread.h"            // how devices differ, where a scene does not say
#include "config/condition.h"                 // conditions: "permanent_contact_time < 60 us"
#include "config/invalid_key.h"               // InvalidKey: key, file and line of what is wrong in a scene
#include "config/scene.h"                     // SceneFile, Scene
#include "model/device.h"                     // Device
#include "model/structure/tabulated_modes.h"  // ModalTable: a structure by its modes

// Its pieces: the switch, its pull-in voltages, waveforms and one closing.
#include "exchange/recording.h"  // read: files of instruments
#include "model/closing.h"       // simulate_closing
#include "model/pull_in.h"       // static_pull_in, dynamic_pull_in, release_voltage
#include "model/switch.h"        // Switch
#include "objectives/figures.h"  // figure_table: every figure of merit, its name and unit
#include "waveforms/export.h"    // CSV and SPICE for a generator
#include "waveforms/waveform.h"  // Waveform: the families

// The studies behind the verbs of the program.
#include "studies/closing/auto_settings.h"           // prepare_and_choose: a scene made ready to run
#include "studies/closing/certify.h"                 // simulate --certify
#include "studies/closing/effects.h"                 // effects
#include "studies/closing/prepared.h"                // PreparedScene
#include "studies/closing/simulate.h"                // simulate
#include "studies/closing/sweep.h"                   // pull-in --sweep
#include "studies/devices/derivatives.h"             // figures by what the scene says
#include "studies/devices/evaluator.h"               // figures as a function of numbers of a scene, many rows at once
#include "studies/devices/robustness.h"              // robustness
#include "studies/exploration/exploration_runner.h"  // explore: the points of a plan into a store
#include "studies/exploration/front_search.h"        // explore --pareto
#include "studies/inverse/practice_device.h"         // device
#include "studies/inverse/tuner.h"                   // tune
#include "studies/search/limit.h"                    // limit
#include "studies/search/opening.h"                  // release
#include "studies/search/optimize.h"                 // optimize --robust none
#include "studies/search/robust_optimize.h"          // optimize --robust MEASURE
#include "studies/search/robust_search_study.h"      // optimize: for the drawing, and for devices that differ
#include "studies/search/search_request.h"  // optimize, whatever its options: run(planned(completed(words, scene), scene))
#include "studies/search/seed_study.h"      // optimize --seeds
#include "studies/search/stored_search.h"   // optimize --resume: a search as its store keeps it

// The doors for what softland does not have.
#include "model/contact/own.h"
#include "objectives/own_objective.h"
#include "waveforms/own_waveform.h"
