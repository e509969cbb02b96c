"""The files of mechanisms/spatial move as closed forms and equations of their own freedoms say, with play and without."""
import csv
import glob
import json
import math
import os
import unittest

from benchmark_mechanisms import bricard, governor
from model_cases import ModelTest
from program import ROOT

FOLDER = os.path.join(ROOT, "mechanisms", "spatial")


def path_of(name):
    return os.path.join(FOLDER, name + ".yaml")


class Mechanism(ModelTest):
    def run_file(self, name, *options):
        self.freeplay("run", path_of(name), "--out", "out", "--quiet", "--force", *options)
        rows = list(csv.reader(self.read("out", "results.csv").splitlines()))
        return {column: [float(x) for x in values] for column, *values in zip(*rows)}

    def assert_facts(self, name, *options, **expected):
        facts = json.loads(self.freeplay("validate", path_of(name), "--json", *options)[0])["facts"]
        self.assertEqual(expected, {key: facts[key] for key in expected})
        return facts

    def assert_balance(self, columns, tolerance):
        """What is put in is stored or lost, to a part of the largest kinetic energy."""
        self.assertLess(max(map(abs, columns["energy.residual"])), tolerance * max(columns["energy.kinetic"]))

    def assert_energy_kept(self, columns, tolerance):
        total = [k + p for k, p in zip(columns["energy.kinetic"], columns["energy.potential"])]
        self.assertLess(max(total) - min(total), tolerance * max(columns["energy.kinetic"]))

    def gap(self, columns, ideal, body):
        """Largest distance of a body's centre of mass from where it is without play [m]."""
        places = lambda of: zip(*(of["body.%s.%s" % (body, axis)] for axis in "xyz"))
        return max(math.dist(p, q) for p, q in zip(places(columns), places(ideal), strict=True))


class Folder(Mechanism):
    def test_every_file_says_what_it_is_and_runs(self):
        names = sorted(os.path.basename(name)[:-5] for name in glob.glob(os.path.join(FOLDER, "*.yaml")))
        self.assertLess(8, len(names))
        for name in names:
            with open(path_of(name), encoding="utf-8") as file:
                self.assertRegex(file.read(), r"\A# .*\n(# .*\n)*freeplay: 1\n", name)
            self.freeplay("run", path_of(name), "--out", name, "--quiet", "--end", "1 ms")


class FreeBodies(Mechanism):
    def test_the_top_stays_at_its_height(self):
        columns = self.run_file("heavy-top")
        self.assert_column(columns, "body.top.z", lambda t: 0.04 * math.cos(math.radians(30)), 1e-9)

    def test_the_tee_keeps_its_energy(self):
        columns = self.run_file("spinning-tee")
        self.assert_column(columns, "energy.kinetic", lambda t: 0.5 * (1e-4 + 50 + 3e-4), 1e-8)
        self.assertLess(min(columns["body.tee.qw"]), -0.5)


class SliderCrank(Mechanism):
    def slide(self, t):
        y, z = 0.1 - 0.08 * math.sin(30 * t), 0.12 + 0.08 * math.cos(30 * t)
        return math.sqrt(0.3 ** 2 - y * y - z * z)

    def test_the_slider_goes_where_the_rod_lets_it(self):
        self.assert_column(self.run_file("slider-crank", "--ideal", "all"), "body.slider.x", self.slide, 1e-9)

    def test_the_slider_with_play_stays_within_it(self):
        columns = self.run_file("slider-crank")
        self.assertGreater(max(columns["joint.socket.contact"]), 0.5)
        depth = max(columns["joint.socket.delta"])
        gaps = [abs(x - self.slide(t)) for t, x in zip(columns["time"], columns["body.slider.x"])]
        # The play along the rod shows along the guide, larger by the slope of the rod.
        self.assertLess(max(gaps), (1e-4 + depth) * 0.3 / min(columns["body.slider.x"]) * 1.001)
        self.assertGreater(max(gaps), 0.5e-4)
        self.assert_balance(columns, 1e-6)


class Bricard(Mechanism):
    def test_it_has_one_row_too_many_and_one_freedom(self):
        self.assert_facts("bricard", bodies=5, joints=6, constraints=30, rank=29, redundant=1, dof=1)

    def test_it_moves_along_its_curve(self):
        columns = self.run_file("bricard", "--end", "3 s")
        for end in (1, 3):
            row = columns["time"].index(end)
            place = [columns["frame.rod3/end." + axis][row] for axis in "xyz"]
            self.assertLess(math.dist(place, bricard(end, 500 * end)[3]), 1e-8)

    def test_it_keeps_its_energy_for_ten_seconds(self):
        columns = self.run_file("bricard")
        self.assertGreater(max(columns["energy.kinetic"]), 4.0)
        self.assert_energy_kept(columns, 1e-7)


