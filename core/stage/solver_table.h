// stage_solver_table(): the functions of a class in the table that the SDK's StageSolver calls.
#pragma once

#include <exception>

#include "freeplay/integrator.h"

namespace freeplay {

/// `Solver` has the functions of StageSolver under the same names; those that may fail return false, and trouble()
/// then says why. The table is valid while `solver` stays where it is. Long, as each entry of the table has a line.
template <class Solver>
abi::StageSolverTable stage_solver_table(Solver& solver) {
  static constexpr auto of = [](void* self) -> Solver& { return *static_cast<Solver*>(self); };
  static constexpr auto answer = [](void* self, Message* message, auto&& act) noexcept {
    try {
      if (act(of(self))) return Status::ok;
      abi::copy_text(message->text, sizeof message->text, of(self).trouble());
    } catch (const std::exception& error) {  // no memory for a matrix
      abi::copy_text(message->text, sizeof message->text, error.what());
    }
    return Status::failed;
  };
  return {sizeof(abi::StageSolverTable),
          &solver,
          [](void* self, const Stage* stage, StateView* out, StageResult* result, Message* m) noexcept {
            return answer(self, m, [&](Solver& one) { return one.solve(*stage, *out, *result); });
          },
          [](void* self, StateView* state, Message* m) noexcept {
            return answer(self, m, [&](Solver& one) { return one.project_velocity(*state); });
          },
          [](void* self, StateView* state, Message* m) noexcept {
            return answer(self, m, [&](Solver& one) { return one.project_position(*state); });
          },
          [](void* self, StateView* state, Span<double> z_rate, Message* m) noexcept {
            return answer(self, m, [&](Solver& one) { return one.accelerate(*state, z_rate); });
          },
          [](void* self, Span<const double> position, Span<const double> velocity) noexcept {
            return of(self).error_norm(position, velocity);
          },
          [](void* self, Span<const double> q_base, Span<const double> increment, Span<double> q) noexcept {
            of(self).system().coordinates().retract(q_base, increment, q);
          },
          0,
          [](void* self, double dt, const StateView* end, Span<const double> error) noexcept {
            return of(self).internal_error_norm(dt, *end, error);
          },
          [](void* self, Span<const double> increment, Span<const double> v, Span<double> rate) noexcept {
            of(self).system().coordinates().increment_rate(increment, v, rate);
          },
          [](void* self) noexcept { return of(self).guess_error(); },
          [](void* self, double beta_q, double beta_v, Span<const double> missed) noexcept {
            return of(self).unsolved_error(beta_q, beta_v, missed);
          }};
}

}  // namespace freeplay
