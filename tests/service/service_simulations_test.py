#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests simulations, calibrations, models and examples of serve_pendulum: service_simulations_test.py PATH_OF_THE_TOOL."""

import json
import unittest

from service import DATASETS, RIG, Curl, flags_of, query_of, run_tool

SWING = {"set": "inertia=0.079,viscous=0.003,coulomb=0.004,release_angle=0.423,release_time=0.5"}


class Simulations(Curl):
    """A simulation equals the output of simulate_pendulum for the same flags."""

    CASES = (
        (False, {"set": "inertia=0.05,viscous=0.001,coulomb=0.002,release_angle=0.4,release_time=0.1"}),
        (True, {**SWING, "model": "coulomb", "duration": "8", "rate": "50", "noise": "0.3", "resolution": "0.1985", "seed": "7"}),
        (True, {**SWING, "range": "-49.6077,153.4578", "resolution": "0.1985", "jitter": "0.001", "start_time": "12.5",
                "unit": "rad"}),
        (True, {"model": "viscous", "gravity": "linear", "unit": "deg_s", "noise": "0.1", "noise_correlation": "0.5",
                "duration": "5",
                "set": "inertia=0.079,viscous=0.003,initial_angle=0.3,initial_rate=0.1"}),
        (False, {"model": "linear", "noise": "0.2", "noise_freedom": "4", "duration": "3", "rate": "200",
                 "set": "inertia=0.05,viscous=0.002,release_angle=0.4,release_time=0.1"}),
    )

    def expected(self, has_rig, options):
        code, _, said = run_tool("simulate_pendulum", *flags_of(options), *(["--rig", RIG] if has_rig else []), "--out",
                                 "expected.csv",
                                 "--truth", "truth.json", folder=self.folder)
        self.assertEqual(code, 0, said)
        return (self.folder / "expected.csv").read_text(), json.loads((self.folder / "truth.json").read_text())

    def test_simulations_equal_those_of_simulate_pendulum(self):
        for has_rig, options in self.CASES:
            with self.subTest(**options):
                recording, truth = self.expected(has_rig, options)
                rig = {"rig": json.loads(RIG.read_text())} if has_rig else {}
                answers = [self.post_value("/v1/simulations", {**options, **rig})]
                if not has_rig:
                    answers.append(self.curl("/v1/simulations?" + query_of(options), method="POST"))
                for answer in answers:
                    self.assertEqual((answer.status, answer.type), (200, "application/json"), answer)
                    self.assertEqual(answer.json(), {"recording": recording, "truth": truth})
                (self.folder / "request.json").write_text(json.dumps({**options, **rig}))
                alone = self.curl("/v1/simulations", "--data-binary", "@request.json", "-H", "Content-Type: application/json",
                                  "-H", "Accept: text/csv")
                self.assertEqual((alone.status, alone.type, alone.body.decode()), (200, "text/csv", recording))

    def test_values_may_be_json_numbers(self):
        recording, _ = self.expected(False, {**self.CASES[0][1], "duration": "2.5", "rate": "40", "seed": "3"})
        answer = self.post_value("/v1/simulations", {**self.CASES[0][1], "duration": 2.5, "rate": 40, "seed": 3})
        self.assertEqual(answer.json()["recording"], recording)

    def test_errors_equal_those_of_simulate_pendulum(self):
        for options in ({"model": "nothing"}, {"duration": "-1"}, {"rate": "0"}, {"set": "inertia=0.05"}, {"unit": "counts"},
                        {"noise": "-1"},
                        {"set": "mass=3"}, {"gravity": "none"}, {"set": "inertia=0.05,release_angle=0,release_time=0.1"}):
            with self.subTest(**options):
                options = {**SWING, **options}
                code, _, sentence = run_tool("simulate_pendulum", *flags_of(options), "--out", "-", folder=self.folder)
                self.assertIn(code, (2, 4, 5), sentence)
                self.check_same_problem(self.post_value("/v1/simulations", options), code, sentence)
        self.check_problem(self.post_value("/v1/simulations", {"ratee": "3"}), 400, "bad_request", "ratee.*did you mean.*rate")

    def test_a_too_large_simulation_is_refused(self):
        answer = self.post_value("/v1/simulations", {**SWING, "duration": "1e6", "rate": "1000"})
        self.check_problem(answer, 413, "too_large", "200000")

    def test_a_simulation_can_be_fitted(self):
        answer = self.post_value("/v1/simulations", {**SWING, "duration": "8"})
        (self.folder / "simulated.csv").write_text(answer.json()["recording"])
        self.assertEqual(self.post_file("/v1/fits?name=simulated.csv", "simulated.csv").body, self.fitted("simulated.csv"))


