# SPDX-License-Identifier: Apache-2.0
"""A running serve_pendulum and its clients for the tests of the service, and the command line's output for comparison."""

import http.client
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
import tempfile
import time
import unittest

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "tools"))
sys.path.append("/usr/lib/python3/dist-packages")  # Debian's modules, for a Python from elsewhere

from sanitizers import is_sanitized  # noqa: E402  (found by the path above)

TOOL = pathlib.Path(sys.argv.pop(1)).resolve()
TOOLS = TOOL.parent
DATASETS = pathlib.Path(__file__).resolve().parents[2] / "datasets"
RIG = DATASETS / "textbook_rig.json"
CALIBRATION = DATASETS / "potentiometer_calibration.json"
IS_SANITIZED = is_sanitized(TOOL)
TIMEOUT_S = 300
EXIT_TO_PROBLEM = {2: (400, "bad_request"), 3: (404, "not_found"), 4: (422, "unusable_data"), 5: (422, "no_swing")}
SANITIZERS_SAY = (b"ERROR: AddressSanitizer", b"ERROR: LeakSanitizer", b"WARNING: ThreadSanitizer", b"runtime error:")

SIMULATED = ["--model", "coulomb", "--rig", str(RIG), "--duration", "6", "--rate", "50", "--noise", "0.3", "--resolution",
             "0.1985",
             "--set", "inertia=0.079,viscous=0.003,coulomb=0.004,release_angle=0.423,release_time=0.5"]


