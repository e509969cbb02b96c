// ModelFacts: how many bodies, joints, rows and freedoms a model has.
#pragma once

#include <optional>

#include "model/model.h"

namespace freeplay {

/// Counts of rows and freedoms at the assembled start (cli.md, section 3).
struct ConstraintFacts {
  int constraints = 0, rank = 0, redundant = 0, dof = 0, dof_driven = 0, driver_redundant = 0;
};

/// What `freeplay validate` reports.
struct ModelFacts {
  int bodies = 0, joints = 0, clearance_joints = 0, drivers = 0, coordinates = 0, velocities = 0;
  int driver_constraints = 0;
  ConstraintFacts actual;
  std::optional<ConstraintFacts> ideal;  ///< with every clearance closed; absent without clearance
};

/// Facts that need no assembly: rank, redundant and dof are -1.
ModelFacts count_facts(const Model& model);

}  // namespace freeplay
