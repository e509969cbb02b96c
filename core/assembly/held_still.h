// Mechanisms of which nothing moves, and motors that move nothing.
#pragma once

#include <functional>
#include <string>

#include <Eigen/Core>

#include "system/system.h"

namespace freeplay {

/// `locked`: a driver by force or torque on a joint whose bodies no motion of the mechanism moves, where no driver
/// prescribes motion; a model without drivers whose joints leave it no freedom but spins of single bodies.
/// `dead-point`: such a driver where other bodies that hang on its joint can move. `open`: the constraint matrix of the
/// system as it runs, evaluated at the start.
void doubt_held_still(const System& released, const Eigen::MatrixXd& open,
                      const std::function<void(const char* id, const std::string& message, const std::string& name,
                                               const Location& location)>& doubt);

}  // namespace freeplay
