#include "run/state_bytes.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/byte_numbers.h"
#include "base/error.h"
#include "base/sha256.h"

namespace freeplay {
namespace {

constexpr std::string_view mark = "FPSTATE\n";
constexpr std::uint64_t version = 1;
constexpr std::size_t size_of_number = 8, size_of_digest = 64;
constexpr std::size_t least_size = 8 + 9 * size_of_number + size_of_digest;

[[noreturn]] void refuse(const char* id, std::string message) {
  throw Error(Error::Category::input, id, std::move(message));
}
[[noreturn]] void refuse_damage() {
  refuse("state-damaged", "the saved state is damaged: bytes are missing, or others than were written");
}

}  // namespace

std::string bytes_of(const RunState& state) {
  const Archive *features = &state.features, *numbers = &state.numbers;
  const std::size_t count =
      9 + features->reals.size() + features->integers.size() + numbers->reals.size() + numbers->integers.size();
  const std::size_t size = mark.size() + count * size_of_number + size_of_digest;
  std::string out(mark);
  out.reserve(size);
  append_bytes(out, version);
  append_bytes(out, static_cast<std::uint64_t>(size));
  append_bytes(out, state.time);
  append_bytes(out, state.steps);
  append_bytes(out, state.rows);
  for (const Archive* part : {features, numbers}) {
    append_bytes(out, part->reals);
    append_bytes(out, part->integers);
  }
  return out + sha256(out);
}

RunState state_of(std::string_view bytes) {
  if (bytes.substr(0, mark.size()) != mark) refuse("state-format", "this is no saved state of a run");
  const std::size_t end = std::max(mark.size(), bytes.size() - std::min(bytes.size(), size_of_digest));
  ByteNumbers numbers(bytes.substr(mark.size(), end - mark.size()), refuse_damage);
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
  if (!numbers.empty()) refuse_damage();
  return state;
}

}  // namespace freeplay
