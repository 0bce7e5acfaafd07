#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests batches, streams of events, and recovery after a crash of serve_pendulum: service_batches_test.py PATH_OF_THE_TOOL."""

import csv
import http.client
import json
import os
import re
import resource
import signal
import sqlite3
import threading
import time
import unittest

from event_stream import EventParser, events
from service import (DATASETS, IS_SANITIZED, RIG, TIMEOUT_S, Lab, Served, data_part, json_part, query_of, run_tool)

KILLS = 5 if IS_SANITIZED else int(os.environ.get("PENDULUM_KILLS", "50"))
MANY = 12 if IS_SANITIZED else 24  # runs, enough that some are in progress for a moment
SLOW = {"model": "viscous,coulomb", "interval": "bootstrap"}  # a few seconds per run
ENDLESS = {"model": "all", "interval": "bootstrap"}  # many seconds
BAD = {"word.csv": b"time_s,angle_deg\n0,1\n0.1,x\n", "empty.csv": b"", "binary.csv": bytes(range(256)) * 50,
       "header.csv": b"0,1\n" * 20,
       "still.csv": b"time_s,angle_deg\n" + b"".join(b"%d.%02d,12.5\n" % divmod(i, 100) for i in range(500))}


class Parsing(unittest.TestCase):
    """The examples of the HTML standard, section 9.2.6."""

    def parsed(self, content, size=1):
        parser = EventParser()
        return [(event.kind, event.data, event.id) for i in range(0, len(content), size)
                for event in parser.feed(content[i:i + size])]

    def test_examples_of_the_standard(self):
        for size in (1, 3, 1000):
            self.assertEqual(self.parsed(b"data: YHOO\ndata: +2\ndata: 10\n\n", size), [("message", "YHOO\n+2\n10", "")])
            self.assertEqual(self.parsed(b": test stream\n\ndata: first event\nid: 1\n\ndata:second event\nid\n\n"
                                         b"data:  third event\n\n", size),
                             [("message", "first event", "1"), ("message", "second event", ""), ("message", " third event", "")])
            self.assertEqual(self.parsed(b"data:test\r\n\r\nevent: add\rdata: test\r\r\n", size),
                             [("message", "test", ""), ("add", "test", "")])


class Batched(Lab):
    def post_batch(self, server, names, query="", *parts, **headers):
        """Posts files of the test's folder as a batch; returns the server's answer."""
        data = [data_part(name, (self.folder / name).read_bytes()) for name in names]
        answer = server.post_parts(f"/v1/batches{query}", [*data, *parts], **headers)
        self.assertEqual(answer.status, 202, answer)
        batch = answer.json()
        self.assertEqual(answer.headers["location"], f"/v1/batches/{batch['id']}")
        self.assertEqual((batch["runs"], [fit["name"] for fit in batch["fits"]]), (len(names), list(names)))
        return batch

    def finished(self, server, batch, seconds=TIMEOUT_S):
        """Waits until the batch is done and returns it; checks that its progress never decreases."""
        last = [0, 0]

        def is_done():
            now = server.get(f"/v1/batches/{batch['id']}").json()
            self.assertGreaterEqual((now["done"], now["failed"]), tuple(last))
            self.assertEqual(now["done"], sum(fit["state"] == "done" for fit in now["fits"]))
            last[:] = now["done"], now["failed"]
            return now if now["state"] == "done" else None
        return self.wait_until(is_done, f"batch {batch['id']} is done", seconds)

    def stream(self, server, batch, most=None, **headers):
        response = server.open(f"/v1/batches/{batch['id']}/events", **headers)
        self.assertEqual((response.status, response.getheader("Content-Type").partition(";")[0]), (200, "text/event-stream"))
        found = list(events(response, most))
        response.close()
        return found

    def check_complete(self, server, batch, expected):
        """Checks that the batch is complete: each run once, with the bytes of the command line."""
        done = self.finished(server, batch)
        self.assertEqual((done["done"], done["failed"], len(done["fits"])), (len(batch["fits"]), 0, len(batch["fits"])))
        self.assertEqual([fit["id"] for fit in done["fits"]], [fit["id"] for fit in batch["fits"]])
        for fit in done["fits"]:
            self.assertEqual(server.get(f"/v1/fits/{fit['id']}").body, expected(fit["name"]), fit)
        listed = server.get(f"/v1/fits?limit=1000&batch={batch['id']}").json()["fits"]
        self.assertEqual(sorted(fit["id"] for fit in listed), sorted(fit["id"] for fit in batch["fits"]))
        self.assertEqual([event.id for event in self.stream(server, batch)][:-1], [str(i + 1) for i in range(len(batch["fits"]))])


