"""Slurm on one machine, without systemd and without root: its daemons are children of the test, their files lie in one folder."""
import getpass
import os
import shutil
import socket
import subprocess
import tempfile
import time

TOOLS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol", "sinfo")
# Groups of processes are followed in /proc, because without root there are no control groups to make.
CONFIGURATION = """ClusterName=box
SlurmctldHost={host}(127.0.0.1)
SlurmUser={user}
SlurmdUser={user}
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
StateSaveLocation={base}/state
SlurmdSpoolDir={base}/spool
SlurmctldPidFile={base}/slurmctld.pid
SlurmdPidFile={base}/slurmd.pid
SlurmctldLogFile={base}/slurmctld.log
SlurmdLogFile={base}/slurmd.log
ReturnToService=2
AuthType=auth/munge
AuthInfo=socket={base}/munge.socket
CredType=cred/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/filetxt
JobCompLoc={base}/jobs.txt
MpiDefault=none
SwitchType=switch/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
MinJobAge=3600
SchedulerParameters=sched_interval=1,bf_interval=1
NodeName={host} NodeAddr=127.0.0.1 CPUs={processors} State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


def found(tool):
    """Where a program is; daemons are not on the path of ordinary users."""
    return shutil.which(tool, path=os.environ["PATH"] + ":/usr/sbin:/sbin")


def missing():
    return [tool for tool in TOOLS if not found(tool)]


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


class SlurmBox:
    """Ready for `sbatch` with the environment `environment` when it is made; `stop` ends the daemons."""

    def __init__(self):
        # Folders of the tests are closed to others, which munge refuses; paths of sockets have 107 characters at most.
        self.base, self.daemons = tempfile.mkdtemp(prefix="slurm-", dir="/tmp"), []
        base = self.base
        os.chmod(base, 0o755)
        self.environment = {**os.environ, "SLURM_CONF": os.path.join(base, "slurm.conf")}
        for name in ("state", "spool"):
            os.mkdir(os.path.join(base, name))
        with open(os.open(os.path.join(base, "munge.key"), os.O_CREAT | os.O_WRONLY, 0o400), "wb") as file:
            file.write(os.urandom(128))
        host = socket.gethostname().split(".")[0]
        with open(self.environment["SLURM_CONF"], "w", encoding="utf-8") as file:
            file.write(CONFIGURATION.format(host=host, user=getpass.getuser(), ports=free_ports(2), base=base, processors=os.cpu_count()))
        files = {"key-file": "key", "socket": "socket", "pid-file": "pid", "log-file": "log", "seed-file": "seed"}
        try:
            self.start("munged", "--foreground", *("--%s=%s/munge.%s" % (option, base, end) for option, end in files.items()))
            self.wait(lambda: os.path.exists(os.path.join(base, "munge.socket")))
            self.start("slurmctld", "-D", "-f", self.environment["SLURM_CONF"])
            self.wait(lambda: self.run("scontrol", "ping").returncode == 0)
            self.start("slurmd", "-D", "-f", self.environment["SLURM_CONF"], "-N", host)
            self.wait(lambda: self.run("sinfo", "-h", "-o", "%T").stdout.strip() == "idle")
        except BaseException:
            self.stop()
            raise

    def start(self, name, *words):
        with open(os.path.join(self.base, name + ".out"), "w", encoding="utf-8") as out:
            self.daemons.append(subprocess.Popen([found(name), *words], stdin=subprocess.DEVNULL, stdout=out, stderr=out,
                                                 env=self.environment))

    def run(self, name, *words):
        return subprocess.run([found(name), *words], capture_output=True, text=True, timeout=60, env=self.environment)

    def wait(self, ready, seconds=60):
        until = time.monotonic() + seconds
        while not ready():
            if time.monotonic() > until or any(daemon.poll() is not None for daemon in self.daemons):
                raise AssertionError("Slurm does not do it:\n" + self.said())
            time.sleep(0.1)

    def said(self):
        """The last lines of every daemon."""
        lines = []
        for name in sorted(os.listdir(self.base)):
            if name.endswith((".out", ".log")):
                with open(os.path.join(self.base, name), encoding="utf-8", errors="replace") as file:
                    lines += [name + ":\n", *file.readlines()[-5:]]
        return "".join(lines)

    def ended_jobs(self):
        """The fields of every job that ended: JobId, JobState, ..."""
        with open(os.path.join(self.base, "jobs.txt"), encoding="utf-8") as file:
            return [dict(word.split("=", 1) for word in line.split() if "=" in word) for line in file]

    def stop(self):
        """The exit codes of the daemons, those last that were started first."""
        codes = []
        for daemon in reversed(self.daemons):
            daemon.terminate()
            try:
                codes.append(daemon.wait(30))
            except subprocess.TimeoutExpired:
                daemon.kill()
                codes.append(daemon.wait())
        self.daemons = []
        shutil.rmtree(self.base, ignore_errors=True)
        return codes
