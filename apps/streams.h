// Writes to standard output and standard error; all other files write through these functions. Control characters in titles,
// paths and keys are escaped, so that they cannot act on a terminal.
#pragma once

#include <string_view>

#include "base/progress.h"

namespace softland::apps {

/// Thrown when the program was asked to stop while it waits for a reader of its output.
class OutputInterrupted : public Interrupted {};

/// Opens a substitute for every closed standard stream, so that no other file gets the descriptor of that stream. Writing to a
/// substitute fails.
void open_standard_streams();

/// Writes to standard output. Throws OutputLost if only part of the text could be written, and OutputInterrupted if, after a
/// signal to stop, no reader takes the output for 0.6 s.
void print(std::string_view text);

/// Writes "softland: " and one line to standard error, as far as that is possible.
void print_note(std::string_view line);

/// Writes the progress bar over the last line of a terminal on standard error; empty text removes it.
void show_bar(std::string_view line);
/// Keeps the progress bar on the screen and continues on the next line.
void end_bar();

}  // namespace softland::apps