class Batches(Batched, Served):
    def write_mixture(self):
        """Writes good and bad recordings in alternation and returns their names."""
        good = self.simulate(6)
        for name, content in BAD.items():
            (self.folder / name).write_bytes(content)
        return [name for pair in zip(good, [*BAD, None]) for name in pair if name]

    def test_results_and_reasons_equal_those_of_fit_pendulum(self):
        names, options = self.write_mixture(), {"model": "viscous,coulomb", "noise": "gaussian"}
        flags = ["--model", "viscous,coulomb", "--noise", "gaussian", "--rig", RIG]
        batch = self.post_batch(self.server, names, f"?{query_of({'model': options['model']})}",
                                json_part("rig", json.loads(RIG.read_text())), json_part("options", {"noise": "gaussian"}))
        done = self.finished(self.server, batch)
        self.assertEqual((done["done"], done["failed"]), (len(names), len(BAD)))
        for name, fit in zip(names, done["fits"], strict=True):
            answer = self.server.get(f"/v1/fits/{fit['id']}")
            self.assertEqual(fit["name"], name)
            if name not in BAD:
                self.assertEqual((fit["exit_code"], fit["reason"], answer.body), (0, "", self.fitted(name, *flags)), name)
                continue
            code, _, sentence = run_tool("fit_pendulum", "--data", name, *flags, folder=self.folder)
            self.assertEqual((fit["exit_code"], fit["reason"]), (code, sentence), name)
            self.check_same_problem(answer, code, sentence)
        item = next(each for each in self.server.get("/v1/batches").json()["batches"] if each["id"] == batch["id"])
        self.assertEqual({key: item[key] for key in ("runs", "done", "failed", "state")},
                         {"runs": len(names), "done": len(names), "failed": len(BAD), "state": "done"})
        listed = self.server.get(f"/v1/fits?batch={batch['id']}").json()["fits"]
        self.assertEqual({fit["name"]: fit["reason"] for fit in listed}, {fit["name"]: fit["reason"] for fit in done["fits"]})

    def check_events(self, found, runs, first=0):
        """Checks the events: every run once, counts that rise by one, and the end."""
        *fits, last = found
        self.assertEqual([event.kind for event in fits], ["fit"] * (runs - first))
        self.assertEqual([event.id for event in fits], [str(i + 1) for i in range(first, runs)])
        for number, event in enumerate(fits, first + 1):
            self.assertEqual((event.json()["done"], event.json()["runs"]), (number, runs))
            self.assertLessEqual({"id", "name", "exit_code", "reason", "failed"}, set(event.json()))
        self.assertEqual(len({event.json()["id"] for event in fits}), runs - first)
        self.assertEqual(last.kind, "done")
        self.assertEqual((last.json()["runs"], last.json()["done"]), (runs, runs))

    def test_events_report_each_run_once_during_and_after_the_batch(self):
        names = self.write_mixture()
        batch = self.post_batch(self.server, names, "?model=viscous")
        streams, threads = [[], [], []], []
        for found in streams:
            threads.append(threading.Thread(target=lambda found=found: found.extend(self.stream(self.server, batch))))
            threads[-1].start()
        for thread in threads:
            thread.join(TIMEOUT_S)
        for found in (*streams, self.stream(self.server, batch)):
            self.check_events(found, len(names))
            self.assertEqual(found[-1].json()["failed"], len(BAD))
            self.assertEqual([event.data for event in found], [event.data for event in streams[0]])
        by_id = {fit["id"]: fit for fit in self.finished(self.server, batch)["fits"]}
        for event in streams[0][:-1]:
            fit = by_id[event.json()["id"]]
            self.assertEqual({key: event.json()[key] for key in ("name", "exit_code", "reason")},
                             {key: fit[key] for key in ("name", "exit_code", "reason")})

    def test_a_stream_continues_after_the_last_event_id(self):
        names = self.simulate(5, seed=50)
        batch = self.post_batch(self.server, names, "?model=viscous")
        seen = self.stream(self.server, batch, most=2)
        self.assertEqual([event.id for event in seen], ["1", "2"])
        rest = self.stream(self.server, batch, Last_Event_ID="2")
        self.check_events(rest, 5, first=2)
        self.check_events(self.stream(self.server, batch, Last_Event_ID="4"), 5, first=4)
        for beyond in ("5", "5000", "99999999999999999999999", "-1", "x", "0"):
            found = self.stream(self.server, batch, Last_Event_ID=beyond)
            self.assertEqual(found[-1].kind, "done", beyond)
            self.assertIn(len(found), (1, 6), beyond)

    def test_waiting_runs_are_409_and_deleted_runs_are_404(self):
        names = self.simulate(MANY, seed=100)
        batch = self.post_batch(self.server, names, f"?{query_of(SLOW)}")
        last = batch["fits"][-1]["id"]
        waiting = self.server.get(f"/v1/fits/{last}")
        problem = self.check_problem(waiting, 409, "conflict")
        self.assertRegex(waiting.headers["retry-after"], r"^[1-9]\d*$", problem)
        self.assertEqual(self.server.get(f"/v1/fits/{last}/recording").body, (self.folder / names[-1]).read_bytes())
        now = self.server.get(f"/v1/batches/{batch['id']}").json()
        self.assertEqual((now["state"], now["fits"][-1]["state"], now["fits"][-1]["exit_code"]), ("running", "waiting", None))
        response = self.server.open(f"/v1/batches/{batch['id']}/events")
        begin = time.monotonic()
        self.assertEqual(self.server.ask("DELETE", f"/v1/batches/{batch['id']}").status, 204)
        list(events(response))  # a stream ends if its batch was deleted
        response.close()
        for target in (f"/v1/batches/{batch['id']}", f"/v1/batches/{batch['id']}/events", f"/v1/fits/{last}",
                       f"/v1/fits/{batch['fits'][0]['id']}"):
            self.check_problem(self.server.get(target), 404, "not_found")
        self.assertNotIn(batch["id"], [each["id"] for each in self.server.get("/v1/batches?limit=1000").json()["batches"]])
        self.assertEqual(self.server.get(f"/v1/fits?batch={batch['id']}").json()["fits"], [])
        after = self.post_batch(self.server, names[:1], "?model=viscous")
        self.finished(self.server, after)  # the deleted batch is not fitted first
        self.assertEqual([fit["id"] for fit in self.server.get(f"/v1/fits?batch={after['id']}").json()["fits"]],
                         [after["fits"][0]["id"]])
        self.assertLess(time.monotonic() - begin, TIMEOUT_S)

    def test_batches_are_listed_in_pages_newest_first(self):
        name = self.simulate(1, seed=300)
        made = [self.post_batch(self.server, name, "?model=linear")["id"] for _ in range(3)][::-1]
        page = self.server.get("/v1/batches?limit=2").json()
        self.assertEqual([each["id"] for each in page["batches"]], made[:2])
        page = self.server.get(f"/v1/batches?limit=1&before={page['next']}").json()
        self.assertEqual([each["id"] for each in page["batches"]], made[2:])

    def test_an_invalid_rig_is_reported_at_once_or_by_each_run(self):
        name = self.simulate(1, seed=500)[0]
        answer = self.server.post_parts("/v1/batches",
                                        [data_part(name, (self.folder / name).read_bytes()), json_part("rig", {"bob_mas": 3})])
        if answer.status != 202:
            self.check_problem(answer, 422, "unusable_data", "bob_mas")
            return
        done = self.finished(self.server, answer.json())
        self.assertEqual((done["failed"], done["fits"][0]["exit_code"]), (1, 4))
        self.assertRegex(done["fits"][0]["reason"], '"bob_mas" is not a key of a rig')

    def test_invalid_batches_are_refused_completely(self):
        count = len(self.server.get("/v1/batches?limit=1000").json()["batches"])
        self.check_problem(self.server.post_parts("/v1/batches", [json_part("rig", {})]), 400, "bad_request", "data")
        name = self.simulate(1, seed=400)[0]
        part = data_part(name, (self.folder / name).read_bytes())
        self.check_problem(self.server.post_parts("/v1/batches?model=none", [part]), 400, "bad_request", "no model 'none'")
        self.check_problem(self.server.post_parts("/v1/batches?modle=viscous", [part]), 400, "bad_request", "modle")
        self.check_problem(self.server.post_parts("/v1/batches", [part, ("stranger", None, None, b"x")]), 400, "bad_request",
                           "stranger")
        self.assertEqual(len(self.server.get("/v1/batches?limit=1000").json()["batches"]), count)


