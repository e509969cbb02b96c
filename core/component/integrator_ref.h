// IntegratorRef: the host's handle on an integrator that may live in another library.
#pragma once

#include "freeplay/integrator.h"

namespace freeplay {

/// Table and object of an integrator; does not own it. Calls return false and fill `message` when it failed.
class IntegratorRef {
 public:
  IntegratorRef() = default;
  IntegratorRef(const abi::IntegratorTable& table, const void* self) : table_(&table), self_(self) {}
  explicit operator bool() const { return self_ != nullptr; }

  bool declare(IntegratorLayout& layout, Message& m) const { return ok(table_->declare(self_, &layout, &m)); }
  bool restart(StateView& state, const abi::StageSolverTable& solver, Message& m) const {
    return ok(table_->restart(self_, &state, &solver, &m));
  }
  bool attempt(double dt, StateView& to, Span<double> scratch, const abi::StageSolverTable& solver, Attempt& result,
               Message& m) const {
    return ok(table_->attempt(self_, dt, &to, scratch, &solver, &result, &m));
  }

 private:
  static bool ok(Status status) { return status == Status::ok; }
  const abi::IntegratorTable* table_ = nullptr;
  const void* self_ = nullptr;
};

}  // namespace freeplay
