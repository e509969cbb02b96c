// The contract of integrators: what integrator.h asks of every one of them.
#pragma once

#include "component/integrator_ref.h"
#include "contract/conditions.h"
#include "contract/finding.h"

namespace freeplay {

/// Two objects made from equal parameters; handles only.
struct IntegratorSubject {
  IntegratorRef integrator, twin;
};

/// All rules for one integrator, run through the host's stage solver on small systems with known motions:
///
///   order-position, order-velocity, order-multiplier, order-internal
///                          the error falls with the declared order, less 0.2, when the step is halved
///   energy                 of a free pendulum does not grow over a thousand steps
///   rest                   stays rest
///   constraints            hold after every step, in position and velocity
///   time                   an attempt ends at t + dt
///   repeatable             an attempt from a copied state gives the same bits after other attempts, one that failed
///   among
///                          them, and from any contents of the scratch
///   same-twin              with another object of the same parameters, too
///   reports-failure        a stage that does not converge makes the attempt one that has not converged
///   restart                leaves position and velocity alone
///   answers, finite, stays-in-span, allocation, declares-sanely
Findings check_integrator(const IntegratorSubject& subject, const Conditions& conditions);

}  // namespace freeplay
