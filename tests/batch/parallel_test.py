#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests refit_parallel with GNU parallel, a crashed task and a stop: parallel_test.py PATH_OF_refit_pendulums.

simulate_pendulum is taken from the same folder. Exit code 77 if GNU parallel is not installed.
"""

import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

import processes
import refit_case

SHARDS = 4

# Replaces ssh: it passes the command to a shell of this machine.
FAKE_SSH = """#!/bin/bash
while [[ $1 == -* ]]; do shift; done
echo "$1" >> "$SSH_LOG"
shift
if [[ $1 == -- ]]; then shift; fi
exec bash -c "$*"
"""


class ParallelTest(refit_case.RefitCase):
    COUNT = 120

    def setUp(self):
        super().setUp()
        self.environment = dict(os.environ, REFIT_PENDULUMS=str(self.TOOL))

    def refit(self, *flags, **options):
        return self.script("refit_parallel", *self.request(SHARDS), "--jobs", "2", *flags,
                           env=self.environment | options.pop("env", {}), **options)

    def start(self):
        process = subprocess.Popen([refit_case.SCRIPTS / "refit_parallel", *self.request(SHARDS), "--jobs", "2"],
                                   cwd=self.folder, env=self.environment, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.terminate)
        return process

    def test_repeats_a_crashed_task(self):
        alone = self.start_of_one_process()
        run = self.start()
        _, work = self.hold_shard()
        processes.kill(work)
        self.assertEqual(run.wait(60), 0, run.stdout.read())
        self.check_store(SHARDS)
        self.assertEqual(refit_case.rows(self.store), refit_case.rows(self.store_of_one_process(alone)))

    def test_continues_after_a_stop(self):
        run = self.start()
        shard, work = self.hold_shard()
        processes.kill(work, signal.SIGCONT)  # a stopped process would get SIGHUP when its shell ends
        run.terminate()
        self.assertEqual(run.wait(30), 75)
        self.assertIn("refit_parallel: stopped; the same command again goes on.", run.stdout.read())
        self.assertEqual(refit_case.work_on(self.shards / f"shard-{shard}.sqlite"), [])
        self.assertTrue((self.shards / f"shard-{shard}.sqlite.part").exists())
        self.refit()
        self.check_store(SHARDS)

    def test_fits_only_missing_shards(self):
        self.refit()
        before = refit_case.rows(self.store)
        (self.shards / "shard-2.sqlite").unlink()
        self.store.unlink()
        self.assertIn("fits shards 2 of 4", self.refit())
        self.check_store(SHARDS)
        self.assertEqual(refit_case.rows(self.store), before)
        self.assertNotIn("fits", self.refit())

    def test_makes_no_store_if_every_task_fails(self):
        self.assertIn("refit_parallel: shards 0-3 of 4 are missing; ", self.refit("--models", "nonsense", code=1))
        self.assertIn("nonsense", self.log(0))
        self.assertFalse(self.store.exists())

    def test_fits_on_other_hosts(self):
        # GNU parallel uses this path as a part of a command.
        ssh = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="ssh-", dir="/tmp"))) / "ssh"
        ssh.write_text(FAKE_SSH, encoding="utf-8")
        ssh.chmod(0o755)
        log = self.folder / "hosts"
        self.refit("--hosts", "left,right", env={"PARALLEL_SSH": str(ssh), "SSH_LOG": str(log)})
        self.check_store(SHARDS)
        self.assertLessEqual({"left", "right"}, set(log.read_text(encoding="utf-8").split()))


if __name__ == "__main__":
    refit_case.skip_without([] if shutil.which("parallel") else ["parallel"])
    refit_case.RefitCase.TOOL = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