class Governor(Mechanism):
    def test_it_moves_by_its_own_equations(self):
        columns = self.run_file("flyball-governor", "--end", "1 s")
        height, speed = governor(1.0, 40000)
        self.assertLess(abs(columns["body.slider.z"][-1] - height), 5e-7)
        self.assertLess(abs(columns["body.shaft.wz"][-1] - speed), 5e-6)

    def test_finer_steps_come_as_close_as_their_order_says(self):
        height, errors = governor(1.0, 40000)[0], []
        for step in ("2 ms", "1 ms", "0.5 ms"):
            columns = self.run_file("flyball-governor", "--end", "1 s", "--step", step)
            errors.append(abs(columns["body.slider.z"][-1] - height))
        for coarse, fine in zip(errors, errors[1:]):
            self.assertTrue(1.8 < math.log2(coarse / fine) < 2.3, errors)

    def test_it_loses_only_what_the_dampers_take_and_stays_symmetric(self):
        columns = self.run_file("flyball-governor", "--end", "2 s")
        self.assert_balance(columns, 1e-6)
        self.assertGreater(columns["energy.dissipated"][-1], 0.001)
        for name, sign in (("x", -1), ("y", -1), ("z", 1)):
            for one, other in zip(columns["body.arm1." + name], columns["body.arm2." + name], strict=True):
                self.assertLess(abs(one - sign * other), 1e-9)


class Bennett(Mechanism):
    ALPHA, BETA = math.radians(40), math.radians(100)

    def assert_closed(self, columns):
        ratio = math.sin((self.BETA + self.ALPHA) / 2) / math.sin((self.BETA - self.ALPHA) / 2)
        for a, b, c, d in zip(*(columns["joint.%s.angle" % joint] for joint in "ABCD")):
            across = math.sin(a / 2) * math.sin(b / 2) - ratio * math.cos(a / 2) * math.cos(b / 2)
            self.assertLess(abs(across), 1e-11)
            self.assertLess(abs(math.sin((a + c) / 2)), 1e-11)
            self.assertLess(abs(math.sin((b + d) / 2)), 1e-11)

    def test_it_moves_against_a_count_of_minus_two(self):
        facts = self.assert_facts("bennett", bodies=3, joints=4, rank=17, redundant=3, dof=1)
        self.assertEqual(-2, facts["velocities"] - facts["constraints"])

    def test_its_angles_follow_bennetts_ratio(self):
        columns = self.run_file("bennett")
        self.assertGreater(max(columns["joint.A.angle"]) - min(columns["joint.A.angle"]), 1.0)
        self.assert_closed(columns)
        self.assert_energy_kept(columns, 1e-6)

    def test_other_twists_move_alike(self):
        self.ALPHA, self.BETA = math.radians(25), math.radians(70)
        self.assert_closed(self.run_file("bennett", "--set", "alpha=25 deg", "--set", "beta=70 deg"))

    def test_lengths_that_are_not_as_the_sines_do_not_move(self):
        with open(path_of("bennett"), encoding="utf-8") as file:
            text = file.read()
        text = text.replace("b: $a*sin($beta)/sin($alpha)", "b: 1.3*$a*sin($beta)/sin($alpha)")
        self.write("bent.yaml", text)
        out, _ = self.freeplay("validate", "bent.yaml", "--json", code=3)
        self.assertEqual("assembly-failed", json.loads(out)["messages"][0]["id"])


class Stewart(Mechanism):
    def pose(self, t):
        """Centre of mass and turn about z that the lengths of the legs were made for."""
        w = 2 * math.pi * t / 0.5
        x = 0.04 * (1 - math.cos(w)) / 2
        return x, 0.0, 0.5 + x / 2, math.radians(8) * math.sin(w)

    def test_the_ideal_platform_goes_where_the_lengths_put_it(self):
        self.assert_facts("stewart", "--ideal", "all", bodies=13, rank=72, redundant=0, dof=6, dof_driven=0)
        columns = self.run_file("stewart", "--ideal", "all")
        for name, part in (("x", 0), ("y", 1), ("z", 2)):
            self.assert_column(columns, "body.platform." + name, lambda t, part=part: self.pose(t)[part], 1e-12)
        self.assert_column(columns, "body.platform.qz", lambda t: math.sin(self.pose(t)[3] / 2), 1e-12)
        self.assert_column(columns, "body.platform.qx", lambda t: 0.0, 1e-12)

    def test_each_leg_is_as_long_as_from_foot_to_ball(self):
        columns = self.run_file("stewart", "--ideal", "all")
        for leg in range(1, 7):
            side = (-1) ** leg
            foot, ball = (math.radians(60 * leg + s * side * 20) for s in (1, -1))

            def length(t):
                x, y, z, turn = self.pose(t)
                return math.dist((x + 0.2 * math.cos(ball + turn), y + 0.2 * math.sin(ball + turn), z),
                                 (0.4 * math.cos(foot), 0.4 * math.sin(foot), 0.0))

            self.assert_column(columns, "joint.leg%d.guide.position" % leg, length, 1e-12)

    def test_play_in_the_balls_is_what_the_platform_strays(self):
        ideal, strays = self.run_file("stewart", "--ideal", "all"), []
        for clearance in ("100 um", "50 um", "25 um"):
            columns = self.run_file("stewart", "--set", "c=" + clearance)
            play = float(clearance.split()[0]) * 1e-6
            for leg in range(1, 7):
                self.assertLess(max(columns["joint.leg%d.socket.delta" % leg]), play)
                self.assertGreater(max(columns["joint.leg%d.socket.contact" % leg]), 0.5)
            self.assert_balance(columns, 1e-5)
            strays.append(self.gap(columns, ideal, "platform"))
            self.assertGreater(strays[-1], play)
        # Elastic penetration does not vanish with the play.
        self.assertLess(strays[1], 0.75 * strays[0])
        self.assertLess(strays[2], 0.75 * strays[1])


