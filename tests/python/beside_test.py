"""Models beside each other: threads that load and run, children of forks meanwhile, threads that a program does not wait for."""
import os
import subprocess
import sys
import threading
import unittest

import freeplay
from in_folder import ROOT, SLIDER, InFolder

ROBOT = str(ROOT / "tests/data/urdf/four_bar_loop.urdf")
ENDS = """
import sys, threading, freeplay
done = threading.Event()
def run():
    while True:
        freeplay.load(%r, end="0.2 ms").run(progress=lambda *_: None)
        done.set()
for _ in range(3):
    threading.Thread(target=run, daemon=True).start()
done.wait()
""" % SLIDER


class Beside(InFolder):
    def test_a_child_of_a_fork_finds_nothing_held_by_threads_that_it_has_not(self):
        model, stop = freeplay.load(SLIDER), threading.Event()

        def load():
            while not stop.is_set():
                freeplay.load(ROBOT).facts()
                model.replace(end="1 ms").facts()
        threads = [threading.Thread(target=load) for _ in range(2)]
        self.addCleanup(stop.set)
        for thread in threads:
            thread.start()
        for _ in range(15):
            fresh = freeplay.load(SLIDER)
            asks = threading.Thread(target=fresh.facts)
            asks.start()
            child = os.fork()
            if child == 0:
                freeplay.load(ROBOT).facts(), fresh.facts()
                os._exit(0)
            asks.join()
            self.assertEqual(0, os.waitpid(child, 0)[1])
        stop.set()
        for thread in threads:
            thread.join()

    def test_a_program_ends_while_threads_run_that_it_does_not_wait_for(self):
        for _ in range(3):
            done = subprocess.run([sys.executable, "-W", "ignore", "-c", ENDS], capture_output=True, text=True)
            self.assertEqual((0, "", ""), (done.returncode, done.stdout, done.stderr))


if __name__ == "__main__":
    unittest.main()
