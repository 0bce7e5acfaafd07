#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests refit_slurm on a real Slurm of three nodes, one of which fails: slurm_test.py PATH_OF_refit_pendulums.

simulate_pendulum is taken from the same folder. Exit code 77 if Slurm is not installed.
"""

import pathlib
import signal
import sys
import tempfile
import unittest

import processes
import refit_case
import slurm_cluster

SHARDS = 6


class SlurmTest(refit_case.RefitCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        # Paths of sockets must be short; $TMPDIR may be too long.
        folder = cls.enterClassContext(tempfile.TemporaryDirectory(prefix="slurm-", dir="/tmp"))
        cls.cluster = cls.enterClassContext(slurm_cluster.SlurmCluster(folder, nodes=3))
        cls.environment = dict(cls.cluster.environment, REFIT_PENDULUMS=str(cls.TOOL))

    def refit(self, *flags):
        """(job of the array or None, job of the merge) submitted by refit_slurm."""
        printed = self.script("refit_slurm", *self.request(SHARDS), "--cpus", "1", *flags, env=self.environment)
        *fits, merge = [line.split()[0] for line in printed.splitlines()]
        return fits[0] if fits else None, merge

    def wait_for_end(self, fits, merge):
        try:
            self.cluster.wait_for_end([fits, merge], 60)
        except TimeoutError:
            self.fail(f"{self.cluster.queue()}\n{self.cluster.logs()}")

    def states(self, fits, count=SHARDS):
        return [self.cluster.job(f"{fits}_{task}")["JobState"] for task in range(count)]

    def hold_shard_of(self, fits, node):
        def tasks():
            return [task for (job, task), place in self.cluster.queue().items()
                    if job == fits and place == ("RUNNING", node)]

        return self.hold_shard(tasks)

    def test_fits_every_run_once_although_a_node_fails_and_a_task_is_stopped(self):
        alone = self.start_of_one_process()
        fits, merge = self.refit()
        (lost, _), (stopped, work) = self.hold_shard_of(fits, "n2"), self.hold_shard_of(fits, "n3")
        self.cluster.kill_node("n2")
        self.assertFalse((self.shards / f"shard-{lost}.sqlite").exists())
        self.cluster.terminate_task(f"{fits}_{stopped}", lambda: processes.continue_when_signalled(work))
        sentence = f"refit_task: {fits}_{stopped} was stopped before its end and goes back into the queue"
        self.wait_for_end(fits, merge)

        self.assertEqual(self.states(fits), ["COMPLETED"] * SHARDS, self.cluster.logs())
        self.assertEqual(self.cluster.job(merge)["JobState"], "COMPLETED")
        self.assertIn(sentence, self.log(stopped))
        for task in (lost, stopped):
            self.assertGreaterEqual(int(self.cluster.job(f"{fits}_{task}")["Restarts"]), 1)
        self.check_store(SHARDS)
        expected = refit_case.rows(self.store_of_one_process(alone))
        self.assertEqual(refit_case.rows(self.store), expected)

        (self.shards / "shard-4.sqlite").unlink()
        self.store.unlink()
        fits, merge = self.refit()
        self.assertEqual([task for job, task in self.cluster.queue() if job == fits], ["4"])
        self.wait_for_end(fits, merge)
        self.check_store(SHARDS)
        self.assertEqual(refit_case.rows(self.store), expected)

        self.assertIsNone(self.refit()[0])

    def test_a_cancelled_job_stays_cancelled_until_the_next_request(self):
        fits, merge = self.refit()
        shard, work = self.hold_shard_of(fits, "n1")
        self.cluster.client("scancel", fits)
        processes.continue_when_signalled(work)
        self.wait_for_end(fits, merge)
        self.assertIn("CANCELLED", self.states(fits))
        self.assertEqual(self.cluster.job(merge)["JobState"], "CANCELLED")
        self.assertNotIn("goes back", self.log(shard))
        self.assertFalse(self.store.exists())
        self.wait_for_end(*self.refit())
        self.check_store(SHARDS)


if __name__ == "__main__":
    refit_case.skip_without(slurm_cluster.missing_programs())
    refit_case.RefitCase.TOOL = pathlib.Path(sys.argv.pop(1)).resolve()
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        unittest.main()
    finally:
        SlurmTest.doClassCleanups()  # unittest skips this after an interruption
