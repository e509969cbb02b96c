"""Runs fuzz targets: fuzz.py [--short | --seconds N | --runs N] FOLDER [TARGET...]. FOLDER holds the programs.

First the inputs that once did harm (regressions/TARGET), then new ones that libFuzzer makes from the project's own
files, from what earlier runs found (FOLDER/found/TARGET, long runs only) and, where FREEPLAY_CASES names a folder with
files of other people, from those. An input may take 2 s (20 s among all tests) and 512 MiB and must leave no memory behind.
"""
import argparse
import glob
import hashlib
import os
import re
import shutil
import subprocess
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
# Executions of the short run, some seconds each; and the longest input: beyond a limit of the reader, where it has one.
TARGETS = {
    "expression": {"short": 40000, "longest": 10500},
    "mjcf": {"short": 3000, "longest": 16384},
    "model": {"short": 6000, "longest": 16384},
    "sdf": {"short": 3000, "longest": 16384},
    "table": {"short": 8000, "longest": 4096},
    "unit": {"short": 30000, "longest": 256},
    "urdf": {"short": 3000, "longest": 16384},
}
ENDING = {"model": "yaml", "urdf": "urdf", "table": "csv"}
UNITS = ["m", "kg*m^2", "N/m^1.5", "rad/s", "1/s", "N/m^exponent", "kind: N/m | N*m/rad", "kg * m / s^-2", "m^(", "Hz"]
EXPRESSIONS = ["2*pi/3", "1 mm + 2 in", "${a}*sin(2*pi*t/1 s)", "smooth(t, 0 s, 0.1 s)*$l", "-2^-2 deg", "3 N*m",
               "atan2($f, t)", "min(1, max(t, 2)) * sqrt(t^2 + 1)", "1e-3", "abs(acos(cos(t)))^$a", "((1))",
               "exp(-t) / log(2)"]
TABLES = ["time,value\n0,0\n0.5,1\n1,0\n", "# s, rad\n t , x \n0,+1e-3\n\n1,2\n2,1e-3\n", "t,a,b\n0,1,2\n1,2,3,4\n2,\n"]

# The pages of documentation have the only files of the project in these formats.
IN_PAGES = {"mjcf": re.compile(rb"```xml\n(<mujoco.*?)```", re.DOTALL), "sdf": re.compile(rb"```xml\n(<sdf.*?)```", re.DOTALL)}
PARTS = {}
PARTS["mjcf"] = """<mujoco><compiler angle="radian" inertiafromgeom="auto" settotalmass="3"/>
<default><geom density="2700"/><default class="arm"><joint damping="1"/><geom type="box"/></default></default>
<worldbody><body name="a" childclass="arm" pos="0 0 1" euler="0 0.1 0.2"><freejoint/>
<geom size="0.1 0.2 0.3"/><geom type="ellipsoid" size="0.1 0.2 0.3" mass="1" axisangle="0 1 0 0.3"/>
<body name="b" quat="1 0 1 0"><joint name="q" type="slide" axis="1 0 0" range="-1 1" stiffness="3" springref="0.1" ref="0.2"/>
<geom type="cylinder" fromto="0 0 0 0 0 1" size="0.05"/><frame pos="0 1 0"><site name="s" zaxis="1 0 0"/></frame></body>
<body name="c"><joint type="ball"/><inertial pos="0 0 1" mass="2" fullinertia="2 2 2 0.1 0 0"/></body></body></worldbody>
<equality><weld body1="a" body2="c"/><connect site1="s" site2="s"/><joint joint1="q" polycoef="0 1 0 0 0"/></equality></mujoco>
"""
PARTS["sdf"] = """<sdf version="1.11"><world name="w"><gravity>0 0 -1</gravity><model name="m" canonical_link="a" placement_frame="f">
<pose degrees="true">1 0 0 0 0 90</pose><link name="a"><pose relative_to="f">0 1 0 0 0 0</pose><inertial><mass>1</mass><inertia>
<ixx>1</ixx><iyy>1</iyy><izz>1</izz><ixy>0.1</ixy></inertia></inertial></link><link name="b"/><link name="c"/>
<frame name="f"><pose rotation_format="quat_xyzw">0 0 1 0 0 0 1</pose></frame><frame name="g" attached_to="n::l"/>
<model name="n"><static>1</static><link name="l"/></model>
<joint name="j" type="revolute"><parent>world</parent><child>a</child><axis><xyz expressed_in="f">0 1 0</xyz>
<limit><lower>-1</lower><upper>inf</upper></limit><dynamics><damping>1</damping><spring_stiffness>2</spring_stiffness></dynamics></axis></joint>
<joint name="k" type="prismatic"><parent>g</parent><child>b</child><axis><xyz>1 0 0</xyz><mimic joint="j"><multiplier>2</multiplier></mimic></axis></joint>
<joint name="s" type="screw"><parent>b</parent><child>a</child><axis><xyz>0 0 1</xyz></axis><screw_thread_pitch>0.1</screw_thread_pitch></joint>
<joint name="u" type="universal"><parent>c</parent><child>b</child><axis><xyz>1 0 0</xyz></axis><axis2><xyz>0 1 0</xyz></axis2></joint>
<joint name="r" type="revolute"><parent>a</parent><child>c</child><axis><xyz>0 1 0</xyz></axis></joint>
<joint name="x" type="gearbox"><parent>world</parent><child>c</child><gearbox_ratio>2</gearbox_ratio>
<gearbox_reference_body>a</gearbox_reference_body></joint></model></world></sdf>
"""


