// What a geometry of contacts may leave out, and what stands for one of its contacts.
#pragma once

#include <cstddef>

#include "freeplay/contact_law.h"

namespace freeplay::play {

/// Part of the laws' forces that each contact of a geometry has: `Geometry::share`, the whole without it.
template <class Geometry>
constexpr double share_of() {
  if constexpr (requires { Geometry::share; }) {
    return Geometry::share;
  } else {
    return 1.0;
  }
}

/// One contact that is on, for what a class of kinematics does with it.
template <class Kinematics>
struct LoadedContact {
  const typename Kinematics::Laws& laws;
  const typename Kinematics::template Contact<double>& at;
  const ContactForce& normal;
  typename Kinematics::Memory memory;
  double share;
  std::size_t first, columns;  ///< of its internal variables among those of the joint; length of a row of derivatives
};

/// Whether b may go away from the surface further than the scale of a flight.
template <class Geometry>
constexpr bool leaves_surface() {
  if constexpr (requires { Geometry::leaves; }) {
    return Geometry::leaves;
  } else {
    return false;
  }
}

/// Energy that the memory of friction stores [J], and how fast it grows [W].
struct Stored {
  double energy, rate;
};

}  // namespace freeplay::play
