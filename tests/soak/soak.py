"""Kills and failing calls in full: `./dev soak`.

Results survive: a run that is killed at any instant, or of which any call that writes fails once, leaves files that open and hold what
they should, and goes on to the bytes of an undisturbed run.
"""
import argparse
import os
import random
import shutil
import sys
import tempfile
import time

from faults import ERRORS, Faults
from kills import Kills

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

# Some seconds each, so that there is more than the second that rows may wait.
KILLED = [("fixed", "slider-crank", ["--end", "1.2 s", "--interval", "0.2 ms"]),
          ("adaptive", "slider-crank", ["--end", "4 s", "--interval", "1 ms", "--accuracy", "1um"]),
          ("six contacts", "3-rrr", ["--end", "0.6 s"]),
          ("rows in contact", "slider-crank", ["--end", "4 s", "--interval", "1 ms", "--accuracy", "1um"])]
FAILED = ["--end", "24 ms"]


def model(name, folder, rows_in_contact=0):
    with open(os.path.join(ROOT, "mechanisms", name + ".yaml"), encoding="utf-8") as file:
        text = file.read()
    path = os.path.join(folder, "%s-%d.yaml" % (name, rows_in_contact))
    with open(path, "w", encoding="utf-8") as file:
        file.write(text.replace("output: {", "output: {rows_in_contact: %d, " % rows_in_contact))
    return path


def soak_kills(program, folder, count, draw, say, runs=KILLED):
    checkpoints = ["--checkpoint", "0.3 s"]
    kinds = [Kills(name, program, folder, model(what, folder, 5 if name == "rows in contact" else 0), options + checkpoints)
             for name, what, options in runs]
    while sum(kind.killed for kind in kinds) < count:
        min(kinds, key=lambda kind: kind.killed).kill(draw)
    for kind in kinds:
        say("%s (%.1f s): %s" % (kind.name, kind.seconds, kind.words()))
    return kinds


def soak_faults(program, library, folder, count, draw, say):
    """All cases where `count` is None."""
    faults = Faults(program, library, folder, model("slider-crank", folder, 3), FAILED)
    faults.short_writes()
    cases = [(call, error) for call in range(1, faults.counted + 1) for error in ERRORS]
    draw.shuffle(cases)
    for call, error in cases[:count]:
        faults.fail(call, error)
    say(faults.words())
    return faults


def main():
    parser = argparse.ArgumentParser(prog="./dev soak", description=__doc__.split("\n\n")[0])
    parser.add_argument("--kills", type=int, default=200, metavar="N", help="runs that are killed (200)")
    parser.add_argument("--faults", type=int, default=None, metavar="N", help="calls that fail (all, with both errors)")
    parser.add_argument("--seed", type=int, default=None, metavar="S", help="of what is drawn by chance; printed")
    parser.add_argument("--program", required=True, help=argparse.SUPPRESS)
    parser.add_argument("--library", required=True, help=argparse.SUPPRESS)
    options = parser.parse_args()
    seed = options.seed if options.seed is not None else random.SystemRandom().randrange(1 << 30)

    def say(text):
        print(text, flush=True)

    folder = tempfile.mkdtemp()
    say("seed %d, files in %s" % (seed, folder))
    began = time.monotonic()
    if options.kills > 0:
        soak_kills(options.program, folder, options.kills, random.Random(seed), say)
        say("%d times killed in %.0f s" % (options.kills, time.monotonic() - began))
    began = time.monotonic()
    if options.faults != 0:
        faults = soak_faults(options.program, options.library, folder, options.faults, random.Random(seed), say)
        say("%d calls failed in %.0f s" % (faults.failed.total(), time.monotonic() - began))
    shutil.rmtree(folder)


if __name__ == "__main__":
    try:
        main()
    except AssertionError as error:  # the files stay
        sys.exit("FAILED: %s" % error)
