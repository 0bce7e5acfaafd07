#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Text, Markdown, page and JSON of a result have the same digits: same_numbers_cli_test.py PATH_OF_FIT_PENDULUM.

src/web/browser/sections_test.mjs checks that the page shows its sections as they are here."""

import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

TOOL = pathlib.Path(sys.argv.pop(1)).resolve()
DATASETS = pathlib.Path(__file__).resolve().parents[2] / "datasets"
CASES = {
    "one recording": ["--data", "coulomb.csv"],
    "one recording, three laws": ["--data", "coulomb.csv", "--models", "viscous,coulomb,drag"],
    "three recordings": ["--data", "runs_1.csv,runs_2.csv,runs_3.csv"],
}
NUMBER = re.compile(r"\d+(?:\.\d+)?(?:e[-+]\d+)?")


def joined(text):
    """Without line breaks, the width of columns, and Markdown's bars, backslashes and bold type."""
    return re.sub(r"[\s|]+", " ", re.sub(r"\\|\*\*", "", text).replace("\N{NO-BREAK SPACE}", " "))


def texts_of(section):
    """The rows, facts and sentences of a section; cells of a row in one text."""
    for block in section["blocks"]:
        if block["kind"] == "table":
            yield from (" ".join(cell for cell in row if cell) for row in block["rows"])
        elif block["kind"] == "facts":
            yield from (row["text"] for row in block["rows"])
        elif block["kind"] == "items":
            yield from block["texts"]
        else:
            yield block["text"]


class SameNumbers(unittest.TestCase):
    def fit(self, words):
        with tempfile.TemporaryDirectory() as folder:
            files = {kind: pathlib.Path(folder) / kind for kind in ["json", "markdown", "report"]}
            outputs = [f"--{kind}={path}" for kind, path in files.items()]
            done = subprocess.run([TOOL, *words, "--rig", "textbook_rig.json", "--details", *outputs], cwd=DATASETS,
                                  capture_output=True, text=True, check=True)
            page = files["report"].read_text(encoding="utf-8")
            sections = json.loads(re.search(r'id="sections">(.*?)</script>', page, re.DOTALL).group(1))
            self.assertEqual(json.loads(re.search(r'id="result">(.*?)</script>', page, re.DOTALL).group(1)),
                             json.loads(files["json"].read_text(encoding="utf-8")))
            return (joined(done.stdout), joined(files["markdown"].read_text(encoding="utf-8")), sections,
                    json.loads(files["json"].read_text(encoding="utf-8")))

    def main_fit(self, result):
        recommended = result["comparison"] and result["comparison"]["recommended"]
        return next(fit for fit in result["fits"] if recommended in (None, fit["model"]))

    def test_every_row_of_the_page_stands_in_text_and_markdown(self):
        for name, words in CASES.items():
            text, markdown, sections, result = self.fit(words)
            law = self.main_fit(result)["model"]
            rows = 0
            for section in sections:
                if section["law"] not in (None, law) or section["id"] == "turning-points":  # the text has a part of them
                    continue
                for told in map(joined, texts_of(section)):
                    with self.subTest(case=name, section=section["title"], told=told):
                        for number in NUMBER.findall(told):
                            self.assertIn(number, text)
                        self.assertIn(re.sub(r" [-*| ]+$", "", told).strip(), markdown)  # without the bars of a strip
                        rows += 1
            self.assertGreater(rows, 60)

    def test_the_summary_in_json_stands_in_text_and_markdown(self):
        for name, words in CASES.items():
            text, markdown, _, result = self.fit(words)
            summary = self.main_fit(result)["summary"]
            for quantity in summary["parameters"] + summary["derived"]:
                told = quantity["value"] + (" ± " + quantity["error"] if quantity["error"] else "")
                with self.subTest(case=name, quantity=quantity["name"]):
                    self.assertIn(told, text)
                    self.assertIn(told, markdown)

    def test_json_has_the_value_that_the_table_rounds(self):
        for name, words in CASES.items():
            _, _, sections, result = self.fit(words)
            fit = self.main_fit(result)
            table = next(section for section in sections if section["id"] == "parameters" and section["law"] == fit["model"])
            rows = {row[0]: row for row in table["blocks"][0]["rows"] if row[0]}
            for parameter, values in fit["parameters"].items():
                shown = rows[parameter][1]
                digits = len(shown.partition(".")[2])
                with self.subTest(case=name, parameter=parameter):
                    self.assertEqual(f"{values['estimate']:.{digits}f}", shown)
                    self.assertEqual(f"± {values['std_error']:.{digits}f}", rows[parameter][2])


if __name__ == "__main__":
    unittest.main()
