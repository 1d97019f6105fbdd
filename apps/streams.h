// Standard output and standard error are written here only. Characters that act on a terminal are escaped, whatever titles,
// paths and keys hold.
#pragma once

#include <string_view>

#include "base/watch.h"

namespace softland::apps {

/// The program was asked to stop, and nobody takes the output: further writing is useless.
class OutputInterrupted : public Interrupted {};

/// Opens a substitute for a closed standard stream, so that no file of ours takes its number; it accepts no output.
void open_standard_streams();

/// Writes to standard output. Throws OutputLost where not all of it could be written; OutputInterrupted where a signal asks to
/// stop and nobody takes the output for a second.
void print(std::string_view text);

/// Writes "softland: " and one line to standard error, as far as that is possible.
void say(std::string_view line);

/// Writes the progress bar over the last line of a terminal on standard error; empty text removes it.
void show_bar(std::string_view line);
/// Leaves the bar where it is and continues below it.
void end_bar();

}  // namespace softland::apps
