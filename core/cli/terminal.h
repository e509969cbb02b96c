// Terminal: what goes to stdout and stderr.
#pragma once

#include <string_view>

#include "io/json_text.h"

namespace freeplay {

/// Writes text for people to stdout, its control characters replaced (file names and names in a model may hold some).
/// Throws Error{file} if it cannot be written.
void print(std::string_view text);
/// The same byte for byte: data.
void print_data(std::string_view text);
void print_json(const Json& json);

/// Writes messages to stderr, control characters replaced, with colour where it is wanted. A failure there is nobody's
/// to hear.
void print_messages(std::string_view text, bool no_color);

bool stderr_is_terminal();

}  // namespace freeplay