class Survival(Batched):
    """Acknowledged requests are kept exactly once, even if the process is killed."""

    def setUp(self):
        super().setUp()
        self.expected = {}

    def result(self, name, *flags):
        if (name, flags) not in self.expected:
            self.expected[name, flags] = self.fitted(name, *flags)
        return self.expected[name, flags]

    def ask_on(self, server, names, number, answers, is_over):
        """Fits one recording after another, also while the server is down."""
        while not is_over.is_set():
            name, number = names[number % len(names)], number + 7
            try:
                answer = server.post_csv("/v1/fits?model=viscous", (self.folder / name).read_bytes())
                answers.append((name, answer.status, answer.headers.get("location"), answer.body))
            except (OSError, http.client.HTTPException):
                time.sleep(0.02)

    def test_keeps_every_acknowledged_batch_and_fit_when_killed_under_load(self):
        names = self.simulate(MANY)
        server = self.serve()
        batches, answers, is_over = [], [], threading.Event()
        clients = [threading.Thread(target=self.ask_on, args=(server, names, number, answers, is_over)) for number in range(4)]
        for client in clients:
            client.start()
        try:
            for kill in range(KILLS):
                # Different moments: multiples of the golden ratio act as random numbers.
                first = kill % 5 * MANY // 10
                batches.append(self.post_batch(server, names[first:][:MANY // 2], "?model=viscous,coulomb"))
                time.sleep(0.05 + 0.5 * ((0.618 * (kill + 1)) % 1))
                server.kill()
                server.start(server.port)
        finally:
            is_over.set()
            for client in clients:
                client.join(TIMEOUT_S)
        for batch in batches:
            self.check_complete(server, batch, lambda name: self.result(name, "--model", "viscous,coulomb"))
        done = [(name, place, body) for name, status, place, body in answers if status == 200]
        self.assertGreater(len(done), 10)
        for name, place, body in done:
            self.assertEqual(body, self.result(name, "--model", "viscous"))
            self.assertEqual(server.get(place).body, body, place)
        self.assertLessEqual({status for _, status, _, _ in answers}, {200, 429})
        self.check_store(server)

    def test_no_run_is_lost_while_the_disk_is_full(self):
        names = self.simulate(2 if IS_SANITIZED else 12)
        server = self.serve()
        batch = self.post_batch(server, names, "?model=all")
        resource.prlimit(server.process.pid, resource.RLIMIT_FSIZE, (4096, resource.RLIM_INFINITY))
        self.assertEqual(server.post_csv("/v1/fits", (self.folder / names[0]).read_bytes()).status, 507)
        self.assertEqual(server.get(f"/v1/batches/{batch['id']}").json()["state"], "running")
        pattern = re.compile(rb"run \w+ of batch \w+ waits: cannot write fits\.sqlite: .*; it is tried again within \d+ s\n")
        # The log is read instead of sending requests, which would fill it: its size is limited, too.
        self.wait_until(lambda: pattern.search(server.log()), "a run waits for its next try")
        self.assertRegex(server.get("/metrics").body, rb"\npendulum_batch_retried_runs_total [1-9]")
        resource.prlimit(server.process.pid, resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
        self.check_complete(server, batch, lambda name: self.result(name, "--model", "all"))

    def check_store(self, server):
        """Checks that the batch tool reads a server's store."""
        self.assertEqual(server.stop(), 0)
        self.check_log(server)
        with sqlite3.connect(self.folder / "fits.sqlite") as database:
            self.assertEqual(database.execute("PRAGMA integrity_check").fetchall(), [("ok",)])
        code, out, said = run_tool("refit_pendulums", "status", "--store", "fits.sqlite", folder=self.folder)
        self.assertEqual((code, b"recordings fitted" in out), (0, True), said)
        code, _, said = run_tool("refit_pendulums", "export", "--store", "fits.sqlite", "--out", "fits_table.csv",
                                 folder=self.folder)
        self.assertEqual(code, 0, said)
        with open(self.folder / "fits_table.csv", newline="", encoding="utf-8") as file:
            self.assertGreater(len(list(csv.DictReader(file))), 0)

    def test_answers_running_requests_after_sigterm_and_continues_batches_later(self):
        names = self.simulate(MANY)
        server = self.serve("--stop_seconds", "120")
        batch = self.post_batch(server, names, "?model=viscous,coulomb")
        answers = []
        asking = threading.Thread(target=lambda: answers.append(
            server.post_csv(f"/v1/fits?{query_of(SLOW)}", (self.folder / names[0]).read_bytes())))
        asking.start()
        self.wait_until(lambda: server.requests_running() == 1, "the fit runs")
        server.process.send_signal(signal.SIGTERM)
        self.assertEqual(server.process.wait(TIMEOUT_S), 0)
        asking.join(TIMEOUT_S)
        self.assertEqual([answer.status for answer in answers], [200])
        self.assertEqual(answers[0].body, self.result(names[0], "--model", SLOW["model"], "--interval", SLOW["interval"]))
        with self.assertRaises(ConnectionError):
            server.connect()
        server.start()
        self.assertEqual(server.get(answers[0].headers["location"]).body, answers[0].body)
        self.check_complete(server, batch, lambda name: self.result(name, "--model", "viscous,coulomb"))
        self.check_store(server)

    def test_a_fit_that_takes_longer_than_the_stop_gets_503(self):
        data = (self.folder / self.simulate(1)[0]).read_bytes()
        server = self.serve("--stop_seconds", "0")
        answers = []
        asking = threading.Thread(target=lambda: answers.append(server.post_csv(f"/v1/fits?{query_of(ENDLESS)}", data)))
        asking.start()
        self.wait_until(lambda: server.requests_running() == 1, "the fit runs")
        server.process.send_signal(signal.SIGTERM)
        self.assertEqual(server.process.wait(TIMEOUT_S), 0)
        asking.join(TIMEOUT_S)
        self.assertEqual([(answer.status, answer.headers["retry-after"]) for answer in answers], [(503, "5")])

    def test_an_interrupt_ends_the_server_and_its_streams(self):
        server = self.serve()
        batch = self.post_batch(server, self.simulate(MANY), f"?{query_of(SLOW)}")
        response = server.open(f"/v1/batches/{batch['id']}/events")
        self.assertEqual(server.stop(signal.SIGINT), 0)
        found = []
        try:
            found += events(response)
        except http.client.IncompleteRead:
            pass  # the stream ends without its last chunk
        response.close()
        self.assertNotIn("done", [event.kind for event in found])

    def test_a_deleted_fit_stays_deleted_and_a_key_is_remembered(self):
        data = (self.folder / self.simulate(1)[0]).read_bytes()
        server = self.serve()
        kept = server.post_csv("/v1/fits?model=viscous", data, Idempotency_Key="kept")
        gone = server.post_csv("/v1/fits?model=viscous", data).headers["location"]
        self.assertEqual(server.ask("DELETE", gone).status, 204)
        server.kill()
        server.start()
        self.check_problem(server.get(gone), 404, "not_found")
        again = server.post_csv("/v1/fits?model=viscous", data, Idempotency_Key="kept")
        self.assertEqual((again.status, again.body), (200, kept.body))
        self.assertEqual(again.headers["location"], kept.headers["location"])


class Live(Lab):
    """A recording that grows, as record_pendulum writes it: run.csv.part, then run.csv."""

    def test_a_growing_recording_is_sent_as_events(self):
        server = self.serve("--live", "run.csv")
        self.assertEqual(server.get("/v1/live").json()["state"], "waiting")
        rows = (DATASETS / "runs_1.csv").read_text().splitlines(keepends=True)
        with open(self.folder / "run.csv.part", "w", encoding="utf-8") as file:
            file.write("".join(rows[:1005]))
            file.flush()
            self.wait_until(lambda: server.get("/v1/live").json()["samples"] == 1000, "the first samples are seen")
            self.assertEqual(server.get("/v1/live").json()["state"], "recording")
            response, parser, found = server.open("/v1/live/events"), EventParser(), []
            found += self.read_until(response, parser, lambda event: event.kind == "samples")
            file.write("".join(rows[1005:])[:-3])
            file.flush()
            found += self.read_until(response, parser,
                                     lambda event: event.kind == "samples" and event.json()["time_s"][-1:] >= [14.9])
            file.write("".join(rows)[-3:])
        (self.folder / "run.csv.part").rename(self.folder / "run.csv")
        found += self.read_until(response, parser, lambda event: event.kind == "state" and event.json()["state"] == "ended")
        response.close()
        times = [time_s for event in found if event.kind == "samples" for time_s in event.json()["time_s"]]
        self.assertEqual(times, sorted(set(times)))
        values = {float(time_s): float(angle) for time_s, angle in (row.split(",") for row in rows[5:])}
        for event in found:
            if event.kind == "samples":
                self.assertEqual(event.json()["values"], [values[time_s] for time_s in event.json()["time_s"]])
        self.assertEqual(server.get("/v1/live/recording").body.decode(), "".join(rows))

    def read_until(self, response, parser, is_last):
        found = []
        while content := response.read1(65536):
            found += parser.feed(content)
            if any(map(is_last, found)):
                return found
        raise AssertionError(f"the stream ended after {found[-3:]}")


if __name__ == "__main__":
    unittest.main()
