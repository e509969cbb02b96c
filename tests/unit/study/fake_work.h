// FakeWork: points of a study that are made of their numbers, for tests of the engine.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include <fmt/format.h>

#include "study/row_text.h"
#include "workers/work.h"

namespace freeplay {

class FakeWork : public StudyWork {
 public:
  /// Units of `length` points one after the other.
  explicit FakeWork(std::uint64_t points, std::uint64_t length = 1) : points_(points), length_(length) {}

  std::uint64_t points() const override { return points_; }
  std::uint64_t units() const override { return points_ / length_; }
  std::uint64_t unit_size(std::uint64_t) const override { return length_; }
  std::uint64_t unit_point(std::uint64_t unit, std::uint64_t place) const override { return unit * length_ + place; }
  UnitPlace place_of(std::uint64_t point) const override { return {point / length_, point % length_}; }
  bool chained() const override { return length_ > 1; }
  std::string hash(std::uint64_t point) const override { return fmt::format("{:024x}", point); }
  StudyOutcome run(std::uint64_t point, const std::string& state_before) override {
    if (before_) before_(point);
    StudyOutcome outcome;
    outcome.run = 1e-6;
    const double before = state_before.empty() ? 0.0 : std::stod(state_before);
    outcome.values = {before + static_cast<double>(point) + 0.25};
    if (chained()) {
      outcome.start = state_before.empty() ? "cold" : "warm";
      outcome.state = fmt::format("{}", outcome.values[0]);
    }
    return outcome;
  }
  /// Called in the worker.
  void before(std::function<void(std::uint64_t)> act) { before_ = std::move(act); }

 private:
  std::uint64_t points_, length_;
  std::function<void(std::uint64_t)> before_;
};

/// The layout of its rows.
inline RowLayout fake_layout(const StudyWork& work) { return {{{"value", "1"}}, {}, work.chained()}; }

}  // namespace freeplay
