#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests serve_pendulum with curl and compares it with the command line: service_clients_test.py PATH_OF_THE_TOOL."""

import hashlib
import json
import math
import re
import shutil
import unittest

from service import CALIBRATION, DATASETS, RIG, Curl, flags_of, in_counts, query_of, run_tool

DEGREES = {"deg": 1, "rad": math.degrees(1)}  # per unit of the samples
COULOMB = (DATASETS / "coulomb.csv").read_bytes()


class SameAsFitPendulum(Curl):
    """The answer equals the command line's JSON byte for byte except for the path, for every way to send a recording."""

    CASES = (
        ("coulomb.csv", None, None, {}),
        ("coulomb.csv", "textbook_rig.json", None, {"model": "viscous,coulomb"}),
        ("textbook_rig.csv", "textbook_rig.json", None, {"model": "viscous", "noise": "gaussian", "seed": "7"}),
        ("excel_export.csv", None, None, {"model": "linear", "interval": "covariance"}),
        ("recorded.csv", "recorded_rig.json", None, {"start": "release", "release": "1"}),
        ("runs_1.csv", "textbook_rig.json", None, {"from": "1", "to": "12.5", "fix": "zero_angle=0", "bounds": "coulomb=0:0.1"}),
        ("runs_1.csv", "textbook_rig.json", None, {"prior": "inertia=0.079:0.001", "init": "viscous=0.004", "loss": "huber"}),
        ("to_rest.csv", "textbook_rig.json", None, {"closed_form_only": "true"}),
        ("counts.csv", None, "potentiometer_calibration.json", {"resolution": "0.1985", "range": "0,1023"}),
        ("counts.csv", None, None, {"model": "linear", "time_column": "time_s", "value_column": "2", "unit": "counts"}),
    )

    def test_results_equal_those_of_fit_pendulum(self):
        for name, rig, calibration, options in self.CASES:
            with self.subTest(name=name, **options):
                files = {"rig": rig, "calibration": calibration}
                given = {key: value for key, value in files.items() if value}
                plain = {key: value for key, value in options.items() if key != "closed_form_only"}
                expected = self.fitted(name, *flags_of(plain), *flags_of(given),
                                       *(["--closed_form_only"] if "closed_form_only" in options else []))
                (self.folder / "options.json").write_text(json.dumps(options))
                parts = [argument for key, file in (("data", name), *given.items()) for argument in ("-F", f"{key}=@{file}")]
                answers = [self.curl("/v1/fits", *parts, "-F", "options=@options.json;type=application/json"),
                           self.curl("/v1/fits?" + query_of(options), *parts),
                           self.post_value("/v1/fits", {
                               "data": (self.folder / name).read_bytes().decode(), "options": options, "name": name,
                               **{key: json.loads((self.folder / file).read_text()) for key, file in given.items()}})]
                if not given:
                    answers += [self.post_file(f"/v1/fits?{query_of(options)}", name, content_type)
                                for content_type in ("text/csv; charset=utf-8", "text/plain", "application/octet-stream")]
                for answer in answers:
                    self.assertEqual(answer.status, 200, answer)
                    self.assertEqual(answer.type, "application/json")
                    self.assertEqual(answer.body, expected)
                    self.assertEqual(self.curl(answer.headers["location"]).body, expected)

    def test_options_may_be_numbers_and_flags_may_be_spelled_models(self):
        expected = self.fitted("runs_1.csv", "--from", "1.5", "--seed", "3", "--model", "viscous")
        data = (self.folder / "runs_1.csv").read_text()
        answer = self.post_value("/v1/fits", {"data": data, "rig": None,
                                              "options": {"from": 1.5, "seed": 3, "models": "viscous"}})
        self.assertEqual((answer.status, answer.body), (200, expected))
        answer = self.post_value("/v1/fits", {"data": data, "options": {"closed_form_only": True}})
        self.assertEqual(answer.body, self.fitted("runs_1.csv", "--closed_form_only"))

    def test_files_equal_those_of_fit_pendulum(self):
        flags = ["--model=viscous,coulomb", "--rig", "textbook_rig.json"]
        self.fitted("coulomb.csv", *flags, "--series", "series", "--residuals", "residuals", "--markdown", "markdown",
                    "--report", "report")
        answer = self.curl("/v1/fits?model=viscous,coulomb", "-F", "data=@coulomb.csv", "-F", "rig=@textbook_rig.json")
        place = answer.headers["location"]
        types = {"series": "application/json", "residuals": "text/csv", "markdown": "text/markdown"}
        for name, content_type in types.items():
            got = self.curl(f"{place}/{name}")
            self.assertEqual((got.status, got.type), (200, content_type), name)
            self.assertEqual(got.body, (self.folder / name).read_bytes(), name)
        report = self.curl(f"{place}/report")
        self.assertEqual((report.status, report.type), (200, "text/html"))
        self.assertIn("attachment", report.headers["content-disposition"])
        self.assertEqual(without_command(report.body), without_command((self.folder / "report").read_bytes()))