class Delta(Mechanism):
    def test_the_platform_goes_round_its_circle_and_does_not_turn(self):
        self.assert_facts("delta", bodies=10, rank=57, redundant=0, dof=3, dof_driven=0)
        columns = self.run_file("delta")
        w = 2 * math.pi / 0.5
        self.assert_column(columns, "body.platform.x", lambda t: 0.08 * math.sin(w * t), 1e-12)
        self.assert_column(columns, "body.platform.y", lambda t: 0.08 * (1 - math.cos(w * t)), 1e-12)
        self.assert_column(columns, "body.platform.z", lambda t: -0.5, 1e-12)
        self.assert_column(columns, "body.platform.qw", lambda t: 1.0, 1e-12)
        # Nothing but the work of the motors chooses the steps here; rows between them are interpolated.
        self.assert_balance(self.run_file("delta", "--accuracy", "1e-9"), 1e-6)

    def test_its_arms_turn_by_the_inverse_kinematics_of_two_circles(self):
        columns = self.run_file("delta")

        def angle(leg, t):
            """Elbow of a leg: where the arm's circle meets the sphere of the rod, in the plane of the arm."""
            at, w = math.radians(120 * (leg - 1)), 2 * math.pi * t / 0.5
            x, y = 0.08 * math.sin(w), 0.08 * (1 - math.cos(w))
            out, side = x * math.cos(at) + y * math.sin(at) + 0.05 - 0.2, y * math.cos(at) - x * math.sin(at)
            rod = math.sqrt(0.55 ** 2 - side ** 2)
            reach = math.hypot(out, 0.5)
            inside = math.acos((0.25 ** 2 + reach ** 2 - rod ** 2) / (2 * 0.25 * reach))
            return math.atan2(0.5, out) - inside

        for leg in (1, 2, 3):
            self.assert_column(columns, "joint.leg%d.shoulder.angle" % leg, lambda t, leg=leg: angle(leg, t), 1e-12)


class FourBar(Mechanism):
    def rocker(self, t):
        """Angle of the rocker from the upright, about y: |C - D| = l for the crank at 20 t."""
        r, l, s, d, e = 0.04, 0.3, 0.15, 0.3, 0.05
        x, y = r * math.cos(20 * t), r * math.sin(20 * t)
        # (d + s sin q - x)^2 + (e - y)^2 + (s cos q)^2 = l^2
        u, v = d - x, e - y
        return math.asin((l * l - u * u - v * v - s * s) / (2 * s * u))

    def test_the_ideal_rocker_follows_the_crank(self):
        self.assert_facts("four-bar", "--ideal", "all", rank=17, redundant=0, dof=1, dof_driven=0)
        columns = self.run_file("four-bar", "--ideal", "all")
        self.assert_column(columns, "joint.D.angle", self.rocker, 1e-11)
        self.assertGreater(max(columns["joint.D.angle"]) - min(columns["joint.D.angle"]), 0.3)

    def test_play_tilts_the_journal_and_is_what_the_rocker_strays(self):
        ideal, strays = self.run_file("four-bar", "--ideal", "all"), []
        for play in (2e-4, 1e-4, 5e-5):
            columns = self.run_file("four-bar", "--set", "c=%r" % play)
            for joint in "BD":
                self.assertGreater(max(columns["joint.%s.contact" % joint]), 0.5)
                self.assertLess(max(columns["joint.%s.delta" % joint]), 0.5 * play)
            # The shoulders hold the journal along its axis, to their own penetration.
            self.assertLess(max(map(abs, columns["joint.D.ey"])), 1.5 * play)
            self.assertGreater(max(map(abs, columns["joint.D.ey"])), 0.5 * play)
            self.assert_balance(columns, 1e-5)
            strays.append(self.gap(columns, ideal, "rocker"))
            self.assertGreater(strays[-1], play)
            # Both plays along the coupler, and the tilt of the journal, which the length of the bearing limits.
            self.assertLess(strays[-1], 8 * play)
        self.assertLess(strays[1], 0.75 * strays[0])
        self.assertLess(strays[2], 0.75 * strays[1])


if __name__ == "__main__":
    unittest.main()
