// RunParts: what runs with fixed and with adaptive steps share.
#pragma once

#include "run/end_check.h"
#include "run/step_acceptance.h"

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
  EndCheck& end;
};

}  // namespace freeplay