def without_command(page):
    """A report without the command and the path, which depend on the request."""
    page, count = re.subn(rb'(id="command">).*?(</script>)', rb"\1\2", page, flags=re.DOTALL)
    assert count == 1
    return re.sub(rb'"path":(?:null|"coulomb\.csv")', b'"path":', page)


class SameSentences(Curl):
    """An error has the sentence and the exit code of the command line."""

    def check_mistake(self, name, **options):
        exit_code, _, sentence = run_tool("fit_pendulum", "--data", name, *flags_of(options), "--json", "-", folder=self.folder)
        self.assertIn(exit_code, (2, 4, 5), sentence)
        answer = self.post_file("/v1/fits?" + query_of({"name": name, **options}), name)
        self.check_same_problem(answer, exit_code, sentence)
        self.check_same_problem(self.curl("/v1/fits", "-F", f"data=@{name}", "-F", "options=" + json.dumps(options)), exit_code,
                                sentence)

    def test_recordings_that_cannot_be_used(self):
        rows = "".join(f"{i / 10:.1f},{i}\n" for i in range(20))
        recordings = {"word.csv": "time_s,angle_deg\n0,1\n0.1,x\n", "empty.csv": "\n",
                      "back.csv": "time_s,angle_deg\n" + rows + rows,
                      "no_header.csv": rows, "short.csv": "time_s,angle_deg\n0,1\n0.1,2\n",
                      "column.csv": "time_s,weight_kg\n" + rows,
                      "constant.csv": "time_s,angle_deg\n" + "".join(f"{i / 100},12.5\n" for i in range(500)),
                      "counts_only.csv": in_counts(COULOMB.decode()), "equal.csv": "time_s,angle_deg\n" + "0,1\n" * 30}
        for name, text in recordings.items():
            with self.subTest(name=name):
                (self.folder / name).write_text(text)
                self.check_mistake(name)

    def test_invalid_flags(self):
        for options in ({"model": "nothing"}, {"unit": "counts"}, {"interval": "x"}, {"range": "3"}, {"fix": "inertia"},
                        {"fix": "mass=3"}, {"init": "inertia=x"}, {"from": "x"}, {"noise": "pink"}, {"seed": "-3"},
                        {"model": "coulomb,coulomb"}, {"start": "late"}, {"release": "0"}, {"release": "9"}, {"from": "100"},
                        {"bounds": "inertia=3:1"}, {"prior": "inertia=1"}, {"from": "5", "to": "2"},
                        {"loss": "huber", "noise": "quantized"}, {"value_column": "9"}, {"sample_rate_hz": "-1"}):
            with self.subTest(**options):
                self.check_mistake("coulomb.csv", **options)

    def test_flags_that_contradict_the_closed_forms(self):
        exit_code, _, sentence = run_tool("fit_pendulum", "--data", "coulomb.csv", "--closed_form_only", "--interval",
                                          "bootstrap",
                                          folder=self.folder)
        self.check_same_problem(self.post_file("/v1/fits?closed_form_only=true&interval=bootstrap&name=coulomb.csv",
                                               "coulomb.csv"),
                                exit_code, sentence)

    def test_rigs_and_calibrations_that_cannot_be_used(self):
        cases = {"rig": ('{"bob_mas": 3}', '{"gravity_torque": -1}', '{"gravity_torque": "x"}', "[]", '{"bob_mass": 1', "{}"),
                 "calibration": ('{"input": "counts"}',
                                 '{"schema_version": 1, "input": "counts", "angle_unit": "deg", "coefficients": [1]}')}
        for key, texts in cases.items():
            for text in texts:
                with self.subTest(key=key, text=text):
                    file = f"{key}.json"
                    (self.folder / file).write_text(text)
                    exit_code, _, sentence = run_tool("fit_pendulum", "--data", "counts.csv", f"--{key}", file, "--json", "-",
                                                      folder=self.folder)
                    self.check_same_problem(self.curl("/v1/fits", "-F", "data=@counts.csv", "-F", f"{key}=@{file}"), exit_code,
                                            sentence)

    def test_a_calibration_of_degrees_is_refused(self):
        exit_code, _, sentence = run_tool("fit_pendulum", "--data", "coulomb.csv", "--calibration", CALIBRATION,
                                          folder=self.folder)
        self.check_same_problem(self.curl("/v1/fits", "-F", "data=@coulomb.csv", "-F", f"calibration=@{CALIBRATION}"), exit_code,
                                sentence)

    def test_unknown_parameters_are_refused_with_the_nearest_name(self):
        for target in ("/v1/fits?modle=linear", "/v1/fits?moddel=linear&name=a.csv"):
            self.check_problem(self.post_file(target, "coulomb.csv"), 400, "bad_request", r"mod\w+.*did you mean.*model")
        self.check_problem(self.post_value("/v1/fits", {"data": COULOMB.decode(), "options": {"intervall": "profile"}}), 400,
                           "bad_request", "intervall.*did you mean.*interval")
        self.check_problem(self.curl("/v1/fits?limitt=3"), 400, "bad_request", "limitt.*did you mean.*limit")
        self.check_problem(self.curl("/v1/fits?limit=3&limit=4"), 400, "bad_request", "limit")
        self.check_problem(self.post_file("/v1/fits?model=linear&model=viscous", "coulomb.csv"), 400, "bad_request",
                           "model.*twice")

    def test_a_flag_given_twice_is_refused(self):
        answer = self.curl("/v1/fits?model=linear", "-F", "data=@coulomb.csv", "-F", 'options={"model": "linear"}')
        self.check_problem(answer, 400, "bad_request", "model")

    def test_flags_only_of_the_command_line_are_unknown(self):
        for flag in ("json", "threads", "data", "rig", "shared", "report", "help"):
            self.check_problem(self.post_file(f"/v1/fits?{flag}=1", "coulomb.csv"), 400, "bad_request", flag)
        self.check_problem(self.post_file("/v1/fits?release=all", "coulomb.csv"), 400, "bad_request", "release")

    def test_json_requests_of_the_wrong_form_are_refused(self):
        for value in ({}, [], 3, None, {"data": 3}, {"data": COULOMB.decode(), "option": {}},
                      {"data": COULOMB.decode(), "options": []},
                      {"data": COULOMB.decode(), "rig": 3}, {"data": COULOMB.decode(), "options": {"model": ["linear"]}}):
            with self.subTest(value=str(value)[-60:]):
                answer = self.post_value("/v1/fits", value)
                self.assertIn((answer.status, answer.json()["code"]), ((400, "bad_request"), (422, "unusable_data")), answer)


