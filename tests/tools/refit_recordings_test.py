# SPDX-License-Identifier: Apache-2.0
"""Recordings from other sources, fitted by one command: refit_recordings_test.py PATH_OF_THE_TOOL.

PENDULUM_RECORDINGS names their folder; without it the test is skipped.
"""

import os
import pathlib
import shutil
import unittest

from refit_lab import Lab

MANY = 16


@unittest.skipUnless(os.environ.get("PENDULUM_RECORDINGS"), "PENDULUM_RECORDINGS names no folder of recordings")
class RealRecordings(Lab):
    """One command for a folder of recordings from other sources, some of which cannot be fitted unchanged."""

    def test_a_folder_gives_a_table(self):
        recordings = self.folder / "recordings"
        recordings.mkdir()
        # The smallest ones; recordings_test also fits larger ones individually.
        smallest = sorted(pathlib.Path(os.environ["PENDULUM_RECORDINGS"]).glob("*.csv"), key=lambda path: path.stat().st_size)
        for path in smallest[:MANY]:
            shutil.copy(path, recordings)
        self.run_tool("--data", recordings, "--models", "viscous,coulomb", "--store", "a.sqlite")
        stored = self.rows("a.sqlite")
        runs = {pathlib.Path(key[1]).stem: row for key, row in stored.items() if key[0] == "runs"}
        self.assertEqual(sorted(runs), sorted(path.stem for path in recordings.glob("*.csv")))
        self.assertEqual(sum(key[0] == "fits" for key in stored), 2 * len(runs))
        self.assertGreater(sum(row["exit_code"] == 0 for row in runs.values()), len(runs) / 2)
        for name, row in runs.items():
            self.assertTrue(row["result"] or row["reason"], name)
        # These models cannot use volts without a calibration, nor uncalibrated counts.
        self.assertIn("needs an angle", runs["cubli_PRINT_00"]["reason"])
        self.assertIn("coulomb", self.run_tool("status", "--store", "a.sqlite")[0])


if __name__ == "__main__":
    unittest.main()
