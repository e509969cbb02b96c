// Numbers that no machine has, or that lack a unit: what is doubted of a model that is valid otherwise.
#include "answers.h"

namespace freeplay {
namespace {

const std::string slider_crank =
    "freeplay: 1\n"
    "gravity: [0, -9.81]\n"
    "bodies:\n"
    "  crank: {mass: 1, inertia: 0.01, com: [0.05, 0], frames: {tip: [0.1, 0]}}\n"
    "  slider: {mass: 1, inertia: 0.01}\n"
    "joints:\n"
    "  A: {type: revolute, between: [ground, crank]}\n"
    "  B: {type: prismatic, between: [ground, slider]}\n"
    "  C: {type: distance, between: [crank/tip, slider], length: 0.3}\n";
const std::string short_run = "simulation: {end: 1, step: 1 ms}\n";

constexpr Answer of_motions[] = {
    {"drivers: {m: {joint: A, kind: angle, value: 90*t}}", ""},
    {"drivers: {m: {joint: A, kind: angle, value: 90 deg*t/(1 s)}}", ""},
    {"drivers: {m: {joint: A, kind: angle, value: 45*sin(t)}}",
     "10:45 doubtful-angle: 'drivers.m.value' swings or turns by 45 rad: write '45 deg' if degrees are meant, else '45 "
     "rad'"},
    {"drivers: {m: {joint: A, kind: angle, value: 45}}",
     "10:45 doubtful-angle: 'drivers.m.value' is 45 rad, 7.16 turns: write '45 deg' if degrees are meant, else '45 "
     "rad'"},
    {"drivers: {m: {joint: A, kind: angle, value: 45 + 0.1*t}}",
     "10:45 doubtful-angle: 'drivers.m.value' is 45 rad, 7.16 turns: write '45 deg' if degrees are meant, else '45 "
     "rad'"},
    {"drivers: {m: {joint: A, kind: velocity, value: 3000}}",
     "10:48 doubtful-time: 'drivers.m.value' turns the joint by 3 rad in one step of 0.001 s: shorten 'step', or give "
     "'accuracy' in its place\n10:48 doubtful-speed: 'drivers.m.value' comes to 3000 rad/s, that is 28648 rpm, with "
     "which the joint at 'crank/tip' would go round at 300 m/s (pins of fast engines do at 40): write '3000 rpm' if "
     "that is meant, else the unit rad/s"},
    {"drivers: {m: {joint: A, kind: velocity, value: 3000 rpm}}", ""},
    {"drivers: {m: {joint: A, kind: velocity, value: 3000*2*pi/60}}", ""},
    {"drivers: {m: {joint: A, kind: velocity, value: 1e6 rad/s}}",
     "10:48 doubtful-speed: 'drivers.m.value' comes to 1e+06 rad/s, faster than any machine: check its numbers, its "
     "times and their units"},
    {"drivers: {m: {joint: B, kind: position, value: 100*sin(t)}}",
     "10:48 doubtful-speed: 'drivers.m.value' is 100 m/s, that is 360 km/h: write '100 mm/s' if millimetres per second "
     "are meant, else '100 m/s'"},
    {"drivers: {m: {joint: B, kind: position, value: 100 mm*sin(t)}}", ""},
    {"drivers: {m: {joint: B, kind: velocity, value: 200}}",
     "10:48 doubtful-speed: 'drivers.m.value' is 200 m/s, that is 720 km/h: write '200 mm/s' if millimetres per second "
     "are meant, else '200 m/s'"},
    {"drivers: {m: {joint: B, kind: velocity, value: 2000 m/s}}",
     "10:48 doubtful-speed: 'drivers.m.value' comes to 2e+03 m/s, faster than any machine: check its numbers, its "
     "times and their units"},
    {"drivers: {m: {joint: B, kind: velocity, value: 200 mm/s}}", ""},
    {"drivers: {m: {joint: A, kind: angle, table: {points: [[0, 0], [0.5, 90], [1, 0]], interpolation: linear}}}",
     "10:45 doubtful-angle: 'drivers.m.table' goes from 0 to 90 rad: write 'unit: deg' if degrees are meant, else "
     "'unit: rad'"},
    {"drivers: {m: {joint: A, kind: angle, table: {points: [[0, 0], [0.5, 90 deg], [1, 0]]}}}", ""},
    {"drivers: {m: {joint: A, kind: angle, table: {points: [[0, 0], [0.5, 90], [1, 0]], unit: deg}}}", ""},
    {"drivers: {m: {joint: A, kind: angle, table: {points: [[0, 30], [0.5, 31], [1, 30]], interpolation: linear}}}",
     "10:45 doubtful-angle: 'drivers.m.table' goes from 30 to 31 rad: write 'unit: deg' if degrees are meant, else "
     "'unit: rad'"},
    {"drivers: {m: {joint: A, kind: velocity, table: {points: [[0, 0], [1, 3000]], interpolation: linear}}}",
     "10:48 doubtful-speed: 'drivers.m.table' comes to 3000 rad/s, that is 28648 rpm, with which the joint at "
     "'crank/tip' would go round at 300 m/s (pins of fast engines do at 40): write 'unit: rpm' if that is meant, else "
     "the unit rad/s"},
    {"drivers: {m: {joint: A, kind: velocity, table: {points: [[0, 0], [1, 3000]], interpolation: linear, unit: rpm}}}",
     ""},
    {"drivers: {m: {joint: B, kind: position, table: {points: [[0, 0], [0.5, 50], [1, 0]], interpolation: linear}}}",
     "10:48 doubtful-length: 'drivers.m.table' moves by 50 m where the lengths of the mechanism are about 0.05 m: "
     "write 'unit: mm' if millimetres are meant, else 'unit: m'"},
    {"drivers: {m: {joint: B, kind: velocity, table: {points: [[0, 0], [1, 500]], interpolation: linear}}}",
     "10:48 doubtful-speed: 'drivers.m.table' comes to 500 m/s: write its unit, as in 'unit: mm/s'"},
    {"drivers: {m: {joint: A, kind: angle, table: {points: [[0, 0], [0.4, 0], [0.41, 1], [0.42, 1], [1, 1]]}}}",
     "10:45 doubtful-value: the cubic through the points of 'drivers.m.table' comes to -9.322 at t = 0.25 s, but its "
     "points lie between 0 and 1: write 'interpolation: linear', or give more points"},
    {"drivers: {m: {joint: A, kind: torque, value: 1e9}}",
     "10:46 doubtful-value: 'drivers.m.value' comes to 1e+09 N m on 2 kg in a mechanism of 0.05 m, more than any "
     "machine has: check its numbers and their units"},
    {"drivers: {m: {joint: A, kind: torque, value: 1e9 N*m}}",
     "10:46 doubtful-value: 'drivers.m.value' comes to 1e+09 N m on 2 kg in a mechanism of 0.05 m, more than any "
     "machine has: check its numbers and their units"},
    {"drivers: {m: {joint: B, kind: force, value: 1e12}}",
     "10:45 doubtful-value: 'drivers.m.value' comes to 1e+12 N on 2 kg in a mechanism of 0.05 m, more than any machine "
     "has: check its numbers and their units"},
    {"drivers: {m: {joint: A, kind: torque, table: {points: [[0, 0], [1, 1e12]], interpolation: linear}}}",
     "10:46 doubtful-value: 'drivers.m.table' comes to 1e+12 N m on 2 kg in a mechanism of 0.05 m, more than any "
     "machine has: check its numbers and their units"},
    {"forces: {w: {type: force, at: slider, value: [1e12, 0]}}",
     "10:46 doubtful-value: 'forces.w.value' comes to 1e+12 N on 2 kg in a mechanism of 0.05 m, more than any machine "
     "has: check its numbers and their units"},
    {"forces: {w: {type: torque, on: crank, value: 1e12}}",
     "10:46 doubtful-value: 'forces.w.value' comes to 1e+12 N m on 2 kg in a mechanism of 0.05 m, more than any "
     "machine has: check its numbers and their units"},
    {"drivers: {m: {joint: A, kind: angle, value: 'if(t < 5, 0, 1)'}}",
     "10:45 doubtful-time: 'drivers.m.value' depends on t, but the run ends at 1 s, before it begins to change, at 5 "
     "s: write the unit after its times, as in 'ms', or check the end of the run"},
    {"forces: {w: {type: force, at: slider, value: ['if(t < 5, 0, 1)', 0]}}",
     "10:46 doubtful-time: 'forces.w.value' depends on t, but the run ends at 1 s, before it begins to change, at 5 s, "
     "so that it is zero all the time: write the unit after its times, as in 'ms', or check the end of the run"},
    {"forces: {w: {type: force, at: slider, value: ['if(t < 5 s, 0, 1)', 0]}}",
     "10:46 doubtful-time: 'forces.w.value' depends on t, but the run ends at 1 s, before it begins to change, at 5 s, "
     "so that it is zero all the time: check its times and the end of the run"},
    {"forces: {w: {type: force, at: slider, value: ['if(t < 5, 2, 1)', 0]}}",
     "10:46 doubtful-time: 'forces.w.value' depends on t, but the run ends at 1 s, before it begins to change, at 5 s: "
     "write the unit after its times, as in 'ms', or check the end of the run"},
    {"drivers: {m: {joint: A, kind: torque, table: {points: [[0, 0], [500, 0], [600, 1]], interpolation: linear}}}",
     "10:46 doubtful-time: 'drivers.m.table' goes on to 600 s, but the run takes 1 s: write 'time_unit: ms' if "
     "milliseconds are meant\n10:46 doubtful-time: 'drivers.m.table' depends on t, but the run ends at 1 s, long "
     "before it begins to change, at 500 s, so that it is zero all the time: check the unit of its times, or the end "
     "of the run"},
    {"drivers: {m: {joint: A, kind: torque, table: {points: [[0, 2], [500, 2], [600, 1]], interpolation: linear}}}",
     "10:46 doubtful-time: 'drivers.m.table' goes on to 600 s, but the run takes 1 s: write 'time_unit: ms' if "
     "milliseconds are meant"},
    {"drivers: {m: {joint: A, kind: angle, table: {points: [[5, 0], [6, 1]], interpolation: linear}}}",
     "10:45 doubtful-time: 'drivers.m.table' depends on t, but the run ends at 1 s, before it begins to change, at 5 "
     "s: check the unit of its times, or the end of the run"},
    {"drivers: {m: {joint: A, kind: torque, table: {points: [[2, 0], [6.1, 0], [6.2, 1], [6.3, 0], [7.9, 0]], "
     "interpolation: linear, outside: repeat}}}",
     ""},
    {"drivers: {m: {joint: A, kind: torque, table: {points: [[-5, 0], [2.1, 0], [2.2, 1], [3, 0]], "
     "interpolation: linear, outside: repeat}}}",
     "10:46 doubtful-time: 'drivers.m.table' depends on t, but the run ends at 1 s, before it begins to change, at 2.1 "
     "s, so that it is zero all the time: check the unit of its times, or the end of the run"},
    {"drivers: {m: {joint: A, kind: velocity, value: 2*pi*1000}}",
     "10:48 doubtful-time: 'drivers.m.value' turns the joint by 6.28 rad in one step of 0.001 s: shorten 'step', or "
     "give 'accuracy' in its place\n10:48 doubtful-speed: 'drivers.m.value' comes to 6283.19 rad/s, that is 60000 rpm, "
     "with which the joint at 'crank/tip' would go round at 628 m/s (pins of fast engines do at 40): write '6283.19 "
     "rpm' if that is meant, else the unit rad/s"},
    {"drivers: {m: {joint: A, kind: angle, value: sin(100*t)}}", ""},
    {"drivers: {m: {joint: A, kind: angle, value: pi*t}}", ""},
    {"parameters: {w: 3000, v: 3000 rpm}\ndrivers: {m: {joint: A, kind: velocity, value: $w + 0*$v}}",
     "11:48 doubtful-time: 'drivers.m.value' turns the joint by 3 rad in one step of 0.001 s: shorten 'step', or give "
     "'accuracy' in its place"},
};

TEST(Doubts, OfMotionsAndLoads) { expect_answers(slider_crank + "@\n" + short_run, of_motions); }

constexpr Answer of_starts[] = {
    {"{joints: {A: 30}}",
     "10:23 doubtful-angle: 'initial.joints.A' is 30 rad, 4.77 turns: write '30 deg' if degrees are meant, else '30 "
     "rad'"},
    {"{joints: {A: 30 deg}}", ""},
    {"{joints: {A: 30 rad}}", ""},
    {"{joints: {A: 10*pi}}", ""},
    {"{joints: {A: 0.5}, speeds: {A: 3000}}",
     "10:41 doubtful-speed: 'initial.speeds.A' is 3000 rad/s, that is 28648 rpm: write '3000 rpm' if revolutions per "
     "minute are meant, else '3000 rad/s'"},
    {"{joints: {A: 0.5}, speeds: {A: 3000 rpm}}", ""},
    {"{joints: {A: 0.5}, speeds: {A: 100*pi}}", ""},
    {"{speeds: {B: 200}}",
     "10:23 doubtful-speed: 'initial.speeds.B' is 200 m/s, that is 720 km/h: write '200 mm/s' if millimetres per "
     "second are meant, else '200 m/s'"},
    {"{speeds: {B: 200 mm/s}}", ""},
    {"{speeds: {B: 200 m/s}}", ""},
    {"{joints: {B: 300}}",
     "10:23 doubtful-length: 'initial.joints.B' is 300 m where the lengths of the mechanism are about 0.05 m: write "
     "the unit after the number, as in '300 mm'"},
    {"{joints: {B: 300 mm}}", ""},
};

constexpr Answer of_gravities[] = {
    {"gravity: [0, -9810]",
     "2:10 doubtful-value: 'gravity' is 9810 m/s^2, 1000 times that of the earth: write the unit after the number, as "
     "in '9810 mm/s^2'"},
    {"gravity: [0, '-9810 mm/s^2']", ""},
    {"gravity: [0, '-9810 m/s^2']", ""},
    {"gravity: [0, 9.81]",
     "2:10 doubtful-value: 'gravity' pulls towards +y, which is up in drawings: write -9.81 in place of 9.81 if things "
     "are to fall down"},
    {"gravity: [0, 9.8]",
     "2:10 doubtful-value: 'gravity' pulls towards +y, which is up in drawings: write -9.8 in place of 9.8 if things "
     "are to fall down"},
    {"gravity: [9.81, 0]", ""},
    {"gravity: [-9810, -9810]",
     "2:10 doubtful-value: 'gravity' is 1.387e+04 m/s^2, 1414 times that of the earth: write the unit after the "
     "number, as in '1.387e+04 mm/s^2'"},
    {"gravity: [0]", "2:10 wrong-length: 'gravity' must have 2 items, not 1"},
    {"gravity: 3", "2:10 wrong-type: 'gravity' must be a list of 2, not a scalar"},
    {"parameters: {g: 9810}\ngravity: [0, -$g]",
     "3:10 doubtful-value: 'gravity' is 9810 m/s^2, 1000 times that of the earth: write the unit after the number, as "
     "in '9810 mm/s^2'"},
    {"gravity: [0, 9.81 m/s^2]",
     "2:10 doubtful-value: 'gravity' pulls towards +y, which is up in drawings: write -9.81 in place of 9.81 if things "
     "are to fall down"},
};

constexpr Answer of_times[] = {
    {"{end: 1, step: 1}",
     "10:28 doubtful-time: 'simulation.step' is 1 s in a run of 1 s: write '1 ms' if milliseconds are meant, else '1 "
     "s'"},
    {"{end: 1, step: 0.1}",
     "10:28 doubtful-time: 'simulation.step' is 0.1 s in a run of 1 s: write '0.1 ms' if milliseconds are meant, else "
     "'0.1 s'"},
    {"{end: 1, step: 1 s}", ""},
    {"{end: 1000, step: 1 s}", ""},
    {"{end: 1e6, step: 1 ms}",
     "10:19 doubtful-time: 'simulation.end' is 1e+06 s, which takes 1e+09 steps of 0.001 s: write '1e+06 ms' if "
     "milliseconds are meant, else '1e+06 s'"},
    {"{end: 1, step: 1 ms, output: {interval: 5}}",
     "10:53 doubtful-time: 'simulation.output.interval' is 5 s in a run of 1 s: rows show its start and its end alone"},
    {"{end: 1, step: 1 ms, output: {interval: 1}}",
     "10:53 doubtful-time: 'simulation.output.interval' is 1 s in a run of 1 s: write '1 ms' if milliseconds are "
     "meant, else '1 s'"},
    {"{end: 1, step: 1 ms, output: {interval: 1e-9}}",
     "10:19 doubtful-time: 'simulation.end' is 1 s, which takes 1e+09 steps of 1e-09 s: write '1 ms' if milliseconds "
     "are meant, else '1 s'\n10:53 doubtful-time: 'simulation.output.interval' is 1e-09 s in a run of 1 s: 1e+09 rows "
     "would be written"},
    {"{end: 1, step: 1e-12}",
     "10:19 doubtful-time: 'simulation.end' is 1 s, which takes 1e+12 steps of 1e-12 s: write '1 ms' if milliseconds "
     "are meant, else '1 s'"},
    {"{end: 1, step: {size: 1, adaptive: true}}",
     "10:35 doubtful-time: 'simulation.step' is 1 s in a run of 1 s: write '1 ms' if milliseconds are meant, else '1 "
     "s'"},
    {"{end: 1, step: {adaptive: true}}", ""},
};

TEST(Doubts, OfStartsGravityAndTimes) {
  expect_answers(slider_crank + "initial: @\n" + short_run, of_starts);
  expect_answers(test::replaced(slider_crank, "gravity: [0, -9.81]", "@") + short_run, of_gravities);
  expect_answers(slider_crank + "simulation: @\n", of_times);
}

constexpr Answer of_cranks[] = {
    {"{mass: 1000, inertia: 0.01, com: [0.05, 0], frames: {tip: [0.1, 0]}}",
     "4:17 doubtful-mass: the mass of 'crank' is 1000 kg at a radius of gyration of 0.003162 m: its density would be "
     "1.6e+08 kg/m^3, that of osmium is 22590: check mass and inertia and write their units, as in '1000 g'"},
    {"{mass: 1, inertia: 1000, com: [0.05, 0], frames: {tip: [0.1, 0]}}",
     "4:29 doubtful-inertia: the inertia of 'crank' is 1000 kg*m^2 for a mass of 1 kg: its radius of gyration would be "
     "31.62 m, but its frames reach 0.05 m: check the number and write its unit, as in 'kg*mm^2'"},
    {"{mass: 1, inertia: 1000 kg*m^2, com: [0.05, 0], frames: {tip: [0.1, 0]}}",
     "4:29 doubtful-inertia: the inertia of 'crank' is 1000 kg*m^2 for a mass of 1 kg: its radius of gyration would be "
     "31.62 m, but its frames reach 0.05 m: check the number and write its unit, as in 'kg*mm^2'"},
    {"{mass: 1, inertia: 1e-12, com: [0.05, 0], frames: {tip: [0.1, 0]}}",
     "4:17 doubtful-mass: the mass of 'crank' is 1 kg at a radius of gyration of 1e-06 m: its density would be 1.6e+12 "
     "kg/m^3, that of osmium is 22590: check mass and inertia and write their units, as in '1 g'"},
    {"{mass: 1e-9, inertia: 1e-12, com: [0.05, 0], frames: {tip: [0.1, 0]}}", ""},
    {"{mass: 1, inertia: 0.01, com: [50, 0], frames: {tip: [0.1, 0]}}",
     "4:17 doubtful-mass: the mass of 'crank' is 1 kg, but its frames reach 50 m: it would be as thin as a rope; check "
     "its mass and its lengths, and write their units"},
    {"{mass: 1, inertia: 0.01, com: [50 mm, 0], frames: {tip: [0.1, 0]}}", ""},
    {"{mass: 1, inertia: 0.01, com: [0.05, 0], frames: {tip: [100, 0]}}",
     "4:29 doubtful-inertia: the inertia of 'crank' is 0.01 kg*m^2 for a mass of 1 kg: its radius of gyration would be "
     "0.1 m, but its frame 'crank/tip' is 99.95 m away: check the number and the lengths of the body"},
    {"{mass: 1, inertia: 0.01, com: [0.05, 0], frames: {tip: {polar: [100, 0.3]}}}",
     "4:29 doubtful-inertia: the inertia of 'crank' is 0.01 kg*m^2 for a mass of 1 kg: its radius of gyration would be "
     "0.1 m, but its frame 'crank/tip' is 99.95 m away: check the number and the lengths of the body"},
    {"{mass: 1, inertia: 0.01, com: [0.05, 0], frames: {tip: {polar: [100 m, 30]}}}",
     "4:29 doubtful-inertia: the inertia of 'crank' is 0.01 kg*m^2 for a mass of 1 kg: its radius of gyration would be "
     "0.1 m, but its frame 'crank/tip' is 99.99 m away: check the number and the lengths of the body\n4:81 "
     "doubtful-angle: 'bodies.crank.frames.tip.polar[1]' is 30 rad, 4.77 turns: write '30 deg' if degrees are meant, "
     "else '30 rad'"},
    {"{mass: 1, inertia: 0.01, com: [0.05, 0], frames: {tip: {position: [0.1, 0], angle: 90}}}",
     "4:93 doubtful-angle: 'bodies.crank.frames.tip.angle' is 90 rad, 14.3 turns: write '90 deg' if degrees are meant, "
     "else '90 rad'"},
    {"{mass: 1e6, inertia: 0.01, com: [0.05, 0], frames: {tip: [0.1, 0]}}",
     "4:17 doubtful-mass: the mass of 'crank' is 1e+06 kg at a radius of gyration of 0.0001 m: its density would be "
     "1.6e+14 kg/m^3, that of osmium is 22590: check mass and inertia and write their units, as in '1e+06 g'"},
    {"{mass: 1000 kg, inertia: 10, com: [0.05, 0], frames: {tip: [0.1, 0]}}", ""},
    {"{mass: 1e-7, inertia: 1e-9, com: [0.05, 0], frames: {tip: [0.1, 0]}}", ""},
    {"{mass: 1e-7 kg, inertia: 1e-9, com: [0.05, 0], frames: {tip: [0.1 m, 0]}}", ""},
    {"{mass: 1, inertia: 0.01, com: [0.05, 0], frames: {tip: [0.1, 0]}, velocity: {angular: 3000}}",
     "4:96 doubtful-speed: 'bodies.crank.velocity.angular' is 3000 rad/s, that is 28648 rpm: write '3000 rpm' if "
     "revolutions per minute are meant, else '3000 rad/s'"},
    {"{mass: 1, inertia: 0.01, com: [0.05, 0], frames: {tip: [0.1, 0]}, pose: {angle: 90}}",
     "4:90 doubtful-angle: 'bodies.crank.pose.angle' is 90 rad, 14.3 turns: write '90 deg' if degrees are meant, else "
     "'90 rad'"},
};

TEST(Doubts, OfBodies) {
  expect_answers(
      test::replaced(slider_crank, "{mass: 1, inertia: 0.01, com: [0.05, 0], frames: {tip: [0.1, 0]}}", "@") +
          short_run,
      of_cranks);
}

constexpr Answer of_places_in_a_row[] = {
    {"0.2*$i", ""},
    {"0.2*$i + 0.01*$i^4",
     "6:24 doubtful-length: 'ground/swing40.A' is 2.561e+04 m from the origin of its body, but the lengths around it "
     "are about 0.05 m: write the unit after the numbers, as in '2.561e+04 mm'"},
};

TEST(Doubts, NotOfRowsOfFramesThatGoFar) {
  expect_answers(
      "freeplay: 1\n"
      "gravity: [0, -9.81]\n"
      "templates:\n"
      "  swing:\n"
      "    bodies: {rod: {mass: 1, inertia: 0.01, com: [0.05, 0]}}\n"
      "    frames: {ground/A: [@, 0]}\n"
      "    joints: {A: {type: revolute, between: [ground/A, rod]}}\n"
      "instances: {swing: {template: swing, count: 40}}\n" +
          short_run,
      of_places_in_a_row);
}

}  // namespace
}  // namespace freeplay
