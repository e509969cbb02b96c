"""Events that follow each other without end stop a run, and say whose they are."""
import os
import unittest

from program import BUILD, ProgramTest

LIBRARY = os.path.join(BUILD, "plugins", "tests", "endless_events.so")
MODEL = """freeplay: 1
gravity: [9.81, 0]
bodies: {block: {mass: 1 kg, inertia: 0.01}}
joints: {buffer: {type: endless-stop, between: [ground, block], gap: 0.1 m}}
simulation: {end: 1 s, output: {interval: 0.01 s}}
"""


class EndlessEvents(ProgramTest):
    def test_a_storm_of_events_ends_the_run_and_names_joint_and_event(self):
        self.write("m.yaml", MODEL.replace("0.1 m}", "0.1 m, step: 1 us}"))
        for options in (("--accuracy", "1um"), ("--accuracy", "1um", "--integrator", "bathe"), ("--step", "0.1 ms")):
            with self.subTest(options):
                _, err = self.freeplay("run", "m.yaml", "--plugin", LIBRARY, "--out", "r", *options, code=4)
                self.assertRegex(err, r"t = 0\.1\d* s: the events of joint 'buffer' do not end: \d+ within \S+ s, the "
                                      r"last 'stop_(begin|end)'.*\[event-storm\]")
                self.assertLess(len(self.read("r", "events.csv").splitlines()), 1100)
                self.assertGreater(len(self.read("r", "results.csv").splitlines()), 10)

    def test_an_event_that_no_step_can_end_at_names_joint_and_event(self):
        self.write("m.yaml", MODEL)
        _, err = self.freeplay("run", "m.yaml", "--plugin", LIBRARY, "--out", "r", "--accuracy", "1um", code=4)
        self.assertRegex(err, r"event 'stop_end' of joint 'buffer' could not be located; where .*\[event-storm\]")

    def test_a_contact_that_begins_in_the_wrong_direction_is_told(self):
        self.write("m.yaml", MODEL.replace("endless-stop", "backward-stop"))
        for step, verdict in (("--accuracy=1um", "bad"), ("--step=0.1 ms", "doubtful")):
            out, _ = self.freeplay("run", "m.yaml", "--plugin", LIBRARY, "--out", "r", "--force", step)
            self.assertRegex(out, r"trust: %s .*joint 'buffer': its event 'contact_begin' is declared to fall" % verdict)


if __name__ == "__main__":
    unittest.main()
