// FigureNoise: how far means, counts and parts of the time of a run mean anything.
#pragma once

#include <cstddef>

#include "run/statistics.h"

namespace freeplay {

/// By how much figures may differ in another run, as chance in impacts has it; docs/trust.md says how this is
/// estimated.
class FigureNoise {
 public:
  struct OfJoint {
    double rms_force, contacts, contact_fraction;
  };
  struct OfPath {
    double rms_position, rms_angle;
  };
  explicit FigureNoise(const Statistics& statistics) : statistics_(statistics) {}

  OfJoint joint(int index) const;
  double rms_of_driver(int index) const;
  OfPath path(int index) const;

 private:
  /// What the loose joints that share the chance of a value have gone through, the mean of all of them.
  struct Loose {
    double joints = 0.0, contacts = 0.0, flight = 0.0;
  };
  Loose beside(std::size_t place) const;
  [[gnu::cold]] double of_rms(const Statistics::Mean& wanted) const;

  const Statistics& statistics_;
};

}  // namespace freeplay