class Server:
    """serve_pendulum on a free port of this machine, with its store and its log in a folder."""

    def __init__(self, folder, *flags, port=0, environment=None):
        self.folder, self.flags, self.environment = pathlib.Path(folder), flags, environment or {}
        self.process = None
        self.start(port)

    def start(self, port=0):
        """Starts or restarts the server and waits for the line with the port."""
        environment = {name: value for name, value in os.environ.items() if name != "PENDULUM_TOKEN"}
        command = [TOOL, "--port", str(port), "--store", "fits.sqlite", *map(str, self.flags)]
        if self.process:
            self.process.stdout.close()
        with open(self.folder / "serve.log", "ab") as log:
            self.process = subprocess.Popen(command, cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                            stderr=log,
                                            env={**environment, **self.environment})
        ready, _, _ = select.select([self.process.stdout], [], [], TIMEOUT_S)
        line = self.process.stdout.readline().decode() if ready else ""
        begin = "serve_pendulum: listening on http://"
        if not line.startswith(begin):
            self.process.kill()
            self.process.communicate()
            raise AssertionError(f"{command} said {line!r}; {self.log()[-2000:]!r}")
        self.host = line[len(begin):].strip().rstrip("/")
        self.port = int(self.host.rpartition(":")[2])

    def url(self, target):
        return f"http://127.0.0.1:{self.port}{target}"

    def log(self):
        return (self.folder / "serve.log").read_bytes()

    def is_alive(self):
        return self.process.poll() is None

    def kill(self):
        self.process.kill()
        self.process.communicate(timeout=TIMEOUT_S)

    def stop(self, number=signal.SIGTERM):
        """Stops the server like an operator does; returns its exit code."""
        if self.is_alive():
            self.process.send_signal(number)
        self.process.communicate(timeout=TIMEOUT_S)
        return self.process.returncode

    def resident_bytes(self):
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
        return 1024 * int(next(line.split()[1] for line in status.splitlines() if line.startswith("VmRSS:")))

    def cpu_seconds(self):
        """Processor time of the process so far, which does not depend on what else the machine does."""
        fields = pathlib.Path(f"/proc/{self.process.pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def requests_running(self):
        """Requests in progress, without the one that asks. An answered request may still be counted for a moment, so this is
        the smaller of two counts."""
        counts = [re.search(rb"^pendulum_http_requests_running (\d+)$", self.get("/metrics").body, re.MULTILINE)[1]
                  for _ in range(2)]
        return min(map(int, counts)) - 1

    def connect(self, timeout=TIMEOUT_S):
        return socket.create_connection(("127.0.0.1", self.port), timeout)

    def ask(self, method, target, body=None, **headers):
        """Sends one request on a separate connection; in header names _ stands for -."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=TIMEOUT_S)
        try:
            try:
                connection.request(method, target, body, {name.replace("_", "-"): value for name, value in headers.items()})
            except OSError:  # it may answer before it has received everything
                if connection.sock is None:
                    raise
                return read_answer(connection.sock)
            return Response.read(connection.getresponse())
        finally:
            connection.close()

    def open(self, target, **headers):
        """Returns an answer that is not read yet, such as a stream of events; its close() ends the connection."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=TIMEOUT_S)
        connection.request("GET", target, headers={"Connection": "close",
                                                   **{name.replace("_", "-"): value for name, value in headers.items()}})
        return connection.getresponse()

    def get(self, target, **headers):
        return self.ask("GET", target, **headers)

    def post_csv(self, target, data, **headers):
        return self.ask("POST", target, data, Content_Type="text/csv", **headers)

    def post_json(self, target, value, **headers):
        return self.ask("POST", target, json.dumps(value), Content_Type="application/json", **headers)

    def post_parts(self, target, parts, **headers):
        body, content_type = multipart(parts)
        return self.ask("POST", target, body, Content_Type=content_type, **headers)

    def raw(self, data, timeout=TIMEOUT_S):
        """Sends bytes unchanged; returns the answer to their one request, or None if the connection ended without an answer."""
        with self.connect(timeout) as connection:
            try:
                connection.sendall(data)
            except OSError:
                pass  # it may answer and close before it has received everything
            return read_answer(connection)


class Response:
    """Status, headers by lower-case names, and body."""

    def __init__(self, status, headers, body):
        self.status, self.headers, self.body = status, headers, body

    @classmethod
    def read(cls, response):
        body = response.read()
        return cls(response.status, {name.lower(): value for name, value in response.getheaders()}, body)

    def json(self):
        return json.loads(self.body)

    @property
    def type(self):
        return self.headers.get("content-type", "").partition(";")[0].strip()

    def __repr__(self):
        return f"{self.status} {self.headers} {self.body[:600]!r}"


def read_answer(connection):
    try:
        response = http.client.HTTPResponse(connection)
        response.begin()
        return Response.read(response)
    except (OSError, http.client.HTTPException):
        return None


def multipart(parts, boundary="gap-of-9d3f1b"):
    """Body and Content-Type of parts (name, filename or None, type or None, bytes)."""
    lines = []
    for name, filename, content_type, content in parts:
        disposition = f'Content-Disposition: form-data; name="{name}"' + (f'; filename="{filename}"'
                                                                          if filename is not None else "")
        head = disposition + (f"\r\nContent-Type: {content_type}" if content_type else "")
        lines += [f"--{boundary}\r\n{head}\r\n\r\n".encode(), content, b"\r\n"]
    return b"".join(lines) + f"--{boundary}--\r\n".encode(), f"multipart/form-data; boundary={boundary}"


def data_part(name, content):
    return "data", name, "text/csv", content


def json_part(name, value):
    return name, f"{name}.json", "application/json", json.dumps(value).encode()


def run_tool(name, *arguments, folder):
    """Exit code, standard output, and the last sentence on standard error without the tool's name and the command to try."""
    done = subprocess.run([TOOLS / name, *map(str, arguments)], cwd=folder, capture_output=True, timeout=TIMEOUT_S)
    lines = [line for line in done.stderr.decode().splitlines() if not line.startswith((f"{name}: warning: ", "try: "))]
    return done.returncode, done.stdout, lines[-1].removeprefix(f"{name}: ") if lines else ""


def without_path(result, path):
    """Result JSON of the command line in the form of the service."""
    there = b'"path": ' + json.dumps(path, ensure_ascii=False).encode()
    assert result.count(there) == 1, result[:300]
    return result.replace(there, b'"path": null')


def flags_of(options):
    """Flags of the command line for the flags of a request."""
    return [f"--{name}={value}" for name, value in options.items()]


def query_of(options):
    return "&".join(f"{name}={value}" for name, value in options.items())


class Lab(unittest.TestCase):
    """A separate folder for each test, and servers in it."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="service_"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def serve(self, *flags, **options):
        server = Server(self.folder, *flags, **options)
        self.addCleanup(self.end, server)
        return server

    def end(self, server):
        server.stop(signal.SIGKILL)
        self.check_log(server)

    def check_log(self, server):
        log = server.log()
        for words in SANITIZERS_SAY:
            self.assertNotIn(words, log, log[max(0, log.find(words)):][:4000].decode(errors="replace"))

    def check_problem(self, response, status, code, pattern="."):
        """Checks that an answer is a problem document (RFC 9457) with this status, code and text."""
        self.assertIsNotNone(response, "the connection ended without an answer")
        self.assertEqual((response.status, response.type), (status, "application/problem+json"), response)
        problem = response.json()
        self.assertEqual((problem["type"], problem["status"], problem["code"]), (f"urn:pendulum:problem:{code}", status, code),
                         problem)
        self.assertRegex(problem["title"], r"\w")
        self.assertRegex(problem["detail"], pattern)
        self.assertIn("exit_code", problem)
        if status in (408, 429, 503):
            self.assertRegex(response.headers.get("retry-after", ""), r"^[1-9]\d*$")
        return problem

    def check_same_problem(self, response, exit_code, sentence):
        """Checks that an answer has the sentence of the command line, which had that exit code."""
        status, code = EXIT_TO_PROBLEM[exit_code]
        problem = self.check_problem(response, status, code)
        self.assertEqual((problem["detail"], problem["exit_code"]), (sentence, exit_code))

    def fitted(self, path, *flags):
        """Result of the command line in the service's form, as bytes; path is relative to the test's folder or absolute."""
        code, out, said = run_tool("fit_pendulum", "--data", path, "--json", "-", *flags, folder=self.folder)
        self.assertIn(code, (0, 1), said)
        return without_path(out, str(path))

    def simulate(self, count, *flags, seed=1, name="run.csv"):
        """Simulates `count` recordings in the test's folder and returns their names."""
        before = set(self.folder.glob("*.csv"))
        code, _, said = run_tool("simulate_pendulum", *SIMULATED, "--count", count, "--seed", seed, *flags, "--out", name,
                                 folder=self.folder)
        self.assertEqual(code, 0, said)
        return sorted(path.name for path in set(self.folder.glob("*.csv")) - before)

    def wait_until(self, holds, what, seconds=TIMEOUT_S):
        """Waits until holds() is true and returns its value."""
        end = time.monotonic() + seconds
        while not (found := holds()):
            self.assertLess(time.monotonic(), end, f"after {seconds} s this is still not true: {what}")
            time.sleep(0.05)
        return found


class Served(Lab):
    """One server for all tests of a class."""

    FLAGS = ()

    @classmethod
    def setUpClass(cls):
        cls.store_folder = pathlib.Path(tempfile.mkdtemp(prefix="service_"))
        cls.addClassCleanup(shutil.rmtree, cls.store_folder, ignore_errors=True)
        cls.server = Server(cls.store_folder, *cls.FLAGS)
        cls.addClassCleanup(cls.server.stop, signal.SIGKILL)

    @classmethod
    def tearDownClass(cls):
        code = cls.server.stop()
        assert code == 0, f"exit code {code}; {cls.server.log()[-3000:]!r}"
        assert not any(words in cls.server.log() for words in SANITIZERS_SAY), cls.server.log().decode(errors="replace")[-8000:]

    def check_lives(self):
        """Checks that the same server still answers."""
        self.assertTrue(self.server.is_alive(), self.server.log()[-3000:])
        response = self.server.get("/healthz")
        self.assertEqual((response.status, response.json()["status"]), (200, "ok"))


class Curl(Served):
    """Requests by curl, with files of the datasets in the test's folder."""

    def setUp(self):
        super().setUp()
        for name in ("coulomb.csv", "textbook_rig.csv", "excel_export.csv", "recorded.csv", "runs_1.csv", "to_rest.csv",
                     "textbook_calibration.csv", "textbook_rig.json", "recorded_rig.json", "potentiometer_calibration.json"):
            shutil.copy(DATASETS / name, self.folder)
        (self.folder / "counts.csv").write_text(in_counts((DATASETS / "coulomb.csv").read_text()))

    def curl(self, target, *arguments, method=None):
        """The output of curl, whose exit code must be 0."""
        command = ["curl", "-sS", "--noproxy", "*", "-D", "head", "-o", "body", *(["-X", method] if method else []), *arguments,
                   self.server.url(target)]
        done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, timeout=TIMEOUT_S)
        self.assertEqual(done.returncode, 0, (command, done.stderr))
        heads = (self.folder / "head").read_text().strip().split("\n\n")
        first, *fields = heads[-1].splitlines()
        headers = {name.lower(): value.strip() for name, _, value in (field.partition(":") for field in fields)}
        body = (self.folder / "body").read_bytes() if (self.folder / "body").exists() else b""
        (self.folder / "body").unlink(missing_ok=True)
        return Response(int(first.split()[1]), headers, body)

    def post_file(self, target, name, content_type="text/csv"):
        return self.curl(target, "--data-binary", f"@{name}", "-H", f"Content-Type: {content_type}")

    def post_value(self, target, value):
        (self.folder / "request.json").write_text(json.dumps(value))
        return self.post_file(target, "request.json", "application/json")

    def fit(self, name="coulomb.csv", **options):
        """Makes a fit and returns its identifier."""
        response = self.post_file("/v1/fits?" + query_of({"name": name, **options}), name)
        self.assertEqual(response.status, 200, response)
        return re.fullmatch(r"/v1/fits/([\w-]+)", response.headers["location"])[1]


def in_counts(text):
    """Converts a recording in degrees to counts of datasets/potentiometer_calibration.json, without comments."""
    rows = (line.split(",") for line in text.splitlines() if line[0].isdigit())
    return "time_s,counts\n" + "".join(f"{time},{round((float(angle) + 49.6077) / 0.1985)}\n" for time, angle in rows)
