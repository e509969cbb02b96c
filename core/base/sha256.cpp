#include "base/sha256.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>

#include <nettle/sha2.h>

namespace freeplay {

std::string sha256(std::string_view text) {
  Sha256 hash;
  hash.add(text.data(), text.size());
  return hash.digits();
}

Sha256::Sha256() {
  static_assert(sizeof(sha256_ctx) == sizeof state_);
  sha256_ctx context;
  sha256_init(&context);
  std::memcpy(state_.data(), &context, sizeof context);
}

void Sha256::add(const void* bytes, std::size_t count) {
  sha256_ctx context;
  std::memcpy(&context, state_.data(), sizeof context);
  sha256_update(&context, count, static_cast<const std::uint8_t*>(bytes));
  std::memcpy(state_.data(), &context, sizeof context);
}

std::string Sha256::digits() const {
  sha256_ctx context;
  std::memcpy(&context, state_.data(), sizeof context);
  std::array<std::uint8_t, SHA256_DIGEST_SIZE> bytes{};
  sha256_digest(&context, bytes.size(), bytes.data());
  std::string digits;
  for (const std::uint8_t byte : bytes) {
    digits += "0123456789abcdef"[byte >> 4];
    digits += "0123456789abcdef"[byte & 15];
  }
  return digits;
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
