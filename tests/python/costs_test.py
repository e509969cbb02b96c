"""What the package costs: in size and memory, beside other threads. Run it alone to see the figures."""
import ctypes
import gc
import os
import pathlib
import signal
import subprocess
import sys
import threading
import unittest

import freeplay
from in_folder import ROOT, SLIDER, InFolder, is_in_core

LARGEST = 8.0e6  # of _core without symbols
FAILS = (ROOT / "mechanisms/pendulum.yaml").read_text().replace("pivot: {type: revolute", "pivot: {type: revolut")


def show(what, figure):
    print(f"{what}: {figure}", flush=True)


def resident():
    """Memory in use [MB]."""
    gc.collect()
    ctypes.CDLL("libc.so.6").malloc_trim(0)
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6


class Costs(InFolder):
    def test_the_extension_is_small(self):
        core = next(pathlib.Path(freeplay.__file__).parent.glob("_core*.so"))
        subprocess.run(["strip", "-o", "stripped.so", core], check=True)
        show("_core", f"{os.stat('stripped.so').st_size / 1e6:.2f} MB")
        self.assertLess(os.stat("stripped.so").st_size, LARGEST)

    def test_hdf5_is_the_system_s_and_loaded_when_it_is_needed(self):
        code = ("import freeplay; maps = lambda: 'libhdf5' in open('/proc/self/maps').read(); r = freeplay.run(%r, end='0.1 ms'); a = maps(); "
                "r.save('x', format='hdf5'); print(a, maps(), len(freeplay.open('x').time) == len(r.time))" % SLIDER)
        said = subprocess.run([sys.executable, "-W", "ignore", "-c", code], check=True, capture_output=True, text=True).stdout
        self.assertEqual("False True True\n", said)

    def test_200_rounds_leave_nothing(self):
        model = freeplay.load(str(ROOT / "mechanisms/4-rrr.yaml"))

        def once():
            result = freeplay.run(SLIDER, end="0.2 ms")
            views = [result[name] for name in result.names]
            model.error(pose=[0.05, 0, 0])
            with model.replace(end="0.2 ms").simulation() as sim:
                sim.advance(rows=1)
            try:
                freeplay.run(FAILS)
            except freeplay.ModelError as error:
                views.append(str(error))
        for _ in range(30):
            once()
        before = resident()
        for _ in range(200):
            once()
        show("200 rounds leave", f"{resident() - before:.2f} MB")
        self.assertLess(resident() - before, 2)

    def test_python_goes_on_while_a_run_is_on(self):
        model = freeplay.load(SLIDER, end="100000 s")

        def go_on():
            turns = 0
            while turns < 10000:
                turns += is_in_core(sys._current_frames()[threading.main_thread().ident], "run_model")
            os.kill(os.getpid(), signal.SIGINT)  # which would be no Interrupted outside of the run
        thread = threading.Thread(target=go_on)
        thread.start()
        self.assertRaises(freeplay.Interrupted, model.run)
        thread.join()


if __name__ == "__main__":
    unittest.main()
