#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests serve_pendulum with hostile requests: service_hostile_test.py PATH_OF_THE_TOOL.

Each is refused with a problem that gives the reason, or is harmless; the same process answers the next request.
"""

import contextlib
import gzip
import http.client
import io
import json
import threading
import unittest
import zipfile

from service import DATASETS, IS_SANITIZED, Lab, Served, data_part, json_part, multipart, query_of

COULOMB = (DATASETS / "coulomb.csv").read_bytes()
SHORT = b"".join((DATASETS / "runs_1.csv").read_bytes().splitlines(keepends=True)[:800])
LONG_FIT = {"model": "all", "interval": "bootstrap"}  # a minute of processor time
FORM = "multipart/form-data; boundary=b"


def request(method, target, *fields, body=b""):
    """Bytes of a request with a Host field; everything else is sent as given."""
    head = [method + b" " + target + b" HTTP/1.1", b"Host: localhost", *fields, b"Connection: close"]
    return b"\r\n".join(head) + b"\r\n\r\n" + body


class Hostile(Served):
    FLAGS = ("--max_body_mb", "16", "--max_samples", "20000", "--max_batch_runs", "50", "--request_seconds", "20")

    def tearDown(self):
        self.check_lives()

    def refused(self, answer, *statuses):
        """Checks that an answer is a problem with one of the statuses."""
        self.assertIsNotNone(answer, "the connection ended without an answer")
        self.assertIn(answer.status, statuses, answer)
        self.check_problem(answer, answer.status, answer.json()["code"])
        self.assertNotRegex(answer.json()["detail"], r"/(?:tmp|root|home|work|usr)/|std::|exception|0x[0-9a-f]{6}")


class Places(Hostile):
    def test_paths_reach_no_other_files(self):
        up = ("..", "%2e%2e", "%252e%252e", "..%2f..", "%2e%2e%5c", "..\\..", "..%5c..", "%c0%ae%c0%ae", "..;", "....//", "%00",
              ".%00.")
        for base in ("/", "/v1/fits/", "/v1/examples/", "/app.js/", "/fits/", "/docs/"):
            for step in up:
                for file in ("etc/passwd", "fits.sqlite", "serve.log"):
                    target = f"{base}{step}/{step}/{step}/{file}".encode()
                    answer = self.server.raw(request(b"GET", target))
                    self.refused(answer, 400, 404)
                    self.assertNotIn(b"root:", answer.body)
        for target in (b"/v1/examples/..%2fdatasets%2fcoulomb", b"/v1/examples/%2fetc%2fpasswd", b"file:///etc/passwd",
                       b"//etc/passwd", b"*", b"etc/passwd"):
            self.refused(self.server.raw(request(b"GET", target)), 400, 404, 405)

    def test_invalid_targets(self):
        for target in (b"/v1/fits?name=%", b"/v1/fits?name=%zz", b"/v1/fits?name=%ff", b"/v1/fits?name=%00", b"/v1/fits?%=1",
                       b"/v1/fits?=1", b"/v1/fits?&&=&"):
            answer = self.server.raw(request(b"GET", target))
            self.assertIn(answer.status, (200, 400), target)
        self.refused(self.server.raw(request(b"GET", b"/v1/fi\x80ts")), 400, 404)
        for broken in (b"GET\r\n\r\n", b"GET / HTTP/9.9\r\n\r\n", b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03" * 20,
                       b"\0" * 1000 + b"\r\n\r\n",
                       b"GET /\x00 HTTP/1.1\r\nHost: localhost\r\n\r\n", b"GET / HTTP/1.1\r\nHost : localhost\r\n\r\n",
                       b"GET / HTTP/1.1\r\nHost: localhost\r\n folded\r\n\r\n", b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"):
            answer = self.server.raw(broken)
            if answer:  # the server may also close the connection
                self.assertGreaterEqual(answer.status, 200 if b"folded" in broken else 400, broken[:40])

    def test_a_million_parameters(self):
        query = b"&".join(b"x%d=1" % i for i in range(10**6))
        self.refused(self.server.raw(request(b"GET", b"/v1/fits?" + query)), 400, 413, 414, 431)
        self.refused(self.server.raw(request(b"GET", b"/v1/fits?" + query[:4000])), 400)

    def test_too_large_headers(self):
        self.check_problem(self.server.raw(request(b"GET", b"/", b"X: " + b"x" * 10**6)), 431, "headers_too_large")
        self.check_problem(self.server.raw(request(b"GET", b"/", *[b"X%d: 1" % i for i in range(10**5)])), 431,
                           "headers_too_large")

    def test_nothing_is_injected_into_headers_or_the_log(self):
        evil = "a\r\nSet-Cookie: evil=1\r\n\r\n<script>"
        coded = "a%0d%0aSet-Cookie:%20evil=1%0d%0a%0d%0a%3Cscript%3E%0a127.0.0.1%20forged"
        answers = [self.server.post_csv(f"/v1/fits?name={coded}", SHORT), self.server.get(f"/v1/fits/{coded}"),
                   self.server.get(f"/{coded}"),
                   self.server.post_csv(f"/v1/fits?model={coded}", SHORT), self.server.post_csv(f"/v1/fits?{coded}=1", SHORT),
                   self.server.post_json("/v1/fits", {"data": SHORT.decode(), "name": evil}),
                   self.server.post_json("/v1/fits", {"data": SHORT.decode(), "options": {"model": evil}}),
                   self.server.post_json("/v1/fits", {"data": SHORT.decode(), "options": {evil: "1"}})]
        for answer in answers:
            self.assertLess(answer.status, 500)
            self.assertNotIn("set-cookie", answer.headers)
            if answer.status == 200:
                for part in ("recording", "report"):
                    file = self.server.get(answer.headers["location"] + "/" + part)
                    self.assertNotIn("set-cookie", file.headers)
                    self.assertRegex(file.headers["content-disposition"], r'^attachment[^\r\n]*$')
        self.assertNotIn(b"\n127.0.0.1 forged", self.server.log())

    def test_any_filename_is_harmless(self):
        for name in ('"; filename="other.csv', "a\r\nX: 1", "../../../etc/passwd", "..\\..\\a.csv", "C:\\run.csv", "\0.csv",
                     "x" * 5000, "<b>.csv", ""):
            part = "data", name.replace('"', "%22").replace("\r\n", "%0D%0A"), "text/csv", SHORT
            answer = self.server.post_parts("/v1/fits", [part])
            self.assertIn(answer.status, (200, 400), (name, answer))
            if answer.status == 200:
                stored = self.server.get(answer.headers["location"] + "/request").json()["name"]
                self.assertLessEqual(len(stored.encode()), 200)
                recording = self.server.get(answer.headers["location"] + "/recording")
                self.assertRegex(recording.headers["content-disposition"], r"^attachment[^\r\n]*$")
        head = b'--b\r\nContent-Disposition: form-data; name="data"; filename="a\r\nX-Evil: 1"\r\n\r\n'
        self.assertIn(self.server.ask("POST", "/v1/fits", head + SHORT + b"\r\n--b--\r\n", Content_Type=FORM).status, (200, 400))


class Bodies(Hostile):
    def test_files_that_are_not_recordings(self):
        zeros = io.BytesIO()
        with zipfile.ZipFile(zeros, "w", zipfile.ZIP_DEFLATED) as file:
            file.writestr("run.csv", b"\0" * (50 << 20))
        for data in (zeros.getvalue(), b"\0" * (8 << 20), gzip.compress(COULOMB), bytes(range(256)) * 20000,
                     b"\xff\xfe" + COULOMB.decode().encode("utf-16-le")[1:],
                     b",".join([b"a"] * 10**6), b'"' * 10**6, b"\n" * 10**6, b"time_s,angle_deg\n" + b"9" * 10**6,
                     b"# resolution: " + b"9" * 10**6,
                     b"time_s,angle_deg\n0,\xff\xfe\n1,2\n"):
            self.refused(self.server.post_csv("/v1/fits", data), 400, 413, 422)

    def test_compressed_bodies_are_refused(self):
        bomb = gzip.compress(b"\0" * (100 << 20))
        for coding in ("gzip", "deflate", "br", "GZIP, gzip"):
            self.refused(self.server.post_csv("/v1/fits", bomb, Content_Encoding=coding), 400, 415)
        for coding in (b"gzip, chunked", b"gzip", b"chunked, chunked", b"nonsense"):
            answer = self.server.raw(request(b"POST", b"/v1/fits", b"Content-Type: text/csv", b"Transfer-Encoding: " + coding,
                                             body=bomb[:1000]))
            if answer:
                self.refused(answer, 400, 408, 411, 415, 501)

    def test_invalid_or_too_deep_json(self):
        deep = 100_000
        texts = [b"[" * deep + b"]" * deep, b'{"data":' * deep + b"1" + b"}" * deep, b'{"options":' + b'{"a":' * deep,
                 b"[" * (5 << 20), b"",
                 b"{", b"nul", b"\xff\xfe", b'{"data": "\xff"}', b'{"data": "\\ud800"}', b'{"data": "a\\u0000b"}', b"{}{}",
                 b'{"data": NaN}', b"\0",
                 b'{"data": 1e999999}', b'{"data": ' + b"1" * 10**6 + b"}", b'{"data": Infinity}', b"\xef\xbb\xbf{", b"//",
                 b'{"data": "x",}']
        for text in texts:
            for target in ("/v1/fits", "/v1/simulations"):
                self.refused(self.server.ask("POST", target, text, Content_Type="application/json"), 400, 422)

    def test_options_with_invalid_numbers(self):
        for value in ("NaN", "Infinity", "-Infinity", "1e999", "-1e999", "1" * 10**5, '"nan"', '"inf"', "null", "[]", "{}"):
            for key in ("from", "seed", "resolution", "release", "sample_rate_hz"):
                text = '{"data": %s, "options": {"%s": %s}}' % (json.dumps(SHORT.decode()), key, value)
                answer = self.server.ask("POST", "/v1/fits", text.encode(), Content_Type="application/json")
                self.assertLess(answer.status, 500, (key, value))
                if answer.status != 200:
                    self.refused(answer, 400, 422)
            for key in ("duration", "rate", "noise", "jitter", "start_time", "noise_freedom"):
                text = '{"set": "inertia=0.05,release_angle=0.4,release_time=0.1", "%s": %s}' % (key, value)
                answer = self.server.ask("POST", "/v1/simulations", text.encode(), Content_Type="application/json")
                if answer.status != 200:
                    self.refused(answer, 400, 413, 422)

    def test_keys_given_twice_are_refused(self):
        data = json.dumps(SHORT.decode())
        for text in ('{"data": %s, "data": "x"}' % data,
                     '{"data": %s, "options": {"model": "linear", "model": "viscous"}}' % data,
                     '{"data": %s, "rig": {"gravity_torque": 1, "gravity_torque": 2}}' % data):
            self.refused(self.server.ask("POST", "/v1/fits", text.encode(), Content_Type="application/json"), 400, 422)

    def test_extreme_rigs(self):
        for rig in ({"gravity_torque": 1e308}, {"gravity_torque": 5e-324}, {"gravity_torque": [1] * 1000},
                    {"gravity_torque": {"value": 1, "std_dev": -1}},
                    {"gravity_torque": "x" * 10**6}, {"x" * 10**6: 1}, {"gravity_torque": True}):
            answer = self.server.post_json("/v1/fits", {"data": SHORT.decode(), "rig": rig})
            self.assertLess(answer.status, 500, str(rig)[:60])
            if answer.status != 200:
                self.refused(answer, 400, 422)

    def test_extreme_calibrations(self):
        for table in (b"counts,angle_deg\n" + b"1,1\n" * 200000, b"counts,angle_deg\n" + b"1e308,1e308\n-1e308,-1e308\n0,0\n",
                      b"counts,angle_deg\nnan,nan\n1,2\n",
                      b"\0" * 10**6, b"counts,angle_deg\n1,1\n1,2\n1,3\n"):
            self.refused(self.server.post_csv("/v1/calibrations?order=5", table), 400, 413, 422)

    def test_wrong_body_lengths(self):
        def post(*fields, body=b""):
            return self.server.raw(request(b"POST", b"/v1/fits", b"Content-Type: text/csv", *fields, body=body))
        for length in (b"-1", b"x", b"1e3", b"99999999999999999999999999", b"0x10", b"1, 2", b""):
            self.refused(post(b"Content-Length: " + length, body=b"12"), 400, 413)
        self.refused(post(b"Content-Length: 5", b"Content-Length: 6", body=b"123456"), 400)
        self.refused(post(b"Content-Length: 0"), 400, 422)
        self.refused(post(), 400, 411, 422)
        smuggled = b"0\r\n\r\nGET /v1/none HTTP/1.1\r\nHost: localhost\r\n\r\n"
        self.refused(post(b"Content-Length: 100", b"Transfer-Encoding: chunked", body=smuggled), 400, 422)
        for chunks in (b"zz\r\n", b"-1\r\n", b"ffffffffffffffffff\r\n", b"5\r\n123456\r\n0\r\n\r\n",
                       b"1;" + b"x" * 10**6 + b"\r\n1\r\n0\r\n\r\n", b"7fffffffffffffff\r\nx"):
            self.refused(post(b"Transfer-Encoding: chunked", body=chunks), 400, 408, 413, 431)
        self.refused(post(b"Transfer-Encoding: chunked", body=b"1\r\nx\r\n" * 300000 + b"0\r\n\r\n"), 413, 422)

    def test_an_incomplete_body_times_out(self):
        answer = self.server.raw(request(b"POST", b"/v1/fits", b"Content-Type: text/csv", b"Content-Length: 100", body=b"time_s"))
        if answer:  # or the connection was closed
            self.check_problem(answer, 408, "timed_out")

    def test_too_many_samples(self):
        data = b"time_s,angle_deg\n" + b"".join(b"%d.%03d,%d\n" % (*divmod(i, 1000), i % 50) for i in range(20001))
        for answer in (self.server.post_csv("/v1/fits", data), self.server.post_parts("/v1/fits", [data_part("a.csv", data)]),
                       self.server.post_json("/v1/fits", {"data": data.decode()})):
            problem = self.check_problem(answer, 413, "too_large", "20 ?000|20001")
            self.assertEqual(problem["exit_code"], 4)

    def test_a_too_large_body(self):
        self.check_problem(self.server.post_csv("/v1/fits", b"1" * (17 << 20)), 413, "too_large", "16")


class Parts(Hostile):
    def post(self, body, content_type=FORM, target="/v1/fits"):
        return self.server.ask("POST", target, body, Content_Type=content_type)

    def test_a_hundred_thousand_parts(self):
        body, content_type = multipart([("x", None, None, b"")] * 10**5)
        for target in ("/v1/fits", "/v1/batches"):
            self.refused(self.post(body, content_type, target), 400, 413)
        body, content_type = multipart([data_part("a.csv", b"")] * 10**5)
        self.refused(self.post(body, content_type, "/v1/batches"), 400, 413)

    def test_more_runs_than_a_batch_may_have(self):
        body, content_type = multipart([data_part("a.csv", SHORT)] * 51)
        self.check_problem(self.post(body, content_type, "/v1/batches"), 413, "too_large", "50")

    def test_invalid_forms(self):
        data = b'--b\r\nContent-Disposition: form-data; name="data"\r\n\r\n' + SHORT
        for body in (b"", b"--b", b"--b\r\n", b"--b--", data, data + b"\r\n--b", data + b"\r\n--c--\r\n",
                     b"--b\r\n\r\n" + SHORT + b"\r\n--b--\r\n",
                     b"--b\r\nContent-Disposition: form-data\r\n\r\nx\r\n--b--\r\n",
                     b"--b\r\nContent-Disposition: attachment; name=data\r\n\r\nx\r\n--b--\r\n",
                     b"--b\r\n" + b"X: 1\r\n" * 10**5 + b"\r\nx\r\n--b--\r\n",
                     b'--b\r\nContent-Disposition: form-data; name="data' + b"\r\n\r\nx\r\n--b--\r\n",
                     b"\0" * 10**6):
            self.refused(self.post(body), 400, 413, 422)
        for content_type in ("multipart/form-data", "multipart/form-data; boundary=",
                             "multipart/form-data; boundary=" + "b" * 1000, 'multipart/form-data; boundary="b'):
            self.refused(self.post(data + b"\r\n--b--\r\n", content_type), 400, 415)

    def test_repeated_unknown_or_missing_parts(self):
        rig = json_part("rig", {"gravity_torque": 1.0})
        data = data_part("a.csv", SHORT)
        for parts in ([data, data], [data, rig, rig], [rig], [], [data, json_part("stranger", {})],
                      [data, ("options", None, None, b"[1]")],
                      [data, ("options", None, None, b'{"model": {"a": 1}}')], [data, ("options", None, None, b"\xff")],
                      [data, ("rig", None, None, b"\0" * 1000)],
                      [data, ("options", None, None, b"[" * 100000)], [data, ("rig", None, None, b"[" * 100000)],
                      [data, ("calibration", None, None, b"{" * 10)]):
            body, content_type = multipart(parts)
            self.refused(self.post(body, content_type), 400, 422)


class Overload(Lab):
    """Work that takes or would wait too long gets an error, and its resources are released."""

    def at_once(self, server, count, data, options):
        answers = []
        threads = [threading.Thread(target=lambda: answers.append(server.post_csv(f"/v1/fits?{query_of(options)}", data)))
                   for _ in range(count)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        return answers

    def test_a_fit_that_takes_too_long_is_ended(self):
        seconds = "5"  # A short fit must end within them on a busy machine.
        server = self.serve("--fit_seconds", seconds, "--threads", "1")
        problem = self.check_problem(server.post_csv(f"/v1/fits?{query_of(LONG_FIT)}", COULOMB), 408, "timed_out",
                                     f"not done after {seconds} s")
        self.assertEqual(problem["exit_code"], 75)
        self.assertEqual(server.get("/v1/fits").json()["fits"], [])
        # The worker is free again: it finishes another fit with less work than the rest of the first fit.
        self.assertEqual(server.post_csv("/v1/fits?closed_form_only=true", SHORT).status, 200)
        self.assertLess(server.cpu_seconds(), 200 if IS_SANITIZED else 20)

    def test_a_run_of_a_batch_that_takes_too_long_is_ended_as_well(self):
        server = self.serve("--fit_seconds", "1", "--threads", "1")
        place = server.post_parts(f"/v1/batches?{query_of(LONG_FIT)}", [data_part("long.csv", COULOMB)]).headers["location"]
        done = self.wait_until(lambda: (now := server.get(place).json())["state"] == "done" and now, "the run is ended")
        self.assertEqual((done["failed"], done["fits"][0]["exit_code"]), (1, 75))
        self.assertIn("not done after 4 s", done["fits"][0]["reason"])  # four times the limit of a single fit

    def test_a_full_queue_refuses_and_other_requests_are_answered(self):
        server = self.serve("--threads", "1", "--max_queue", "2")
        answers = self.at_once(server, 16, COULOMB, {"model": "viscous,coulomb,drag"})
        fitted = [answer for answer in answers if answer.status == 200]
        self.assertGreaterEqual(len(fitted), 3)
        self.assertEqual(len({answer.body for answer in fitted}), 1)
        for answer in answers:
            if answer.status != 200:
                self.assertEqual(self.check_problem(answer, 429, "too_many_requests")["exit_code"], 75)
        self.assertLess(len(fitted), 16)
        self.assertEqual(server.post_csv("/v1/fits?closed_form_only=true", SHORT).status, 200)

    def test_quick_requests_are_answered_while_fits_use_every_thread(self):
        server = self.serve("--threads", "1", "--fit_seconds", "3600")

        def fit():
            with contextlib.suppress(OSError, http.client.HTTPException):  # the test kills the server
                server.post_csv(f"/v1/fits?{query_of(LONG_FIT)}", COULOMB)
        slow = threading.Thread(target=fit)
        slow.start()
        self.wait_until(lambda: server.requests_running() == 1, "the fit runs")
        for target in ("/healthz", "/v1/fits", "/v1/models", "/", "/metrics"):
            self.assertEqual(server.get(target).status, 200)
        self.assertTrue(slow.is_alive())  # so nothing has waited for the fit's end
        server.kill()
        slow.join()


if __name__ == "__main__":
    unittest.main()