class Stored(Curl):
    """Fits can be read again."""

    def test_a_fit_keeps_its_request_recording_and_samples(self):
        answer = self.curl("/v1/fits?model=viscous&from=1&name=Monday%20%C3%BC", "-F", "data=@coulomb.csv;filename=a.csv", "-F",
                           "rig=@textbook_rig.json")
        place = answer.headers["location"]
        request = self.curl(f"{place}/request").json()
        self.assertEqual(set(request), {"id", "name", "file", "created", "batch", "options", "rig", "calibration", "data_sha256"})
        self.assertEqual((request["name"], request["file"], request["batch"], request["options"]),
                         ("Monday ü", "a.csv", None, {"model": "viscous", "from": "1"}))
        self.assertEqual((request["rig"], request["calibration"]), (json.loads(RIG.read_text()), None))
        self.assertEqual(request["data_sha256"], hashlib.sha256(COULOMB).hexdigest())
        self.assertRegex(request["created"], r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ$")
        recording = self.curl(f"{place}/recording")
        self.assertEqual((recording.type, recording.body), ("text/csv", COULOMB))
        self.assertIn("attachment", recording.headers["content-disposition"])
        samples = self.curl(f"{place}/samples").json()
        angles = [float(line.split(",")[1]) for line in COULOMB.decode().splitlines() if line[0].isdigit()]
        self.assertEqual((samples["samples"], len(samples["time_s"])), (2000, 2000))
        for found, expected in zip(samples["measured"], angles, strict=True):
            self.assertAlmostEqual(found * DEGREES[samples["unit"]], expected, places=10)

    def test_many_samples_are_thinned_and_keep_every_extreme(self):
        run_tool("simulate_pendulum", "--rate", "500", "--duration", "30", "--set",
                 "inertia=0.05,viscous=0.001,release_angle=0.9,release_time=0.2",
                 "--out", "long.csv", folder=self.folder)
        samples = self.curl(f"/v1/fits/{self.fit('long.csv', closed_form_only='true')}/samples").json()
        angles = [float(line.split(",")[1]) for line in (self.folder / "long.csv").read_text().splitlines()[3:]]
        self.assertEqual(samples["samples"], len(angles))
        self.assertLessEqual(len(samples["measured"]), 4000)
        self.assertEqual(samples["time_s"], sorted(set(samples["time_s"])))
        found = {round(angle * DEGREES[samples["unit"]], 8) for angle in samples["measured"]}
        extremes = [b for a, b, c in zip(angles, angles[1:], angles[2:]) if (b - a) * (c - b) < 0]
        self.assertGreater(len(extremes), 30)
        self.assertLessEqual({round(angle, 8) for angle in extremes}, found)

    def test_a_refit_has_its_options_replaced(self):
        place = f"/v1/fits/{self.fit(model='viscous', seed='5')}"
        for query, flags in (("?model=coulomb", ["--model", "coulomb", "--seed", "5"]),
                             ("?model=&from=1", ["--from", "1", "--seed", "5"])):
            answer = self.curl(f"{place}/refits{query}", method="POST")
            self.assertEqual((answer.status, answer.body), (200, self.fitted("coulomb.csv", *flags)))
            self.assertNotEqual(answer.headers["location"], place)
            self.assertEqual(self.curl(answer.headers["location"] + "/recording").body, COULOMB)
        rig = self.post_value(f"{place}/refits", {"rig": json.loads(RIG.read_text()), "options": {"seed": ""}})
        self.assertEqual(rig.body, self.fitted("coulomb.csv", "--model", "viscous", "--rig", RIG))
        kept = self.curl(rig.headers["location"] + "/refits", method="POST")
        self.assertEqual(kept.body, rig.body)
        without = self.post_value(rig.headers["location"] + "/refits", {"rig": None})
        self.assertEqual(without.body, self.fitted("coulomb.csv", "--model", "viscous"))
        self.check_problem(self.curl(f"{place}/refits?model=nothing", method="POST"), 400, "bad_request", "no model 'nothing'")
        self.check_problem(self.curl("/v1/fits/none/refits", method="POST"), 404, "not_found")

    def test_a_refit_may_add_a_calibration(self):
        answer = self.curl("/v1/fits?model=linear", "-F", "data=@counts.csv")
        again = self.post_value(answer.headers["location"] + "/refits",
                                {"calibration": json.loads(CALIBRATION.read_text()), "options": {"model": "viscous"}})
        self.assertEqual(again.body, self.fitted("counts.csv", "--model", "viscous", "--calibration", CALIBRATION))


class Listed(Curl):
    """The list of fits, starting with an empty store: newest first, filtered, in pages."""

    def test_fits_are_listed_filtered_paged_and_deleted(self):
        self.assertEqual(self.curl("/v1/fits").json(), {"fits": [], "next": None})
        options = ({"model": "viscous"}, {"model": "coulomb"}, {"model": "viscous,coulomb"}, {"closed_form_only": "true"},
                   {"model": "linear"})
        made = []
        for number, each in enumerate(options):
            shutil.copy(self.folder / "coulomb.csv", self.folder / f"run {number}.csv")
            made.insert(0, self.curl("/v1/fits?" + query_of(each), "-F", f"data=@run {number}.csv").headers["location"][9:])
        whole = self.curl("/v1/fits").json()
        self.assertEqual([item["id"] for item in whole["fits"]], made)
        self.assertEqual([item["name"] for item in whole["fits"]], [f"run {number}.csv" for number in (4, 3, 2, 1, 0)])
        self.check_item(whole["fits"][3], made[3])
        self.check_pages(made)
        self.check_filters(made, whole["fits"])
        for fit in made:
            gone = self.curl(f"/v1/fits/{fit}", method="DELETE")
            self.assertEqual((gone.status, gone.body), (204, b""))
            for target in ("", "/request", "/recording", "/series", "/samples"):
                self.check_problem(self.curl(f"/v1/fits/{fit}{target}"), 404, "not_found", fit)
            self.check_problem(self.curl(f"/v1/fits/{fit}", method="DELETE"), 404, "not_found")
        self.assertEqual(self.curl("/v1/fits").json()["fits"], [])

    def check_item(self, item, fit):
        whole = self.curl(f"/v1/fits/{fit}").json()
        result, own = whole["fits"][0], whole["recordings"][0]["fits"][0]
        self.assertEqual((item["batch"], item["state"], item["exit_code"], item["reason"]), (None, "done", 0, ""))
        self.assertEqual([model["model"] for model in item["models"]], ["coulomb"])
        model = item["models"][0]
        self.assertEqual((model["status"], model["rms_residual"], model["residual_unit"]),
                         (result["status"], result["statistics"]["rms_residual_rad"], "rad"))
        for name, quantity in model["parameters"].items():
            expected = {**result["derived"], **result["parameters"], **own["parameters"]}[name]
            self.assertLessEqual({"estimate", "std_error", "unit"}, set(quantity))
            self.assertEqual(quantity, {key: expected[key] for key in quantity}, name)
        self.assertLessEqual({"inertia", "viscous", "coulomb"}, set(model["parameters"]))

    def check_pages(self, made):
        found, target = [], "/v1/fits?limit=2"
        for count in (2, 2, 1):
            page = self.curl(target).json()
            self.assertEqual(len(page["fits"]), count)
            found += [item["id"] for item in page["fits"]]
            target = f"/v1/fits?limit=2&before={page['next']}"
        self.assertEqual((found, page["next"]), (made, None))
        for wrong in ("limit=0", "limit=x", "limit=-1", "before=nonsense%21", "since=yesterday"):
            self.check_problem(self.curl(f"/v1/fits?{wrong}"), 400, "bad_request", wrong.partition("=")[0])

    def check_filters(self, made, items):
        def listed(query):
            return [item["id"] for item in self.curl(f"/v1/fits?{query}").json()["fits"]]
        self.assertEqual(listed("model=viscous"), [made[2], made[4]])
        self.assertEqual(listed("model=linear"), [made[0]])
        self.assertEqual(listed("name=run%203"), [made[1]])
        self.assertEqual(listed("name=run"), made)
        self.assertEqual(listed("name=%25"), [])
        self.assertEqual(listed("status=converged&model=coulomb&name=2.csv"), [made[2]])
        self.assertEqual(listed("status=failed"), [])
        self.assertEqual(listed("since=2100-01-01T00:00:00Z"), [])
        self.assertEqual(listed("batch=none"), [])
        self.assertEqual(listed(f"since={min(item['created'] for item in items)}"), made)


if __name__ == "__main__":
    unittest.main()