def scalars(text):
    """Most values of a YAML file, found without reading it: some files are there to be refused."""
    return [match.strip() for match in re.findall(rb"[:\[,]\s+\"?([^\"#{}\[\],\n]{1,200})", text)]


def files(ending):
    folders = [os.path.join(ROOT, "mechanisms"), os.path.join(ROOT, "tests", "data"),
               os.environ.get("FREEPLAY_CASES", "")]
    found = [path for folder in folders if folder
             for path in glob.glob(os.path.join(folder, "**", "*." + ending), recursive=True)]
    return sorted(path for path in found if os.path.getsize(path) <= 1 << 16)


def read(path):
    with open(path, "rb") as file:
        return file.read()


def seeds(target):
    """Texts to begin with."""
    if target == "unit":
        return [text.encode() for text in UNITS]
    texts = [read(path) for path in files(ENDING[target])] if target in ENDING else []
    if target == "table":
        texts += [text.encode() for text in TABLES]
    if target in PARTS:
        pages = glob.glob(os.path.join(ROOT, "docs", "*.md"))
        texts = [text for path in pages for text in IN_PAGES[target].findall(read(path))]
        texts.append(PARTS[target].encode())
    if target == "expression":
        texts = [text.encode() for text in EXPRESSIONS]
        for path in files("yaml"):
            texts += scalars(read(path))
    return sorted(set(texts))


def write_seeds(target, folder):
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    for text in seeds(target):
        with open(os.path.join(folder, hashlib.sha256(text).hexdigest()[:16]), "wb") as file:
            file.write(text)


def dictionary(target, build):
    """Words to build inputs from: those of the program's own tables for YAML, a list for others that have one."""
    if target != "model":
        path = os.path.join(HERE, target + ".dict")
        return path if os.path.exists(path) else None
    path = os.path.join(build, "model.dict")
    with open(path, "wb") as file:
        file.write(subprocess.run([os.path.join(build, "fuzz_words")], check=True, stdout=subprocess.PIPE).stdout)
    return path


def run(command):
    environment = {**os.environ, "ASAN_OPTIONS": "quarantine_size_mb=16:malloc_context_size=12",
                   "UBSAN_OPTIONS": "print_stacktrace=1"}
    return subprocess.run(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


def report(target, crash, output):
    sys.stdout.write(output.decode(errors="replace")[-8000:])
    print("%s: FAILED. Replay: ./dev fuzz %s %s" % (target, target, crash))


def replay(target, program, limits, paths):
    """True if all inputs are taken; names the first that is not."""
    if not paths or run([program, *limits, *paths]).returncode == 0:
        return True
    for path in paths:
        done = run([program, *limits, path])
        if done.returncode != 0:
            report(target, os.path.relpath(path), done.stdout)
            return False
    return True


def fuzz(target, build, options):
    program = os.path.join(build, "fuzz_" + target)
    seconds = 20 if options.short else 2  # by the clock, and a machine that runs all tests is busy
    limits = ["-timeout=%d" % seconds, "-rss_limit_mb=512", "-max_len=%d" % TARGETS[target]["longest"]]
    inputs = options.input or sorted(glob.glob(os.path.join(HERE, "regressions", target, "*")))
    if not replay(target, program, limits, inputs):
        return False
    print("%-10s %d known inputs pass" % (target, len(inputs)), flush=True)
    if options.input:
        return True
    seed_folder, found = os.path.join(build, "seeds", target), os.path.join(build, "found", target)
    write_seeds(target, seed_folder)
    os.makedirs(found, exist_ok=True)
    crashes = os.path.join(build, "crashes", target + "-")
    os.makedirs(os.path.dirname(crashes), exist_ok=True)
    command = [program, *limits, "-print_final_stats=1", "-verbosity=0", "-artifact_prefix=" + crashes]
    words = dictionary(target, build)
    if words:
        command.append("-dict=" + words)
    if options.short:
        command += ["-seed=1", "-runs=%d" % TARGETS[target]["short"], seed_folder]
    else:
        length = "-runs=%d" % options.runs if options.runs else "-max_total_time=%d" % options.seconds
        command += [length, found, seed_folder]
    begin = time.monotonic()
    done = run(command)
    taken = time.monotonic() - begin
    if done.returncode != 0:
        crash = re.search(rb"Test unit written to (\S+)", done.stdout)
        report(target, os.path.relpath(crash.group(1).decode(), os.getcwd()) if crash else "?", done.stdout)
        return False
    count = int(re.search(rb"number_of_executed_units: (\d+)", done.stdout).group(1))
    peak = int(re.search(rb"peak_rss_mb: *(\d+)", done.stdout).group(1))
    print("%-10s %d executions, %.0f/s, peak %d MiB, no crash" % (target, count, count / max(taken, 1e-3), peak),
          flush=True)
    return True


def main():
    parser = argparse.ArgumentParser(prog="./dev fuzz")
    parser.add_argument("--short", action="store_true", help=argparse.SUPPRESS)
    parser.add_argument("--seconds", type=int, default=300, help="time for each target, default 300")
    parser.add_argument("--runs", type=int, help="executions of each target instead")
    parser.add_argument("build", help=argparse.SUPPRESS)
    parser.add_argument("target", nargs="?", choices=sorted(TARGETS), help="default: all")
    parser.add_argument("input", nargs="*", help="files to replay")
    options = parser.parse_args()
    targets = [options.target] if options.target else sorted(TARGETS)
    results = [fuzz(target, options.build, options) for target in targets]
    return 0 if all(results) else 1


if __name__ == "__main__":
    sys.exit(main())
