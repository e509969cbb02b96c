#include "run/step_corners.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"
#include "run/dense_step.h"

namespace freeplay {
namespace {
constexpr double near_corner = 1e-9;              // of the step asked for: so near a corner is at its end
constexpr std::size_t most_corners_in_step = 64;  // that are distinguished
}  // namespace

StepCorners::StepCorners(RunContext& run, StepAttempt& attempt)
    : run_(run),
      attempt_(attempt),
      load_kinks_(run.model, DriveKinks::Of::loads),
      flow_begin_(freeplay::at(run.energy.flows())),
      flow_half_way_(flow_begin_.size()),
      flow_end_(flow_begin_.size()) {
  corners_.reserve(most_corners_in_step);
}

void StepCorners::list(double until) {
  const double from = run_.accepted.t();
  if (from_ == from || !any()) return;
  corners_.clear();
  from_ = from;
  near_ = std::max(8.0 * rounding * std::abs(until), near_corner * run_.settings.step);
  const auto add = [&](DriveKinks& of, bool motion) {
    double corner = of.next(from, until + near_);
    while (corner <= until + near_ && corners_.size() < corners_.capacity()) {
      corners_.push_back({corner, motion});
      corner = of.next(corner, until + near_);
    }
  };
  add(run_.kinks, true);
  add(load_kinks_, false);
  const double end = run_.settings.end;
  const bool one_at_end = run_.kinks.one_at_end() || load_kinks_.one_at_end();
  if (one_at_end && until >= end - near_ && corners_.size() < corners_.capacity())
    corners_.push_back({end, run_.kinks.one_at_end()});
  std::ranges::sort(corners_, {}, &Corner::time);
}

double StepCorners::at(double t) const {
  double found = unbounded;
  for (const Corner& corner : corners_) {
    if (std::abs(corner.time - t) <= near_) found = corner.time;
  }
  return found;
}

bool StepCorners::pass(double corner) {
  const double t = run_.accepted.t();
  run_.accepted.t() = std::max(t, corner + near_);
  const bool good = attempt_.restart();
  run_.accepted.t() = t;
  return good;
}

bool StepCorners::flow_inside(double t, std::span<double> powers) {
  const State &start = run_.accepted, &end = run_.trial;
  State& between = run_.between;
  const double s = (t - start.t()) / (end.t() - start.t());
  DenseStep(run_.model.space, start, run_.e_accepted->internal_rate, end, run_.e_trial->internal_rate)
      .at(std::min(s, 1.0), between);
  std::ranges::copy(end.h(), between.h().begin());  // as the attempt had it
  between.t() = t;
  StateView view = between.view();
  run_.solver.use_history(between.h());
  if (!run_.solver.accelerate(view, {run_.z_rate.data(), run_.z_rate.size()})) return false;
  if (!run_.system.evaluate(point(between), terms_of_equations, run_.e_between)) return false;
  run_.system.constraints().fill_driven(run_.e_between);
  run_.system.driven().recover_loads(run_.e_between, between.lambda());
  run_.energy.flow(run_.e_between, between.lambda(), powers);
  return true;
}

bool StepCorners::add_energy() {
  const double from = run_.accepted.t(), to = run_.trial.t();
  const auto inside = [&](const Corner& corner) { return corner.time > from + near_ && corner.time <= to + near_; };
  if (run_.energy.flows() == 0 || std::ranges::none_of(corners_, inside)) return false;
  run_.energy.begin_parts();
  double begin = from;
  const auto add_until = [&](double end) {
    const double length = end - begin;
    if (!(length > 4.0 * near_)) return true;
    if (!flow_inside(begin + near_, flow_begin_) || !flow_inside(begin + 0.5 * length, flow_half_way_) ||
        !flow_inside(end - near_, flow_end_)) {
      return false;
    }
    run_.energy.add_part(length, flow_begin_, flow_half_way_, flow_end_);
    begin = end;
    return true;
  };
  for (const Corner& corner : corners_) {
    if (inside(corner) && !add_until(corner.time)) return false;
  }
  if (!add_until(to)) return false;
  run_.energy.take_parts(to - from, run_.e_trial, run_.trial.lambda());
  run_.energy.renew(run_.e_trial, run_.trial.lambda());
  return true;
}

}  // namespace freeplay
