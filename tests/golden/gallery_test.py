"""The mechanisms of docs/gallery.md: their files, their figures, and what each is known for."""
import csv
import glob
import math
import os
import re
import shlex
import unittest

import curve_reference
from program import MECHANISMS, ROOT, ProgramTest, drawing

FOLDER = os.path.join(MECHANISMS, "gallery")
NAMES = sorted(os.path.basename(path)[:-5] for path in glob.glob(os.path.join(FOLDER, "*.yaml")))
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def text_of(*path):
    with open(os.path.join(ROOT, *path), encoding="utf-8") as file:
        return file.read()


class Gallery(ProgramTest):
    def run_file(self, name):
        """Columns of a run that says nothing but that it went well."""
        out, err = self.freeplay("run", os.path.join(FOLDER, name + ".yaml"), "--out", name)
        self.assert_good(out, err)
        rows = list(csv.reader(self.read(name, "results.csv").splitlines()))
        return {column: [float(x) if x else math.nan for x in values] for column, *values in zip(*rows)}

    def assert_good(self, out, err):
        self.assertIn("trust: good", out)
        self.assertNotIn("far, correct it", out)
        self.assertEqual("", err)

    def assert_all(self, columns, difference, tolerance):
        for row in range(len(columns["time"])):
            self.assertAlmostEqual(0, difference(lambda name: columns[name][row]), delta=tolerance)

    def test_page_and_folder_show_the_same_short_files(self):
        page = text_of("docs", "gallery.md")
        self.assertEqual(NAMES, sorted(re.findall(r"run mechanisms/gallery/(.*)\.yaml$", page, re.M)))
        for name in NAMES:
            self.assertLess(text_of("mechanisms", "gallery", name + ".yaml").count("\n"), 80)

    def test_commands_run_without_a_doubt_and_draw_the_figures(self):
        os.symlink(MECHANISMS, self.path("mechanisms"))
        for line in re.findall(r"^\./dev (.*)$", text_of("docs", "gallery.md"), re.M):
            words = shlex.split(line)
            out, err = self.freeplay(*words)
            if words[0] == "run":
                self.assert_good(out, err)
                continue
            name = words[words.index("--out") + 1]
            shown, drawn = text_of("docs", "images", "gallery", name), drawing(self.read(name))
            self.assertEqual(NUMBER.sub("#", shown), NUMBER.sub("#", drawn), name)
            for x, y in zip(NUMBER.findall(shown), NUMBER.findall(drawn), strict=True):
                self.assertAlmostEqual(float(x), float(y), delta=0.1, msg=name)

    def test_a_scotch_yoke_makes_a_cosine(self):
        self.assert_all(self.run_file("scotch-yoke"),
                        lambda at: at("body.yoke.x") - 0.04 * math.cos(4 * math.pi * at("time")), 2e-6)

    def test_a_quick_return_takes_its_two_ways_in_times_of_the_swing(self):
        columns = self.run_file("quick-return")
        ends = [t for t, a, b in zip(columns["time"], columns["body.lever.omega"], columns["body.lever.omega"][1:])
                if a * b < 0]
        half = math.asin(60 / 150)
        ratio = (ends[1] - ends[0]) / (ends[2] - ends[1])
        wanted = (math.pi + 2 * half) / (math.pi - 2 * half)
        self.assertAlmostEqual(math.log(wanted), abs(math.log(ratio)), delta=0.03)

    def test_a_shaper_cuts_on_its_way_forward_alone(self):
        columns = self.run_file("shaper")
        for force, speed in zip(columns["force.cutting.fx"], columns["body.ram.vx"]):
            if abs(speed) > 1e-3:
                self.assertEqual(-500 if speed > 0 else 0, force)

    def test_a_toggle_multiplies_the_force_of_its_rod(self):
        columns = self.run_file("toggle-press")
        self.assertGreater(max(columns["force.work.fy"]), 19e3)
        self.assertLess(max(map(abs, columns["driver.motor.torque"])), 130)

    def test_both_wipers_stay_parallel(self):
        self.assert_all(self.run_file("windscreen-wiper"),
                        lambda at: at("body.arm.angle") - at("body.second.angle"), 1e-9)

    def test_a_pantograph_draws_twice_as_large(self):
        columns = self.run_file("pantograph")
        for axis in "xy":
            self.assert_all(columns, lambda at: 2 * at("frame.inner/tracer." + axis) - at("frame.right/pen." + axis), 1e-9)

    def test_the_linkage_of_peaucellier_draws_a_straight_line(self):
        columns = self.run_file("peaucellier")
        self.assert_all(columns, lambda at: at("frame.c/pen.x") - 0.2625, 1e-9)
        self.assertGreater(max(columns["frame.c/pen.y"]), 0.09)

    def test_a_scissor_lift_needs_the_force_of_virtual_work(self):
        columns = self.run_file("scissor-lift")
        for row in (0, -1):  # at rest: dV = F dx with V = g (2 M + 60 kg) l sin(a), x = l cos(a)
            x = columns["joint.cylinder.position"][row]
            force = -9.81 * (2 * 530 + 60) * x / math.sqrt(1 - x * x)
            self.assertAlmostEqual(force, columns["driver.lift.force"][row], delta=1e-6 * abs(force))

    def test_an_oldham_coupling_turns_evenly_while_its_disc_whirls(self):
        columns = self.run_file("oldham-coupling")
        self.assert_all(columns, lambda at: at("body.first.angle") - at("body.second.angle"), 1e-9)
        self.assert_all(columns, lambda at: math.hypot(at("body.disc.x") - 0.0025, at("body.disc.y")) - 0.0025, 1e-9)

    def test_the_first_piston_of_a_radial_engine_is_that_of_a_slider_crank(self):
        self.assert_all(self.run_file("radial-engine"), lambda at: at("joint.one.position") - (
            0.045 * math.sin(at("joint.main.angle"))
            + math.sqrt(0.16 ** 2 - (0.045 * math.cos(at("joint.main.angle"))) ** 2)), 1e-9)

    def test_a_foot_of_hoekens_goes_straight_on_over_half_a_turn(self):
        columns = self.run_file("walking-leg")
        low = [(y, vx) for angle, y, vx in zip(columns["joint.main.angle"], columns["frame.rod/foot.y"],
                                               columns["frame.rod/foot.vx"]) if math.cos(angle) < 0]
        self.assertLess(max(y for y, _ in low) - min(y for y, _ in low), 0.01 * 0.16)
        self.assertGreater(len(low), 100)

    def test_two_cardan_joints_cancel_each_other(self):
        columns = self.run_file("double-cardan")
        self.assert_all(columns, lambda at: at("body.last.wx") - at("body.first.wx"), 1e-4)
        speed, bend = 20 * math.pi, math.radians(25)
        along = [math.cos(bend) * wx + math.sin(bend) * wy
                 for wx, wy in zip(columns["body.middle.wx"], columns["body.middle.wy"])]
        self.assertAlmostEqual(math.cos(bend), min(along) / speed, delta=1e-4)
        self.assertAlmostEqual(1 / math.cos(bend), max(along) / speed, delta=1e-4)

    def test_a_suspension_rests_where_it_starts_and_comes_to_rest_again(self):
        columns = self.run_file("wishbone-suspension")
        before = [y for t, y in zip(columns["time"], columns["body.body.y"]) if t < 0.5]
        self.assertLess(max(map(abs, before)), 1e-3)
        self.assertGreater(max(columns["body.body.y"]), 0.02)
        self.assertLess(abs(columns["body.body.y"][-1]), 2e-3)
        self.assertAlmostEqual(380 + 10, columns["force.tyre.fy"][-1] / 9.81, delta=5)

    def test_a_luffing_crane_keeps_its_load_level(self):
        columns = self.run_file("luffing-crane")
        self.assertGreater(columns["frame.jib/hook.x"][0] - columns["frame.jib/hook.x"][-1], 11)
        self.assertLess(max(columns["frame.jib/hook.y"]) - min(columns["frame.jib/hook.y"]), 0.12)

    def test_watts_linkage_guides_the_rod_straight(self):
        columns = self.run_file("beam-engine")
        self.assert_all(columns, lambda at: at("frame.coupler/rod.x") - 1.2, 1e-3)
        self.assertGreater(max(columns["frame.coupler/rod.y"]) - min(columns["frame.coupler/rod.y"]), 0.6)

    def test_a_valve_is_lifted_and_never_left(self):
        columns = self.run_file("valve-train")
        self.assertAlmostEqual(0.039, max(columns["body.valve.y"]), delta=1e-5)
        self.assertGreater(min(columns["joint.roller.normal_force"]), 0)
        # While the valve is shut the spring swings on as a chain of eight masses between fixed ends does.
        slowest = 2 * math.sqrt(30e3 * 9 / (0.06 / 8)) * math.sin(math.pi / 18)
        force, times = columns["force.head.fy"], columns["time"]
        peaks = [times[k] for k in range(420, 620) if force[k - 1] < force[k] >= force[k + 1]]
        self.assertAlmostEqual(2 * math.pi / slowest, (peaks[-1] - peaks[0]) / (len(peaks) - 1), delta=3e-5)

    def test_a_finger_stays_on_its_cam_as_deep_as_both_curves_say(self):
        columns = self.run_file("finger-follower")

        def ramp(x, begin, end):
            u, w = (x - begin) / (end - begin), end - begin
            if not 0 < u < 1:
                return (0.0 if u <= 0 else 1.0), 0.0, 0.0
            return u ** 3 * (10 - 15 * u + 6 * u * u), 30 * (u * (1 - u)) ** 2 / w, 60 * u * (1 - u) * (1 - 2 * u) / w ** 2

        def cam(x):
            up, down = (ramp(math.degrees(x) % 360, *ends) for ends in ((100, 180), (180, 260)))
            value, slope, bend = (0.008 * (a - b) for a, b in zip(up, down))
            return 0.02 + value, math.degrees(slope), bend * math.degrees(1) ** 2
        pad, angles = curve_reference.ellipse(0.012, 0.008), None
        for row, turn in enumerate(columns["joint.shaft.angle"]):
            finger = columns["joint.hub.angle"][row]
            x, y = -0.05 + 0.05 * math.cos(finger), 0.028 + 0.05 * math.sin(finger)
            c, s = math.cos(turn), math.sin(turn)
            gap, *_, angles = curve_reference.touch(cam, pad, (c * x + s * y, c * y - s * x), finger - turn, angles)
            self.assertAlmostEqual(-gap, columns["force.pad.delta"][row], delta=1e-12)
            if row > 0:  # it starts just touching
                self.assertGreater(columns["force.pad.fn"][row], 10)
        self.assertAlmostEqual(0.16, max(columns["joint.hub.angle"]), delta=0.005)

    def test_a_geneva_wheel_turns_by_a_quarter_and_rests(self):
        columns = self.run_file("geneva")
        for t, angle in zip(columns["time"], columns["joint.wheel.angle"]):
            if t % 1 < 0.1 or t % 1 > 0.45:
                self.assertAlmostEqual(-math.pi / 2 * math.floor(t + 0.6), angle, delta=2e-3)

    def test_a_ratchet_goes_on_by_whole_teeth_and_never_back_by_more_than_its_play(self):
        columns = self.run_file("ratchet")
        time, angle = columns["time"], columns["joint.wheel.angle"]
        tooth, stroke = math.radians(30), math.radians(36)
        rests = []
        for turn in (0, 1):
            rows = [row for row, t in enumerate(time) if turn < t <= turn + 1]
            rests.append(angle[rows[-1]])
            far = max(rows, key=angle.__getitem__)  # where the lever turns round
            self.assertAlmostEqual(turn + 0.5, time[far], delta=0.01)
            self.assertTrue(0 < angle[far] - rests[turn] < stroke - tooth)
            self.assertGreater(min(angle[row] for row in rows if row >= far), rests[turn] - 2e-4)
            late = [angle[row] for row in rows if time[row] > turn + 0.8]
            self.assertLess(max(late) - min(late), 1e-4)
        self.assertAlmostEqual(tooth, rests[1] - rests[0], delta=1e-4)
        # At rest both pawls together hold the load: the moment of their forces about the shaft, in the mean over its trembling.
        root, way = 0.05 - 0.0025 * math.asin(0.85), math.radians(30)
        pin = (0.04 * math.cos(way), root + 0.04 * math.sin(way))

        def moment(pawl, frame, row):
            slant = frame + columns["joint.%s_pin.angle" % pawl][row]
            x = math.cos(frame) * pin[0] - math.sin(frame) * pin[1] - 0.04 * math.cos(slant)
            y = math.sin(frame) * pin[0] + math.cos(frame) * pin[1] - 0.04 * math.sin(slant)
            return y * columns["joint.%s.fx" % pawl][row] - x * columns["joint.%s.fy" % pawl][row]
        rest = [row for row, t in enumerate(time) if t > 1.8]
        held = sum(moment("hold", 0, row) + moment("push", columns["joint.lever.angle"][row], row) for row in rest) / len(rest)
        self.assertAlmostEqual(2, held, delta=5e-3)

    def test_a_strand_goes_slack_in_the_jerk_of_a_start(self):
        columns = self.run_file("belt-drive")
        tensions = columns["force.belt.left_tension"], columns["force.belt.right_tension"]
        self.assertEqual(0, min(map(min, tensions)))
        self.assertLess(abs(columns["joint.motor.speed"][-1] / columns["joint.fan.speed"][-1] - 3), 1e-2)

    def test_cables_of_a_robot_pull_alone_and_carry_it_in_the_end(self):
        columns = self.run_file("cable-robot")
        names = [corner + "_" + side for corner in ("upper", "lower") for side in ("left", "right")]
        slack = {name: columns["driver.%s.cable.force" % name].count(0) for name in names}
        self.assertEqual([True, False, False, True], [slack[name] > 20 for name in names])
        self.assertEqual(0, max(max(columns["driver.%s.cable.force" % name]) for name in names))
        # At rest the pulls balance the weight of the platform and of its hooks.
        pull = [0, 0]
        for name in names:
            post = (1.2 if "right" in name else -1.2, 0.8 if "upper" in name else -0.8)
            way = [columns["body.%s.hook.%s" % (name, axis)][-1] - p for axis, p in zip("xy", post)]
            for k in (0, 1):
                pull[k] += columns["driver.%s.cable.force" % name][-1] * way[k] / math.hypot(*way)
        self.assertAlmostEqual(0, pull[0], delta=1e-3)
        self.assertAlmostEqual(9.81 * (12 + 4 * 0.05), pull[1], delta=1e-3)

    def test_the_pin_of_a_planet_bears_what_both_of_its_meshes_press_across(self):
        columns = self.run_file("gear-train")
        self.assert_all(columns, lambda at: at("body.sun.omega") - 3.6 * at("body.arm.omega"), 1e-9)
        # Without the way round, on which the planet is held by 0.5 kg 36 mm omega^2.
        across = lambda at, name: (at("joint." + name + ".fy") * math.cos(at("body.arm.angle"))
                                   - at("joint." + name + ".fx") * math.sin(at("body.arm.angle")))
        self.assert_all(columns, lambda at: across(at, "inner") - at("joint.inner.torque") / -0.016, 1e-6)
        self.assert_all(columns, lambda at: across(at, "pin") + across(at, "inner") + across(at, "outer"), 2)

    def test_a_trapezoid_turns_the_inner_wheel_further_and_teeth_push_the_rack_away(self):
        columns = self.run_file("steering")
        for left, right in zip(columns["body.wheel_left.angle"], columns["body.wheel_right.angle"]):
            if abs(left + right) > 0.2:  # as Ackermann wants it for a base of 2.5 m to 2.9 m
                base = 1.4 / abs(1 / math.tan(left) - 1 / math.tan(right))
                self.assertGreater((left + right) * (abs(left) - abs(right)), 0)
                self.assertTrue(2.5 < base < 2.9, base)
        self.assertLess(max(columns["joint.teeth.fy"]), 0)
        self.assert_all(columns, lambda at: at("joint.teeth.fy") + abs(at("joint.teeth.fx")) * math.tan(math.radians(20)), 1e-9)

    def test_the_counterweight_of_a_pump_jack_saves_torque(self):
        largest = max(map(abs, self.run_file("pump-jack")["driver.motor.torque"]))
        self.freeplay("run", os.path.join(FOLDER, "pump-jack.yaml"), "--out", "light", "--set", "counterweight=1kg", "--quiet")
        rows = list(csv.reader(self.read("light", "results.csv").splitlines()))
        column = rows[0].index("driver.motor.torque")
        self.assertGreater(max(abs(float(row[column])) for row in rows[1:]) / largest, 2)


if __name__ == "__main__":
    unittest.main()
