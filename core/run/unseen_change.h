// UnseenChange: what a function of time does between the ends of steps of one size, where no step sees it.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>

#include "base/expression.h"
#include "base/formula_course.h"
#include "base/formula_sides.h"
#include "model/time_table.h"

namespace freeplay {

/// Compares a function, or one of its derivatives, with what the ends of four steps show of it: their range, and where
/// it has no corners the polynomial of degree 4 through them.
class UnseenChange {
 public:
  struct Found {
    double time;    ///< where it is farthest from what most of these ends show [s]
    double length;  ///< on either side of that it falls to half within this time [s]
  };

  /// The first of [from, to] in steps of `step` [s]; `derivative` is 0, 1 or 2. Formulas are bounded over spans of
  /// time, so that no change is too short, until a bounded amount of work is done. Between two corners that are no more
  /// than `cut_form` and four steps apart steps are a quarter of that, and end at both [s].
  [[gnu::cold]] static std::optional<Found> of(const Expression& formula, double from, double to, double step,
                                               int derivative, double cut_form = 0.0);
  /// Of tables by their points and the middles between them.
  [[gnu::cold]] static std::optional<Found> of(const TimeTable& table, double from, double to, double step,
                                               int derivative);
  /// Of signals that can be looked at alone: fills them at a time; false where it cannot.
  using Look = std::function<bool(double t, std::span<double> values)>;
  /// The one that is farthest from what the ends of four steps show, at instants no more than `apart` from each other,
  /// a bounded number of times [s]. What may jump is compared with their range.
  [[gnu::cold]] static std::optional<Found> of(const Look& look, std::size_t signals, double from, double to,
                                               double step, double apart);

 private:
  UnseenChange(double from, double to, double step, int derivative)
      : from_(from), to_(to), step_(step), derivative_(derivative) {}

  /// Of four steps.
  struct Window {
    double begin = 0.0, end = 0.0;
    std::array<double, 5> shown{};
    double low = 0.0, high = 0.0, allowed = 0.0;
    double beyond(double value) const;
    double polynomial(double t) const;
    bool hides(double value) const { return beyond(value) > allowed; }
  };
  template <class Function>
  bool value(const Function& function, double t, double& out) const;
  template <class Function>
  void note_range(const Function& function);
  template <class Function>
  bool look(const Function& function, double begin, Window& window) const;
  template <class Function>
  std::optional<double> between(const Function& function, const Window& window) const;
  template <class Function>
  Found measured(const Function& function, const Window& window, double t) const;
  std::optional<double> hidden(const Expression& formula, FormulaSides& sides, const Window& window,
                               const FormulaSides::Span& span) const;
  std::optional<double> inside(const Expression& formula, FormulaSides& sides, const Window& window) const;
  std::optional<Found> between_corners(const Expression& formula, FormulaCourse& course, FormulaSides& sides,
                                       double t) const;
  bool is_slow(const Interval& second, double length) const;

  double from_, to_, step_;
  int derivative_;
  double low_ = 0.0, high_ = 0.0;  ///< over the run, at the ends of steps
};

}  // namespace freeplay
