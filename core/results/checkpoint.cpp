#include "results/checkpoint.h"

#include <fstream>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "base/byte_numbers.h"
#include "base/error.h"
#include "base/sha256.h"
#include "run/state_bytes.h"

namespace freeplay {
namespace {

constexpr std::string_view checkpoint_mark = "FPCHECK\n";
constexpr std::uint64_t checkpoint_version = 1;
constexpr std::size_t digest_size = 64;

std::string padded(std::string text) {
  text.resize((text.size() + 7) / 8 * 8, ' ');
  return text;
}

[[noreturn]] void refuse_checkpoint(const std::string& file, const std::string& why) {
  throw Error(Error::Category::file, "bad-checkpoint", fmt::format("'{}' {}", file, why), {},
              "nothing was changed; run the model again from its start");
}

}  // namespace

std::string bytes_of(const Checkpoint& checkpoint) {
  const std::string text = padded(checkpoint.made.dump(-1, ' ', false, Json::error_handler_t::replace));
  const std::string state = checkpoint.state ? bytes_of(*checkpoint.state) : std::string();
  std::string body;
  append_bytes(body, static_cast<std::uint64_t>(text.size()));
  body += text;
  append_bytes(body, checkpoint.events);
  append_bytes(body, static_cast<std::uint64_t>(state.size()));
  body += state;
  append_bytes(body, checkpoint.files.reals);
  append_bytes(body, checkpoint.files.integers);
  std::string out(checkpoint_mark);
  append_bytes(out, checkpoint_version);
  append_bytes(out, static_cast<std::uint64_t>(out.size() + 8 + body.size() + digest_size));
  out += body;
  return out + sha256(out);
}

Checkpoint checkpoint_of(std::string_view bytes, const std::string& file) {
  const auto damaged = [&] { refuse_checkpoint(file, "is damaged: bytes are missing, or others than were written"); };
  if (bytes.substr(0, checkpoint_mark.size()) != checkpoint_mark) refuse_checkpoint(file, "is no checkpoint");
  if (bytes.size() < checkpoint_mark.size() + digest_size) damaged();
  const std::string_view checked = bytes.substr(0, bytes.size() - digest_size);
  ByteNumbers numbers(checked.substr(checkpoint_mark.size()), damaged);
  const std::uint64_t version = numbers.next();
  if (version != checkpoint_version) {
    refuse_checkpoint(
        file, fmt::format("has version {} of its form; this program reads version {}", version, checkpoint_version));
  }
  if (numbers.next() != bytes.size() || sha256(checked) != bytes.substr(checked.size())) damaged();
  Checkpoint out;
  out.made = Json::parse(numbers.text(numbers.next()), nullptr, false);
  if (!out.made.is_object()) damaged();
  numbers.next(out.events);
  const std::string_view state = numbers.text(numbers.next());
  try {
    if (!state.empty()) out.state = state_of(state);
  } catch (const Error& error) {
    refuse_checkpoint(file, "cannot be read: " + error.message());
  }
  numbers.next(out.files.reals);
  numbers.next(out.files.integers);
  if (!numbers.empty()) damaged();
  return out;
}

Checkpoint read_checkpoint(const std::filesystem::path& directory) {
  std::error_code error;
  if (!std::filesystem::is_directory(directory, error)) {
    throw Error(Error::Category::file, "unreadable-result",
                fmt::format("'{}' is not the directory of a result", directory.string()), {},
                "give a directory that `freeplay run` has written");
  }
  const std::filesystem::path path = directory / checkpoint_name;
  if (!std::filesystem::exists(path, error)) {
    throw Error(Error::Category::file, "no-checkpoint",
                fmt::format("'{}' has no {}: there is nothing to go on from", directory.string(), checkpoint_name), {},
                "run the model again");
  }
  std::ifstream file(path, std::ios::binary);
  const bool plain = std::filesystem::is_regular_file(path, error);
  const std::string bytes{plain ? std::istreambuf_iterator<char>(file) : std::istreambuf_iterator<char>(), {}};
  return checkpoint_of(bytes, path.string());
}

}  // namespace freeplay
