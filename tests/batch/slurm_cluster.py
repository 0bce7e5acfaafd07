# SPDX-License-Identifier: Apache-2.0
"""A private Slurm: munged, slurmctld and some slurmd on 127.0.0.1, with ports, sockets and a key for this run only.

It needs Debian's packages and no privileges. A node is a slurmd with its tasks, so it can fail like a machine.
"""

import contextlib
import os
import pathlib
import random
import shutil
import socket
import subprocess

import processes

PROGRAMS = ("munge", "munged", "sbatch", "scancel", "scontrol", "setpriv", "sinfo", "slurmctld", "slurmd", "squeue")
CLIENT_TIMEOUT = 20  # s; without slurmctld a client waits long

# A node is lost after SlurmdTimeout and the two other timeouts; its task restarts cred_expire later. linuxproc and the older
# cgroup plugin are for hosts without writable cgroups.
CONFIGURATION = """\
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket={folder}/run/munge.sock,cred_expire=5
StateSaveLocation={folder}/state
SlurmctldPidFile={folder}/run/slurmctld.pid
SlurmdSpoolDir={folder}/spool/%n
SlurmdPidFile={folder}/run/%n.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SwitchType=switch/none
MpiDefault=none
SchedulerParameters=batch_sched_delay=0,sched_min_interval=10000,bf_interval=1
SlurmdTimeout=3
MessageTimeout=3
TCPTimeout=1
KillWait=2
JobRequeue=1
ReturnToService=2
SlurmdParameters=config_overrides
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""
NODE = "NodeName={name} NodeHostname={host} NodeAddr=127.0.0.1 Port={port} CPUs=1 RealMemory=2000\n"


def missing_programs():
    return [program for program in PROGRAMS if not program_path(program)]


def program_path(program):
    return shutil.which(program) or shutil.which(program, path="/usr/sbin:/sbin")


def free_ports(count):
    """Consecutive free ports below the range of ephemeral ports."""
    for _ in range(100):
        first = random.randrange(10000, 32000)
        with contextlib.ExitStack() as sockets:
            try:
                for port in range(first, first + count):
                    sockets.enter_context(socket.socket()).bind(("127.0.0.1", port))
            except OSError:
                continue
            return list(range(first, first + count))
    raise RuntimeError("no free ports were found")


class SlurmCluster:
    """with SlurmCluster(folder, nodes) as cluster: the folder is empty, belongs to this user and has a short name."""

    def __init__(self, folder, nodes=3):
        self.folder = pathlib.Path(folder)
        self.nodes = [f"n{number}" for number in range(1, nodes + 1)]
        self.daemons = {}  # in the order of their start
        self.environment = {name: value for name, value in os.environ.items()
                            if not name.startswith(("SLURM", "SBATCH", "SQUEUE", "SCANCEL", "SINFO"))}
        self.environment["SLURM_CONF"] = str(self.folder / "slurm.conf")

    def __enter__(self):
        try:
            self._configure()
            self._start_daemons()
        except BaseException:
            self.close()
            raise
        return self

    def __exit__(self, *_):
        self.close()

    def client(self, *command, **options):
        """The output of a client; raises an error if it fails."""
        done = subprocess.run(command, env=self.environment, capture_output=True, text=True, timeout=CLIENT_TIMEOUT,
                              stdin=subprocess.DEVNULL, check=False, **options)
        if done.returncode != 0:
            raise RuntimeError(f"{command} ended with {done.returncode}: {done.stderr}")
        return done.stdout

    def queue(self, *flags):
        """{(job, task): (state, node)} of unfinished tasks; a pending task that is grouped with others has no entry."""
        lines = self.client("squeue", "--noheader", "--array", "--format=%F|%K|%T|%N", *flags).splitlines()
        rows = (line.split("|") for line in lines)
        return {(job, task): (state, node) for job, task, state, node in rows}

    def wait_for_end(self, jobs, seconds):
        """Waits until none of the jobs is in the queue; sbatch --wait would poll with growing pauses."""
        processes.wait_until(f"the jobs {jobs} have ended", lambda: not self._unfinished(jobs), seconds)

    def job(self, name):
        """scontrol's information about a job or a task (12_3), also after its end."""
        words = self.client("scontrol", "--oneliner", "show", "job", name).split()
        return dict(word.split("=", 1) for word in words if "=" in word)

    def terminate_task(self, name, wait_for_it):
        """Sends SIGTERM to the shell of a task; wait_for_it() returns when the signal has arrived.

        Slurm 22.05 delivers the signal but asks for a repetition anyway; scancel would then repeat it 5 s later and hit the next
        attempt.
        """
        scancel = subprocess.Popen(["scancel", "--signal=TERM", "--batch", name], env=self.environment,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            wait_for_it()
        finally:
            scancel.kill()
            scancel.wait()

    def kill_node(self, node):
        """Kills a node completely: slurmd, the slurmstepd of its tasks, their shells and all their child processes."""
        tasks = self._tasks_of(node)
        steps = {processes.parent_of(pid) for pid in tasks}
        steps = {pid for pid in steps if processes.name_of(pid) == "slurmstepd"}
        daemon = self.daemons.pop(node)
        processes.kill([daemon.pid, *steps, *tasks])
        daemon.wait()

    def close(self):
        """Ends jobs, then all slurmd, then slurmctld, then munged. Kills daemons that do not end."""
        if "slurmctld" in self.daemons:
            with contextlib.suppress(Exception):
                self.client("scancel", "--quiet", f"--user={os.getuid()}")
                processes.wait_until("the queue is empty", lambda: not self.queue(), 5)
        self._stop(self.nodes)
        for node in self.nodes:
            processes.kill(self._tasks_of(node))
        self._stop(["slurmctld"])
        self._stop(["munged"])

    def logs(self):
        """The last lines of every daemon, for the report of a failure."""
        return "".join(f"--- {path.name}\n" + "".join(path.read_text(errors="replace").splitlines(True)[-30:])
                       for path in sorted((self.folder / "log").glob("*")))

    def _unfinished(self, jobs):
        return [key for key in self.queue("--jobs=" + ",".join(jobs)) if key[0] in jobs]

    def _configure(self):
        for name in ("key", "log", "run", "spool", "state"):
            (self.folder / name).mkdir()
        self.folder.chmod(0o755)
        (self.folder / "run").chmod(0o755)  # munged needs a socket open to all, and a private key
        (self.folder / "key").chmod(0o700)
        key = self.folder / "key/munge.key"
        key.touch(0o600)
        key.write_bytes(os.urandom(128))
        host = socket.gethostname().split(".")[0]
        ports = free_ports(1 + len(self.nodes))
        text = CONFIGURATION.format(host=host, folder=self.folder, ports=ports, user=self.client("id", "-un").strip())
        text += "".join(NODE.format(name=node, host=host, port=port) for node, port in zip(self.nodes, ports[1:]))
        (self.folder / "slurm.conf").write_text(text, encoding="utf-8")
        (self.folder / "cgroup.conf").write_text("CgroupPlugin=cgroup/v1\n", encoding="utf-8")

    def _start_daemons(self):
        """Waits for each daemon to respond before starting the next one, which would otherwise wait long."""
        munge_socket = self.folder / "run/munge.sock"
        self._start("munged", "munged", "--foreground", f"--socket={munge_socket}",
                    f"--key-file={self.folder}/key/munge.key", f"--pid-file={self.folder}/run/munged.pid",
                    f"--seed-file={self.folder}/key/munge.seed")
        processes.wait_until("munge answers", lambda: self._answers("munge", "--no-input", f"--socket={munge_socket}"), 10)
        self._start("slurmctld", "slurmctld", "-D", "-c", "-f", self.folder / "slurm.conf")
        processes.wait_until("slurmctld answers", lambda: self._answers("scontrol", "ping"), 20)
        for node in self.nodes:
            self._start(node, "slurmd", "-D", "-N", node, "-f", self.folder / "slurm.conf")
        processes.wait_until("all nodes are idle", self._all_idle, 20)

    def _start(self, name, program, *arguments):
        # A daemon with the test's own output would block the reader of that output. A daemon ends when its test is killed.
        with open(self.folder / f"log/{name}.log", "wb") as output:
            self.daemons[name] = subprocess.Popen(["setpriv", "--pdeathsig", "TERM", program_path(program), *arguments],
                                                  env=self.environment, stdin=subprocess.DEVNULL, stdout=output,
                                                  stderr=output)

    def _answers(self, *command):
        for name, daemon in self.daemons.items():
            if daemon.poll() is not None:
                raise RuntimeError(f"{name} ended with {daemon.returncode}\n{self.logs()}")
        try:
            return self.client(*command)
        except (RuntimeError, subprocess.TimeoutExpired):
            return False

    def _all_idle(self):
        return (self._answers("sinfo", "--noheader", "--Node", "--format=%T") or "").split() == ["idle"] * len(self.nodes)

    def _tasks_of(self, node):
        """The batch shells of this cluster's node and all their child processes, found by their environment."""
        marks = {f"SLURMD_NODENAME={node}".encode(), f"SLURM_CONF={self.folder}/slurm.conf".encode()}
        return [pid for pid in processes.all_pids() if marks <= set(processes.environment_of(pid))]

    def _stop(self, names):
        daemons = [self.daemons.pop(name) for name in names if name in self.daemons]
        for daemon in daemons:
            daemon.terminate()
        for daemon in daemons:
            try:
                daemon.wait(8)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()
