// The process and its terminal, in one way on all systems: process_posix.cpp and process_windows.cpp.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace flaunay::system {

/// To be called first in a program: standard streams carry bytes, closed ones are errors where they are used,
/// and so are closed pipes and files that become too large.
void prepare_streams();
/// As in every filter, from now on a closed pipe ends the program without a message, where systems do that.
void end_on_closed_pipe();

/// The arguments of main, in UTF-8.
std::vector<std::string> arguments_of_main(int argc, char** argv);

/// From now on, signals that end the process, such as Ctrl-C, first call `clean_up` on a separate thread,
/// unless they are ignored. To be called before there are other threads.
void clean_up_when_interrupted(void (*clean_up)());

/// The number of columns if standard error is a terminal that obeys escape sequences, else 0.
std::size_t terminal_width();
/// Writes to standard error at once. Failures are ignored.
void write_to_terminal(const std::string& text);

}  // namespace flaunay::system
