#include "run/state_bytes.h"

#include <algorithm>
#include <bit>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/sha256.h"

namespace freeplay {
namespace {

constexpr std::string_view mark = "FPSTATE\n";
constexpr std::uint64_t version = 1;
constexpr std::size_t size_of_number = 8, size_of_digest = 64;
constexpr std::size_t least_size = 8 + 9 * size_of_number + size_of_digest;

void append(std::string& out, std::uint64_t number) {
  for (int byte = 0; byte < 8; ++byte) out += static_cast<char>(number >> (8 * byte) & 0xff);
}
void append(std::string& out, std::int64_t number) { append(out, static_cast<std::uint64_t>(number)); }
void append(std::string& out, double number) { append(out, std::bit_cast<std::uint64_t>(number)); }

template <class T>
void append_list(std::string& out, const std::vector<T>& numbers) {
  append(out, static_cast<std::uint64_t>(numbers.size()));
  for (const T number : numbers) append(out, number);
}

[[noreturn]] void refuse(const char* id, std::string message) {
  throw Error(Error::Category::input, id, std::move(message));
}
[[noreturn]] void refuse_damage() {
  refuse("state-damaged", "the saved state is damaged: bytes are missing, or others than were written");
}

/// The bytes between the mark and the digest, one number after the other.
class Numbers {
 public:
  explicit Numbers(std::string_view bytes) : bytes_(bytes) {}

  std::uint64_t next() {
    if (left() == 0) refuse_damage();
    std::uint64_t number = 0;
    for (std::size_t byte = 0; byte < size_of_number; ++byte) {
      number |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes_[byte])) << (8 * byte);
    }
    bytes_.remove_prefix(size_of_number);
    return number;
  }
  void next(double& number) { number = std::bit_cast<double>(next()); }
  void next(std::int64_t& number) { number = static_cast<std::int64_t>(next()); }
  template <class T>
  void next(std::vector<T>& numbers) {
    const std::uint64_t count = next();
    if (count > left()) refuse_damage();
    numbers.resize(static_cast<std::size_t>(count));
    for (T& number : numbers) next(number);
  }
  std::size_t left() const { return bytes_.size() / size_of_number; }

 private:
  std::string_view bytes_;
};

}  // namespace

std::string bytes_of(const RunState& state) {
  const Archive *features = &state.features, *numbers = &state.numbers;
  const std::size_t count =
      9 + features->reals.size() + features->integers.size() + numbers->reals.size() + numbers->integers.size();
  const std::size_t size = mark.size() + count * size_of_number + size_of_digest;
  std::string out(mark);
  out.reserve(size);
  append(out, version);
  append(out, static_cast<std::uint64_t>(size));
  append(out, state.time);
  append(out, state.steps);
  append(out, state.rows);
  for (const Archive* part : {features, numbers}) {
    append_list(out, part->reals);
    append_list(out, part->integers);
  }
  return out + sha256(out);
}

RunState state_of(std::string_view bytes) {
  if (bytes.substr(0, mark.size()) != mark) refuse("state-format", "this is no saved state of a run");
  const std::size_t end = std::max(mark.size(), bytes.size() - std::min(bytes.size(), size_of_digest));
  Numbers numbers(bytes.substr(mark.size(), end - mark.size()));
  const std::uint64_t written = numbers.next();
  if (written != version) {
    refuse("state-format",
           fmt::format("the saved state has version {} of its form; this program reads version {}", written, version));
  }
  if (bytes.size() < least_size || numbers.next() != bytes.size()) refuse_damage();
  if (sha256(bytes.substr(0, bytes.size() - size_of_digest)) != bytes.substr(bytes.size() - size_of_digest)) {
    refuse_damage();
  }
  RunState state;
  numbers.next(state.time);
  numbers.next(state.steps);
  numbers.next(state.rows);
  for (Archive* part : {&state.features, &state.numbers}) {
    numbers.next(part->reals);
    numbers.next(part->integers);
  }
  if (numbers.left() != 0) refuse_damage();
  return state;
}

}  // namespace freeplay
