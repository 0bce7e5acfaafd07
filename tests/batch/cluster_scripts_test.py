#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests scripts/cluster without a cluster: refused input, the chosen tool, the arguments of sbatch, and the work of a task.

Slurm's commands and refit_pendulums are replaced by programs that record their arguments.
"""

import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts/cluster"
REQUEST = ["--manifest", "runs.csv", "--models", "viscous,coulomb", "--store", "all.sqlite", "--shards", "8"]
NEEDED = ["awk", "bash", "dirname", "env", "mkdir", "mv", "nproc", "readlink", "rm", "sed", "sha256sum",
          "sleep", "stat"]

RECORDER = """#!/bin/bash
{{ printf '%s' "${{0##*/}}"; printf '|%s' "$@"; echo; }} >> "$CALLS"
{}
"""
TOOL = """
if [[ $1 == --version ]]; then echo "refit_pendulums $VERSION"; exit; fi
if [[ $1 == missing ]]; then echo "$MISSING"; exit; fi
if [[ $1 == merge || -z $STOPPABLE ]]; then exit "${CODE:-0}"; fi
trap 'kill $!; exit 75' TERM
: > started
sleep 30 &
wait
"""


class ScriptCase(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory())) / 'it\'s "one" rig, 100 %a'
        self.programs = self.folder / "programs"
        self.programs.mkdir(parents=True)
        for name in NEEDED:
            (self.programs / name).symlink_to(shutil.which(name))
        self.calls = self.folder / "calls"
        self.tool = self.make("refit_pendulums", TOOL)
        (self.folder / "runs.csv").write_text("path,id\n", encoding="utf-8")
        self.environment = {"PATH": str(self.programs), "CALLS": str(self.calls), "MISSING": "0,1,2,5",
                            "REFIT_PENDULUMS": str(self.tool)}

    def make(self, name, body, folder=None):
        path = (folder or self.programs) / name
        path.write_text(RECORDER.format(body), encoding="utf-8")
        path.chmod(0o755)
        return path

    def command(self, script, *arguments, **environment):
        return {"args": [SCRIPTS / script, *arguments], "cwd": self.folder, "env": self.environment | environment,
                "text": True, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "stdin": subprocess.DEVNULL}

    def run_script(self, script, *arguments, **environment):
        return subprocess.run(**self.command(script, *arguments, **environment), timeout=30, check=False)

    def called(self, name):
        """The arguments of each call of a program."""
        lines = self.calls.read_text(encoding="utf-8").splitlines() if self.calls.exists() else []
        return [words[1:] for words in (line.split("|") for line in lines) if words[0] == name]


class RefusalTest(ScriptCase):
    def refuse(self, code, sentence, *arguments, script="refit_slurm", **environment):
        done = self.run_script(script, *arguments, **environment)
        self.assertEqual((done.returncode, done.stdout), (code, ""), done.stderr)
        self.assertEqual(done.stderr, f"{script}: {sentence}\n")
        self.assertEqual(self.called("sbatch"), [])

    def test_wrong_options(self):
        for script in ("refit_slurm", "refit_parallel"):
            self.refuse(2, "there is no option '--fast'; --help names those there are.", "--fast", script=script)
            self.refuse(2, "there is no option '--fast'; --help names those there are.", "--fast=1", script=script)
            self.refuse(2, "'stray' belongs to no option.", *REQUEST, "stray", script=script)
            self.refuse(2, "--shards is without its value.", *REQUEST[:-1], script=script)
            self.refuse(2, "--shards is '0'; it is a whole number from 1.", *REQUEST, "--shards=0", script=script)
            self.refuse(2, "--cpus is 'many'; it is a whole number from 1.", *REQUEST, "--cpus", "many", script=script)
            self.refuse(2, "--all takes no value.", *REQUEST, "--all=yes", script=script)
            self.refuse(2, "-force stands behind --, but is not for you to give there.", *REQUEST, "--", "-force",
                        script=script)
            self.refuse(2, "--store=x stands behind --, but is not for you to give there.", *REQUEST, "--", "--store=x",
                        script=script)
            for position, name in ((0, "--manifest"), (2, "--models"), (4, "--store"), (6, "--shards")):
                self.refuse(2, f"{name} is missing.", *REQUEST[:position], *REQUEST[position + 2:], script=script)
        self.refuse(2, "there is no option '--jobs'; --help names those there are.", *REQUEST, "--jobs", "2")
        self.refuse(2, "--jobs is '-1'; it is a whole number from 1.", *REQUEST, "--jobs", "-1", script="refit_parallel")

    def test_files_and_folders(self):
        self.refuse(3, f"{self.folder}/none.csv cannot be read; check the path.", *REQUEST, "--manifest", "none.csv")
        self.refuse(3, f"{self.folder}/programs cannot be read; check the path.", *REQUEST, "--manifest", "programs")
        self.refuse(73, f"{self.folder}/none/all.sqlite cannot be written; there is no such folder.", *REQUEST, "--store",
                    "none/all.sqlite")
        self.refuse(73, f"{self.folder}/runs.csv cannot be made; check the path and its permissions.", *REQUEST, "--dir",
                    "runs.csv")

    def test_missing_programs(self):
        self.refuse(69, "there is no sbatch here; give this command on a node from which jobs are submitted, or use "
                    "refit_parallel.", *REQUEST)
        self.refuse(69, "there is no GNU parallel here; Debian has it as parallel.", *REQUEST, script="refit_parallel")
        self.make("parallel", "echo 'parallel [OPTIONS] command -- arguments' >&2; exit 1")
        self.refuse(69, "there is no GNU parallel here; Debian has it as parallel.", *REQUEST, script="refit_parallel")
        self.make("sbatch", "echo 7")
        self.refuse(69, "REFIT_PENDULUMS is 'nowhere', which is no program.", *REQUEST, REFIT_PENDULUMS="nowhere")
        self.tool.unlink()

    def test_help_goes_to_stdout(self):
        for script in ("refit_slurm", "refit_parallel"):
            done = self.run_script(script, "--help")
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertRegex(done.stdout, rf"(?s)^Fits all recordings.*\n  {script} --manifest .*Exit codes: 0\s[^#]*\.\n$")


class SubmissionTest(ScriptCase):
    def submit(self, *arguments, **environment):
        done = self.run_script("refit_slurm", *REQUEST, *arguments, **environment)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return done.stdout

    def test_submits_an_array_of_missing_shards_and_then_a_merge(self):
        self.make("sbatch", 'echo "7;cluster"')
        printed = self.submit("--dir", "out", "--cpus", "3", "--time", "1-0", "--", "--checkpoint_s", "9")
        self.assertEqual(printed, f"7 fits shards 0-2,5 of 8\n7 merges them into {self.folder}/all.sqlite\n")
        fits, merge = self.called("sbatch")
        pattern = str(self.folder).replace("%", "%%")
        at = fits.index(str(SCRIPTS / "refit_task"))
        self.assertLessEqual({"--array=0-2,5", "--cpus-per-task=3", "--time=1-0", "--requeue", "--open-mode=append",
                              "--signal=B:TERM@60", f"--output={pattern}/out/logs/shard-%a.log"}, set(fits[:at]))
        self.assertEqual(fits[at + 1:], [str(SCRIPTS), "shard", f"{self.folder}/out", "8", str(self.tool), "--manifest",
                                         f"{self.folder}/runs.csv", "--models", "viscous,coulomb", "--checkpoint_s", "9"])
        at = merge.index(str(SCRIPTS / "refit_task"))
        self.assertLessEqual({"--dependency=afterok:7", "--kill-on-invalid-dep=yes"}, set(merge[:at]))
        self.assertEqual(merge[at + 1:], [str(SCRIPTS), "merge", f"{self.folder}/out", "8", str(self.tool), "--store",
                                          f"{self.folder}/all.sqlite"])

    def test_submits_only_the_merge_if_no_shard_is_missing(self):
        self.make("sbatch", "echo 8")
        self.assertEqual(self.submit(MISSING=""), f"8 merges them into {self.folder}/all.sqlite\n")
        (merge,) = self.called("sbatch")
        self.assertFalse([flag for flag in merge if flag.startswith(("--array", "--dependency"))])

    def test_shards_of_another_request_become_checkpoints(self):
        self.make("sbatch", "echo 8")
        folder = self.folder / "out"
        shard, checkpoint = folder / "shard-3.sqlite", folder / "shard-3.sqlite.part"

        def check(is_kept, *flags, **environment):
            self.environment |= environment
            self.submit("--dir", "out", *flags)
            self.assertEqual((shard.exists(), checkpoint.exists()), (is_kept, not is_kept))
            checkpoint.unlink(missing_ok=True)
            shard.touch()

        folder.mkdir()
        shard.touch()
        check(False)  # the request is unknown
        check(True)
        check(False, "--all")
        check(True)
        check(False, VERSION="2")
        check(True)
        check(False, "--models", "drag")
        check(True, "--models", "drag")
        check(False, "--", "--noise", "gaussian")
        (self.folder / "runs.csv").write_text("path,id\na.csv,a\n", encoding="utf-8")
        check(False, "--", "--noise", "gaussian")
        check(True, "--", "--noise", "gaussian")

    def test_sbatch_refuses(self):
        self.make("sbatch", "echo 'sbatch: error: invalid partition' >&2; exit 1")
        done = self.run_script("refit_slurm", *REQUEST)
        self.assertEqual(done.returncode, 75)
        self.assertEqual(done.stderr, "sbatch: error: invalid partition\n"
                         "refit_slurm: sbatch has not taken the job refit_shards; see above.\n")

    def test_finds_the_tool_next_to_the_scripts_or_on_the_path(self):
        self.make("sbatch", "echo 8")
        del self.environment["REFIT_PENDULUMS"]
        for scripts, tool in (("share/pendulum", "bin"), ("share", "bin"), ("a/b", "a/b/programs")):
            top = self.folder / scripts.replace("/", "_")
            shutil.copytree(SCRIPTS, top / scripts)
            (top / tool).mkdir()
            tool = self.make("refit_pendulums", TOOL, top / tool)
            link = top / "link"
            link.symlink_to(top / scripts / "refit_slurm")
            self.calls.unlink(missing_ok=True)
            path = f"{tool.parent}:{self.programs}" if tool.parent.name == "programs" else str(self.programs)
            done = subprocess.run([link, *REQUEST], cwd=self.folder, env=self.environment | {"PATH": path},
                                  capture_output=True, text=True, timeout=30, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(str(tool), self.called("sbatch")[0])


class TaskTest(ScriptCase):
    """Tests refit_task in the environment of Slurm. squeue prints $STATE; scontrol terminates the task as a requeue does."""

    def setUp(self):
        super().setUp()
        self.make("squeue", 'echo "$STATE"')
        self.make("scontrol", "kill $PPID")  # a requeued job is terminated
        self.environment |= {"SLURM_ARRAY_JOB_ID": "7", "SLURM_ARRAY_TASK_ID": "3", "SLURM_JOB_ID": "12",
                             "SLURM_CPUS_PER_TASK": "2", "STATE": "RUNNING"}
        self.arguments = ["refit_task", SCRIPTS, "shard", self.folder, "8", self.tool, "--models", "viscous"]
        self.shard = ["--models", "viscous", "--shard", "3/8", "--store", f"{self.folder}/shard-3.sqlite", "--threads", "2"]

    def test_a_shard_and_a_merge(self):
        self.assertEqual(self.run_script(*self.arguments).returncode, 0)
        self.assertEqual(self.called("refit_pendulums"), [self.shard])
        self.calls.unlink()
        self.run_script("refit_task", SCRIPTS, "merge", self.folder, "8", self.tool, "--store", "all.sqlite")
        self.assertEqual(self.called("refit_pendulums"),
                         [["merge", "--shard_dir", str(self.folder), "--shard_count", "8", "--store", "all.sqlite"]])

    def test_uses_a_scratch_folder_only_on_another_disk(self):
        self.run_script(*self.arguments, TMPDIR=str(self.programs))
        self.run_script(*self.arguments, TMPDIR="/nowhere")
        self.assertEqual(self.called("refit_pendulums"), [self.shard, self.shard])
        other = "/dev/shm"
        if not os.access(other, os.W_OK) or os.stat(other).st_dev == os.stat(self.folder).st_dev:
            self.skipTest(f"{other} is not another disk")
        self.run_script(*self.arguments, TMPDIR=other)
        self.assertEqual(self.called("refit_pendulums")[2], [*self.shard, "--scratch", other])

    def test_does_not_requeue_after_another_exit_code(self):
        self.assertEqual(self.run_script(*self.arguments, CODE="5").returncode, 5)
        self.assertEqual(self.called("scontrol"), [])

    def test_requeues_a_running_task_at_most_three_times(self):
        for count, state, again in (("0", "RUNNING", True), ("2", "RUNNING", True), ("3", "RUNNING", False),
                                    ("0", "COMPLETING", False), ("0", "", False)):
            self.calls.unlink(missing_ok=True)
            done = self.run_script(*self.arguments, CODE="75", SLURM_RESTART_COUNT=count, STATE=state)
            self.assertEqual(self.called("scontrol"), [["requeue", "7_3"]] if again else [])
            self.assertEqual(done.returncode, -signal.SIGTERM if again else 75)

    def test_returns_75_if_the_requeue_fails(self):
        self.make("scontrol", "exit 1")
        self.assertEqual(self.run_script(*self.arguments, CODE="75").returncode, 75)

    def test_passes_a_signal_to_the_tool_and_waits_for_it(self):
        task = subprocess.Popen(**self.command(*self.arguments, STOPPABLE="1"))
        self.addCleanup(task.communicate)
        self.addCleanup(task.kill)
        for _ in range(400):
            if (self.folder / "started").exists():
                break
            time.sleep(0.05)
        task.terminate()
        self.assertEqual(task.wait(20), -signal.SIGTERM)
        self.assertEqual(self.called("scontrol"), [["requeue", "7_3"]])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])  # unittest must not parse the tool's path, which every process test gets
