// Mistakes in bodies, forces, drivers, result columns and the section `analysis` of a model that is sound otherwise.
#include "answers.h"

namespace freeplay {
namespace {

constexpr const char* sound =
    "freeplay: 1\n"
    "parameters: {a: 1}\n"
    "bodies:\n"
    "  rod: {mass: $a, inertia: 1, com: [0.5, 0], frames: {tip: [1, 0]}}\n"
    "  bob: {mass: 1, inertia: 1}\n"
    "joints:\n"
    "  A: {type: revolute, between: [ground, rod]}\n"
    "  B: {type: revolute, between: [rod/tip, bob]}\n"
    "drivers:\n"
    "  m: {joint: A, kind: angle, value: 3*t}\n"
    "forces:\n"
    "  w: {type: force, at: bob, value: [1, 0]}\n"
    "initial: {joints: {B: 30 deg}}\n"
    "simulation: {end: 2, step: 1 ms}\n";

TEST(Answers, ASoundModelGetsNone) { EXPECT_EQ(said_of(sound), ""); }

constexpr Answer of_inertias[] = {
    {"[1, 1, 3]",
     "3:32 out-of-range: no body has this inertia: its largest principal moment is above the sum of the others (1, 1, "
     "3)"},
    {"[-1, 1, 1]", "3:32 out-of-range: no body has this inertia: a principal moment is negative (-1, 1, 1)"},
    {"[[1, 0, 0], [0, -1, 0], [0, 0, 1]]",
     "3:32 out-of-range: no body has this inertia: a principal moment is negative (-1, 1, 1)"},
    {"[1, 1, 1, 0, 0, 2]", "3:32 out-of-range: no body has this inertia: a principal moment is negative (-1, 1, 3)"},
    {"0", "3:32 wrong-type: 'bodies.a.inertia' must be a list, not a scalar"},
    {"[0, 0, 1]",
     "3:32 out-of-range: no body has this inertia: its largest principal moment is above the sum of the others (0, 0, "
     "1)"},
    {"[[1, 0], [0, 1]]",
     "3:32 wrong-type: 'bodies.a.inertia' must be 3 moments of inertia, 6 numbers or 3 rows of 3, not a list"},
    {"[[1,0,0],[0,1],[0,0,1]]", "3:41 wrong-length: 'bodies.a.inertia[1]' must have 3 items, not 2"},
    {"{x: 1}", "3:32 wrong-type: 'bodies.a.inertia' must be a list, not a map"},
};

constexpr Answer of_bodies[] = {
    {"frames: 3", "5:38 wrong-type: 'bodies.bob.frames' must be a map, not a scalar"},
    {"frames: {a: 3}", "5:42 wrong-type: 'bodies.bob.frames.a' must be a position or a map, not a scalar"},
    {"frames: {a: {polar: 3}}", "5:50 wrong-type: 'bodies.bob.frames.a.polar' must be a list of 2, not a scalar"},
    {"frames: {a: {position: [0, 0], rpy: 3}}",
     "5:61 unknown-key: unknown key 'rpy' in 'bodies.bob.frames.a' | only in spatial models"},
    {"frames: {a/b: [0, 0]}",
     "5:39 bad-name: 'a/b' is not a valid name of a frame | a name has letters, digits, '_' and '-' and begins with a "
     "letter or '_'"},
    {"frames: {a: {angle: 3 m}}",
     "5:50 dimension-mismatch: expected angle or number, but this is length | write a number without a unit, or an "
     "angle"},
    {"velocity: {linear: [1]}", "5:49 wrong-length: 'bodies.bob.velocity.linear' must have 2 items, not 1"},
    {"velocity: 3", "5:40 wrong-type: 'bodies.bob.velocity' must be a map, not a scalar"},
    {"pose: 3", "5:36 wrong-type: 'bodies.bob.pose' must be a map, not a scalar"},
};

constexpr Answer of_names[] = {
    {"name: ''", "2:7 wrong-type: 'name' must not be empty"},
    {"name: ", "2:1 wrong-type: 'name' is empty; it must be a word or text"},
    {"frames: {bob/x/y: [0, 0]}",
     "2:10 bad-name: 'x/y' is not a valid name of a frame | a name has letters, digits, '_' and '-' and begins with a "
     "letter or '_'"},
    {"frames: {bobb/x: [0, 0]}", "2:10 unknown-name: unknown body 'bobb' | bob"},
    {"freeplay: 1", "2:1 duplicate-key: the key 'freeplay' is given twice"},
};

constexpr Answer of_models[] = {
    {"freeplay: 1\nbodies: {ground: {mass: 1}}\n",
     "2:19 unknown-key: unknown key 'mass' in 'bodies.ground' | ground does not move; it carries frames only"},
    {"3\n", "1:1 wrong-type: a model must be a map, not a scalar"},
    {"freeplay: 1\nbodies: {ground: {frames: {a: [0, 0]}}}\n", "1:1 empty-model: the model has no body that moves"},
};

TEST(Answers, ToBodies) {
  expect_answers("freeplay: 1\nspace: spatial\nbodies: {a: {mass: 1, inertia: @}}\n", of_inertias);
  expect_answers(test::replaced(sound, "bob: {mass: 1, inertia: 1", "bob: {mass: 1, inertia: 1, @"), of_bodies);
  expect_answers(test::replaced(sound, "parameters:", "@\nparameters:"), of_names);
  expect_answers("@", of_models);
}

constexpr Answer of_forces[] = {
    {"{type: gravity, on: [rod], value: [0, 1]}\n  v: {type: gravity, on: [rod], value: [0, 1]}",
     "13:27 duplicate-name: body 'rod' has its gravity from 'w' already"},
    {"{type: gravity, on: 3, value: [0, 1]}", "12:26 wrong-type: 'forces.w.on' must be a list, not a scalar"},
    {"{type: force, at: bob}", "12:3 missing-key: missing key 'value' in 'forces.w'"},
    {"{at: bob, value: [0, 1]}", "12:3 missing-key: missing key 'type' in 'forces.w'"},
    {"{type: force, at: bob, value: [0, body.bob.ax*1]}",
     "12:40 algebraic-loop: 'body.bob.ax' is an acceleration: a force that depends on the acceleration it makes is "
     "defined by itself | write it by positions and speeds; what resists an acceleration in proportion is mass: add it "
     "to a body"},
    {"{type: force, at: bob, value: [0, joint.A.fx]}",
     "12:40 algebraic-loop: 'joint.A.fx' follows from the forces: one that depends on it is defined by itself | write "
     "by positions and speeds what it is made of"},
    {"{type: force, at: bob, value: [0, output.x]}",
     "12:40 state-not-allowed: 'output.x' is a result, on which no force can depend | it may hold t, parameters and "
     "channels such as body.NAME.vx, joint.NAME.speed and frame.BODY/FRAME.x"},
    {"{type: force, at: bob, value: [0, energy.kinetic]}",
     "12:40 state-not-allowed: 'energy.kinetic' is a result, on which no force can depend | it may hold t, parameters "
     "and channels such as body.NAME.vx, joint.NAME.speed and frame.BODY/FRAME.x"},
    {"{type: force, at: bob, value: [0, driver.m.value]}",
     "12:40 state-not-allowed: 'driver.m.value' is a result, on which no force can depend | it may hold t, parameters "
     "and channels such as body.NAME.vx, joint.NAME.speed and frame.BODY/FRAME.x"},
    {"{type: force, at: bob, value: [0, driver.m.torque]}",
     "12:40 algebraic-loop: 'driver.m.torque' follows from the forces: one that depends on it is defined by itself | "
     "write by positions and speeds what it is made of"},
    {"{type: force, at: bob, value: [0, force.w.fx]}",
     "12:40 algebraic-loop: 'force.w.fx' follows from the forces: one that depends on it is defined by itself | write "
     "by positions and speeds what it is made of"},
    {"{type: force, at: bob, value: [0, frame.rod/tip.ax]}",
     "12:40 algebraic-loop: 'frame.rod/tip.ax' is an acceleration: a force that depends on the acceleration it makes "
     "is defined by itself | write it by positions and speeds; what resists an acceleration in proportion is mass: add "
     "it to a body"},
    {"{type: force, at: bob, value: [0, frame.tip.xx]}",
     "12:40 unknown-name: unknown channel 'frame.tip.xx' | frame.tip.x"},
    {"{type: force, at: bob, value: [0, frame.top.x]}",
     "12:40 unknown-name: unknown channel 'frame.top.x' | frame.tip.x"},
    {"{type: force, at: bob, value: [0, frame.bob/tip.x]}",
     "12:40 unknown-name: unknown channel 'frame.bob/tip.x' | frame.rod/tip.x"},
    {"{type: force, at: bob, value: [0, body.bob.power]}",
     "12:40 unknown-name: unknown channel 'body.bob.power' | it may hold t, parameters and channels such as "
     "body.NAME.vx, joint.NAME.speed and frame.BODY/FRAME.x"},
    {"{type: torque, on: bob, value: [1]}", "12:37 wrong-type: 'forces.w.value' must be a quantity, not a list"},
    {"{type: spring-damper, between: [ground, ground]}", "12:37 same-body: both frames of 'forces.w' are on 'ground'"},
    {"{type: gear}", "12:13 unknown-type: the type 'gear' is a joint, not a force | write it under 'joints'"},
    {"{type: gear-clearance}",
     "12:3 missing-key: missing key 'between' in 'forces.w'\n12:13 unknown-type: 'gear-clearance' is what a gear with "
     "play is | write 'type: gear' with a block 'clearance'"},
};

TEST(Answers, ToForces) {
  expect_answers(test::replaced(sound, "{type: force, at: bob, value: [1, 0]}", "@"), of_forces);
}

constexpr Answer of_drivers[] = {
    {"{inverse_kinematics: {frame: bob, path: {x: 1, y: t}, joints: [A, B]}, joint: A}",
     "10:7 conflicting-keys: 'joint' and 'inverse_kinematics' exclude each other\n13:20 conflicting-keys: a driver "
     "moves joint 'B'; it has no start value of its own"},
    {"{inverse_kinematics: {frame: bob, path: {x: 1, y: t}, joints: [A, B]}, value: A}",
     "10:77 conflicting-keys: 'inverse_kinematics' and 'value' exclude each other\n13:20 conflicting-keys: a driver "
     "moves joint 'B'; it has no start value of its own"},
    {"{inverse_kinematics: 3}", "10:27 wrong-type: 'drivers.m.inverse_kinematics' must be a map, not a scalar"},
    {"3", "10:6 wrong-type: 'drivers.m' must be a map, not a scalar"},
    {"{joint: B, kind: angle, table: {points: [[0, 1], [1, 2]]}, input: 3}",
     "10:65 conflicting-keys: 'table' and 'input' exclude each other"},
    {"{joint: Z, kind: angle, input: 3}",
     "10:14 unknown-name: unknown joint 'Z'\n10:30 wrong-type: 'drivers.m.input' is for a torque or a force: 'angle' "
     "is prescribed by 'value' or 'table' | not in this release"},
    {"{joint: Z, kind: torque, input: 3 m}",
     "10:14 unknown-name: unknown joint 'Z'\n10:38 dimension-mismatch: expected torque or energy, but this is length | "
     "write a unit such as 'N*m'"},
    {"{joint: Z, kind: velocity, value: 3 m}", "10:14 unknown-name: unknown joint 'Z'"},
    {"{joint: Z, kind: angle, table: {points: [[0, 1], [1, 2 m]]}}",
     "10:14 unknown-name: unknown joint 'Z'\n10:59 dimension-mismatch: expected angle or number, but this is length | "
     "write a number without a unit, or an angle"},
    {"{joint: A, kind: torque, value: joint.Z.speed}",
     "10:38 unknown-name: unknown channel 'joint.Z.speed' | joint.A.speed"},
    {"{joint: A, kind: velocity, value: 3 m}",
     "10:40 dimension-mismatch: expected angular velocity, but this is length | write a unit such as 'rad/s'"},
    {"{inverse_kinematics: {frame: bobb, path: {x: 1, y: t}, joints: [A, B]}}",
     "10:35 unknown-name: unknown body 'bobb' | bob"},
    {"{inverse_kinematics: {frame: bob, path: {x: 1, y: t}, joints: [A, A]}}",
     "10:60 duplicate-driver: joint 'A' is driven by 'm' already"},
    {"{inverse_kinematics: {frame: bob, path: {x: 1, y: t}, joints: [A, B]}}\n  n: {joint: A, kind: angle, value: 0}",
     "11:3 duplicate-driver: joint 'A' is driven by 'm' already\n14:20 conflicting-keys: a driver moves joint 'B'; it "
     "has no start value of its own"},
    {"{inverse_kinematics: {frame: bob, path: {x: 1, y: t}, joints: [A, B], elbow: 0}}",
     "10:83 out-of-range: 'drivers.m.inverse_kinematics.elbow' must be 1 or -1, not 0"},
    {"{inverse_kinematics: {frame: bob, path: {file: p.csv, x: t}, joints: [A, B]}}",
     "10:53 file-not-found: cannot read 'p.csv': there is no such file\n10:60 conflicting-keys: 'file' and 'x' exclude "
     "each other"},
    {"{inverse_kinematics: {frame: bob, path: {file: p.csv, unit: kg}, joints: [A, B]}}",
     "10:66 dimension-mismatch: 'drivers.m.inverse_kinematics.path.unit' must be a unit of length, not of mass"},
    {"{inverse_kinematics: {frame: bob, path: {file: p.csv, angle_unit: m}, joints: [A, B]}}",
     "10:72 dimension-mismatch: 'drivers.m.inverse_kinematics.path.angle_unit' must be a unit of angle or number, not "
     "of length"},
    {"{inverse_kinematics: {frame: bob, path: {file: p.csv, interpolation: z}, joints: [A, B]}}",
     "10:75 wrong-type: 'drivers.m.inverse_kinematics.path.interpolation' must be cubic or linear, not 'z'"},
};

TEST(Answers, ToDrivers) {
  expect_answers(test::replaced(sound, "{joint: A, kind: angle, value: 3*t}", "@"), of_drivers);
}

constexpr Answer of_columns[] = {
    {"3", "14:52 wrong-type: 'simulation.output.columns' must be a map from names to formulas, not a scalar"},
    {"{a b: t}",
     "14:53 bad-name: 'a b' is not a valid name | a name has letters, digits, '_' and '-' and begins with a letter or "
     "'_'"},
    {"{a: output.b, b: output.a}",
     "14:69 algebraic-loop: 'output.a' is defined by itself: output.a -> output.b -> output.a | one of these formulas "
     "must do without the others"},
    {"{a: output.c}", "14:56 unknown-name: unknown channel 'output.c' | output.a"},
    {"{a: body.rod.xx}", "14:56 unknown-name: unknown channel 'body.rod.xx' | body.rod.ax"},
    {"{a: [1]}", "14:56 wrong-type: 'simulation.output.columns.a' must be a formula, not a list"},
    {"{a: output.a}",
     "14:56 algebraic-loop: 'output.a' is defined by itself: output.a -> output.a | one of these formulas must do "
     "without the others"},
};

TEST(Answers, ToResultColumns) {
  expect_answers(test::replaced(sound, "1 ms", "1 ms, output: {columns: @}"), of_columns);
}

constexpr Answer of_analyses[] = {
    {"analysis: {limits: {A: [2, 1]}}",
     "2:24 out-of-range: 'analysis.limits.A' must be [lowest, highest], the lowest below the highest"},
    {"analysis: {limits: {'Z*': [0, 1]}}", "2:21 unknown-name: no joint matches the pattern 'Z*'"},
    {"analysis: {limits: {Z: [0, 1]}}", "2:21 unknown-name: unknown joint 'Z'"},
    {"analysis: {limits: {A: [0]}}", "2:24 wrong-length: 'analysis.limits.A' must have 2 items, not 1"},
    {"analysis: {limits: {'*': [0 m, 1]}}",
     "2:27 dimension-mismatch: expected angle or number, but this is length | write a number without a unit, or an "
     "angle"},
    {"analysis: {error: {input: 1 kg}}",
     "2:27 dimension-mismatch: 'analysis.error.input' must be of angle, or of length for slides, not of mass"},
    {"analysis: {error: {input: -1 deg}}", "2:27 out-of-range: 'analysis.error.input' must be >= 0"},
    {"analysis: {error: {input: [1]}}", "2:27 wrong-type: 'analysis.error.input' must be a quantity, not a list"},
    {"analysis: {error: {clearance: {Z: 1 mm}}}", "2:32 unknown-name: unknown joint 'Z'"},
    {"analysis: {error: {clearance: {A: 1 rad}}}",
     "2:35 dimension-mismatch: expected length, but this is angle or number | write a unit such as 'm'"},
    {"analysis: {grid: {x: [0], z: [0]}}",
     "2:27 type-space: 'z' is no number of a pose in the plane, which has x, y, angle"},
    {"analysis: {elbow: 0}", "2:19 out-of-range: 'analysis.elbow' must be 1 or -1, not 0"},
    {"analysis: {elbow: [1, -1], joints: [A]}", "2:19 wrong-length: 'analysis.elbow' must have 1 item, not 2"},
    {"analysis: {elbow: [1, 0]}", "2:23 out-of-range: 'analysis.elbow[1]' must be 1 or -1, not 0"},
    {"analysis: {path: {x: 1 kg}}",
     "2:22 dimension-mismatch: expected length, but this is mass | write a unit such as 'm'"},
    {"analysis: {path: 3.csv}", "2:18 file-not-found: cannot read '3.csv': there is no such file"},
    {"analysis: {path: [1]}", "2:18 wrong-type: 'analysis.path' must be the path of a file or a map, not a list"},
    {"analysis: {path: {x: t, unit: mm}}",
     "2:25 unknown-key: unknown key 'unit' in 'analysis.path' | only with 'file'"},
    {"analysis: {path: {x: t, z: t}}", "2:25 unknown-key: unknown key 'z' in 'analysis.path' | only in spatial models"},
    {"analysis: {path: {}}", "2:12 missing-key: 'analysis.path' needs at least one of 'x', 'y' and 'angle'"},
    {"analysis: {time: {linspace: [0, 1, 0]}}", "2:36 out-of-range: 'analysis.time.linspace[2]' must be >= 1, not 0"},
};

constexpr Answer of_ends[] = {
    {"  C: {type: fixed, between: [bob, ground]}\nanalysis: {limits: {C: [1, 2]}}",
     "10:21 wrong-type: 'C' has no coordinate that could have ends"},
    {"  C: {type: gear, of: [A, B], ratio: 2}\nanalysis: {limits: {C: [1, 2]}}",
     "10:21 wrong-type: 'C' has no coordinate that could have ends"},
};

TEST(Answers, ToAnalyses) {
  expect_answers(test::replaced(sound, "parameters:", "@\nparameters:"), of_analyses);
  expect_answers(test::replaced(sound, "drivers:", "@\ndrivers:"), of_ends);
}

}  // namespace
}  // namespace freeplay
