#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the access rules, rates and addresses of serve_pendulum: service_access_test.py PATH_OF_THE_TOOL."""

import hashlib
import pathlib
import shutil
import signal
import socket
import sqlite3
import subprocess
import threading
import unittest

from service import DATASETS, TIMEOUT_S, TOOL, Curl, Lab, Served, data_part, multipart

SHORT = b"".join((DATASETS / "runs_1.csv").read_bytes().splitlines(keepends=True)[:800])
PAGES = ("/", "/fits", "/fits/0", "/compare", "/calibration", "/live", "/batches/0")
PAGE_POLICY = {"default-src 'none'", "script-src 'self'", "style-src 'self'", "img-src 'self' data:", "connect-src 'self'",
               "base-uri 'none'", "form-action 'none'", "frame-ancestors 'none'"}


class SecurityFields(Lab):
    """Checks the security fields that every answer has."""

    def check_security_fields(self, response):
        for name, value in (("x-content-type-options", "nosniff"), ("referrer-policy", "no-referrer"),
                            ("cross-origin-resource-policy", "same-origin")):
            self.assertEqual(response.headers.get(name), value, response)
        self.assertIn("default-src 'none'", response.headers.get("content-security-policy", ""), response)
        self.assertNotIn("access-control-allow-origin", response.headers)


class Headers(SecurityFields, Served):
    FLAGS = ("--max_body_mb", "1")

    def test_every_kind_of_answer_has_the_security_fields(self):
        fit = self.server.post_csv("/v1/fits", SHORT)
        place = fit.headers["location"]
        parts = [data_part("a.csv", SHORT)]
        batch = self.server.post_parts("/v1/batches", parts)
        again = {"Idempotency_Key": "one"}
        answers = [fit, batch, *(self.server.get(target) for target in (
            place, f"{place}/report", f"{place}/series", f"{place}/sections", f"{place}/residuals", f"{place}/recording", f"{place}/markdown",
                                                                        "/v1/fits",
            "/healthz", "/metrics", "/openapi.json", "/v1/models", "/none", "/v1/fits/none", "/v1/fits?x=1", "/app.js",
                                                                        "/app.css", *PAGES,
            f"{batch.headers['location']}/events"))]
        answers += [self.server.ask("PUT", "/v1/fits"), self.server.get("/v1/fits", Host="evil.example"),
                    self.server.raw(b"nonsense\r\n\r\n"),
                    self.server.post_csv("/v1/fits", b"x" * 1500000),
                    self.server.ask("POST", "/v1/fits", b"<a/>", Content_Type="text/xml"),
                    self.server.ask("POST", f"{place}/readings", b'{"parameters": {}}', Content_Type="application/json"),
                    self.server.post_csv("/v1/fits?model=no", SHORT), self.server.post_csv("/v1/fits", SHORT, **again),
                    self.server.post_csv("/v1/fits", SHORT, **again), self.server.ask("DELETE", place),
                    self.server.ask("HEAD", "/"),
                    self.server.ask("OPTIONS", "/v1/fits"),
                    self.server.raw(b"GET / HTTP/1.1\r\nHost: a\r\nX: " + b"x" * 300000 + b"\r\n\r\n")]
        seen = set()
        for answer in answers:
            self.check_security_fields(answer)
            seen.add(answer.status)
        self.assertLessEqual({200, 202, 204, 400, 403, 404, 405, 413, 415, 431}, seen)

    def test_the_page_may_load_only_its_own_files(self):
        bodies = set()
        for target in PAGES:
            page = self.server.get(target)
            self.assertEqual((page.status, page.type), (200, "text/html"), target)
            self.assertEqual({each.strip() for each in page.headers["content-security-policy"].split(";") if each.strip()},
                             PAGE_POLICY)
            bodies.add(page.body)
        self.assertEqual(len(bodies), 1)
        for target, content_type in (("/app.js", "javascript"), ("/app.css", "text/css")):
            part = self.server.get(target)
            self.assertEqual(part.status, 200)
            self.assertIn(content_type, part.type)
            again = self.server.get(target, If_None_Match=part.headers["etag"])
            self.assertEqual((again.status, again.body), (304, b""))

    def test_head_is_get_without_its_body(self):
        place = self.server.post_csv("/v1/fits", SHORT).headers["location"]
        for target in ("/", "/app.js", "/healthz", "/openapi.json", "/v1/models", "/v1/fits", place, f"{place}/recording",
                       "/none"):
            got, head = self.server.get(target), self.server.ask("HEAD", target)
            self.assertEqual((head.status, head.body), (got.status, b""), target)
            self.assertEqual(head.headers["content-length"], str(len(got.body)), target)
            self.assertEqual(head.headers["content-type"], got.headers["content-type"], target)

    def test_methods_that_a_path_does_not_allow_are_405(self):
        cases = {"/v1/fits": ("PUT", {"GET", "POST"}), "/v1/fits/1": ("POST", {"GET", "PATCH", "DELETE"}), "/healthz": ("POST", {"GET"}),
                 "/v1/batches": ("DELETE", {"GET", "POST"}), "/v1/simulations": ("GET", {"POST"}),
                 "/v1/calibrations": ("GET", {"POST"}),
                 "/v1/fits/1/series": ("PATCH", {"GET"}), "/": ("POST", {"GET"}), "/v1/fits/1/refits": ("GET", {"POST"}),
                 "/v1/models": ("DELETE", {"GET"}), "/openapi.json": ("PUT", {"GET"})}
        for target, (method, allowed) in cases.items():
            answer = self.server.ask(method, target)
            self.check_problem(answer, 405, "method_not_allowed")
            self.assertEqual({each.strip() for each in answer.headers["allow"].split(",")} - {"HEAD", "OPTIONS"}, allowed, target)

    def test_unknown_methods_are_refused(self):
        for method in ("TRACE", "BREW", "CONNECT", "get"):
            answer = self.server.ask(method, "/v1/models")
            self.assertIn(answer.status, (400, 405, 501), method)  # RFC 9110, section 9.1
            self.check_problem(answer, answer.status, answer.json()["code"])

    def test_unknown_paths_are_404(self):
        for target in ("/v1", "/v2/fits", "/v1/fits/1/2/3", "/v1/fitss", "/index.html", "/fits/1/2", "/V1/fits"):
            self.check_problem(self.server.get(target), 404, "not_found")
        for target in ("/v1/", "/v1/fits/", "//", "/v1//fits", "/v1/fits/1/"):
            answer = self.server.get(target)
            self.assertIn(answer.status, (400, 404), target)
            self.check_problem(answer, answer.status, answer.json()["code"])

    def test_bodies_of_other_types_are_415(self):
        for content_type in ("text/xml", "application/pdf", "image/png", "application/x-www-form-urlencoded", "nonsense"):
            for target in ("/v1/fits", "/v1/calibrations", "/v1/simulations"):
                self.check_problem(self.server.ask("POST", target, SHORT, Content_Type=content_type), 415,
                                   "unsupported_media_type")
        self.check_problem(self.server.post_csv("/v1/batches", SHORT), 415, "unsupported_media_type")
        self.check_problem(self.server.post_csv("/v1/fits", SHORT, Content_Encoding="gzip"), 415, "unsupported_media_type")

    def test_an_unavailable_accept_type_is_answered_or_406(self):
        answer = self.server.get("/v1/models", Accept="image/png")
        self.assertIn(answer.status, (200, 406))  # RFC 9110, section 12.5.1 leaves the choice to the server


