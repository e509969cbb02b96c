// Values of options: texts that are read before any model, so that they know no parameters.
#pragma once

#include <string>
#include <vector>

#include "base/unit.h"

namespace freeplay {

/// Throws Error{usage} "bad-value": "bad value 'TEXT' of OPTION: WHY".
[[noreturn]] void bad_value(const std::string& option, const std::string& text, const std::string& why,
                            const std::string& hint = {});
/// A whole number from `least` to 10^9. Throws Error{usage} "bad-value".
long whole_number(const std::string& option, const std::string& text, long least);
/// A positive quantity such as "0.5 s". Throws Error{usage} "bad-value".
double positive_quantity(const std::string& option, const std::string& text, const Dimension& dimension);
/// A quantity of either sign. Throws Error{usage} "bad-value".
double signed_quantity(const std::string& option, const std::string& text, const Dimension& dimension);

/// Throws Error{usage} "unknown-name" with a suggestion unless `word` is one of `allowed`; `what` is what it names.
void require_word(const std::string& what, const std::string& word, const std::vector<std::string>& allowed);

}  // namespace freeplay
