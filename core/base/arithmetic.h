// Arithmetic: what the bytes of a result depend on besides the program and its input.
#pragma once

#include <string>

namespace freeplay {

/// 16 hexadecimal digits that are the same wherever results have the same bytes: of 4096 values of each elementary
/// function, and of all numbers of a short run. Made at the first call, in about a millisecond.
const std::string& arithmetic_fingerprint();

}  // namespace freeplay
