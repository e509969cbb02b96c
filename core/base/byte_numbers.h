// ByteNumbers: numbers as 8 bytes each, little endian: integers two's complement, reals IEEE 754 with all bits.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace freeplay {

inline void append_bytes(std::string& out, std::uint64_t number) {
  for (int byte = 0; byte < 8; ++byte) out += static_cast<char>(number >> (8 * byte) & 0xff);
}
inline void append_bytes(std::string& out, std::int64_t number) {
  append_bytes(out, static_cast<std::uint64_t>(number));
}
inline void append_bytes(std::string& out, double number) { append_bytes(out, std::bit_cast<std::uint64_t>(number)); }
/// Its length, then its numbers.
template <class T>
void append_bytes(std::string& out, const std::vector<T>& numbers) {
  append_bytes(out, static_cast<std::uint64_t>(numbers.size()));
  for (const T number : numbers) append_bytes(out, number);
}

/// Its length, then its bytes.
inline void append_bytes(std::string& out, std::string_view text) {
  append_bytes(out, static_cast<std::uint64_t>(text.size()));
  out += text;
}

/// Takes such numbers from the front of bytes. `refuse` is called, and throws, where there are too few.
template <class Refuse>
class ByteNumbers {
 public:
  ByteNumbers(std::string_view bytes, Refuse refuse) : bytes_(bytes), refuse_(refuse) {}

  std::uint64_t next() {
    std::uint64_t number = 0;
    for (const char byte : text(8))
      number = number >> 8 | static_cast<std::uint64_t>(static_cast<unsigned char>(byte)) << 56;
    return number;
  }
  void next(double& number) { number = std::bit_cast<double>(next()); }
  void next(std::int64_t& number) { number = static_cast<std::int64_t>(next()); }
  template <class T>
  void next(std::vector<T>& numbers) {
    const std::uint64_t count = next();
    if (count > bytes_.size() / 8) refuse_();
    numbers.resize(static_cast<std::size_t>(count));
    for (T& number : numbers) next(number);
  }
  void next(std::string& out) { out = text(next()); }
  /// So many bytes as they are.
  std::string_view text(std::uint64_t size) {
    if (size > bytes_.size()) refuse_();
    const std::string_view front = bytes_.substr(0, static_cast<std::size_t>(size));
    bytes_.remove_prefix(front.size());
    return front;
  }
  bool empty() const { return bytes_.empty(); }

 private:
  std::string_view bytes_;
  Refuse refuse_;
};

}  // namespace freeplay
