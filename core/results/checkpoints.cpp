#include "results/checkpoints.h"

#include <algorithm>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "base/arithmetic.h"
#include "base/version.h"
#include "base/whole_file.h"
#include "freeplay/plugin.h"

namespace freeplay {
namespace {

constexpr const char* hashes_of_checkpoint = "kept";
constexpr int most_steps_to_look = 16;
constexpr double short_time = 0.01;  // between two looks at the clock, in periods

}  // namespace

Json program_of_checkpoints() {
  return {{"version", program_version}, {"compiler", compiler}, {"arithmetic", arithmetic_fingerprint()}};
}

KeptPart kept_part_of(const Checkpoint& from) {
  const Json hashes = from.made.value(hashes_of_checkpoint, Json::object());
  return {.rows = from.rows(),
          .events = from.events,
          .row_digits = hashes.value("rows", ""),
          .event_digits = hashes.value("events", "")};
}

void Checkpoints::begin() {
  recording_.require_directory();
  write_whole_file(file_, bytes_of({.made = made_}));
}

void Checkpoints::go_on(const Checkpoint& from) {
  made_["resumed"] = from.made.value("resumed", 0) + 1;
  made_["resumed_from"] = from.state ? Json(from.state->time) : Json(nullptr);
  resumed_words_ = fmt::format("resumed from t = {:g} s, row {}", from.state ? from.state->time : 0.0, from.rows());
  if (!from.files.reals.empty() || !from.files.integers.empty()) recording_.restore(from.files);
}

bool Checkpoints::look() {
  const auto now = std::chrono::steady_clock::now();
  const bool is_soon = now - looked_ < short_time * period_;
  steps_to_look_ = is_soon ? std::min(2 * steps_to_look_, most_steps_to_look) : 1;
  steps_ = 0;
  looked_ = now;
  return now - last_ >= period_;
}

void Checkpoints::end(std::int64_t rows) {
  made_["rows"] = rows;
  begin();
}

void Checkpoints::add(RunState state) {
  last_ = std::chrono::steady_clock::now();
  const auto checkpoint =
      std::make_shared<Checkpoint>(Checkpoint{.made = made_, .state = std::move(state), .events = recording_.events()});
  recording_.save(checkpoint->files);
  recording_.when_safe([checkpoint, path = file_, &recording = recording_] {
    recording.require_directory();
    checkpoint->made[hashes_of_checkpoint] = recording.hashes();
    write_whole_file(path, bytes_of(*checkpoint), true);
  });
}

}  // namespace freeplay
