// Checkpoints: the checkpoints of a run that goes on.
#pragma once

#include <chrono>
#include <filesystem>
#include <utility>

#include "results/checkpoint.h"
#include "results/kept_part.h"
#include "results/recording.h"

namespace freeplay {

/// Version, build and arithmetic: what the bytes of a run may depend on besides its model.
Json program_of_checkpoints();

/// What stays of the files of a run that goes on from it.
KeptPart kept_part_of(const Checkpoint& from);

/// Writes checkpoints in the thread of `recording`, once all rows and events that they count are safe on the disk. The
/// run only copies numbers.
class Checkpoints {
 public:
  /// `made`: what the run is made from and with, see Checkpoint. `period`: wall time between two [s]; 0: only those
  /// that are asked for.
  Checkpoints(Recording& recording, const std::filesystem::path& directory, Json made, double period)
      : recording_(recording), file_(directory / checkpoint_name), made_(std::move(made)), period_(period) {}

  /// The one before the first step: none of its rows counts.
  void begin();
  /// Those of a run that goes on from one, instead of begin().
  void go_on(const Checkpoint& from);
  /// Asked after every step. The clock, whose reading takes a part of a short step, is not read in each of those that
  /// are far shorter than the period.
  bool due() { return period_.count() > 0.0 && ++steps_ >= steps_to_look_ && look(); }
  /// How often the run was resumed, and the time of the checkpoint that it went on from last; null without.
  int resumed() const { return made_.value("resumed", 0); }
  Json resumed_from() const { return made_.value("resumed_from", Json()); }
  /// "resumed from t = 0.31 s, row 3100".
  const std::string& resumed_words() const { return resumed_words_; }
  /// The last one of a run that came to its end, after its files: what they hold.
  void end(std::int64_t rows);
  /// One more. A failure to write it is one of the recording.
  void add(RunState state);

 private:
  bool look();

  Recording& recording_;
  std::filesystem::path file_;
  Json made_;
  std::string resumed_words_;
  std::chrono::duration<double> period_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now(), looked_ = last_;
  int steps_ = 0, steps_to_look_ = 1;  // since the last look at the clock, and until the next
};

}  // namespace freeplay
