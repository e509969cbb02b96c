// InputCourse: what efforts that are inputs become during a run.
#pragma once

#include <vector>

#include "run/simulation.h"

namespace freeplay {

/// At each of these times, which increase, a step ends and every input has the effort of that row.
struct InputCourse {
  struct Row {
    double time;                  ///< [s]
    std::vector<double> efforts;  ///< by input, in declaration order [N, N m]
  };
  std::vector<Row> rows;
};

/// Runs to the end, with the inputs of `course`. A run that goes on from a saved state takes up what it has not passed.
Outcome run_with(Simulation& simulation, const RunHooks& hooks, const InputCourse& course);

}  // namespace freeplay
