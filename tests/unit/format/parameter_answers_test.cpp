// Mistakes in curves, formulas and laws among the parameters of joints and force elements.
#include "answers.h"

namespace freeplay {
namespace {

const std::string two_bodies =
    "freeplay: 1\n"
    "bodies:\n"
    "  rod: {mass: 1, inertia: 1, frames: {tip: [1, 0]}}\n"
    "  bob: {mass: 1, inertia: 1}\n"
    "joints:\n"
    "  A: {type: revolute, between: [ground, rod]}\n";

constexpr Answer of_springs[] = {
    {"spring: {}", "9:52 missing-key: missing key 'points' in 'forces.w.spring'"},
    {"spring: {points: 3}", "9:69 wrong-type: 'forces.w.spring.points' must be a list, not a scalar"},
    {"spring: {points: [[0, 0]]}", "9:69 bad-table: a curve has from 2 to 1000 points"},
    {"spring: {points: [3, 4]}", "9:70 wrong-type: 'forces.w.spring.points[0]' must be a list of 2, not a scalar"},
    {"spring: {points: [[0, 0, 1], [1, 1]]}",
     "9:70 wrong-length: 'forces.w.spring.points[0]' must have 2 items, not 3"},
    {"spring: {points: [[0 kg, 0], [1, 1]]}",
     "9:71 dimension-mismatch: expected length, but this is mass | write a unit such as 'm'"},
    {"spring: {points: [[0, 0 kg], [1, 1]]}",
     "9:74 dimension-mismatch: expected force, but this is mass | write a unit such as 'N'"},
    {"spring: {points: [[0, 0], [0, 1]]}", "9:79 bad-table: the first numbers of points must increase: 0 follows 0"},
    {"spring: {points: [[0, 0], [1, 1]], interpolation: quadratic}",
     "9:102 wrong-type: 'forces.w.spring.interpolation' must be cubic or linear, not 'quadratic'"},
    {"spring: {points: [[0, 0], [1, 1]], ends: clamped}",
     "9:93 wrong-type: 'forces.w.spring.ends' must be natural or periodic, not 'clamped'"},
    {"spring: {points: [[0, 0], [1, 1]], ends: periodic}", "9:69 bad-table: a curve has from 3 to 1000 points"},
    {"spring: {points: [[0, 0], [1, 1], [2, 2]], ends: periodic}",
     "9:69 bad-table: the first and the last value of periodic points must agree: 0 and 2"},
    {"spring: {points: [[0, 0], [1, 1]], x: 1}", "9:87 unknown-key: unknown key 'x' in 'forces.w.spring'"},
    {"spring: {arcs: [[0, 0], [1, 1]]}",
     "9:60 wrong-type: 'arcs' are for a curve in the plane, which 'forces.w.spring' is not"},
    {"spring: [1]", "9:60 wrong-type: 'forces.w.spring' must be a formula, not a list"},
    {"spring: 3", ""},
    {"spring: 3 N/m*y", "9:66 unknown-name: unknown variable 'y' | it may hold x"},
    {"spring: t*1 N", "9:60 time-not-allowed: 't' is not allowed here | it may hold x"},
    {"length: 1 kg", "9:52 unknown-key: unknown key 'length' in 'forces.w' | free_length"},
    {"length: [1]", "9:52 unknown-key: unknown key 'length' in 'forces.w' | free_length"},
    {"stiffness: nan", "9:63 bad-number: a number must be finite"},
    {"stiffness: -1", "9:63 out-of-range: 'forces.w.stiffness' must be >= 0 N/m, not -1 N/m"},
    {"kind: round", "9:58 wrong-type: 'forces.w.kind' must be linear or rotational, not 'round'"},
    {"kind: [linear]", "9:58 wrong-type: 'forces.w.kind' must be linear or rotational, not a list"},
    {"damping: sqrt(-1)", "9:61 bad-expression: square root of a negative number"},
    {"stiffness: 1/0", "9:64 bad-expression: division by zero"},
    {"spring: x*1e3 N/m, stiffness: 1", ""},
};

constexpr Answer of_curves[] = {
    {"curve: {}", "7:54 missing-key: missing key 'points' in 'joints.B.curve'"},
    {"curve: {arcs: 3}", "7:68 wrong-type: 'joints.B.curve.arcs' must be a list, not a scalar"},
    {"curve: {arcs: [[0, 0]]}", "7:68 wrong-length: a curve has from 2 to 1000 arcs"},
    {"curve: {arcs: [3, 3]}", "7:69 wrong-type: 'joints.B.curve.arcs[0]' must be a list, not a scalar"},
    {"curve: {arcs: [[0], [1, 0]]}",
     "7:69 wrong-length: 'joints.B.curve.arcs[0]' must be [x, y, radius], or [x, y] for an end"},
    {"curve: {arcs: [[0, 0], [1, 0, 1, 1]]}",
     "7:77 wrong-length: 'joints.B.curve.arcs[1]' must be [x, y, radius], or [x, y] for an end"},
    {"curve: {arcs: [[0, 0], [1 kg, 0]]}",
     "7:78 dimension-mismatch: expected length, but this is mass | write a unit such as 'm'"},
    {"curve: {arcs: [[0, 0], [1, 0]], roller: [1]}",
     "7:94 wrong-type: 'joints.B.curve.roller' must be a quantity, not a list"},
    {"curve: {arcs: [[0, 0], [1, 0]], roller: 1 kg}",
     "7:94 dimension-mismatch: expected length, but this is mass | write a unit such as 'm'"},
    {"curve: {arcs: [[0, 0], [0, 0]]}",
     "7:77 bad-curve: this circle and the one before it have no common tangent in their sense"},
    {"form: polar, curve: {arcs: []}", "7:81 wrong-length: a curve has from 1 to 1000 arcs"},
    {"form: polar, curve: {arcs: [[0, 0, 1], [5, 0, 1]]}", ""},
    {"form: polar, curve: {arcs: [[0, 0, -1]]}",
     "7:82 bad-curve: the curve crosses itself: list its circles counter-clockwise, hollow ones with a negative "
     "radius"},
    {"curve: {arcs: [[0, 0], [1, 0]], rollers: 1}",
     "7:86 unknown-key: unknown key 'rollers' in 'joints.B.curve' | roller"},
    {"curve: {points: [[0, 0], [1, 1]], roller: 1}", "7:88 unknown-key: unknown key 'roller' in 'joints.B.curve'"},
    {"form: polar, curve: {points: [[0, 1], [1, 1], [2, 1]], ends: periodic}", ""},
    {"curve: {arcs: [[0, 0], [1, 0], [0.5, 1]]}", "7:77 bad-curve: a corner has no normal: give it a radius"},
};

constexpr Answer of_laws[] = {
    {"contact: [1]", "4:118 wrong-type: 'joints.A.clearance.contact' must be the name of a law or a map, not a list"},
    {"contact: {}", "4:109 missing-key: missing key 'law' in 'joints.A.clearance.contact'"},
    {"contact: {law: flore}",
     "4:109 missing-key: missing key 'restitution' in 'joints.A.clearance.contact'\n4:124 unknown-type: unknown type "
     "'flore' in 'joints.A.clearance.contact.law' | flores"},
    {"contact: {law: floress, K: 1e9, restitution: 0.9}",
     "4:124 unknown-type: unknown type 'floress' in 'joints.A.clearance.contact.law' | flores"},
    {"contact: {law: [flores]}",
     "4:124 wrong-type: 'joints.A.clearance.contact.law' must be a word or text, not a list"},
    {"contact: {K: 1}", "4:109 missing-key: missing key 'law' in 'joints.A.clearance.contact'"},
    {"contact: flores", "4:109 missing-key: missing key 'restitution' in 'joints.A.clearance.contact'"},
    {"contact: zzzz",
     "4:118 unknown-type: unknown type 'zzzz' in 'joints.A.clearance.contact' | not in this release, which has hertz, "
     "kelvin-voigt, hunt-crossley, herbert-mcwhannell, lee-wang, lankarani-nikravesh, gonthier, flores, hu-guo, "
     "zhiying-qishao, johnson, radzimovsky, esdu-78035 or expression"},
    {"contact: {law: flores, K: 1e9, restitution: 0.9, kk: 1}",
     "4:158 unknown-key: unknown key 'kk' in 'joints.A.clearance.contact'"},
    {"contact: {law: hertz, K: 1e9 kg}",
     "4:134 dimension-mismatch: expected N/m^1.5, but this is mass | write a unit such as 'N/m^1.5'"},
    {"contact: {law: hertz, K: 1e9, exponent: 0}",
     "4:149 out-of-range: 'joints.A.clearance.contact.exponent' must be >= 1 and <= 3, not 0"},
    {"contact: {law: hertz, K: 1e9, exponent: x}", "4:149 bad-expression: 'x' is not a number | exp"},
    {"contact: {law: hertz, K: 1e9}, friction: 3",
     "4:150 unknown-type: unknown type '3' in 'joints.A.clearance.friction' | not in this release, which has none, "
     "coulomb-tanh, coulomb-linear, coulomb-atan, ambrosio, threlfall, bengisu-akay, stribeck, lugre or expression"},
    {"contact: {law: hertz, K: 1e9}, friction: [1]",
     "4:150 wrong-type: 'joints.A.clearance.friction' must be the name of a law or a map, not a list"},
    {"contact: {law: hertz, K: 1e9}, friction: {law: coulomb-tanh}",
     "4:140 missing-key: missing key 'mu' in 'joints.A.clearance.friction'"},
    {"contact: {law: hertz, K: 1e9}, friction: {law: coulom-tanh, coefficient: 0.1}",
     "4:140 missing-key: missing key 'mu' in 'joints.A.clearance.friction'\n4:156 unknown-type: unknown type "
     "'coulom-tanh' in 'joints.A.clearance.friction.law' | coulomb-tanh\n4:169 unknown-key: unknown key 'coefficient' "
     "in 'joints.A.clearance.friction'"},
    {"contact: {law: expression, force: 3}", ""},
    {"contact: {law: expression, force: [1]}",
     "4:143 wrong-type: 'joints.A.clearance.contact.force' must be a formula, not a list"},
    {"contact: {law: hertz, E: 200 GPa, nu: 0.3, K: 1e9}",
     "4:131 unknown-key: unknown key 'E' in 'joints.A.clearance.contact'\n4:143 unknown-key: unknown key 'nu' in "
     "'joints.A.clearance.contact'"},
    {"contact: {law: hertz}",
     "4:109 missing-key: 'K' is required, as it cannot be computed without the material of the bearing, the material "
     "of the journal"},
};

TEST(Answers, ToCurvesAndFormulas) {
  expect_answers(
      two_bodies +
          "  B: {type: revolute, between: [rod/tip, bob]}\nforces:\n  w: {type: spring-damper, between: [ground, "
          "bob], @}\nsimulation: {end: 2, step: 1 ms}\n",
      of_springs);
  expect_answers(two_bodies +
                     "  B: {type: point-on-curve, between: [rod/tip, bob], @}\nforces:\n  w: {type: force, at: bob, "
                     "value: [0, 1]}\nsimulation: {end: 2, step: 1 ms}\n",
                 of_curves);
}

TEST(Answers, ToLaws) {
  expect_answers(
      "freeplay: 1\nbodies: {puck: {mass: 1, inertia: 1}}\njoints:\n  A: {type: revolute, between: [ground, puck], "
      "clearance: {radial_clearance: 0.1 mm, bearing_radius: 10 mm, @}}\nsimulation: {end: 1, step: 1 ms}\n",
      of_laws);
}

}  // namespace
}  // namespace freeplay
