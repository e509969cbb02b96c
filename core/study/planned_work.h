// PlannedWork: the points of a plan, run one by one, as the engine wants them.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "study/merge.h"
#include "study/plan.h"
#include "study/point_runner.h"
#include "study/row_text.h"
#include "workers/work.h"

namespace freeplay {

class PlannedWork final : public StudyWork {
 public:
  /// Both outlive it. Without a runner no point can be run.
  PlannedWork(const StudyPlan& plan, PointRunner* runner) : plan_(plan), runner_(runner) {}

  std::uint64_t points() const override { return plan_.points(); }
  std::uint64_t units() const override { return plan_.units(); }
  std::uint64_t unit_size(std::uint64_t unit) const override { return plan_.unit_size(unit); }
  std::uint64_t unit_point(std::uint64_t unit, std::uint64_t place) const override {
    return plan_.unit_point(unit, place);
  }
  UnitPlace place_of(std::uint64_t point) const override { return plan_.place_of(point); }
  bool chained() const override { return plan_.chained(); }
  std::string hash(std::uint64_t point) const override { return plan_.hash(point); }
  StudyOutcome run(std::uint64_t index, const std::string& state_before) override {
    const StudyPoint point = plan_.point(index);
    return instead_ ? instead_(point) : runner_->run(point, state_before);
  }
  /// What workers do at a point from now on.
  void do_instead(std::function<StudyOutcome(const StudyPoint&)> act) { instead_ = std::move(act); }

 private:
  const StudyPlan& plan_;
  PointRunner* runner_;
  std::function<StudyOutcome(const StudyPoint&)> instead_;
};

RowLayout row_layout(const StudyPlan& plan, const StudyColumns& columns);
/// The table of a plan's rows: what merge_rows() wants. The plan outlives it.
MergePlan merge_plan(const StudyPlan& plan, const StudyColumns& columns);

}  // namespace freeplay
