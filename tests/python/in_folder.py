"""What tests of the package share: the program, a model, bits, a folder for each test."""
import os
import pathlib
import signal
import tempfile
import unittest
import warnings

import numpy as np

import freeplay

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ["FREEPLAY"]
SLIDER = str(ROOT / "mechanisms/slider-crank.yaml")


def same_bits(a, b):
    return np.asarray(a, dtype=float).tobytes() == np.asarray(b, dtype=float).tobytes()


def is_in_core(frame, function):
    """Whether this function of the package, innermost in a thread, is past its beginning, where it calls the core."""
    return frame.f_code.co_name == function and frame.f_lineno > frame.f_code.co_firstlineno


class InFolder(unittest.TestCase):
    def setUp(self):
        # Shells start what goes on in their background with interrupts ignored.
        signal.signal(signal.SIGINT, signal.default_int_handler)
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)
        warnings.simplefilter("ignore", freeplay.ModelWarning)
