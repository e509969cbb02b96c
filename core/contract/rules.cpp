#include "contract/rules.h"

namespace freeplay {
namespace {

enum Kinds : unsigned { joints = 1, contact_laws = 2, friction_laws = 4, integrators = 8, laws = 6, all = 15 };

struct Rule {
  const char* name;
  unsigned kinds;
  const char* meaning;
};

constexpr Rule rules[] = {
    // The table of the library.
    {"name", all, "The name is lower-case words joined by hyphens."},
    {"space", joints, "`space` is planar, spatial or both."},
    {"summary", all, "The type and each of its parameters has a summary; manuals and error messages print it."},
    {"parameter-names", all,
     "Names are letters, digits and underscores, paths are joined by dots, and no two are alike. None is a key that "
     "the "
     "model file reads itself, such as `type`."},
    {"parameter-bounds", all, "A parameter's minimum lies below its maximum."},
    {"parameter-defaults", all, "A default lies within its bounds; that of a choice is the index of one of its words."},
    {"parameter-choices", all, "A choice has words separated by '|', no two alike."},
    {"parameter-units", all,
     "Units are those of the model format; an exponent names a number of the table, alternatives have a choice in "
     "front "
     "and one unit for each of its words."},
    {"parameter-variables", all,
     "A formula has one to four variables with units, such as \"delta: m; rate: m/s\"; none is called like another, a "
     "unit, a function, `t` or `pi`. What is no formula has none."},
    {"accepts-parameters", all,
     "The constructor accepts some block that its own table allows. Look at the checks in the constructor and at the "
     "bounds in the table."},
    // Every call.
    {"answers", all, "Every call returns and throws nothing on input within the table's bounds."},
    {"finite", all,
     "Every number that a call gives is finite. Look for a division by a length, speed or load of zero."},
    {"stays-in-span", all,
     "A call writes only the numbers that it was given to fill, and changes no input. Look at the indices, and at the "
     "sizes that declare() asks for."},
    {"allocation", all,
     "Calls of the time loop allocate no memory. Look for std::vector, std::string, std::function and dynamic Eigen "
     "matrices; size work space in the constructor, or declare history or scratch."},
    {"declares-sanely", joints,
     "declare() asks for at most 3 rows in the plane and 6 in space and for no negative sizes; `forces` is set if "
     "apply() acts. It answers the same each time."},
    {"declares-sanely", integrators,
     "declare() asks for an order of 1 or more, a tolerance above 0 and sizes within reason."},
    {"no-hidden-state", joints | laws,
     "The same input gives the same numbers, bit for bit, whatever was asked before. Look for mutable, static and "
     "global "
     "variables and for numbers that are never set; what must be kept belongs into history or internal variables."},
    {"same-twin", all,
     "Two objects with equal parameters give the same numbers, bit for bit. Look for static and global variables and "
     "for "
     "members that the constructor does not set."},
    // Rows and coordinate.
    {"jacobian", joints, "The Jacobian of constrain() is the derivative of phi: d(phi)/dt = G V - nu."},
    {"nu", joints, "nu is minus the partial derivative of phi in time."},
    {"gamma", joints,
     "gamma collects what is left of the second derivative of phi without accelerations: G dV/dt = gamma. Look for a "
     "centripetal term (speed squared) that is missing or has the wrong sign."},
    {"coordinate", joints,
     "The Jacobian of coordinate() is the derivative of its value, which does not depend on time."},
    {"coordinate-bias", joints,
     "s'' = G dV/dt + bias for the value s of coordinate(). Look for missing speed-squared terms."},
    {"constraint-balance", joints,
     "Moving both markers as one rigid body changes neither rows nor coordinate, so that the forces of the multipliers "
     "are a pair. Look at the columns of body a and at the lever arms in the columns of turns."},
    {"rows-independent", joints, "The rows of one joint are linearly independent."},
    {"place", joints,
     "place() puts body b where the rows are satisfied and the coordinate has the value that was asked for. The pose "
     "has "
     "a rotation matrix."},
    {"pin", joints,
     "A joint that sets `pin` keeps the origins of its markers together in the plane and leaves the turn free."},
    {"planar-rows", joints,
     "constrain() and coordinate() write what `planar_rows` and `planar_coordinate` declare. Where they do not, leave "
     "these empty: the host then asks."},
    // Forces of joints.
    {"balance", joints,
     "The wrenches on a and b have no resultant force and no resultant moment about any point. Look at the reaction on "
     "a "
     "and at the moment that moves the force to each marker's origin."},
    {"energy", joints,
     "The power of the wrenches plus the rate of the stored energy is not positive: what is not stored is dissipated. "
     "Look at the sign of the damping and at `potential`."},
    {"potential-rate", joints,
     "`potential_rate`, where apply() fills it, is the derivative of `potential` in time. Look at terms that depend on "
     "speeds."},
    {"energy-cycle", joints,
     "A closed motion takes no energy out of the joint. Look at internal variables that push instead of relaxing."},
    {"derivatives", joints,
     "The derivatives that apply() fills agree with differences of its own forces and rates. Leave "
     "`analytic_derivatives` at zero and the program takes differences itself."},
    {"unused-derivatives", joints, "Forces are the same, bit for bit, whether derivatives are asked for or not."},
    // Events and memory of joints.
    {"event-rate", joints, "The rate of an event function is its derivative in time."},
    {"event-names", joints,
     "Names of events and of their fields are lower-case words joined by underscores, no two alike."},
    {"channel-names", joints,
     "Names of channels are lower-case words joined by underscores, no two alike, and none that every joint has."},
    {"channel-units", joints, "Channels and event fields have units of the model format."},
    {"roles", joints,
     "A channel is what its role says: penetration, eccentricity in m, forces in N, slip speed in m/s; a normal force "
     "is not negative, `in_contact` is 0 or 1, an eccentricity is the origin of b minus that of a in world axes. As "
     "many events end a contact as begin one."},
    {"rollback", joints,
     "After history and internal variables are put back, the joint repeats itself bit for bit, also after an attempt "
     "that "
     "was given up. Look for numbers that are kept in members."},
    {"history-loss", joints,
     "Where apply() fills `potential_rate`, what on_event() and commit() change takes as much out of `potential` as "
     "they add to JointInput::dissipated."},
    {"step-limit", joints, "step_limit() gives a time above zero."},
    {"free-distance", joints,
     "Wherever the markers move within free_distance(), turns counted by free_levers() where the joint declares "
     "`free_turns`, the joint exerts and stores nothing, no event is past its zero, there is nothing to warn of, and "
     "begin_step() and commit() change nothing that it answers later."},
    {"play-bounds", joints,
     "Where b stands off by half of what `play_bounds` declares the joint exerts nothing, by twice of it something. "
     "Look "
     "for a bound in other axes than those of a, and for a turn that counts with the wrong sign."},
    // Contacts of joints, where an event begins one.
    {"contact-acts", joints,
     "After its begin event a contact pushes as soon as it is deep, and stops a body that it can stop. Look for a "
     "contact "
     "that no force belongs to, and for events that belong to another one."},
    {"located", joints,
     "Where `per_contact` is not zero, steps end at events, and history alone says who touches: a contact in flight "
     "gives "
     "no force past its event, and its function stays past zero until the event is handled."},
    {"prediction", joints,
     "In steps of one size a contact begins inside of a step. Its force there is that which it has after its event: "
     "begin_step() predicts the approach speed, or the force takes the present rate for it."},
    {"force-jump", joints,
     "The elastic force of a contact starts from zero, and no force jumps with the place while contacts go on. Look "
     "for "
     "a preload, and for formulas that change when a second contact closes."},
    {"no-tension", joints, "Surfaces push and do not pull: return zero where damping would make a force negative."},
    {"starts-in-contact", joints,
     "A contact that is on when a run starts pushes, and has no approach speed to divide by: it is elastic until it "
     "has "
     "ended. Look at what initialize() leaves and what the begin event, which is handled then, makes of it."},
    {"event-fields", joints,
     "`speed` of a begin is the rate of its event function; `duration` and `max_fn` of an end are those of this "
     "contact."},
    {"contacts-apart", joints,
     "Events of one contact leave the others as they are. Look at the places of a contact in `history`."},
    {"contact-numbers", joints,
     "The normal forces of contacts() add up to the channel of that role, and their losses to the power that the "
     "wrenches "
     "take out and do not store."},
    {"impact-energy", joints,
     "An impact of a free body never has more energy than it began with. Look at approach speeds that are next to "
     "zero."},
    {"impact-modes", joints,
     "An impact loses the same where steps end at its events and where they do not. Look at the approach speed of "
     "each."},
    {"impact-events", joints,
     "An impact has one begin and, when the body has left, one end. Look for functions that are NaN when they must "
     "be "
     "numbers."},
    {"impact-steps", joints,
     "step_limit() during an impact is its duration over `per_contact`, about. Look at the mass that the contact "
     "feels, "
     "turning included (`whole_mobility`)."},
    {"event-storm", joints,
     "Events come to an end. Look for one that makes another possible when that is past its zero already."},
    {"time-scale", joints,
     "`time_scale` is a time above zero, or zero where it is not known; a joint that declares `unbounded` gives the "
     "same "
     "forces and rows at any time. Look for JointInput::t and for functions of time among the parameters."},
    {"next-corner", joints,
     "next_corner(t) gives the first corner after t, later than t and the same from wherever in between it is asked; "
     "unbounded where none is left."},
    {"initial-offset", joints,
     "A joint with play starts at a finite place and angle with finite speeds, for any load."},
    // Contact laws.
    {"no-tension", contact_laws,
     "The normal force is never negative: surfaces do not pull. Return zero where it would be."},
    {"continuous", contact_laws,
     "The force starts from zero with the penetration; a damped contact may begin with a jump only if `validity` says "
     "that there is a jump."},
    {"monotone", contact_laws, "The elastic force grows with penetration."},
    {"elastic-part", contact_laws,
     "An approach speed of zero leaves the elastic force, whatever the rate; `elastic`, where it is given, is that "
     "force "
     "at any approach speed."},
    {"potential", contact_laws,
     "`potential` is the integral of the elastic force over penetration and depends on penetration alone."},
    {"derivatives", contact_laws, "d_penetration and d_rate agree with differences of the normal force."},
    {"passive", contact_laws,
     "Loading and unloading takes no energy out of the contact. Look at the sign of the damping at negative rates."},
    {"outside-range", contact_laws, "outside_range() gives a sentence or null, not an empty text."},
    // Friction laws.
    {"opposes-slip", friction_laws,
     "The force acts against the slip; with internal variables once these have settled."},
    {"unloaded", friction_laws, "Without a normal force there is no friction."},
    {"derivatives", friction_laws, "d_normal and d_slip agree with differences of the tangential force."},
    {"passive", friction_laws, "Slip to and fro takes no energy out of the contact."},
    {"memory", friction_laws, "Start values of internal variables are finite numbers, and resets are known ones."},
    {"stored-energy", friction_laws,
     "stored() is zero at the start values, its slopes agree with differences, and it depends on no variable that is "
     "never reset: what a contact stored is lost when it ends."},
    // Integrators.
    {"order-position", integrators,
     "The error of positions falls with the declared order when the step is halved. Look at the weights of the "
     "stages."},
    {"order-velocity", integrators, "The error of velocities falls with the declared order when the step is halved."},
    {"order-multiplier", integrators,
     "The error of multipliers falls with the declared order. Solve for accelerations once more at the end of the "
     "step."},
    {"order-internal", integrators,
     "The error of internal variables falls with the declared order. Look at the known terms and beta of z."},
    {"converges", integrators, "Small smooth systems are stepped to their end."},
    {"energy", integrators, "The energy of a free pendulum does not grow over a thousand steps."},
    {"rest", integrators, "A body at rest stays at rest."},
    {"constraints", integrators, "Constraints hold after every step, in position and velocity. Project the velocity."},
    {"time", integrators, "An attempt ends at t + dt."},
    {"repeatable", integrators,
     "An attempt from a copied state gives the same numbers, bit for bit, after other attempts and from any contents "
     "of "
     "the scratch. Look for mutable members, and for scratch that is read before it is written."},
    {"reports-failure", integrators, "When a stage does not converge, the attempt has not converged."},
    {"restart", integrators, "restart() leaves positions and velocities alone."},
    {"estimate-order", integrators,
     "The error estimate falls with the power of the step that `error_order` declares, or with the order and one if it "
     "is "
     "left at zero."},
    {"estimate-size", integrators, "The error estimate is not much less than the error itself."},
    {"error-estimate", integrators,
     "The error of an attempt is a finite number that is not negative, and zero if declare() announces no estimate."},
};

unsigned bit(ComponentKind kind) { return 1u << static_cast<unsigned>(kind); }
static_assert(static_cast<unsigned>(ComponentKind::joint) == 0 &&
              static_cast<unsigned>(ComponentKind::contact_law) == 1 &&
              static_cast<unsigned>(ComponentKind::friction_law) == 2 &&
              static_cast<unsigned>(ComponentKind::integrator) == 3);

}  // namespace

std::string_view rule_meaning(ComponentKind kind, std::string_view rule) {
  for (const Rule& row : rules) {
    if (rule == row.name && (row.kinds & bit(kind)) != 0) return row.meaning;
  }
  return {};
}

}  // namespace freeplay
