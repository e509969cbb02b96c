#include "results/checkpoints.h"

#include <memory>
#include <string>

#include <fmt/format.h>

#include "base/arithmetic.h"
#include "base/version.h"
#include "base/whole_file.h"
#include "freeplay/plugin.h"

namespace freeplay {

Json program_of_checkpoints() {
  return {{"version", program_version}, {"compiler", compiler}, {"arithmetic", arithmetic_fingerprint()}};
}

void Checkpoints::begin() { write_whole_file(file_, bytes_of({.made = made_})); }

void Checkpoints::go_on(const Checkpoint& from) {
  made_["resumed"] = from.made.value("resumed", 0) + 1;
  made_["resumed_from"] = from.state ? Json(from.state->time) : Json(nullptr);
  resumed_words_ = fmt::format("resumed from t = {:g} s, row {}", from.state ? from.state->time : 0.0, from.rows());
  if (!from.files.reals.empty() || !from.files.integers.empty()) recording_.restore(from.files);
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
  recording_.when_safe([checkpoint, path = file_] { write_whole_file(path, bytes_of(*checkpoint), true); });
}

}  // namespace freeplay
