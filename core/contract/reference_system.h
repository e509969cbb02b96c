// ReferenceSystem: small systems with known motions, on which integrators are judged. Built without a model file.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "system/system.h"

namespace freeplay {

/// A known state: the parts that an integrator promises its order in.
struct KnownState {
  std::vector<double> q, v, lambda, z;
};

class ReferenceSystem {
 public:
  enum class Kind {
    oscillator,  ///< a body held by forces that are linear, driven in time, and relax by an internal variable
    pendulum,    ///< a rigid body that swings on a hinge: two constraint rows
    hanging      ///< the same at rest
  };
  explicit ReferenceSystem(Kind kind);
  ReferenceSystem(const ReferenceSystem&) = delete;
  ReferenceSystem& operator=(const ReferenceSystem&) = delete;
  ~ReferenceSystem();

  const System& system() const { return *system_; }
  const std::string& name() const { return name_; }
  KnownState start() const { return known(first_, 0.0); }
  /// States at 0, dt, ..., steps dt, by a classical fourth-order rule with steps so small that its error is rounding.
  std::vector<KnownState> motion(double dt, int steps) const;
  double energy(std::span<const double> q, std::span<const double> v) const;

 private:
  struct Parts;  // the joints
  std::vector<double> rate(const std::vector<double>& y, double t) const;
  KnownState known(const std::vector<double>& y, double t) const;
  void build_oscillator();
  void build_pendulum();

  Kind kind_;
  std::string name_;
  std::unique_ptr<Parts> parts_;
  std::unique_ptr<Model> model_;
  std::unique_ptr<System> system_;
  std::vector<double> first_;  // start of the reference equations
};

}  // namespace freeplay