class Origins(SecurityFields, Served):
    """Without a token only pages of this machine's own service may send requests."""

    FLAGS = ("--allowed_hosts", "lab.example,other.example")

    def test_hosts(self):
        port = self.server.port
        for host in (f"127.0.0.1:{port}", f"localhost:{port}", f"[::1]:{port}", "localhost", "LOCALHOST", "lab.example",
                     f"other.example:{port}"):
            self.assertEqual(self.server.get("/v1/models", Host=host).status, 200, host)
        for host in ("evil.example", f"evil.example:{port}", "127.0.0.1.evil.example", "localhost.evil.example", "xlab.example",
                    
                     "10.0.0.1", "a.lab.example"):
            for target in ("/v1/models", "/", "/v1/fits", "/metrics"):
                self.check_problem(self.server.get(target, Host=host), 403, "forbidden")

    def test_requests_without_a_host_or_with_two_are_refused(self):
        for head in (b"", b"Host: localhost\r\nHost: evil.example\r\n", b"Host: a b\r\n"):
            answer = self.server.raw(b"GET /v1/models HTTP/1.1\r\n" + head + b"Connection: close\r\n\r\n")
            self.assertIn(answer.status, (400, 403), head)

    def test_origins(self):
        host = f"127.0.0.1:{self.server.port}"
        self.assertEqual(self.server.post_csv("/v1/fits", SHORT, Host=host, Origin=f"http://{host}").status, 200)
        count = len(self.server.get("/v1/fits").json()["fits"])
        for origin in ("http://evil.example", "null", "http://127.0.0.1:1", f"http://{host}.evil.example",
                       f"http://evil.example/{host}"):
            self.check_problem(self.server.post_csv("/v1/fits", SHORT, Host=host, Origin=origin), 403, "forbidden")
            self.check_problem(self.server.ask("DELETE", "/v1/fits/1", Host=host, Origin=origin), 403, "forbidden")
        self.assertEqual(len(self.server.get("/v1/fits").json()["fits"]), count)

    def test_cross_site_requests(self):
        self.check_problem(self.server.post_csv("/v1/fits", SHORT, Sec_Fetch_Site="cross-site"), 403, "forbidden")
        self.check_problem(self.server.get("/v1/fits", Sec_Fetch_Site="cross-site"), 403, "forbidden")
        for site in ("same-origin", "none"):
            self.assertEqual(self.server.get("/v1/fits", Sec_Fetch_Site=site).status, 200, site)