class Calibrations(Curl):
    """A calibration equals the output of calibrate_sensor for the same table."""

    def test_calibrations_equal_those_of_calibrate_sensor(self):
        for options in ({}, {"order": "1", "bits": "10"}, {"order": "2", "input_range": "0,1000"}, {"order": "3"}):
            with self.subTest(**options):
                code, text, said = run_tool("calibrate_sensor", "--details", "--data", "textbook_calibration.csv", *flags_of(options),
                                            "--json",
                                            "calibration.json", folder=self.folder)
                self.assertEqual(code, 0, said)
                answer = self.post_file("/v1/calibrations?" + query_of(options), "textbook_calibration.csv")
                self.assertEqual((answer.status, answer.type), (200, "application/json"), answer)
                value = answer.json()
                expected = json.loads((self.folder / "calibration.json").read_text())
                self.assertEqual(value["calibration"], expected)
                self.assertEqual(value["order"], int(options.get("order", 1)))
                self.assertEqual(without_table(value["text"]), without_table(text.decode()))
                self.check_points(value["points"], expected["coefficients"])

    def check_points(self, points, coefficients):
        table = [tuple(map(float, line.split(",")))
                 for line in (DATASETS / "textbook_calibration.csv").read_text().splitlines()[1:]]
        self.assertEqual([(point["reading"], point["angle"]) for point in points], table)
        for point in points:
            fitted = sum(each * point["reading"] ** power for power, each in enumerate(coefficients))
            self.assertAlmostEqual(point["fitted"], fitted, places=8)
            self.assertAlmostEqual(abs(point["residual"]), abs(point["angle"] - fitted), places=8)
            self.assertLess(abs(point["residual"]), abs(point["left_out"]))

    def test_tables_that_cannot_be_used(self):
        tables = {"words.csv": "counts,angle_deg\n1,x\n2,3\n", "time.csv": "time_s,angle_deg\n0,1\n1,2\n",
                  "one.csv": "counts,angle_deg\n5,1\n",
                  "empty.csv": "\n"}
        for name, table in tables.items():
            with self.subTest(name=name):
                (self.folder / name).write_text(table)
                code, _, sentence = run_tool("calibrate_sensor", "--data", name, folder=self.folder)
                problem = self.check_problem(self.post_file("/v1/calibrations", name), 422, "unusable_data")
                self.assertEqual(problem["exit_code"], code)
                # Only the sentences are compared, because the service does not know the name of the table.
                self.assertEqual(problem["detail"].partition(": ")[2], sentence.partition(": ")[2])

    def test_invalid_flags(self):
        for options in ({"order": "0"}, {"order": "9"}, {"order": "x"}, {"bits": "77"}, {"input_range": "3,1"},
                        {"bits": "8", "input_range": "0,255"}):
            with self.subTest(**options):
                code, _, sentence = run_tool("calibrate_sensor", "--details", "--data", "textbook_calibration.csv", *flags_of(options),
                                             folder=self.folder)
                self.check_same_problem(self.post_file("/v1/calibrations?" + query_of(options), "textbook_calibration.csv"), code,
                                        sentence)
        self.check_problem(self.post_file("/v1/calibrations?ordre=2", "textbook_calibration.csv"), 400, "bad_request",
                           "ordre.*order")


def without_table(text):
    """The printed text without the line that names the table."""
    return [line for line in text.splitlines() if not line.strip().startswith("table ")]


class Knowledge(Curl):
    """The service's information about itself: models, examples, health."""

    def test_models_are_those_of_the_command_line(self):
        _, out, _ = run_tool("fit_pendulum", "--help", folder=self.folder)
        listed = " ".join(out.decode().split()).partition("Model of the friction: one of ")[2].partition("; several")[0].split(", ")
        models = self.curl("/v1/models").json()["models"]
        self.assertEqual([model["name"] for model in models], listed)
        by_name = {model["name"]: model for model in models}
        for model in models:
            self.assertEqual(set(model), {"name", "label", "about", "gravity", "equation", "nested_in", "parameters"})
            fit = json.loads(self.fitted("coulomb.csv", "--model", model["name"], "--rig", RIG, "--interval",
                                         "covariance"))["fits"][0]
            for parameter in model["parameters"]:
                self.assertEqual(set(parameter), {"name", "symbol", "unit", "lower", "upper"})
                self.assertIn(parameter["name"], fit["parameters"])
                self.assertEqual(parameter["unit"], fit["parameters"][parameter["name"]]["unit"])
            self.assertLessEqual(set(model["nested_in"]), set(listed))
        self.assertIn("coulomb", by_name["viscous"]["nested_in"])  # with a dry friction of 0
        self.assertIn("drag", by_name["coulomb"]["nested_in"])
        self.assertNotIn("viscous", by_name["coulomb"]["nested_in"])

    def test_every_example_can_be_fitted(self):
        examples = self.curl("/v1/examples").json()["examples"]
        self.assertGreater(len(examples), 1)
        for listed in examples:
            with self.subTest(listed["name"]):
                self.assertEqual(set(listed), {"name", "title", "about", "models", "has_rig"})
                example = self.curl(f"/v1/examples/{listed['name']}").json()
                self.assertEqual(set(example), {"name", "title", "about", "models", "recording", "rig"})
                self.assertEqual(example["rig"] is not None, listed["has_rig"])
                (self.folder / "example.csv").write_text(example["recording"])
                models = example["models"] if isinstance(example["models"], str) else ",".join(example["models"])
                answer = self.post_value("/v1/fits",
                                         {"data": example["recording"], "rig": example["rig"], "options": {"model": models}})
                flags = ["--model", models]
                if example["rig"]:
                    (self.folder / "example.json").write_text(json.dumps(example["rig"]))
                    flags += ["--rig", "example.json"]
                self.assertEqual((answer.status, answer.body), (200, self.fitted("example.csv", *flags)))
        self.check_problem(self.curl("/v1/examples/none"), 404, "not_found", "none")

    def test_health_reports_the_version(self):
        _, out, _ = run_tool(self.server.process.args[0].name, "--version", folder=self.folder)
        self.assertEqual(self.curl("/healthz").json(), {"status": "ok", "version": out.decode().split()[1]})

    def test_there_is_no_live_recording_without_the_flag(self):
        for target in ("/v1/live", "/v1/live/events", "/v1/live/recording"):
            self.check_problem(self.curl(target), 404, "not_found", "--live")


if __name__ == "__main__":
    unittest.main()
