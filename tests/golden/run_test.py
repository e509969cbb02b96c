"""freeplay run: files, numbers, stop conditions, interrupts and refusals."""
import csv
import hashlib
import json
import math
import os
import pty
import resource
import shutil
import signal
import subprocess
import time
import unittest

from program import PROGRAM, ProgramTest, let_work, mechanism

SUMMARY = ["freeplay", "model", "settings", "status", "stop_reason", "exit_code", "time", "counts", "statistics",
           "residuals", "bodies", "joints", "drivers", "forces", "paths", "memory", "energy", "advice", "verify",
           "agree_until", "verification", "trust", "noise", "repeat",
           "hashes", "provenance", "twin", "performance", "files", "warnings"]
FILES = ["checkpoint.bin", "events.csv", "model.yaml", "results.csv", "results.h5", "run.log", "summary.json"]
EVENTS = ("time,joint,kind,speed,tangential_speed,direction,duration,max_fn,max_delta,steps,"
          "approach_speed,impulse,tangential_impulse,energy_lost,impact")

PENDULUM = """freeplay: 1
name: %s
gravity: [0, -9.81]
bodies: {rod: {mass: 1 kg, inertia: 1/12, com: [0.5, 0]}}
joints: {pivot: {type: revolute, between: [ground, rod]}}
initial: {joints: {pivot: 0 deg}}
simulation: {end: %s, step: 1 ms, output: {interval: 10 ms%s}%s}
"""


