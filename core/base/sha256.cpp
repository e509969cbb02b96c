#include "base/sha256.h"

#include <array>
#include <cstring>
#include <fstream>

#include <sha2.h>

namespace freeplay {

std::string sha256(std::string_view text) {
  char hex[SHA256_DIGEST_STRING_LENGTH];
  SHA256Data(reinterpret_cast<const std::uint8_t*>(text.data()), text.size(), hex);
  return hex;
}

Sha256::Sha256() {
  static_assert(sizeof(SHA2_CTX) == sizeof state_);
  SHA2_CTX context;
  SHA256Init(&context);
  std::memcpy(state_.data(), &context, sizeof context);
}

void Sha256::add(const void* bytes, std::size_t count) {
  SHA2_CTX context;
  std::memcpy(&context, state_.data(), sizeof context);
  SHA256Update(&context, static_cast<const std::uint8_t*>(bytes), count);
  std::memcpy(state_.data(), &context, sizeof context);
}

std::string Sha256::digits() const {
  SHA2_CTX context;
  std::memcpy(&context, state_.data(), sizeof context);
  char hex[SHA256_DIGEST_STRING_LENGTH];
  return SHA256End(&context, hex);
}

std::string sha256_of_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return {};
  Sha256 hash;
  std::array<char, 1 << 16> piece{};
  while (file) {
    file.read(piece.data(), piece.size());
    hash.add(piece.data(), static_cast<std::size_t>(file.gcount()));
  }
  return file.bad() ? std::string() : hash.digits();
}

}  // namespace freeplay