class Tokens(SecurityFields):
    def check_token(self, server, token):
        for headers in ({}, {"Authorization": "Bearer wrong"}, {"Authorization": f"Bearer {token}x"},
                        {"Authorization": f"Bearer {token[:-1]}"},
                        {"Authorization": token}, {"Authorization": f"Basic {token}"}, {"Authorization": "Bearer "}):
            for method, target in (("GET", "/v1/fits"), ("POST", "/v1/fits"), ("GET", "/metrics"), ("DELETE", "/v1/fits/1"),
                                   ("GET", "/v1/models"), ("GET", "/v1/none")):
                answer = server.ask(method, target, **headers)
                self.check_problem(answer, 401, "unauthorized")
                self.assertRegex(answer.headers["www-authenticate"], "^Bearer")
                self.check_security_fields(answer)
                self.assertNotIn(token.encode(), answer.body)
        for target in ("/healthz", "/", "/fits", "/app.js", "/app.css"):
            self.assertEqual(server.get(target).status, 200, target)
        self.assertEqual(server.get("/v1/fits", Authorization=f"Bearer {token}").status, 200)
        self.assertEqual(server.post_csv("/v1/fits", SHORT, Authorization=f"bearer {token}").status, 200)
        self.assertEqual(server.stop(), 0)
        self.assertNotIn(token.encode(), server.log())

    def test_a_token_in_a_file(self):
        (self.folder / "token").write_text("correct-horse-battery-staple\n")
        self.check_token(self.serve("--token_file", "token"), "correct-horse-battery-staple")

    def test_a_token_in_the_environment(self):
        self.check_token(self.serve(environment={"PENDULUM_TOKEN": "from-the-environment-0123456789"}),
                         "from-the-environment-0123456789")

    def test_with_a_token_any_address_is_served(self):
        (self.folder / "token").write_text("correct-horse-battery-staple")
        server = self.serve("--token_file", "token", "--address", "0.0.0.0")
        self.assertEqual(server.get("/v1/fits", Authorization="Bearer correct-horse-battery-staple", Host="evil.example").status,
                         200)


