// Sha256: the fingerprint of a model file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace freeplay {

/// 64 hexadecimal digits.
std::string sha256(std::string_view text);
/// The same of a file; empty where it cannot be read.
std::string sha256_of_file(const std::string& path);

/// The same of bytes that come piece by piece. A copy goes on from where it was made.
class Sha256 {
 public:
  Sha256();
  void add(const void* bytes, std::size_t count);
  /// 64 hexadecimal digits of all that was added.
  std::string digits() const;

 private:
  std::array<std::uint64_t, 14> state_{};  // that of the library, as plain words
};

}  // namespace freeplay
