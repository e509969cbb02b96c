// Sha256: the fingerprint of a model file.
#pragma once

#include <string>
#include <string_view>

namespace freeplay {

/// 64 hexadecimal digits.
std::string sha256(std::string_view text);

}  // namespace freeplay
