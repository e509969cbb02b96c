// What a gear that cannot be is answered: its pair, its teeth, its play.
#include "answers.h"

namespace freeplay {
namespace {

constexpr const char* wheels =
    "freeplay: 1\n"
    "bodies:\n"
    "  wheel: {mass: 1, inertia: 1e-3}\n"
    "  pinion: {mass: 1, inertia: 1e-3, pose: {position: [0.3, 0]}}\n"
    "  rack: {mass: 1, inertia: 1e-3}\n"
    "  bob: {mass: 1, inertia: 1e-3, pose: {position: [0.3, 0]}}\n"
    "  ground: {frames: {P: [0.3, 0]}}\n"
    "joints:\n"
    "  W: {type: revolute, between: [ground, wheel]}\n"
    "  P: {type: revolute, between: [ground/P, pinion]}\n"
    "  R: {type: prismatic, between: [ground, rack]}\n"
    "  S: {type: point-on-line, between: [ground/P, bob]}\n"
    "  D: {type: distance, between: [ground, bob], length: 0.3}\n"
    "  T: {type: prismatic, between: [rack, bob]}\n"
    "  X: {type: revolute, between: [rack, bob]}\n"
    "  Y: {type: revolute, between: [ground, bob]}\n"
    "  L: {type: revolute, between: [ground/P, bob], clearance: {bearing_radius: 10 mm, journal_radius: 9.9 mm, "
    "contact: {law: kelvin-voigt, K: 1e6, D: 1500}}}\n"
    "  G: {type: gear, @}\n";

constexpr Answer of_gears[] = {
    {"of: [W, P], ratio: -2, pressure_angle: 20",
     "18:58 out-of-range: 'joints.G.pressure_angle' must be above 0 and not above 45 deg | a number without a unit is "
     "in rad; write '20 deg'"},
    {"of: [W, P], ratio: -2, pressure_angle: 50 deg",
     "18:58 out-of-range: 'joints.G.pressure_angle' must be above 0 and not above 45 deg | usual are 14.5 deg, 20 deg "
     "and 25 deg"},
    {"of: [R, T], ratio: 2, pressure_angle: 20 deg",
     "18:57 conflicting-keys: 'pressure_angle' needs a wheel: both joints slide"},
    {"of: [W, P], ratio: 1, pressure_angle: 20 deg",
     "18:57 conflicting-keys: 'pressure_angle' needs wheels that do not turn equally fast the same way"},
    {"of: [W, S], ratio: -1, pressure_angle: 20 deg",
     "18:58 conflicting-keys: 'pressure_angle' needs a rack that does not turn, but 'S' leaves it free"},
    {"of: [W, D], ratio: -1", "18:27 wrong-type: joint 'D' has no coordinate that a gear could couple"},
    {"of: [W, R], ratio: 2 mm, clearance: {pitch_radius: 0.1, gap: 0.1 mm, contact: {law: kelvin-voigt, K: 1e6, D: "
     "1500}}",
     "18:44 wrong-type: teeth with play join two wheels that turn, no slide | leave 'clearance' out, or couple two "
     "joints that turn"},
    {"of: [W, P], ratio: -2, clearance: {pitch_radius: 0.2, gap: 0.1 mm, contact: {law: kelvin-voigt, K: 1e6, D: "
     "1500}}",
     "18:68 out-of-range: the axes of 'W' and 'P' are 0.3 m apart, but with this pitch radius and ratio the pitch "
     "circles touch at 0.6 m | the pitch radius of the second wheel is 0.1 m"},
    {"of: [W, P], ratio: -2, clearance: {first_radius: 1, pitch_radius: 0.1, gap: 0.1 mm, contact: {law: kelvin-voigt, "
     "K: 1e6, D: 1500}}",
     "18:54 conflicting-keys: 'joints.G.clearance.first_radius' follows from the gear"},
    {"of: [W, P], ratio: -2, clearance: {middle: 1, pitch_radius: 0.1, gap: 0.1 mm, contact: {law: kelvin-voigt, K: "
     "1e6, D: 1500}}",
     "18:54 conflicting-keys: 'joints.G.clearance.middle' follows from the gear"},
    {"of: [W, P], ratio: 1, clearance: {pitch_radius: 0.2, gap: 0.1 mm, contact: {law: kelvin-voigt, K: 1e6, D: 1500}}",
     "18:67 out-of-range: the axes of 'W' and 'P' are 0.3 m apart, but with this pitch radius and ratio the pitch "
     "circles touch at 0 m"},
    {"of: [W, Z], ratio: 1, clearance: {pitch_radius: 0.2, gap: 0.1 mm, contact: {law: kelvin-voigt, K: 1e6, D: 1500}}",
     "18:27 unknown-name: unknown joint 'Z'"},
    {"of: [W, X], ratio: -2, clearance: {pitch_radius: 0.1, gap: 0.1 mm, contact: {law: kelvin-voigt, K: 1e6, D: "
     "1500}}",
     "18:3 wrong-type: 'W' and 'X' do not hold two wheels on one body: teeth meet where one body carries both axes | "
     "couple joints between the wheels and the frame or the arm that carries them"},
    {"of: [W, X], ratio: -2, pressure_angle: 20 deg",
     "18:58 conflicting-keys: 'pressure_angle' needs 'W' and 'X' on one body that carries both wheels"},
    {"of: [W, L], ratio: -2, pressure_angle: 20 deg",
     "18:58 conflicting-keys: 'pressure_angle' needs bearings without play, but 'L' has play | give the gear play, "
     "too, by a block 'clearance'"},
    {"of: [W, P], ratio: -2, offset: 90",
     "18:50 doubtful-angle: 'joints.G.offset' is 90 rad, 14.3 turns: write '90 deg' if degrees are meant, else '90 "
     "rad'"},
    {"of: [W, R], ratio: 10 mm, offset: 90",
     "18:53 doubtful-length: 'joints.G.offset' is 90 m where the lengths of the mechanism are about 0.15 m: write the "
     "unit after the number, as in '90 mm'"},
    {"of: 3, ratio: 1", "18:23 wrong-type: 'joints.G.of' must be a list of 2, not a scalar"},
    {"of: [W, T], ratio: 1 mm, pressure_angle: 20 deg",
     "18:60 conflicting-keys: 'pressure_angle' needs 'W' and 'T' on one body that carries both wheels"},
    {"of: [W, P], ratio: x, pressure_angle: 20 deg", "18:38 bad-expression: 'x' is not a number | exp"},
    {"of: [W, P], ratio: x, of: 3",
     "18:38 bad-expression: 'x' is not a number | exp\n18:41 duplicate-key: the key 'of' is given twice"},
    {"of: [W, Y], ratio: -2, pressure_angle: 20 deg",
     "18:58 conflicting-keys: 'pressure_angle' needs two axles at a distance, of which pitch radii follow; both are at "
     "the same point"},
};

TEST(Answers, ToGears) { expect_answers(wheels, of_gears); }

}  // namespace
}  // namespace freeplay
