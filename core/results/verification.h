// Verification: what a second run by another method says about the first.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "results/table.h"

namespace freeplay {

/// One channel of both runs.
struct ChannelError {
  std::string name;
  double error = 0.0;                          ///< largest difference while the runs agree
  double rms = 0.0, second_rms = 0.0;          ///< after that, of each run; NaN when nothing is left
  double largest = 0.0, second_largest = 0.0;  ///< largest absolute values, likewise
};

/// A figure of the table of a run, such as "joint B max |F|", "driver m rms |torque|" or "force f work", in SI units;
/// NaN where it has none. Its last word says with which others it is compared.
struct Peak {
  std::string name;
  double value = 0.0;
};

/// The same peak of both runs.
struct PeakPair {
  std::string name;
  double run = 0.0, second = 0.0;
  bool differs = false;
};

/// What the table and the peaks of one run say.
struct RunResult {
  const ResultTable* rows = nullptr;
  std::vector<Peak> peaks;
};

enum class Agreement {
  agree,     ///< positions within the limit in every row, peaks too
  err,       ///< positions differ by more than the limit, as methods of different accuracy do
  part,      ///< two runs of the second method part as well: the motion forgets where it came from
  disagree,  ///< the first run differs from the second by far more than runs of the second method among themselves
};

/// A channel that decides, of bodies' places and turns.
struct PositionChannel {
  std::string name;
  double lever = 1.0;  ///< what a difference of it counts [m], of a place 1
};

struct VerificationRules {
  std::vector<PositionChannel> positions;
  /// Difference of positions that counts as agreement in the first second, and in each second after it [m].
  double limit = 1e-6;
  bool fixed = false;   ///< the first run takes fixed steps: nothing is promised of its error
  double size = 0.0;    ///< of the model [m]; torques are compared with forces by it
  double energy = 0.0;  ///< that was moved in the second run [J]: a small part of it is no work, and makes no force
  double length = 0.0;  ///< by which positions of both runs may differ [m]: shorter errors and penetrations are none
};

struct Verification {
  Agreement agreement = Agreement::agree;
  double limit = 1e-6;                 ///< see VerificationRules
  double agree_until = 0.0;            ///< [s]
  double largest = 0.0, at = 0.0;      ///< largest difference of positions [m] and its time [s]
  std::vector<ChannelError> channels;  ///< in the order of the columns, without time
  std::vector<PeakPair> peaks;
  std::string method;  ///< of the second run: its integrator, kind and steps
  long steps = 0;      ///< that it took
  double until = 0.0;  ///< the second run went as far [s]
  bool whole = true;   ///< it came to its end: all of the run is verified

  bool throughout() const { return agreement == Agreement::agree; }
};

/// Differences of both runs as far as both go; `agreement` is `agree` or `err`: what else it is, judge() decides.
Verification compare_runs(const RunResult& run, const RunResult& second, const VerificationRules& rules);

/// What to make of runs that do not agree, by a third one that takes the second's method less accurately. Where that
/// differs from the second as well, by tens of the limit, the motion is chaotic (`part`). Where the first differs from
/// the second by more than 30 times what these two differ by so far, and by more than 10 limits or, with fixed steps,
/// 1 % of the way of the body that goes farthest, the first is wrong (`disagree`); also where one of its means or
/// works is off by 10 %, or a largest value by half, and by 5 times as much as that of the third: a step that goes over
/// a load has nothing of its peak, while one of vibrations may be one part or another of them.
void judge(Verification& verification, const RunResult& run, const RunResult& second, const RunResult& third,
           const VerificationRules& rules);

}  // namespace freeplay
