// The contract of joints: what joint.h asks of every one of them.
#pragma once

#include "contract/contact_poses.h"
#include "contract/joint_probe.h"

namespace freeplay {

/// Two objects made from equal parameters; handles only.
struct JointSubject {
  JointRef joint, twin;
  Space space = Space::planar;  ///< planar or spatial
  bool passive = true;          ///< false: a parameter is a function of time, which may bring energy
  bool thorough = true;         ///< false: fewer moments, for one that differs by a law from another
};

/// All rules for one joint. At random moments up to 50 s, in the plane or in space, turned by any angle, with distances
/// and speeds up to 5 m and 5 m/s and 10 rad/s:
///
///   jacobian, nu, gamma               rows against differences of phi along poses, in time, along accelerated motion
///   coordinate, coordinate-bias       the same for the coordinate
///   constraint-balance                moving both markers as one body changes neither rows nor coordinate, so that
///                                     the multipliers' forces are a pair; with `jacobian` they do no work on motions
///                                     that satisfy the constraints
///   rows-independent                  of one joint
///   balance                           the wrenches have no resultant force and no moment about any point
///   energy, energy-cycle              stored energy and dissipation account for the work, at once and over a cycle
///   derivatives, unused-derivatives   of apply() against differences
///   event-rate                        rates of the event functions against differences
///   place                             is a pose that satisfies the rows and gives the coordinate
///   pin                               where it is set, origins coincide in the plane and the turn is free
///   initial-offset                    of a joint with play is a finite place within reach
///   no-hidden-state, same-twin        answers depend on the input alone, bit for bit, and not on the object
///   free-distance                     within it nothing acts, happens or is remembered
///   play-bounds                       within the bounds nothing acts, beyond them it does
///   time-scale, next-corner           what it says of its own dependence on time
///   rollback                          history and internal variables are all there is to put back
///   contact-acts, located, prediction, force-jump, no-tension, starts-in-contact, event-fields, contacts-apart,
///   contact-numbers                   each contact where it begins, as runs of both kinds meet it
///   impact-energy, impact-modes, impact-events, impact-steps, event-storm    a free body thrown against each contact
///   answers, finite, stays-in-span, step-limit, allocation, declares-sanely    of every call
Findings check_joint(const JointSubject& subject, const Conditions& conditions);

// The parts, each on moments of its own choice.
void check_rows(const JointProbe& probe, const std::vector<JointMoment>& moments, RandomNumbers& random,
                Findings& findings);
void check_forces(const JointProbe& probe, bool passive, const std::vector<JointMoment>& moments, Findings& findings);
void check_cycle(const JointProbe& probe, const JointSubject& subject, RandomNumbers& random, Findings& findings);
void check_memory(const JointProbe& probe, const JointProbe& twin, const std::vector<JointMoment>& moments,
                  RandomNumbers& random, Findings& findings);
void check_bounds(const JointProbe& probe, RandomNumbers random, Findings& findings);
void check_rest(const JointProbe& probe, const std::vector<JointMoment>& moments, RandomNumbers& random,
                Findings& findings);
void check_time(const JointProbe& probe, const std::vector<JointMoment>& moments, RandomNumbers& random,
                Findings& findings);
void check_roles(const JointProbe& probe, const std::vector<JointMoment>& moments, Findings& findings);
void check_contacts(const JointProbe& probe, const std::vector<ContactPose>& poses, RandomNumbers& random,
                    Findings& findings);
void check_impacts(const JointProbe& probe, const std::vector<ContactPose>& poses, RandomNumbers& random,
                   Findings& findings);

}  // namespace freeplay
