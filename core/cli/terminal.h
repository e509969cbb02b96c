// Terminal: what goes to stdout and stderr.
#pragma once

#include <string>
#include <string_view>

#include "base/json_text.h"

namespace freeplay {

/// Opens standard input, output and error on the null device where they are closed: a file that is opened later would
/// get their number, and what is printed. Call before any file is opened.
void open_standard_descriptors();

/// Writes text for people to stdout, its control characters replaced (file names and names in a model may hold some).
/// What cannot be written is dropped, and the command goes on: its exit code says how it went, see stdout_failure().
void print(std::string_view text);
/// The same byte for byte: data.
void print_data(std::string_view text);
void print_json(const Json& json);

/// Why stdout did not take all that was printed; empty if it did, or if its pipe was closed.
std::string stdout_failure();

/// Writes messages to stderr, control characters replaced, with colour where it is wanted. A failure there is not
/// reported, for lack of a place.
void print_messages(std::string_view messages, bool no_color);

bool stderr_is_terminal();
bool stdout_is_terminal();
/// Characters in a line of the terminal on stdout; 80 where it is none.
int stdout_columns();
/// Whether what reads stdout is to be given more than ASCII, by the locale and the kind of terminal.
bool stdout_takes_unicode();

}  // namespace freeplay
