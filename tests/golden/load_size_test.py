"""Loads, speeds and forces beyond those of all machines are doubtful, whatever makes them."""
import json
import unittest

from program import ProgramTest, mechanism


class LoadSize(ProgramTest):
    def run_file(self, file, *options):
        self.freeplay("run", file, "--out", "r", "--force", "--quiet", *options)
        self.reasons = json.loads(self.read("r", "summary.json"))["trust"]["reasons"]

    def judge(self, text):
        self.run_file(self.write("m.yaml", text))

    def ids(self):
        return [reason["id"] for reason in self.reasons]

    def test_loads_beyond_all_machines_are_doubtful_without_play(self):
        """A ram on a rail, 2 kg and 0.2 m, under a motion, a force or a motor."""
        ram = ("freeplay: 1\nbodies: {ram: {mass: 2, inertia: 0.01, frames: {t: [0.2, 0]}}}\nframes: {ground/w: [-0.3, 0]}\n"
               "joints: {rail: {type: prismatic, between: [ground, ram]}}\n%s\nsimulation: {end: 0.1, accuracy: 1 um}\n")
        moved = "drivers: {d: {joint: rail, kind: position, value: 0.05*sin(20*t)}}\nforces: {f: {%s}}"
        spring = "type: spring-damper, between: [ground/w, ram/t], free_length: 0.6, stiffness: "
        for part, element in (
                (moved % "type: force, at: ram/t, value: [-5e6, 0]", "force 'f'"),
                (moved % "type: torque, on: ram, value: 5e5", "force 'f'"),
                (moved % (spring + "5e8"), "force 'f'"),
                (moved % "type: spring-damper, between: [ground/w, ram/t], stiffness: 0, damping: 5e6", "force 'f'"),
                (moved % "type: joint-friction, between: [ground, ram], friction: 2e6", "force 'f'"),
                ("drivers: {d: {joint: rail, kind: force, value: 3e5*sin(60*t)}}\nforces: {f: {%s}}" % (spring + "1000"), "driver 'd'")):
            with self.subTest(part):
                self.judge(ram % part)
                reason = next(r for r in self.reasons if r["id"] == "load-size")
                self.assertEqual(["doubtful", element], [reason["level"], reason["element"]])
        for part in ("type: force, at: ram/t, value: [-1e5, 0]", spring + "5e4"):
            self.judge(ram % (moved % part))
            self.assertNotIn("load-size", self.ids(), self.reasons)

    def test_a_force_that_no_part_of_that_mass_bears_is_doubtful(self):
        """Of 70 kN m in place of 70 N m on a planetary gear of 7 kg the pin of a planet has 1.9 MN."""
        self.run_file(mechanism("gallery/gear-train"), "--set", "load=70 kN*m", "--end", "50 ms")
        reason, = [r for r in self.reasons if r["id"] == "load-size"]
        self.assertEqual("joint 'pin'", reason["element"])
        self.assertIn("'planet' of 0.5 kg", reason["message"])
        self.assertIn("force 'winch' of 7e+04 N m", reason["message"])

    def test_a_wheel_that_would_burst_is_doubtful(self):
        wheel = ("freeplay: 1\nbodies: {frame: {mass: 500, inertia: 50}, wheel: {mass: 1, inertia: 0.01}}\n"
                 "joints: {bolts: {type: fixed, between: [ground, frame]}, axle: {type: revolute, between: [frame, wheel]}}\n"
                 "forces: {drag: {type: joint-friction, kind: rotational, between: [frame, wheel], friction: 1e-3}}\n"
                 "initial: {speeds: {axle: %s rad/s}}\nsimulation: {end: 0.01, accuracy: 1 um}\n")
        self.judge(wheel % 11000)
        reason, = [r for r in self.reasons if r["id"] == "body-speed"]
        self.assertEqual("body 'wheel'", reason["element"])
        self.assertIn("turns with 1.1e+03 m/s at its radius of gyration", reason["message"])
        self.judge(wheel % 9000)
        self.assertNotIn("body-speed", self.ids())

    def test_a_step_that_makes_energy_names_what_would_store_it(self):
        """A Geneva wheel without its axle is thrown out, and its slot closes round the pin."""
        with open(mechanism("gallery/geneva"), encoding="utf-8") as file:
            lines = file.readlines()
        axle = [line for line in lines if line.startswith("  wheel: {type: revolute")]
        self.assertEqual(1, len(axle))
        self.write("m.yaml", "".join(line for line in lines if line not in axle).replace(", wheel: 0}", "}"))
        _, err = self.freeplay("run", "m.yaml", "--out", "r", "--force", "--quiet", code=4)
        self.assertRegex(err, r"energy would grow by \d+ J .*; force 'quarter\d\.drive' would store \d+ J")


if __name__ == "__main__":
    unittest.main()
