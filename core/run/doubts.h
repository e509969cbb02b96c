// RunDoubts: what a run holds against its own numbers while it goes on.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "run/fast_motion.h"
#include "run/lasting_blows.h"
#include "run/recorder.h"
#include "run/slow_motion.h"

namespace freeplay {

class RunDoubts {
 public:
  RunDoubts(RunContext& run, RunFailure& failure, Recorder& recorder);

  /// At the start: events of contacts that are declared in the wrong direction.
  void note_event_directions();
  /// Forces at the start, to which later ones are compared.
  void note_first_forces();
  /// Of a step that is about to be accepted: how fast what moves does so, in steps of one size, and how slowly.
  void note_motion();
  /// After an accepted step of the length dt: false, with the outcome, where going on makes no sense.
  bool watch_row(double dt);
  bool note_warnings();
  /// Once the run is over: warnings of joints, and play that was never used.
  [[gnu::cold]] void format_warnings();
  [[gnu::cold]] void note_unused_play();
  [[gnu::cold]] void note_damped_peaks();
  [[gnu::cold]] void judge_motion();
  [[gnu::cold]] void note_lasting_blows();

  void save(ArchiveWriter& archive) const;
  void restore(ArchiveReader& archive);

 private:
  [[gnu::cold]] bool is_nearly_singular() const;
  struct Warning {
    const char* text = nullptr;
    double time = 0.0;
    std::size_t values = 0;  ///< offset into warning_values_
  };

  RunContext& run_;
  RunFailure& failure_;
  Recorder& recorder_;
  std::vector<Warning> joint_warnings_;     // by joint
  std::vector<std::string> warning_texts_;  // of a run that goes on, by joint: the joints' own are those of another run
  std::vector<double> warning_values_;      // the joints' own channels when they warned
  /// Time from which drivers pull the mechanism apart, looked for when a journal is deeper than its play.
  std::optional<double> torn_from_;
  FastMotion motion_;   // in steps of one size
  LastingBlows blows_;  // likewise
  SlowMotion slow_;
  bool swings_ = false;  // whether the run looks for a period
};

}  // namespace freeplay
