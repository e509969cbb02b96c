#include "study/chain_state.h"

#include "base/byte_numbers.h"
#include "base/error.h"

namespace freeplay {
namespace {

constexpr std::string_view digits = "0123456789abcdef";

[[noreturn]] void refuse() {
  throw Error(Error::Category::input, "state-damaged", "the state after the point before it in the chain is damaged");
}

}  // namespace

std::string chain_text(const EndedMotion& motion) {
  std::string bytes, text;
  append_bytes(bytes, motion.t);
  for (const auto* numbers : {&motion.q, &motion.v, &motion.z, &motion.h}) append_bytes(bytes, *numbers);
  text.reserve(2 * bytes.size());
  for (const char byte : bytes) {
    const auto value = static_cast<unsigned char>(byte);
    text += digits[value >> 4];
    text += digits[value & 15];
  }
  return text;
}

EndedMotion chain_motion(std::string_view text) {
  if (text.size() % 2 != 0 || text.find_first_not_of(digits) != std::string_view::npos) refuse();
  std::string bytes;
  for (std::size_t i = 0; i < text.size(); i += 2) {
    bytes += static_cast<char>(digits.find(text[i]) << 4 | digits.find(text[i + 1]));
  }
  EndedMotion motion;
  ByteNumbers numbers(bytes, refuse);
  numbers.next(motion.t);
  for (auto* list : {&motion.q, &motion.v, &motion.z, &motion.h}) numbers.next(*list);
  if (!numbers.empty()) refuse();
  return motion;
}

}  // namespace freeplay
