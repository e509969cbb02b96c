// FIPS 180-4, section 6.2. Our own, since loading and starting a library for it takes longer than a short run.
#include "io/sha256.h"

#include <array>
#include <bit>
#include <cstdint>

#include <fmt/format.h>

namespace freeplay {
namespace {

using Word = std::uint32_t;
constexpr std::size_t block_size = 64;  // bytes

// Fractional parts of the cube roots of the first 64 primes, section 4.2.2.
constexpr std::array<Word, 64> constants = {
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

Word sum(Word x, int a, int b, int c) { return std::rotr(x, a) ^ std::rotr(x, b) ^ std::rotr(x, c); }
Word mix(Word x, int a, int b, int shift) { return std::rotr(x, a) ^ std::rotr(x, b) ^ (x >> shift); }

class Digest {
 public:
  void add_block(std::string_view block) {
    std::array<Word, 64> w{};
    for (std::size_t i = 0; i < block_size; ++i) w[i / 4] = w[i / 4] << 8 | static_cast<unsigned char>(block[i]);
    for (std::size_t i = 16; i < 64; ++i) {
      w[i] = mix(w[i - 2], 17, 19, 10) + w[i - 7] + mix(w[i - 15], 7, 18, 3) + w[i - 16];
    }
    auto [a, b, c, d, e, f, g, h] = hash_;
    for (std::size_t i = 0; i < 64; ++i) {
      const Word first = h + sum(e, 6, 11, 25) + ((e & f) ^ (~e & g)) + constants[i] + w[i];
      const Word second = sum(a, 2, 13, 22) + ((a & b) ^ (a & c) ^ (b & c));
      h = g, g = f, f = e, e = d + first, d = c, c = b, b = a, a = first + second;
    }
    const std::array<Word, 8> change = {a, b, c, d, e, f, g, h};
    for (std::size_t i = 0; i < 8; ++i) hash_[i] += change[i];
  }

  std::string hex() const {
    std::string text;
    for (const Word word : hash_) text += fmt::format("{:08x}", word);
    return text;
  }

 private:
  // Fractional parts of the square roots of the first eight primes, section 5.3.3.
  std::array<Word, 8> hash_ = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                               0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
};

}  // namespace

std::string sha256(std::string_view text) {
  Digest digest;
  const std::uint64_t bits = 8 * static_cast<std::uint64_t>(text.size());
  for (; text.size() >= block_size; text.remove_prefix(block_size)) digest.add_block(text.substr(0, block_size));
  // A one, zeros, and the length in bits end the last block.
  std::string end(text);
  end += '\x80';
  while (end.size() % block_size != block_size - 8) end += '\0';
  for (int shift = 56; shift >= 0; shift -= 8) end += static_cast<char>(bits >> shift & 0xff);
  for (std::string_view rest = end; !rest.empty(); rest.remove_prefix(block_size)) {
    digest.add_block(rest.substr(0, block_size));
  }
  return digest.hex();
}

}  // namespace freeplay
