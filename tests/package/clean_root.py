"""Installs the packages in FOLDER in a Debian root made for it, and runs the program and the package for Python there.

usage: clean_root.py FOLDER. Needs root, debootstrap and the mirrors of this system.
"""
import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
EXAMPLES = "/usr/share/doc/freeplay/examples"
COMMANDS = [
    "freeplay --version",
    "cd /tmp && cp -r %s try && cd try && freeplay run mechanisms/pendulum.yaml --report --quiet" % EXAMPLES,
    "cd /tmp/try && test -s results/pendulum/report.html && freeplay study plan mechanisms/studies/tolerance-bound.yaml",
    "cd /tmp/try && freeplay init new.yaml && freeplay validate new.yaml",
    "cd / && freeplay complete run --integ | grep -x -e --integrator && python3 -c 'import freeplay; print(freeplay.__version__)'",
    "cd /tmp/try && python3 ../first.py",
]


def system(name):
    with open("/etc/os-release", encoding="utf-8") as file:
        return dict(line.rstrip().split("=", 1) for line in file if "=" in line)[name].strip('"')


def mirror():
    found = subprocess.run(["apt-get", "indextargets", "--format", "$(REPO_URI)", "Created-By: Packages", "Release: " + system("VERSION_CODENAME")],
                           capture_output=True, text=True).stdout.split()
    return found[0] if found else "http://deb.debian.org/debian"


def first_script():
    with open(os.path.join(ROOT, "docs", "python.md"), encoding="utf-8") as file:
        return re.search(r"^```python first\n(.*?)^```", file.read(), re.S | re.M)[1]


def run(*words, **options):
    print("+", " ".join(words), flush=True)
    subprocess.run(words, check=True, **options)


def inside(root, command):
    run("chroot", root, "/bin/sh", "-ec", command, env={"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "HOME": "/root", "LC_ALL": "C.UTF-8", "DEBIAN_FRONTEND": "noninteractive"})


def try_packages(folder, root):
    run("debootstrap", "--variant=minbase", system("VERSION_CODENAME"), root, mirror(), stdout=subprocess.DEVNULL)
    for path in glob.glob("/etc/apt/apt.conf.d/*proxy*"):
        shutil.copy(path, root + "/etc/apt/apt.conf.d")
    os.mkdir(root + "/packages")
    for path in glob.glob(os.path.join(folder, "*.deb")):
        shutil.copy(path, root + "/packages")
    inside(root, "apt-get -qq update && apt-get -qq install -y --no-install-recommends /packages/*.deb >/dev/null")
    with open(root + "/tmp/first.py", "w", encoding="utf-8") as file:
        file.write(first_script())
    run("mount", "-t", "proc", "proc", root + "/proc")
    try:
        for command in COMMANDS:
            inside(root, command)
    finally:
        run("umount", root + "/proc")


def main():
    with tempfile.TemporaryDirectory(prefix="freeplay-root-", ignore_cleanup_errors=True) as root:
        os.chmod(root, 0o755)
        try_packages(sys.argv[1], root)
    print("the packages install and run in a clean Debian root")


if __name__ == "__main__":
    main()
