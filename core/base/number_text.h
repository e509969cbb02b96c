// NumberText: numbers as the result files and the command line write them.
#pragma once

#include <string>

namespace freeplay {

/// Appends the shortest decimal form that reads back to the same double, with '.' whatever the locale. Nothing for NaN:
/// an empty field of a table. Does not allocate if `out` has room for 32 more characters.
void append_number(std::string& out, double value);

std::string number_text(double value);

}  // namespace freeplay
