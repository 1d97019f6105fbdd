// Writes to standard output and standard error; no other file does. Control characters in titles, paths and keys are escaped, so
// that they cannot act on a terminal.
#pragma once

#include <string_view>

#include "base/progress.h"

namespace softland::apps {

/// Thrown when the program was asked to stop while no reader takes the output.
class OutputInterrupted : public Interrupted {};

/// Opens a substitute for every closed standard stream, so that no other file gets its descriptor. Writing to it fails.
void open_standard_streams();

/// Writes to standard output. Throws OutputLost if not all of the text could be written, and OutputInterrupted if, after a
/// signal to stop, no reader takes the output for about a second.
void print(std::string_view text);

/// Writes "softland: " and one line to standard error, as far as that is possible.
void print_note(std::string_view line);

/// Writes the progress bar over the last line of a terminal on standard error; empty text removes it.
void show_bar(std::string_view line);
/// Keeps the progress bar on the screen and continues on the next line.
void end_bar();

}  // namespace softland::apps
