"""Accuracy in place of a step, the second look of --verify, and `freeplay compare`."""
import csv
import json
import math
import os
import re
import unittest

from program import PROGRAM, ProgramTest, mechanism


class Accuracy(ProgramTest):
    def run_json(self, *arguments, code=0):
        out, _ = self.freeplay("run", *arguments, "--json", code=code)
        return json.loads(out)

    def test_an_event_at_the_very_start_of_a_step_does_not_stop_the_run(self):
        # Balls that just touch begin a contact where the next step starts, closer than the time can tell.
        for accuracy in ("2e-8", "1e-8", "1e-9"):
            self.run_json(mechanism("validation/cradle-5"), "--accuracy", accuracy, "--out", accuracy)

    def test_an_event_just_after_the_end_does_not_stop_the_run(self):
        # The motion so far has the impact before the end, the step up to the end has it a microsecond later.
        for end in ("16 ms", "16.003 ms", "16.005 ms", "16.006 ms"):
            self.run_json(mechanism("slider-crank"), "--accuracy", "1um", "--out", end, "--set", "simulation.end=" + end, "--set",
                          "speed=480.2871635683082 rad/s", "--set", "joints.wrist.clearance.bearing_radius=0.01038812181255904 m")

    def test_a_slow_motion_with_play_goes_on(self):
        # Steps are as long as they may be: where one ends moves with its length.
        with open(mechanism("slider-crank"), encoding="utf-8") as file:
            self.write("s.yaml", re.sub("simulation: .*", "simulation: {end: 20 s, output: {interval: 10 ms}}",
                                        file.read()))
        for speed, accuracy in (("3 rpm", "10um"), ("6 rpm", "1um"), ("10 rpm", "10um")):
            with self.subTest(speed):
                out = self.run_json("s.yaml", "--set", "speed=" + speed, "--accuracy", accuracy, "--out", speed)
                self.assertEqual(("completed", "good"), (out["status"], out["trust"]["verdict"]))

    def test_kinks_of_friction_do_not_decide_the_motion(self):
        # Steps over a kink erred by up to 300 times what they showed, and the last 2 ms magnify errors a hundredfold:
        # these runs ended up to 40 nm apart.
        places = []
        for accuracy in ("1.2nm", "1nm", "0.95nm", "0.9nm"):
            self.freeplay("run", mechanism("4-rrr"), "--set", "c=0.08 mm", "--set", "mu=0.05", "--end", "0.02 s", "--accuracy",
                          accuracy, "--quiet", "--out", accuracy)
            with open(self.path(accuracy, "results.csv"), encoding="utf-8", newline="") as file:
                places.append(float(list(csv.DictReader(file))[-1]["body.leg1.coupler.x"]))
        self.assertLess(max(places) - min(places), 8e-9)

    def test_accuracy_chooses_integrator_and_steps(self):
        settings = self.run_json(mechanism("pendulum"), "--accuracy", "1um", "--end", "0.1 s", "--out", "r")["settings"]
        self.assertEqual("dopri5", settings["integrator"]["type"])
        self.assertEqual((True, 1e-6, 5.0),
                         tuple(settings["step"][key] for key in ("adaptive", "accuracy", "per_contact")))
        settings = self.run_json(mechanism("pendulum"), "--accuracy", "1um", "--integrator", "bathe", "--end", "0.1 s",
                                 "--out", "r")["settings"]
        self.assertEqual("bathe", settings["integrator"]["type"])

    def test_accuracy_in_the_file_keeps_the_integrator_that_the_file_names(self):
        with open(mechanism("pendulum"), encoding="utf-8") as file:
            text = file.read().replace("{end: 2 s, step: 1 ms}", "{end: 0.1 s, accuracy: 1 um, integrator: hht}")
        with open(self.path("a.yaml"), "w", encoding="utf-8") as file:
            file.write(text)
        self.assertEqual("hht", self.run_json("a.yaml")["settings"]["integrator"]["type"])
        self.assertEqual("dopri5", self.run_json("a.yaml", "--accuracy", "1um")["settings"]["integrator"]["type"])
        fixed = self.run_json("a.yaml", "--step", "1ms")["settings"]
        self.assertEqual({"size": 1e-3, "adaptive": False}, fixed["step"])

    def test_rows_between_steps_follow_a_stiff_damper(self):
        # m x'' = -c x' - k (x - 1) creeps with the rate k/c = 1/s, while c/m = 1e6/s makes iterations inside a step grow.
        self.write("stiff.yaml", """\
freeplay: 1
bodies: {m: {mass: 1 kg, inertia: 1 kg*m^2}}
joints: {slide: {type: prismatic, between: [ground, m]}}
forces: {hold: {type: spring-damper, between: [ground, m], stiffness: 1e6, damping: 1e6, free_length: 1 m}}
initial: {joints: {slide: 1.1 m}}
simulation: {end: 2 s, accuracy: 1 um}
""")
        for integrator in ("bathe", "newmark", "generalized-alpha"):
            self.freeplay("run", "stiff.yaml", "--integrator", integrator, "--out", integrator)
            rows = [line.split(",")[:2] for line in self.read(integrator, "results.csv").splitlines()[1:]]
            for t, x in rows:
                self.assertAlmostEqual(1 + 0.1 * math.exp(-float(t)), float(x), delta=4e-6)

    def test_step_and_accuracy_exclude_each_other(self):
        self.freeplay("run", mechanism("pendulum"), "--step", "1ms", "--accuracy", "1um", code=2)
        self.freeplay("run", mechanism("pendulum"), "--accuracy", "1 s", code=2)

    def test_accuracy_below_rounding_is_refused_with_the_reason(self):
        _, err = self.freeplay("run", mechanism("pendulum"), "--accuracy", "1e-17 m", "--out", "r", code=3)
        self.assertIn("rounded", err)

    def test_rows_stand_at_the_interval_and_impacts_are_counted(self):
        summary = self.run_json(mechanism("slider-crank"), "--accuracy", "1um", "--end", "2 ms", "--out", "r")
        with open(self.path("r/results.csv"), encoding="utf-8") as file:
            times = [line.split(",")[0] for line in file.read().splitlines()[1:]]
        self.assertEqual(101, len(times))
        for k, time in enumerate(times):
            self.assertAlmostEqual(k * 2e-5, float(time), delta=1e-15)
        self.assertGreater(summary["counts"]["contacts_total"], 5)
        with open(self.path("r/events.csv"), encoding="utf-8") as file:
            steps = [int(row["steps"]) for row in csv.DictReader(file) if row["kind"] == "contact_end"]
        self.assertGreaterEqual(min(steps), 20)

    def test_under_resolved_impacts_are_counted_with_the_step_that_would_do(self):
        with open(mechanism("slider-crank"), encoding="utf-8") as file:
            self.write("all.yaml", file.read().replace("discard: 12 ms", "discard: 0 ms"))
        out, _ = self.freeplay("run", "all.yaml", "--step", "10us", "--end", "4 ms", "--out", "r")
        self.assertRegex(out, r"steps per impact: \d+ or more; \d+ of \d+ impacts took fewer than 20: --step")
        with open(self.path("r/summary.json"), encoding="utf-8") as file:
            advice = json.load(file)["advice"]
        self.assertGreater(advice["under_resolved"], 0)
        self.assertLess(advice["step"], 1e-5)

    def test_verify_prints_errors_and_until_when_runs_agree(self):
        out, _ = self.freeplay("run", mechanism("slider-crank"), "--accuracy", "1e-9", "--end", "10 ms", "--verify",
                               "--out", "r")
        self.assertIn("verified by bathe (implicit), accuracy 5e-10 m, steps of 2e-05 s at most", out)
        self.assertIn("body.slider.x", out)
        with open(self.path("r/summary.json"), encoding="utf-8") as file:
            summary = json.load(file)
        self.assertGreaterEqual(summary["agree_until"], 8e-3)
        self.assertLess(summary["verify"]["body.slider.x"], 1e-6)
        self.assertIn(summary["verification"]["agreement"], ("agree", "part"))

    def test_verify_of_fixed_steps_takes_another_kind_with_error_control(self):
        out, _ = self.freeplay("run", mechanism("pendulum"), "--end", "1 s", "--verify", "--out", "r")
        self.assertRegex(out, r"verified by dopri5 \(explicit\), accuracy 5e-08 m, steps of 0.001 s at most, \d+ steps: "
                              "positions agree")
        self.assertNotIn("go their own ways", out)

    def test_verify_calls_a_chaotic_motion_chaotic(self):
        out, _ = self.freeplay("run", mechanism("slider-crank"), "--accuracy", "1um", "--verify", "--out", "r")
        self.assertIn("after that runs go their own ways", out)

    PULSE = """freeplay: 1
bodies: {m: {mass: 1, inertia: 1}}
joints: {guide: {type: prismatic, between: [ground, m]}}
forces: {hit: {type: force, at: m, value: ["1000*smooth(t, 0.5, 0.501)*(1-smooth(t, 0.501, 0.502))", 0]}}
simulation: {end: 2 s, %s}
"""

    def test_a_short_pulse_is_in_the_last_row_and_verified(self):
        self.write("pulse.yaml", self.PULSE % "accuracy: 1 um")
        summary = self.run_json("pulse.yaml", "--verify", "--out", "r")
        with open(self.path("r/results.csv"), encoding="utf-8") as file:
            lines = file.read().splitlines()
        x = float(lines[-1].split(",")[lines[0].split(",").index("body.m.x")])
        self.assertAlmostEqual(1.499, x, delta=5e-6)
        self.assertEqual("agree", summary["verification"]["agreement"])

    def test_verify_disagrees_with_steps_that_go_over_a_pulse(self):
        self.write("pulse.yaml", self.PULSE % "step: 5 ms, output: {interval: 5 ms}")
        out, err = self.freeplay("run", "pulse.yaml", "--verify", "--out", "r", code=7)
        self.assertIn("THE RUNS DISAGREE", out)
        self.assertIn("force 'hit': it has corners at 0.5 s and 0.501 s", err)
        with open(self.path("r/summary.json"), encoding="utf-8") as file:
            summary = json.load(file)
        self.assertEqual(("disagree", 7), (summary["verification"]["agreement"], summary["exit_code"]))
        self.assertEqual("bad", summary["trust"]["verdict"])