class Run(ProgramTest):
    def pendulum(self, name="p", end="0.1 s", output="", more=""):
        return self.write("p.yaml", PENDULUM % (name, end, output, more))

    def rows(self, *names):
        return list(csv.reader(self.read(*names).splitlines()))

    def summary(self, *names):
        return json.loads(self.read(*names, "summary.json"))

    def test_files_of_a_run(self):
        self.freeplay("run", self.pendulum())
        self.assertEqual(FILES, sorted(os.listdir(self.path("results", "p"))))
        summary = self.summary("results", "p")
        self.assertEqual(SUMMARY, list(summary))
        self.assertEqual(FILES, summary["files"])
        self.assertEqual(self.read("p.yaml"), self.read("results", "p", "model.yaml"))
        self.assertEqual(hashlib.sha256(self.read("p.yaml").encode()).hexdigest(), summary["model"]["sha256"])
        self.assertEqual(EVENTS + "\n", self.read("results", "p", "events.csv"))
        self.assertEqual(("completed", 0, 0.1), (summary["status"], summary["exit_code"], summary["time"]["reached"]))
        self.assertEqual((11, 100), (summary["counts"]["rows"], summary["counts"]["steps"]))

    def test_rows_stand_at_the_output_instants(self):
        self.freeplay("run", self.pendulum())
        rows = self.rows("results", "p", "results.csv")
        self.assertEqual(["time", "body.rod.x", "body.rod.y", "body.rod.angle"], rows[0][:4])
        self.assertEqual([float(row[0]) for row in rows[1:]], [k * 0.01 for k in range(11)])
        self.assertEqual({len(rows[0])}, {len(row) for row in rows})

    def test_channels_are_picked_by_patterns(self):
        self.freeplay("run", self.pendulum(output=", channels: [energy.*, body.rod.y]"), "--out", "r")
        self.assertEqual(["time", "body.rod.y", "energy.kinetic", "energy.potential", "energy.dissipated",
                          "energy.work", "energy.residual"], self.rows("r", "results.csv")[0])

    def test_a_pattern_without_a_channel(self):
        self.pendulum(output=", channels: [energy.*, body.rood.y]")
        _, err = self.freeplay("run", "p.yaml", code=3)
        self.assertTrue(err.startswith("p.yaml:7:") and "[unknown-name]" in err, err)
        self.assertIn("did you mean 'body.rod.y'?", err)

    def test_a_stop_condition_ends_the_run_well(self):
        self.freeplay("run", self.pendulum(end="2 s", more=", stop: [{channel: body.rod.y, below: -0.1}]"))
        summary = self.summary("results", "p")
        self.assertEqual(("stopped", 0), (summary["status"], summary["exit_code"]))
        self.assertIn("body.rod.y", summary["stop_reason"])
        # Half the angle phi that the rod has fallen: phi'^2 = 3 g sin(phi) / l, so y = -0.1 is reached near 0.19 s.
        self.assertTrue(0.1 < summary["time"]["reached"] < 0.3)

    def test_a_stop_condition_on_an_unknown_channel(self):
        self.pendulum(more=", stop: [{channel: body.rod.yy, below: -0.1}]")
        for command in ("run", "validate"):
            _, err = self.freeplay(command, "p.yaml", code=3)
            self.assertTrue(err.startswith("p.yaml:7:") and "[unknown-name]" in err, err)
            self.assertIn("did you mean 'body.rod.y'?", err)

    def test_default_directory(self):
        self.freeplay("run", self.pendulum(name="..a b/c"), "--quiet")
        self.assertEqual(["__a_b_c"], os.listdir(self.path("results")))
        self.freeplay("run", mechanism("slider-crank"), "--end", "10 us", "--ideal", "all", "--quiet")
        self.assertIn("slider-crank-ideal", os.listdir(self.path("results")))

    def test_an_earlier_result_is_replaced(self):
        self.freeplay("run", self.pendulum(), "--out", "r")
        self.freeplay("run", "p.yaml", "--out", "r", "--end", "50 ms")
        self.assertEqual(0.05, self.summary("r")["time"]["reached"])

    def test_other_content_is_refused(self):
        os.mkdir(self.path("r"))
        self.write("r/precious", "x")
        out, err = self.freeplay("run", self.pendulum(), "--out", "r", code=6)
        self.assertEqual(("", ["precious"]), (out, os.listdir(self.path("r"))))
        self.assertIn("--force", err)
        self.freeplay("run", "p.yaml", "--out", "r", "--force")
        self.assertEqual(sorted(FILES + ["precious"]), sorted(os.listdir(self.path("r"))))

    def test_a_summary_of_something_else_is_other_content(self):
        os.mkdir(self.path("r"))
        self.write("r/summary.json", "{}")
        self.freeplay("run", self.pendulum(), "--out", "r", code=6)

    def test_a_directory_that_cannot_be_made(self):
        for out in ("p.yaml", "p.yaml/r"):
            _, err = self.freeplay("run", self.pendulum(), "--out", out, code=6)
            self.assertIn(out, err)

    def test_quiet_and_json(self):
        self.assertEqual(("", ""), self.freeplay("run", self.pendulum(), "--quiet"))
        out, err = self.freeplay("run", "p.yaml", "--json")
        self.assertEqual(self.summary("results", "p"), json.loads(out))
        self.assertEqual("", err)

    def test_table(self):
        out, _ = self.freeplay("run", mechanism("3-rrr"), "--end", "0.11 s")
        lines = out.splitlines()
        self.assertRegex(lines[0], r"^3-rrr: completed, 0\.11 s in 55000 steps \(\S+, 2e-06 s\), \S+ s wall$")
        heads = [" ".join(line.split()) for line in lines]
        for head in ("joint max |F| contacts in contact max delta", "driver max |torque| rms",
                     "path max error rms max angle rms"):
            self.assertIn(head, heads)
        self.assertRegex(lines[-3], r"^  energy residual \S+ J   position residual \S+ m$")
        self.assertEqual("  results in results/3-rrr", lines[-1])

    def test_keys_of_adaptive_steps_warn_in_fixed_ones(self):
        text = self.read(self.pendulum()).replace("step: 1 ms", "step: {size: 1 ms, tolerance: 1e-9, min: 1 us}")
        self.write("p.yaml", text)
        _, err = self.freeplay("run", "p.yaml")
        for key in ("tolerance", "min"):
            self.assertIn("warning: '%s' has no effect on fixed steps: 'adaptive: true' is missing [unused]" % key, err)
        self.assertEqual("", self.freeplay("run", "p.yaml", "--integrator", "dopri5")[1])
        self.write("p.yaml", text.replace("1e-9", "1e-9, adaptive: true"))
        self.assertEqual("", self.freeplay("run", "p.yaml")[1])

    def test_a_start_other_than_zero_is_said(self):
        self.write("p.yaml", self.read(self.pendulum(end="1.1 s")).replace("{end", "{start: 1 s, end"))
        self.assertIn("completed, 1 s to 1.1 s in 100 steps (", self.freeplay("run", "p.yaml")[0])

    def steps_said(self, *options):
        """What stands between the parentheses of the first line, and the shortest and longest step of summary.json."""
        out, _ = self.freeplay("run", self.pendulum(), *options)
        time = self.summary("results", "p")["time"]
        return out[out.index("(") + 1:out.index(")")], time["smallest_step"], time["largest_step"]

    def test_the_step_that_is_printed_is_the_one_that_was_taken(self):
        self.assertEqual(("bathe, 0.001 s", 1e-3, 1e-3), self.steps_said())
        self.assertEqual(("bathe, 0.01 s: the step of 0.02 s is longer than the output interval", 0.01, 0.01),
                         self.steps_said("--step", "20 ms"))
        self.assertEqual(("bathe, 0.001 to 0.003 s", 1e-3, 3e-3), self.steps_said("--step", "3 ms"))
        # The end of the run is no multiple of the interval.
        self.assertEqual(("bathe, 0.01 s: the step of 0.02 s is longer than the output interval", 5e-3, 0.01),
                         self.steps_said("--step", "20 ms", "--end", "0.085 s"))
        said, smallest, largest = self.steps_said("--integrator", "dopri5", "--step", "1 ms")
        self.assertEqual("dopri5, tolerance 1e-06, steps of %.2g to %.2g s" % (smallest, largest), said)
        self.assertEqual("dopri5, accuracy 1e-06 m", self.steps_said("--accuracy", "1 um")[0])

    def test_entries_of_forces_are_in_table_and_summary(self):
        self.write("f.yaml", """freeplay: 1
bodies:
  pushed: {mass: 1 kg, inertia: 1}
  hung: {mass: 1 kg, inertia: 1}
  rotor: {mass: 1 kg, inertia: 0.5}
joints:
  a: {type: prismatic, between: [ground, pushed]}
  b: {type: prismatic, between: [ground, hung]}
  c: {type: revolute, between: [ground, rotor]}
forces:
  push: {type: force, at: pushed, value: [2 N, 0]}
  spring: {type: spring-damper, between: [ground, hung], stiffness: 100 N/m}
  turn: {type: torque, on: rotor, value: 3 N*m}
initial: {joints: {b: 0.1 m}}
simulation: {end: 1 s, accuracy: 1 nm}
""")
        out, _ = self.freeplay("run", "f.yaml")
        forces = self.summary("results", "f")["forces"]
        self.assertEqual(["push", "spring", "turn"], list(forces))
        # The mass goes F t^2 / 2m = 1 m, the rotor turns M t^2 / 2J = 3 rad; the spring swings with 10 rad/s.
        expected = {"push": ("force", 2.0, 0.0, 2.0), "turn": ("torque", 0.0, 3.0, 9.0),
                    "spring": ("spring-damper", 10.0, 0.0, 0.5 * math.sin(10.0) ** 2)}
        for name, (kind, force, torque, work) in expected.items():
            self.assertEqual(kind, forces[name]["type"])
            for key, value in (("max_force", force), ("max_torque", torque), ("work", work)):
                self.assertAlmostEqual(value, forces[name][key], delta=1e-6, msg=name + " " + key)
        rows = [" ".join(line.split()) for line in out.splitlines()]
        at = rows.index("force max |F| max |torque| work")
        self.assertEqual(["push 2 N - 2 J", "spring 10 N - 0.148 J", "turn - 3 N*m 9 J"], rows[at + 1:at + 4])

    def test_work_of_forces_counts_from_discard_on(self):
        self.write("f.yaml", """freeplay: 1
bodies: {pushed: {mass: 1 kg, inertia: 1}}
joints: {a: {type: prismatic, between: [ground, pushed]}}
forces: {push: {type: force, at: pushed, value: ["2*t", 0]}}
simulation: {end: 1 s, step: 1 ms, output: {discard: 0.5 s}}
""")
        self.freeplay("run", "f.yaml")
        # F = 2 t, v = t^2: the integral of 2 t^3 from 0.5 on.
        self.assertAlmostEqual(0.5 * (1 - 0.5 ** 4), self.summary("results", "f")["forces"]["push"]["work"], delta=1e-6)

    def test_a_gear_says_its_torque_and_what_it_leaves_out(self):
        self.write("g.yaml", """freeplay: 1
bodies: {one: {mass: 1, inertia: 1}, two: {mass: 1, inertia: 1}}
joints:
  a: {type: revolute, between: [ground, one]}
  b: {type: revolute, between: [ground, two]}
  pair: {type: gear, of: [a, b], ratio: -2}
drivers: {motor: {joint: a, kind: torque, value: 125 N*m}}
simulation: {end: 10 ms, step: 1 ms}
""")
        out, _ = self.freeplay("run", "g.yaml")
        # 125 N m turn (1 + 4) kg m^2; the second rotor gets twice that acceleration.
        self.assertAlmostEqual(50.0, self.summary("results", "g")["joints"]["pair"]["max_torque"], delta=1e-9)
        rows = [" ".join(line.split()) for line in out.splitlines()]
        self.assertIn("pair - 50 N*m", rows)
        self.assertIn("the forces of its teeth on the bearings are not modelled", out)
        self.assertIn("gears 1 (the forces of their teeth on the bearings are not modelled)",
                      [" ".join(line.split()) for line in self.freeplay("validate", "g.yaml")[0].splitlines()])
        header = self.rows("results", "g", "results.csv")[0]
        self.assertIn("joint.pair.torque", header)
        self.write("g.yaml", self.read("g.yaml").replace("kind: torque, value: 125 N*m", 'kind: angle, value: "t*t"'))
        out, _ = self.freeplay("analyze", "inverse-dynamics", "g.yaml", "--frame", "one", "--time", "0:1:2")
        found = dict(zip(*(line.split(",") for line in out.splitlines()[:2])))
        self.assertAlmostEqual(-4.0, float(found["joint.pair.torque"]), delta=1e-12)

    def test_a_moment_that_a_joint_holds_is_in_the_table(self):
        self.write("w.yaml", """freeplay: 1
gravity: [0, -9.81]
bodies: {beam: {mass: 2 kg, inertia: 1, com: [0.5, 0]}}
joints: {wall: {type: fixed, between: [ground, beam]}}
simulation: {end: 10 ms, step: 1 ms}
""")
        out, _ = self.freeplay("run", "w.yaml")
        rows = [" ".join(line.split()) for line in out.splitlines()]
        self.assertIn("joint max |F| contacts in contact max delta max |torque|", rows)
        self.assertIn("wall 19.62 N - - - 9.81 N*m", rows)
        self.assertAlmostEqual(9.81, self.summary("results", "w")["joints"]["wall"]["max_torque"], delta=1e-9)

    def test_all_made_ideal_where_nothing_plays_is_said(self):
        note = "freeplay: note: --ideal all: no joint of 'p.yaml' has clearance, nothing was made ideal\n"
        for command in ("run", "validate", "show"):
            self.assertEqual(note, self.freeplay(command, self.pendulum(), "--ideal", "all")[1])
        self.assertEqual([], self.summary("results", "p-ideal")["settings"]["ideal"])
        self.assertEqual("", self.freeplay("validate", mechanism("slider-crank"), "--ideal", "all")[1])

    def test_statistics_that_never_began_are_null(self):
        out, _ = self.freeplay("run", mechanism("3-rrr"), "--end", "1 ms")
        self.assertIn("energy residual -   position residual -", out)
        summary = self.summary("results", "3-rrr")
        self.assertEqual({None}, set(summary["residuals"].values()))
        for joint in summary["joints"].values():
            play = joint["play"] or {"impacts": 0}
            self.assertEqual(0, play.pop("impacts"))
            self.assertLessEqual(set(play.values()), {None})
            described = ("type", "clearance", "play")
            self.assertEqual({None}, {value for key, value in joint.items() if key not in described})

    def test_dry_run_writes_nothing(self):
        out, _ = self.freeplay("run", self.pendulum(), "--dry-run")
        self.assertEqual(self.freeplay("validate", "p.yaml")[0], out)
        self.assertEqual(["p.yaml"], os.listdir(self.folder))

    def test_settings_are_recorded(self):
        self.freeplay("run", mechanism("slider-crank"), "--end", "2e-5", "--step", "2e-6", "--set", "c=1 mm", "--set",
                      "c=0.2 mm", "--out", "r")
        settings = self.summary("r")["settings"]
        self.assertEqual((2e-5, {"size": 2e-6, "adaptive": False}, {"c": "0.2 mm"}, []),
                         (settings["end"], settings["step"], settings["set"], settings["ideal"]))
        self.assertIn("type", settings["integrator"])

    def test_events_are_sorted_and_complete(self):
        self.freeplay("run", mechanism("slider-crank"), "--quiet")
        rows = self.rows("results", "slider-crank", "events.csv")
        self.assertEqual(EVENTS.split(","), rows[0])
        times = [float(row[0]) for row in rows[1:]]
        self.assertTrue(times)
        self.assertEqual(sorted(times), times)
        self.assertEqual("contact_open", rows.pop()[2])  # the run ends in contact
        for row in rows[1:]:
            cells = dict(zip(rows[0], row))
            ended = cells["kind"] == "contact_end"
            self.assertIn(cells["kind"], ("contact_begin", "contact_end"))
            self.assertGreaterEqual(float(cells["speed"]), 0.0)
            self.assertEqual([ended] * 4, [cells[k] != "" for k in ("duration", "max_fn", "max_delta", "steps")])
        begins = sum(row[2] == "contact_begin" for row in rows[1:])
        self.assertEqual(begins, self.summary("results", "slider-crank")["counts"]["contacts_total"])

    def test_a_rerun_is_the_same_byte_for_byte_in_any_locale(self):
        self.pendulum(end="0.5 s")
        self.freeplay("run", "p.yaml", "--out", "a")
        self.freeplay("run", "p.yaml", "--out", "b", environment={"LC_ALL": "de_DE.UTF-8", "LANG": "de_DE.UTF-8"})
        for name in ("results.csv", "events.csv"):
            self.assertEqual(self.read("a", name), self.read("b", name))
        summaries = [self.summary(name) for name in ("a", "b")]
        for summary in summaries:
            del summary["performance"], summary["provenance"]["command"]
        self.assertEqual(*summaries)

    def test_an_interrupt_seals_the_files(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            process = subprocess.Popen([PROGRAM, "run", mechanism("3-rrr"), "--end", "100 s", "--out", number.name],
                                       cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            # Interrupted once rows have reached the file, which they do within a second.
            deadline = time.monotonic() + 60
            while not self.grown(number.name, "results.csv") and time.monotonic() < deadline:
                time.sleep(0.05)
            process.send_signal(number)
            process.communicate(timeout=60)
            self.assertEqual(130, process.returncode)
            summary = self.summary(number.name)
            self.assertEqual(("interrupted", 130), (summary["status"], summary["exit_code"]))
            reason = next(r for r in summary["trust"]["reasons"] if r["id"] == "run-interrupted")
            self.assertEqual(("doubtful", summary["time"]["reached"], 100.0), (reason["level"], reason["value"], reason["limit"]))
            rows = self.rows(number.name, "results.csv")
            self.assertEqual({len(rows[0])}, {len(row) for row in rows})
            self.assertEqual(summary["counts"]["rows"], len(rows) - 1)
            self.assertTrue(self.read(number.name, "results.csv").endswith("\n"))

    def test_an_interrupt_of_the_second_run_is_one(self):
        process = subprocess.Popen([PROGRAM, "run", mechanism("slider-crank"), "--end", "24 ms", "--accuracy", "1e-9",
                                    "--verify", "--out", "v"], cwd=self.folder, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        let_work(process, 2.0)  # the first run takes a fifth of a second, the second half a minute
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=60)
        self.assertEqual(130, process.returncode, out + err)
        self.assertIn("interrupted", out)
        self.assertEqual("interrupted", self.summary("v")["status"])

    def test_a_directory_that_is_removed_is_a_failure_of_files(self):
        process = subprocess.Popen([PROGRAM, "run", mechanism("3-rrr"), "--end", "100 s", "--out", "gone"],
                                   cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        deadline = time.monotonic() + 60
        while not self.grown("gone", "results.csv") and time.monotonic() < deadline:
            time.sleep(0.05)
        shutil.rmtree(os.path.join(self.folder, "gone"))
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=60)
        self.assertEqual(6, process.returncode, err)
        self.assertNotIn("internal", err)

    def test_a_directory_that_another_takes_the_place_of_is_left_alone(self):
        process = subprocess.Popen([PROGRAM, "run", mechanism("3-rrr"), "--end", "100 s", "--out", "here", "--checkpoint",
                                    "0.2 s"], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.kill)
        deadline = time.monotonic() + 60
        while not self.grown("here", "results.csv") and time.monotonic() < deadline:
            time.sleep(0.05)
        self.assertIn(" runs ", self.read("here", "run.log"))  # messages are there as they come
        os.rename(self.path("here"), self.path("there"))
        os.mkdir(self.path("here"))
        _, err = process.communicate(timeout=60)
        self.assertEqual(6, process.returncode, err)
        self.assertRegex(err, r"cannot write 'here\S*': it (or its run.log )?was removed or replaced while .*\[cannot-write\]")
        self.assertNotIn("free some space", err)
        self.assertEqual([], os.listdir(self.path("here")))

    def test_progress_is_shown_on_a_terminal_only(self):
        main, terminal = pty.openpty()
        run = subprocess.Popen([PROGRAM, "run", mechanism("slider-crank"), "--end", "50 ms"], cwd=self.folder,
                               stdout=subprocess.DEVNULL, stderr=terminal)
        os.close(terminal)
        shown = ""
        try:  # read while it runs: a terminal that nobody reads stops the program once it is full
            while piece := os.read(main, 1000):
                shown += piece.decode()
        except OSError:  # the other end is closed
            pass
        os.close(main)
        self.assertEqual(0, run.wait(timeout=300))
        self.assertRegex(shown, r"\r *\d+ %  t = \S+ / 0\.05 s  [\d ]+ steps  eta \d\d:\d\d")

    def grown(self, *names):
        return os.path.exists(self.path(*names)) and os.path.getsize(self.path(*names)) > 10000

    def test_a_full_disk_keeps_whole_rows(self):
        limit = 20000

        def shrink():
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

        out, err = self.freeplay("run", self.pendulum(end="20 s"), "--out", "r", code=6, preexec_fn=shrink)
        self.assertRegex(err, r"error: cannot write '.*': File too large.* \[cannot-write\]\n")
        text = self.read("r", "results.csv")
        self.assertTrue(text.endswith("\n") and len(text) <= limit)
        rows = self.rows("r", "results.csv")
        self.assertEqual({len(rows[0])}, {len(row) for row in rows})

    def test_a_default_name_does_not_replace_the_result_of_another_model(self):
        first, second = self.pendulum(end="1 ms"), self.path("b", "pendulum.yaml")
        os.mkdir(self.path("b"))
        self.freeplay("run", first, "--quiet")
        shutil.copy(self.path(first), second)
        self.freeplay("run", second, "--quiet")
        with open(second, "a", encoding="utf-8") as file:
            file.write("# another one\n")
        self.freeplay("run", second, "--quiet")
        _, err = self.freeplay("run", first, "--quiet", code=6)
        name = self.summary("results", os.listdir(self.path("results"))[0])["model"]["name"]
        self.assertIn("'results/%s' holds the result of another model of that name, '%s'" % (name, second), err)
        self.assertIn("--out", err)
        self.freeplay("run", first, "--quiet", "--force")
        os.remove(self.path(first))
        self.freeplay("run", second, "--quiet")  # which was moved there, for all that is known

    def test_rows_that_no_time_tells_apart_are_refused(self):
        model = self.pendulum(end="1 s")
        _, err = self.freeplay("run", model, "--interval", "1e-17 s", "--yes", "--quiet", code=2)
        self.assertIn("--interval: 1e-17 s between rows is less than times of 1 s can differ by; it must be at least "
                      "4.4e-16 s", err)
        model = self.write("p.yaml", self.read("p.yaml").replace("interval: 10 ms", "interval: 1e-17 s"))
        _, err = self.freeplay("run", model, "--yes", "--quiet", code=3)
        self.assertIn("[out-of-range]", err)

    def test_what_a_failed_run_leaves_differs_from_other_files(self):
        model = self.pendulum(end="20 s")
        limit = (20000, 20000)
        self.freeplay("run", model, "--out", "r", code=6,
                      preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, limit))
        summary = self.summary("r")
        self.assertEqual(("failed", 6), (summary["status"], summary["exit_code"]))
        self.assertLess(summary["counts"]["rows"], 20000)
        self.assertEqual({"rows": None, "events": None}, summary["hashes"])
        os.remove(self.path("r", "summary.json"))
        _, err = self.freeplay("run", model, "--out", "r", code=6)
        self.assertIn("error: 'r' holds the result of a run that did not end: it has no summary.json", err)
        self.freeplay("run", model, "--out", "r", "--end", "1 ms", "--force")
        # What was killed before it had a row is nothing to lose.
        os.remove(self.path("r", "summary.json"))
        os.remove(self.path("r", "results.h5"))
        self.write(os.path.join("r", "results.csv"), self.read("r", "results.csv").split("\n")[0] + "\n")
        self.freeplay("run", model, "--out", "r", "--end", "1 ms")
        os.remove(self.path("r", "summary.json"))
        self.write(os.path.join("r", "thesis.txt"), "two years of work")
        _, err = self.freeplay("run", model, "--out", "r", code=6)
        self.assertIn("'r' holds other files than a result", err)


if __name__ == "__main__":
    unittest.main()