class Idempotency(Served):
    def count(self):
        return len(self.server.get("/v1/fits?limit=1000").json()["fits"])

    def test_a_repetition_gives_the_same_answer(self):
        before = self.count()
        first = self.server.post_csv("/v1/fits?model=viscous", SHORT, Idempotency_Key="key-1")
        self.assertEqual(first.status, 200)
        self.assertNotIn("idempotency-replayed", first.headers)
        for _ in range(2):
            again = self.server.post_csv("/v1/fits?model=viscous", SHORT, Idempotency_Key="key-1")
            self.assertEqual((again.status, again.body, again.headers["location"], again.headers["idempotency-replayed"]),
                             (200, first.body, first.headers["location"], "true"))
        self.assertEqual(self.count(), before + 1)
        self.assertNotEqual(self.server.post_csv("/v1/fits?model=viscous", SHORT).headers["location"], first.headers["location"])

    def test_a_repeated_batch_is_made_once(self):
        body, content_type = multipart([data_part("a.csv", SHORT), data_part("b.csv", SHORT)])
        answers = [self.server.ask("POST", "/v1/batches", body, Content_Type=content_type, Idempotency_Key="batch-1")
                   for _ in range(3)]
        self.assertEqual([answer.status for answer in answers], [202] * 3)
        self.assertEqual(len({answer.headers["location"] for answer in answers}), 1)

    def test_a_key_of_another_request_is_refused(self):
        self.assertEqual(self.server.post_csv("/v1/fits?model=viscous", SHORT, Idempotency_Key="key-2").status, 200)
        for target, data in (("/v1/fits?model=viscous", SHORT + b"# more\n"), ("/v1/fits?model=linear", SHORT)):
            self.check_problem(self.server.post_csv(target, data, Idempotency_Key="key-2"), 422, "idempotency_key_reused")

    def test_keys_are_visible_ascii(self):
        for key in ("", "x" * 256, "a b", "a\tb", "\u00fc"):
            self.check_problem(self.server.post_csv("/v1/fits", SHORT, Idempotency_Key=key.encode("latin-1")), 400,
                               "bad_request")
        self.assertEqual(self.server.post_csv("/v1/fits", SHORT, Idempotency_Key="!" + "~" * 254).status, 200)

    def test_simultaneous_repetitions_make_one_fit(self):
        before, answers = self.count(), []
        data = (DATASETS / "coulomb.csv").read_bytes()

        def post():
            answers.append(self.server.post_csv("/v1/fits?model=viscous,coulomb", data, Idempotency_Key="key-3"))
        threads = [threading.Thread(target=post) for _ in range(8)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(self.count(), before + 1)
        done = [answer for answer in answers if answer.status == 200]
        self.assertEqual(sum("idempotency-replayed" not in answer.headers for answer in done), 1)
        self.assertEqual(len({hashlib.sha256(answer.body).digest() for answer in done}), 1)
        for answer in answers:
            if answer.status != 200:
                self.check_problem(answer, 409, "conflict")

    def test_a_refusal_may_be_repeated(self):
        for _ in range(2):
            self.check_problem(self.server.post_csv("/v1/fits?model=no", SHORT, Idempotency_Key="key-4"), 400, "bad_request")


class FailedStarts(Lab):
    """The exit code tells why the server does not start."""

    def check_refused(self, code, pattern, *flags, store="other.sqlite"):
        done = subprocess.run([TOOL, *(["--store", store] if store else []), *map(str, flags)], cwd=self.folder,
                              capture_output=True, text=True,
                              timeout=TIMEOUT_S, env={"PATH": "/usr/bin:/bin"})
        self.assertEqual(done.returncode, code, (flags, done.stderr))
        self.assertEqual(done.stdout, "")
        self.assertRegex(done.stderr, pattern)

    def test_other_machines_are_not_served_without_a_token(self):
        for address in ("0.0.0.0", "::", "192.0.2.1"):
            self.check_refused(2, "token", "--address", address, "--port", 0)

    def test_wrong_flags_exit_2(self):
        for flags in (("--prot", 1), ("--port", 70000), ("--port", -1), ("--port", "x"), ("--address", "nowhere at all"),
                      ("--threads", -1),
                      ("--max_body_mb", 0), ("--max_samples", -5), ("--fit_seconds", 0), ("--max_queue", -1),
                      ("--max_connections", 0),
                      ("--max_batch_runs", 0), ("--request_seconds", 0), ("stray",)):
            self.check_refused(2, r"serve_pendulum: .*" + str(flags[0]), *flags)

    def test_a_port_in_use_exits_73(self):
        with socket.create_server(("127.0.0.1", 0)) as taken:
            port = taken.getsockname()[1]
            self.check_refused(73, str(port), "--port", port)

    def test_a_file_that_is_not_a_store_exits_4(self):
        (self.folder / "text.sqlite").write_text("this is no store\n" * 100)
        with sqlite3.connect(self.folder / "strange.sqlite") as database:
            database.execute("CREATE TABLE recipes (name TEXT)")
        for store in ("text.sqlite", "strange.sqlite"):
            before = (self.folder / store).read_bytes()
            self.check_refused(4, store, "--port", 0, store=store)
            self.assertEqual((self.folder / store).read_bytes(), before)

    def test_a_store_that_is_a_device_exits_4(self):
        self.check_refused(4, "/dev/null", "--port", 0, store="/dev/null")
        self.assertFalse(pathlib.Path("/dev/null-journal").exists())

    def test_a_store_in_use_exits_75(self):
        server = self.serve()
        self.check_refused(75, "fits.sqlite", "--port", 0, store="fits.sqlite")
        self.assertEqual(server.get("/healthz").status, 200)
        server.stop(signal.SIGKILL)
        server.start()
        self.assertEqual(server.get("/healthz").status, 200)

    def test_a_store_that_cannot_be_made_exits_73(self):
        self.check_refused(73, "none/a.sqlite", "--port", 0, store="none/a.sqlite")

    def test_help_and_version_succeed(self):
        for flag, pattern in (("--help", "--token_file"), ("--version", r"^serve_pendulum \d+\.\d+\.\d+$")):
            done = subprocess.run([TOOL, flag], capture_output=True, text=True, timeout=TIMEOUT_S)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertRegex(done.stdout, pattern)


class CurlFeatures(Curl):
    """Special features of curl: a body announced with Expect, a persistent connection, chunks."""

    def test_bodies_are_accepted_as_curl_sends_them(self):
        expected = self.fitted("coulomb.csv")
        for arguments in (["-H", "Expect: 100-continue"], ["-H", "Transfer-Encoding: chunked"], ["--http1.0"], ["--compressed"]):
            answer = self.curl("/v1/fits", "--data-binary", "@coulomb.csv", "-H", "Content-Type: text/csv", *arguments)
            self.assertEqual((answer.status, answer.body), (200, expected), arguments)
        shutil.copy(self.folder / "coulomb.csv", self.folder / "again.csv")
        answer = self.curl("/v1/fits", "-T", "again.csv", "-H", "Content-Type: text/csv", method="POST")
        self.assertEqual(answer.body, expected)


if __name__ == "__main__":
    unittest.main()
