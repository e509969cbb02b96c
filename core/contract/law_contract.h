// The contract of contact and friction laws.
#pragma once

#include "contract/conditions.h"
#include "contract/finding.h"
#include "freeplay/contact_law.h"
#include "freeplay/friction_law.h"

namespace freeplay {

/// Two objects made from equal parameters for the same pair; handles only.
struct ContactLawSubject {
  ContactLawRef law, twin;
  double clearance = 1e-4;  ///< of the pair the law was made for [m]; penetrations up to a third of it are tried
  bool may_jump = false;    ///< the law says that a damped contact begins with a jump
};

/// All rules for one contact law, at penetrations over seven decades and speeds of 3 mm/s to 17 m/s:
///
///   no-tension              the normal force is never negative
///   continuous              it starts from zero with the penetration, damped as well unless the law says otherwise
///   monotone                the elastic part grows with penetration
///   elastic-part            approach speed 0 leaves the elastic part, whatever the rate
///   potential               is the integral of the elastic part, and depends on penetration alone
///   derivatives             against differences
///   passive                 a cycle of loading and unloading takes no energy out of the contact
///   no-hidden-state, same-twin, answers, finite, outside-range, allocation
Findings check_contact_law(const ContactLawSubject& subject, const Conditions& conditions);

struct FrictionLawSubject {
  FrictionLawRef law, twin;
};

/// All rules for one friction law, at speeds of 1 um/s to 33 m/s; it may depend on the direction of the slip:
///
///   opposes-slip            the force acts against the slip; with internal variables in steady slip
///   unloaded                no normal force, no friction
///   derivatives             against differences
///   passive                 a cycle of slip to and fro takes no energy out of the contact
///   memory                  start values and resets of internal variables
///   stored-energy           its slopes, against differences; zero at the start values
///   no-hidden-state, same-twin, answers, finite, stays-in-span, allocation
Findings check_friction_law(const FrictionLawSubject& subject, const Conditions& conditions);

}  // namespace freeplay
