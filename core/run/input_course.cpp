#include "run/input_course.h"

namespace freeplay {

Outcome run_with(Simulation& simulation, const RunHooks& hooks, const InputCourse& course) {
  simulation.begin(hooks);
  for (const InputCourse::Row& row : course.rows) {
    if (row.time < simulation.time()) continue;
    if (!simulation.advance({.until = row.time})) break;
    simulation.set_efforts(row.efforts);
  }
  simulation.advance({});
  return simulation.end();
}

}  // namespace freeplay
