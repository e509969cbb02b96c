#include "stage/equations.h"

namespace freeplay {

StageEquations::StageEquations(const System& system, EvaluationContext* run)
    : system_(system), e_(system, run), rows_(system.jacobian()) {
  for (int i = 0; i < system.layout().nv(); ++i) unit_.push_back(system.coordinates().is_turn(i) ? 1.0 : system.size());
  for (const double unit : unit_) per_unit_.push_back(1.0 / unit);
}

bool StageEquations::note_fault() {
  trouble_ = e_->fault.kind == Fault::Kind::plugin ? e_->fault.message.text : e_->fault.motion.text;
  return false;
}

}  // namespace freeplay
