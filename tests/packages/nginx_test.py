#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs serve_pendulum of the Debian package behind a real nginx, with TLS, according to the package's example:
nginx_test.py FOLDER_OF_THE_PACKAGES FOLDER_OF_THE_TOOLS.

Only ports, paths and the certificate differ from the example; everything runs on 127.0.0.1."""

import json
import os
import pathlib
import re
import select
import shutil
import signal
import socket
import subprocess
import sys
import time
import unittest

import empty_root
import packed

BIN = pathlib.Path()
NAME = "pendulum.example.org"
TOKEN = "0123456789abcdef" * 4
RECORDING = empty_root.TOP / empty_root.DATA[0]
PATIENCE = 60  # s; answers usually come at once, so a longer wait means that one is lost


def free_ports(count):
    """Different ports of 127.0.0.1 on which nothing listens."""
    sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(count)]
    ports = [each.getsockname()[1] for each in sockets]
    for each in sockets:
        each.close()
    return ports


class Answer:
    """The last answer in the output of curl --include: status, fields (names in lower case), body."""

    def __init__(self, printed):
        head, _, self.body = printed.partition(b"\r\n\r\n")
        lines = head.decode().split("\r\n")
        self.status = int(lines[0].split()[1])
        self.fields = {name.lower(): value.strip() for name, _, value in (line.partition(":") for line in lines[1:])}

    def json(self):
        return json.loads(self.body)


class NginxTest(packed.DebianFilesTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.http, cls.https = free_ports(2)
        cls.make_certificate()
        cls.start_service()
        cls.start_nginx()

    @classmethod
    def make_certificate(cls):
        cls.certificate, cls.key = cls.folder / "certificate.pem", cls.folder / "key.pem"
        subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes",
                        "-days", "2", "-subj", f"/CN={NAME}", "-addext", f"subjectAltName=DNS:{NAME}",
                        "-out", cls.certificate, "-keyout", cls.key], check=True, capture_output=True)

    @classmethod
    def stop(cls, process):
        process.send_signal(signal.SIGTERM)
        code = process.wait(timeout=PATIENCE)
        if process.stdout:
            process.stdout.close()
        if code != 0:
            raise AssertionError(f"{process.args[0]} ended with {code}")

    @classmethod
    def start_service(cls):
        token = cls.folder / "token"
        token.write_text(TOKEN + "\n")
        cls.run_csv = cls.folder / "run.csv"
        with open(cls.folder / "service.log", "w") as log:
            process = subprocess.Popen([cls.root / "usr/bin/serve_pendulum", "--port", "0",
                                        "--store", cls.folder / "fits.sqlite", "--token_file", token, "--live", cls.run_csv],
                                       stdout=subprocess.PIPE, stderr=log, text=True)
        cls.addClassCleanup(cls.stop, process)
        listening = re.fullmatch(r"serve_pendulum: listening on http://127\.0\.0\.1:(\d+)\n", process.stdout.readline())
        if not listening:
            raise AssertionError((cls.folder / "service.log").read_text())
        cls.port = int(listening[1])

    @classmethod
    def example(cls):
        """The package's nginx.conf, with this test's ports and paths instead of a system's."""
        text = (cls.root / "usr/share/doc/pendulum/examples/nginx.conf").read_text()
        for there, here in {
                "    listen 80;": f"    listen 127.0.0.1:{cls.http};", "    listen [::]:80;\n": "",
                "    listen 443 ssl http2;": f"    listen 127.0.0.1:{cls.https} ssl http2;",
                "    listen [::]:443 ssl http2;\n": "",
                "    server 127.0.0.1:8080;": f"    server 127.0.0.1:{cls.port};",
                f"/etc/ssl/certs/{NAME}.pem": str(cls.certificate),
                f"/etc/ssl/private/{NAME}.key": str(cls.key)}.items():
            if text.count(there) != 1:
                raise AssertionError(f"{there!r} is not once in nginx.conf")
            text = text.replace(there, here)
        return text

    @classmethod
    def start_nginx(cls):
        (cls.folder / "site.conf").write_text(cls.example())
        paths = "".join(f"{name}_temp_path {cls.folder}/{name};\n"
                        for name in ("client_body", "proxy", "fastcgi", "uwsgi", "scgi"))
        user = "user root;\n" if os.geteuid() == 0 else ""  # the user who may write into this folder
        configuration = cls.folder / "nginx.conf"
        configuration.write_text(f"{user}daemon off;\npid {cls.folder}/nginx.pid;\nerror_log stderr;\nworker_processes 1;\n"
                                 f"events {{}}\nhttp {{\naccess_log off;\n{paths}include {cls.folder}/site.conf;\n}}\n")
        program = shutil.which("nginx", path=f"{os.environ['PATH']}:/usr/sbin")
        if program is None:
            raise FileNotFoundError("There is no nginx: run scripts/install_dependencies --packages.")
        command = [program, "-p", cls.folder, "-e", "stderr", "-c", configuration]
        cls.checked = subprocess.run([*command, "-t"], capture_output=True, text=True)
        cls.log = open(cls.folder / "nginx.log", "w+")
        cls.addClassCleanup(cls.log.close)
        process = subprocess.Popen(command, stdout=cls.log, stderr=cls.log)
        cls.addClassCleanup(cls.stop, process)
        deadline = time.monotonic() + PATIENCE
        while process.poll() is None and time.monotonic() < deadline:
            try:
                socket.create_connection(("127.0.0.1", cls.https), timeout=1).close()
                return
            except OSError:
                time.sleep(0.05)
        raise AssertionError((cls.folder / "nginx.log").read_text() + cls.checked.stderr)

    def command(self, path, *options, token=TOKEN):
        """A curl command that trusts only the test's certificate."""
        authorization = ["--header", f"Authorization: Bearer {token}"] if token else []
        return ["curl", "--silent", "--show-error", "--max-time", str(PATIENCE), "--noproxy", "*", "--cacert",
                self.certificate, "--resolve", f"{NAME}:{self.https}:127.0.0.1", *authorization, *options,
                f"https://{NAME}:{self.https}{path}"]

    def ask(self, path, *options, token=TOKEN):
        done = subprocess.run(self.command(path, "--include", "--header", "Expect:", *options, token=token), capture_output=True)
        self.assertEqual((done.returncode, done.stderr), (0, b""))
        return Answer(done.stdout)

    def post_recording(self, path, **options):
        return self.ask(path, "--data-binary", f"@{RECORDING}", "--header", "Content-Type: text/csv", **options)

    def check_problem(self, answer, status, code):
        self.assertEqual(answer.status, status, answer.body)
        self.assertEqual(answer.fields["content-type"], "application/problem+json")
        self.assertEqual((answer.json()["status"], answer.json()["code"]), (status, code))
        self.assertEqual(answer.fields["strict-transport-security"], "max-age=31536000")

    def test_nginx_accepts_the_example_without_a_warning(self):
        self.assertEqual(self.checked.returncode, 0, self.checked.stderr)
        self.assertNotIn("[warn]", self.checked.stderr)

    def test_plain_http_is_sent_to_https_with_its_method(self):
        done = subprocess.run(["curl", "--silent", "--include", "--noproxy", "*", "--data", "", "--header", f"Host: {NAME}",
                               f"http://127.0.0.1:{self.http}/v1/fits?model=drag"], capture_output=True, check=True)
        answer = Answer(done.stdout)
        self.assertEqual((answer.status, answer.fields["location"]), (308, f"https://{NAME}/v1/fits?model=drag"))

    def test_fits_over_TLS_as_fit_pendulum_does(self):
        answer = self.post_recording("/v1/fits?model=coulomb")
        self.assertEqual(answer.status, 200, answer.body)
        self.assertEqual(answer.fields["strict-transport-security"], "max-age=31536000")
        self.assertRegex(answer.fields["location"], r"\A/v1/fits/[^/]+\Z")
        fitted = subprocess.run([BIN / "fit_pendulum", "--data", RECORDING, "--model", "coulomb", "--json", "-"],
                                capture_output=True, text=True, check=True).stdout
        self.assertEqual(answer.body.decode(), fitted.replace(json.dumps(str(RECORDING)), "null"))

    def test_token_is_required_through_nginx(self):
        self.check_problem(self.post_recording("/v1/fits", token=None), 401, "unauthorized")
        self.check_problem(self.post_recording("/v1/fits", token="another one"), 401, "unauthorized")
        self.assertEqual(self.ask("/healthz", token=None).status, 200)

    def test_only_pages_of_this_origin_may_send_requests(self):
        own = self.ask("/v1/fits", "--header", f"Origin: https://{NAME}:{self.https}", "--header", "Sec-Fetch-Site: same-origin")
        self.assertEqual(own.status, 200, own.body)
        other = self.ask("/v1/fits", "--header", "Origin: https://elsewhere.example.org")
        self.check_problem(other, 403, "forbidden")

    def test_body_over_the_limit_is_413(self):
        large = self.folder / "large.csv"
        large.write_bytes(b"0" * ((32 << 20) + 1))
        answer = self.ask("/v1/fits", "--data-binary", f"@{large}", "--header", "Content-Type: text/csv")
        self.check_problem(answer, 413, "too_large")

    def test_limits_and_times_match_the_flags(self):
        """Compares the texts, so that a change of one default requires the change of the other."""
        text = (self.root / "usr/share/doc/pendulum/examples/nginx.conf").read_text()
        default = packed.default_numbers(self.root / "usr/bin/serve_pendulum")
        self.assertEqual(int(re.search(r"client_max_body_size (\d+)m;", text)[1]), default["max_body_mb"])
        self.assertGreater(int(re.search(r"proxy_read_timeout (\d+)s;", text)[1]), default["fit_seconds"])
        self.assertEqual(re.search(r"server 127\.0\.0\.1:(\d+);", text)[1], str(default["port"]))

    def test_nginx_buffers_no_stream_of_the_service(self):
        """nginx passes chunks from the service on at once, so only its configuration shows whether it may wait."""
        location = re.search(r"location ~ (\S+) \{([^}]*)\}", self.example())
        self.assertIn("proxy_buffering off;", location[2])
        paths = self.ask("/openapi.json").json()["paths"]
        streams = {path for path in paths if "text/event-stream" in json.dumps(paths[path])}
        self.assertEqual(len(streams), 2)
        self.assertEqual({path for path in paths if re.search(location[1], path.replace("{id}", "4f1c"))}, streams)

    def test_metrics_are_not_public(self):
        self.assertEqual(self.ask("/metrics").status, 404)

    def stream(self, path):
        """The lines of a stream as they arrive; a line that takes longer than PATIENCE fails."""
        process = subprocess.Popen(self.command(path, "--no-buffer"), stdout=subprocess.PIPE)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        buffered = b""
        while True:
            while b"\n" in buffered:
                line, _, buffered = buffered.partition(b"\n")
                yield line.decode()
            ready, _, _ = select.select([process.stdout], [], [], PATIENCE / 2)
            self.assertTrue(ready, f"nothing comes of {path}, after {buffered}")
            read = os.read(process.stdout.fileno(), 65536)
            if not read:
                return
            buffered += read

    def next_samples(self, lines):
        """Times of the next event with samples."""
        while next(lines) != "event: samples":
            pass
        return json.loads(next(lines).removeprefix("data:"))["time_s"]

    def test_live_events_arrive_while_the_stream_is_open(self):
        """The stream never ends, so data held back by a proxy would never arrive."""
        with open(f"{self.run_csv}.part", "w") as part:
            part.write("# sample_rate_hz: 10\ntime_s,angle_deg\n0,5\n0.1,4\n0.2,3\n")
            part.flush()
            lines = self.stream("/v1/live/events")
            self.assertEqual(self.next_samples(lines), [0, 0.1, 0.2])
            part.write("0.3,2\n")
            part.flush()
            self.assertEqual(self.next_samples(lines), [0.3])

    def test_events_of_a_batch_arrive_completely(self):
        runs = [item for _ in range(2) for item in ("--form", f"data=@{RECORDING};type=text/csv")]
        made = self.ask("/v1/batches?model=viscous", *runs)
        self.assertEqual(made.status, 202, made.body)
        lines = list(self.stream(f"{made.fields['location']}/events"))
        self.assertEqual(lines.count("event: fit"), 2)
        last = lines[lines.index("event: done") + 1]
        self.assertEqual(json.loads(last.removeprefix("data:")), {"runs": 2, "done": 2, "failed": 0})

    def ask_together(self, count):
        """The answers to `count` simultaneous requests over one HTTP/2 connection."""
        command = self.command("/healthz", "--http2", "--parallel", "--parallel-max", str(count),
                               "--write-out", "%{http_code} %{content_type} %header{retry-after}\n", token=None)
        command += ["--output", os.devnull] * count + [f"https://{NAME}:{self.https}/healthz"] * (count - 1)
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()

    def test_too_many_requests_of_one_address_get_429(self):
        answers = set()
        for _ in range(10):  # on a stalled machine they are not simultaneous, and all are accepted
            if len(answers) < 2:
                answers |= set(self.ask_together(150))
        self.assertEqual(answers, {"200 application/json ", "429 application/problem+json 1"})
        deadline = time.monotonic() + PATIENCE
        while self.ask("/healthz").status != 200 and time.monotonic() < deadline:
            time.sleep(0.5)
        self.assertEqual(self.ask("/healthz").status, 200)


if __name__ == "__main__":
    BIN = pathlib.Path(sys.argv.pop(2)).resolve()
    NginxTest.packages = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
