// StepSink: looks at all steps of a run, and at instants inside of them.
#pragma once

#include <cstddef>
#include <limits>
#include <span>

namespace freeplay {

/// Gets rows as Sink does: every channel in the order of Channels::all(), valid during the call only. Those inside of a
/// step come before its end. What it asks for changes no step.
class StepSink {
 public:
  virtual ~StepSink() = default;
  /// The start of the run, and the end of each accepted step after its events.
  virtual void step(std::span<const double> row) = 0;

  /// A row inside of a step that was looked at because values may be the largest there, as in the statistics.
  virtual void inside(std::span<const double>) {}

  /// The earliest instant of which a row is wanted [s]; infinite: none. It rises with each call of instant().
  virtual double next_instant() const { return std::numeric_limits<double>::infinity(); }
  virtual void instant(std::span<const double>) {}

  /// A channel that passes a value: `up` from at most that to more, `down` from at least that to less.
  struct Passage {
    int channel = 0;
    double value = 0.0;
    bool up = true, down = false;
  };
  virtual std::span<const Passage> passages() const { return {}; }
  virtual void passed(std::size_t, std::span<const double>) {}
};

}  // namespace freeplay
