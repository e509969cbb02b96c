// JointRef: the host's handle on a joint that may live in another library.
#pragma once

#include "freeplay/joint.h"

namespace freeplay {

/// Table and object of a joint; does not own it (component/instances.h does). Calls may be made from the time loop:
/// they return false and fill `message` when the joint failed, and do not throw.
class JointRef {
 public:
  JointRef() = default;
  JointRef(const abi::JointTable& table, const void* self) : table_(&table), self_(self) {}
  explicit operator bool() const { return self_ != nullptr; }

  bool declare(JointLayout& layout, Message& m) const { return ok(table_->declare(self_, &layout, &m)); }
  bool coordinate(const JointInput& in, CoordinateRow& out, Message& m) const {
    return ok(table_->coordinate(self_, &in, &out, &m));
  }
  bool constrain(const JointInput& in, ConstraintRows& out, Message& m) const {
    return ok(table_->constrain(self_, &in, &out, &m));
  }
  bool apply(const JointInput& in, JointForces& out, Message& m) const {
    return ok(table_->apply(self_, &in, &out, &m));
  }
  bool initialize(const JointInput& in, Span<double> internal, Span<double> history, Message& m) const {
    return ok(table_->initialize(self_, &in, internal, history, &m));
  }
  bool begin_step(const JointInput& in, const MarkerAccelerations& acceleration, double dt, Span<double> history,
                  Message& m) const {
    return ok(table_->begin_step(self_, &in, &acceleration, dt, history, &m));
  }
  bool events(const JointInput& in, Span<double> g, Span<double> rate, Message& m) const {
    return ok(table_->events(self_, &in, g, rate, &m));
  }
  bool on_event(int index, const JointInput& in, Span<double> internal, Span<double> history, Span<double> fields,
                Message& m) const {
    return ok(table_->on_event(self_, index, &in, internal, history, fields, &m));
  }
  bool commit(const JointInput& in, Span<const double> lambda, Span<double> history, Message& m) const {
    return ok(table_->commit(self_, &in, lambda, history, &m));
  }
  bool observe(const JointInput& in, Span<const double> lambda, Span<double> channels, Message& m) const {
    return ok(table_->observe(self_, &in, lambda, channels, &m));
  }
  bool step_limit(const JointInput& in, double& dt, Message& m) const {
    return ok(table_->step_limit(self_, &in, &dt, &m));
  }
  /// False also when the type cannot place a body; then `m` is empty.
  bool place(double coordinate, Pose& b_in_a, Message& m) const {
    std::int32_t can = 0;
    return ok(table_->place(self_, coordinate, &b_in_a, &can, &m)) && can != 0;
  }
  bool initial_offset(Span<const double> reaction, InitialOffset& out, Message& m) const {
    return ok(table_->initial_offset(self_, reaction, &out, &m));
  }
  bool warning(const JointInput& in, const char*& text, Message& m) const {
    return ok(table_->warning(self_, &in, &text, &m));
  }
  bool free_distance(const JointInput& in, double& distance, Message& m) const {
    return ok(table_->free_distance(self_, &in, &distance, &m));
  }
  bool next_corner(double t, double& corner, Message& m) const {
    return ok(table_->next_corner(self_, t, &corner, &m));
  }
  bool contacts(const JointInput& in, Span<double> numbers, Message& m) const {
    return ok(table_->contacts(self_, &in, numbers, &m));
  }
  bool kinks(const JointInput& in, Span<double> g, Message& m) const { return ok(table_->kinks(self_, &in, g, &m)); }
  bool free_levers(const JointInput& in, Span<double> levers, Message& m) const {
    return ok(table_->free_levers(self_, &in, levers, &m));
  }

 private:
  static bool ok(Status status) { return status == Status::ok; }
  const abi::JointTable* table_ = nullptr;
  const void* self_ = nullptr;
};

}  // namespace freeplay