class Compare(ProgramTest):
    def setUp(self):
        super().setUp()
        for name, step in (("a", "0.2ms"), ("b", "0.1ms"), ("c", "0.2ms")):
            self.freeplay("run", mechanism("pendulum"), "--end", "0.2 s", "--step", step, "--out", name)

    def test_equal_results_agree_and_others_differ(self):
        out, _ = self.freeplay("compare", "a", "c", "--tolerance", "0", "--absolute", "0")
        self.assertEqual("channel,max_abs,max_rel,rms,at_time,ok", out.splitlines()[0])
        out, _ = self.freeplay("compare", "a", "b", code=7)
        self.assertTrue(out.splitlines()[1].endswith(",0"))
        self.freeplay("compare", "a", "b", "--tolerance", "1e-2", "--absolute", "1e-3")

    def test_a_directory_or_its_table_may_be_named(self):
        self.freeplay("compare", os.path.join("a", "results.csv"), "c")

    def test_json_is_a_list_also_when_results_differ(self):
        out, _ = self.freeplay("compare", "a", "b", "--json", "--channels", "body.*", "--tolerance", "1e-13", code=7)
        rows = json.loads(out)
        self.assertEqual(6 + 2, len(rows))
        self.assertEqual({"channel", "max_abs", "max_rel", "rms", "at_time", "ok"}, set(rows[0]))

    def test_distance_of_bodies_is_one_number(self):
        folder = {name: csv.DictReader(self.read(name, "results.csv").splitlines()) for name in "ab"}
        apart = [(math.hypot(*(float(a["body.rod." + k]) - float(b["body.rod." + k]) for k in "xy")), float(a["time"]))
                 for a, b in zip(folder["a"], folder["b"], strict=True)]
        rms = math.sqrt(sum(d * d for d, _ in apart) / len(apart))
        out, _ = self.freeplay("compare", "a", "b", "--json", code=7)
        *_, body, total = json.loads(out)
        self.assertEqual(["body.rod.distance", "distances"], [body["channel"], total["channel"]])
        for row in (body, total):
            self.assertAlmostEqual(rms, row["rms"], delta=1e-12 * rms)
            self.assertAlmostEqual(max(apart)[0], row["max_abs"], delta=1e-12 * rms)
            self.assertEqual(max(apart)[1], row["at_time"])
            self.assertEqual(all(one["ok"] for one in json.loads(out) if one["channel"] in ("body.rod.x", "body.rod.y")), row["ok"])
        out, _ = self.freeplay("compare", "a", "b", code=7)
        number = r"(\S+)"
        pattern = "# distance of bodies and frames, 1 in all: %s m rms\n# farthest: body.rod, %s m at t = %s s\n$" % ((number,) * 3)
        self.assertRegex(out, pattern)
        self.assertEqual([body[name] for name in ("rms", "max_abs", "at_time")],
                         [float(text) for text in re.search(pattern, out).groups()])
        out, _ = self.freeplay("compare", "a", "b", "--channels", "body.rod.x")
        self.assertNotIn("distance", out)

    def test_memory_does_not_grow_with_the_rows(self):
        def peak(rows):
            with open(self.path("long.csv"), "w", encoding="utf-8") as file:
                file.write("time,body.a.x,body.a.y,b,c,d,e,f,g,h\n")
                file.writelines("%d,0,0,0,0,0,0,0,0,0\n" % row for row in range(rows))
            pid = os.posix_spawn(PROGRAM, [PROGRAM, "compare", self.path("long.csv"), self.path("long.csv"), "--quiet"],
                                 os.environ, file_actions=[(os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0)])
            _, status, usage = os.wait4(pid, 0)
            self.assertEqual(0, status)
            return usage.ru_maxrss * 1024
        # Kept whole, each of the two would be 200 000 rows of 10 numbers of 8 bytes.
        self.assertLess(peak(220000) - peak(20000), 4e6)

    def test_requested_channels_are_all_shown_and_others_counted(self):
        names = self.read("a", "results.csv").split("\n")[0].split(",")[1:]
        self.assertGreater(len(names), 10)
        everything, err = self.freeplay("compare", "a", "c", "--channels", "*")
        table = [line for line in everything.splitlines()[1:] if line[0] != "#"]
        self.assertEqual((sorted(names + ["body.rod.distance"]), ""), (sorted(line.split(",")[0] for line in table), err))
        counted = "# %d channels in %d rows: 0 differ" % (len(names), self.read("a", "results.csv").count("\n") - 1)
        self.assertIn(counted, everything)
        self.assertEqual(everything, self.freeplay("compare", "a", "c", "--verbose")[0])
        some, err = self.freeplay("compare", "a", "c")
        left = "# %d more channels, which agree; all with --verbose, some with --channels" % (len(names) - 10)
        self.assertEqual((everything.splitlines()[:11] + [left, counted], ""), (some.splitlines()[:13], err))
        self.assertIn("of which 3 differ;", self.freeplay("compare", "a", "b", "--tolerance", "0", "--absolute", "0",
                                                          code=7)[0])

    def test_a_missing_channel_is_a_row_without_numbers(self):
        lines = self.read("a", "results.csv").splitlines()
        self.write("less.csv", "".join(line.rsplit(",", 1)[0] + "\n" for line in lines))
        name = lines[0].rsplit(",", 1)[1]
        out, err = self.freeplay("compare", "a", "less.csv", code=7)
        self.assertEqual(name + ",,,,,0", out.splitlines()[1])
        # Once, wherever both streams go.
        self.assertEqual((1, ""), (out.count("# channel '%s' is missing in less.csv\n" % name), err))
        out, err = self.freeplay("compare", "less.csv", "a", "--json", code=7)
        self.assertEqual("freeplay: note: channel '%s' is missing in less.csv\n" % name, err)
        row = json.loads(out)[0]
        self.assertEqual((name, None, False), (row["channel"], row["max_abs"], row["ok"]))

    def test_window_and_mistakes(self):
        self.freeplay("compare", "a", "b", "--until", "0 s")
        out, err = self.freeplay("compare", "a", "b", "--from", "5 s", "--channels", "body.*.x", code=7)
        self.assertEqual("body.rod.x,,,,,0", out.splitlines()[1])
        self.assertIn("no rows at common times", out)
        self.freeplay("compare", "a", "b", "--from", "5 ms", "--until", "1 ms", code=2)
        self.freeplay("compare", "a", code=2)
        self.freeplay("compare", "a", "b", "--channels", "joint.nothing.*", code=2)
        self.freeplay("compare", "a", "b", "--tolerance", "-1", code=2)
        self.freeplay("compare", "a", "nothing", code=6)
        with open(self.path("broken.csv"), "w", encoding="utf-8") as file:
            file.write("time,body.rod.x\n0,1\n1,two\n")
        _, err = self.freeplay("compare", "a", "broken.csv", code=6)
        self.assertIn("'two' is not a number", err)

    def test_a_refused_accuracy_leaves_an_earlier_result_alone(self):
        self.freeplay("run", mechanism("pendulum"), "--end", "0.1 s", "--out", "r")
        before = self.read("r", "results.csv")
        self.freeplay("run", mechanism("pendulum"), "--accuracy", "1e-17 m", "--out", "r", code=3)
        self.freeplay("run", mechanism("pendulum"), "--accuracy", "1e-17 m", "--dry-run", code=3)
        self.assertEqual(before, self.read("r", "results.csv"))

    def test_the_reference_integrator_agrees_or_says_how_to_get_it(self):
        names = {entry["name"] for entry in json.loads(self.freeplay("list", "--json")[0])}
        ask = ["run", mechanism("slider-crank"), "--end", "8 ms", "--accuracy", "1nm", "--integrator", "arkode", "--out", "a"]
        if "arkode" not in names:
            _, err = self.freeplay(*ask, code=2)
            self.assertIn("libsundials-dev", err)
            _, err = self.freeplay("describe", "arkode", code=2)
            self.assertIn("libsundials-dev", err)
            return
        self.freeplay(*ask)
        self.freeplay("run", mechanism("slider-crank"), "--end", "8 ms", "--accuracy", "1nm", "--out", "b")
        # Impacts make an error ten times as large each.
        self.freeplay("compare", "a", "b", "--channels", "body.*.x", "--absolute", "1e-7")
        events = []
        for folder in "ab":
            lines = [line.split(",") for line in self.read(folder, "events.csv").splitlines()[1:]]
            events.append([(line[1], line[2], float(line[0])) for line in lines])
        self.assertGreater(len(events[0]), 20)
        self.assertEqual(*[[event[:2] for event in one] for one in events])
        for ours, theirs in zip(*events):
            self.assertAlmostEqual(ours[2], theirs[2], delta=1e-8)


if __name__ == "__main__":
    unittest.main()
