// Standard output and standard error: the only place that writes to either. Nothing that acts on a terminal gets through,
// whatever titles, paths and keys hold.
#pragma once

#include <string_view>

#include "base/watch.h"

namespace softland::apps {

/// Asked to stop, and nobody takes the output: there is no use in writing more.
class OutputInterrupted : public Interrupted {};

/// Gives a standard stream that is closed a place that takes nothing, so that no file of ours takes its number.
void open_standard_streams();

/// Writes to standard output. Throws OutputLost where not all of it could be written; OutputInterrupted where a signal asks to
/// stop and nobody takes the output for a second.
void print(std::string_view text);

/// Writes "softland: " and one line to standard error, as far as that is possible.
void say(std::string_view line);

/// Writes the bar of progress over what stands in the last line of a terminal on standard error; empty text takes it away.
void show_bar(std::string_view line);
/// Leaves the bar where it is and goes on below it.
void end_bar();

}  // namespace softland::apps
