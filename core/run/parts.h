// RunParts: what runs with fixed and with adaptive steps share.
#pragma once

#include "run/end_check.h"
#include "run/motion_loads.h"
#include "run/step_acceptance.h"
#include "run/stop_search.h"

namespace freeplay {

/// Parts of one simulation, which must outlive its runs.
struct RunParts {
  RunContext& run;
  RunFailure& failure;
  StepAttempt& attempt;
  StepAcceptance& acceptance;
  Recorder& recorder;
  EnergyGrowth& growth;
  Corners& corners;
  MotionLoads& motion_loads;
  EndCheck& end;
  StopSearch& stop;
};

}  // namespace freeplay
