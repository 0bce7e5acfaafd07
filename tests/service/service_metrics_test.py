#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the metrics of serve_pendulum: service_metrics_test.py PATH_OF_THE_TOOL."""

import itertools
import math
import re
import unittest

from service import DATASETS, Served, data_part  # first: it finds Debian's modules
from prometheus_client.parser import text_string_to_metric_families

SHORT = b"".join((DATASETS / "runs_1.csv").read_bytes().splitlines(keepends=True)[:800])

# https://prometheus.io/docs/practices/naming and the rules of `promtool check metrics`.
OTHER_UNITS = re.compile(r"(?:^|_)(?:ms|us|ns|milliseconds|microseconds|minutes|hours|days|kb|mb|gb|kilobytes|megabytes|kib|mib|"
                         r"bits|percent|second|byte)(?:_|$)")
BASE_UNITS = ("seconds", "bytes", "ratio", "info")
THINGS = re.compile(r"_(?:requests|connections|streams|fits|runs|batches|samples|threads|fds|answers|responses|events|queued|"
                    r"waiting|running|models|attempts|problems|stored|rejected|refused|accepted|workers)$")


class Metrics(Served):
    def scrape(self):
        answer = self.server.get("/metrics")
        self.assertEqual(answer.status, 200)
        return answer, list(text_string_to_metric_families(answer.body.decode()))

    def samples(self, kinds=("counter", "gauge", "histogram")):
        """{(name, labels): value} of all families of these kinds."""
        return {(sample.name, tuple(sorted(sample.labels.items()))): sample.value
                for family in self.scrape()[1] if family.type in kinds for sample in family.samples}

    def risen(self, before, after):
        """The increases between two scrapes, without those caused by the scrapes."""
        changes = {key: value - before.get(key, 0) for key, value in after.items()}
        self.assertGreaterEqual(min(changes.values()), 0, [key for key, value in changes.items() if value < 0])
        return {key: value for key, value in changes.items() if value and "metrics" not in str(key[1])}

    def by_label(self, changes, value_pattern, name_pattern=""):
        """{label value: increase} of the only counter with such label values."""
        names = {name for name, labels in changes if re.search(name_pattern, name)
                 and any(re.fullmatch(value_pattern, v) for _, v in labels)}
        self.assertEqual(len(names), 1, (name_pattern, sorted(changes)))
        totals = {}
        for (name, labels), value in changes.items():
            if name in names:
                label = next(v for _, v in labels if re.fullmatch(value_pattern, v))
                totals[label] = totals.get(label, 0) + value
        return totals

    def test_the_text_is_prometheus_0_0_4(self):
        answer, families = self.scrape()
        self.assertRegex(answer.headers["content-type"], r"^text/plain; ?version=0\.0\.4; ?charset=utf-8$")
        self.assertTrue(answer.body.endswith(b"\n"))
        self.assertGreater(len(families), 5)
        self.assertEqual(len({family.name for family in families}), len(families))
        keys = [(sample.name, tuple(sorted(sample.labels.items()))) for family in families for sample in family.samples]
        self.assertEqual(len(set(keys)), len(keys))

    def test_names_follow_the_conventions(self):
        self.server.post_csv("/v1/fits", SHORT)
        answer, families = self.scrape()
        types = dict(re.findall(r"(?m)^# TYPE (\S+) (\S+)$", answer.body.decode()))
        helps = dict(re.findall(r"(?m)^# HELP (\S+) (.+)$", answer.body.decode()))
        self.assertEqual(set(types), set(helps))
        for name, kind in types.items():
            self.assertIn(kind, ("counter", "gauge", "histogram", "summary"), name)
            self.assertRegex(name, r"^(?:pendulum|http|process)_[a-z0-9_]+$")
            self.assertEqual(name.endswith("_total"), kind == "counter", name)
            self.assertNotRegex(name, OTHER_UNITS)
            self.assertNotRegex(name, r"_(?:count|sum|bucket)$|counter|gauge|histogram")
            bare = name.removesuffix("_total")
            self.assertTrue(bare.endswith(BASE_UNITS) or THINGS.search(bare),
                            f"{name} ends neither in a base unit nor in what is counted")
            self.assertNotIn(name.replace("_", " "), helps[name])
        for family in families:
            self.assertIn(family.name if family.type != "counter" else family.name + "_total", types)
            for sample in family.samples:
                self.assertTrue(all(re.fullmatch("[a-z_]+", label) for label in sample.labels), sample)
        self.assertTrue(any(kind == "histogram" and name.endswith("_seconds") for name, kind in types.items()))

    def test_counters_count_each_request_and_fit(self):
        before = self.samples(("counter",))
        for number in range(3):
            self.assertEqual(self.server.post_csv(f"/v1/fits?seed={number}", SHORT).status, 200)
        for _ in range(2):
            self.assertEqual(self.server.post_csv("/v1/fits", b"time_s,angle_deg\n0,x\n").status, 422)
        self.assertEqual(self.server.post_csv("/v1/fits?model=none", SHORT).status, 400)
        for _ in range(4):
            self.assertEqual(self.server.get("/v1/fits/none").status, 404)
        self.assertEqual(self.server.ask("PUT", "/v1/fits").status, 405)
        changes = self.risen(before, self.settled())
        statuses = self.by_label(changes, r"[1-5]\d\d", "requests|responses")
        self.assertEqual(statuses, {"200": 3, "422": 2, "400": 1, "404": 4, "405": 1})
        fits = {labels: value for (name, labels), value in changes.items() if re.search(r"_fits(?:_\w+)?_total$", name)}
        self.assertEqual(sum(value for labels, value in fits.items() if not re.search("fail|error|refus|problem", str(labels))),
                         3, changes)

    def settled(self):
        """The counters once only scrapes change them. This takes a moment, because an answer is counted after its last
        byte."""
        last = []

        def still():
            now = {key: value for key, value in self.samples(("counter",)).items() if "/metrics" not in str(key[1])}
            last.append(now)
            return len(last) > 3 and sum(now.values()) == sum(last[-2].values()) == sum(last[-3].values()) or len(last) > 40
        self.wait_until(still, "the counters no longer change")
        return last[-1]

    def test_runs_of_batches_are_counted(self):
        before = self.samples(("counter",))
        parts = [data_part("a.csv", SHORT), data_part("b.csv", b"nonsense"), data_part("c.csv", SHORT + b"# other\n")]
        place = self.server.post_parts("/v1/batches", parts).headers["location"]
        self.wait_until(lambda: self.server.get(place).json()["state"] == "done", "the batch is done")
        changes = self.risen(before, self.settled())
        counted = sorted(value for (name, _), value in changes.items() if re.search(r"(?:fits|runs)(?:_\w+)?_total$", name))
        self.assertIn(sum(counted), (3, 6), changes)  # three runs, counted as fits, as runs, or as both

    def test_histograms_are_cumulative(self):
        self.server.post_csv("/v1/fits", SHORT)
        histograms = [family for family in self.scrape()[1] if family.type == "histogram"]
        self.assertGreater(len(histograms), 0)
        for family in histograms:
            groups = {}
            for sample in family.samples:
                labels = tuple(sorted((key, value) for key, value in sample.labels.items() if key != "le"))
                groups.setdefault(labels, []).append(sample)
            for labels, group in groups.items():
                self.check_histogram(f"{family.name} {labels}", group)

    def check_histogram(self, what, group):
        buckets = [(float(sample.labels["le"]), sample.value) for sample in group if sample.name.endswith("_bucket")]
        total = next(sample.value for sample in group if sample.name.endswith("_sum"))
        count = next(sample.value for sample in group if sample.name.endswith("_count"))
        self.assertEqual(buckets[-1], (math.inf, count), what)
        for (low, few), (high, many) in itertools.pairwise(buckets):
            self.assertLess(low, high, what)
            self.assertLessEqual(few, many, what)
        least = sum((many - few) * low for (low, few), (_, many) in itertools.pairwise(buckets))
        self.assertGreaterEqual(total * (1 + 1e-9), least, what)  # each value is above the bound of the bucket below
        self.assertEqual(count == 0, total == 0, what)

    def test_a_histogram_counts_every_request(self):
        def counted():
            return sum(value for (name, labels), value in self.samples(("histogram",)).items()
                       if name.endswith("_count") and re.search("request|http", name))
        before = counted()
        for _ in range(5):
            self.server.get("/v1/models")
        self.wait_until(lambda: counted() >= before + 5, "five requests are counted")

    def test_unknown_paths_and_methods_make_no_series(self):
        before = len(self.samples())
        for number in range(60):
            self.server.get(f"/stranger/{number}")
            self.server.get(f"/v1/fits/{number}x")
            self.server.ask(f"BREW{number}", "/v1/fits")
        self.assertLess(len(self.samples()), before + 60)

    def test_gauges_return_to_zero(self):
        self.server.post_csv("/v1/fits", SHORT)

        def at_rest():
            gauges = self.samples(("gauge",))
            found = [value for (name, _), value in gauges.items() if re.search("waiting|running|queue|in_flight|streams", name)]
            return found and sum(found) <= 1  # the scrape itself may be counted
        self.wait_until(at_rest, "nothing waits or runs")


if __name__ == "__main__":
    unittest.main()
