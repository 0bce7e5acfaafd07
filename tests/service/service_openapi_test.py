#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that serve_pendulum and its OpenAPI document agree: service_openapi_test.py PATH_OF_THE_TOOL."""

import json
import re
import unittest

import service  # first: it finds Debian's modules
from jsonschema import Draft202012Validator

from service import DATASETS, RIG, Lab, Served, data_part, json_part, multipart

RESULT_SCHEMA = json.loads((DATASETS.parent / "include/pendulum/report/result.schema.json").read_text())
SHORT = b"".join((DATASETS / "runs_1.csv").read_bytes().splitlines(keepends=True)[:800])
METHODS = {"get", "put", "post", "delete", "patch", "options", "trace"}

# Every path of the service except the page's, which are not an interface for programs.
ROUTES = {
    "/v1/fits": {"get", "post"}, "/v1/fits/{}": {"get", "patch", "delete"}, "/v1/fits/{}/request": {"get"},
          "/v1/fits/{}/recording": {"get"},
    "/v1/fits/{}/samples": {"get"}, "/v1/fits/{}/series": {"get"}, "/v1/fits/{}/readings": {"post"}, "/v1/fits/{}/sections": {"get"}, "/v1/fits/{}/residuals": {"get"},
          "/v1/fits/{}/report": {"get"},
    "/v1/fits/{}/markdown": {"get"}, "/v1/fits/{}/refits": {"post"}, "/v1/batches": {"get", "post"},
          "/v1/batches/{}": {"get", "delete"},
    "/v1/batches/{}/events": {"get"}, "/v1/batches/{}/agreement": {"get"},
    "/v1/previews": {"post"}, "/v1/simulations": {"post"}, "/v1/calibrations": {"post"}, "/v1/models": {"get"},
    "/v1/examples": {"get"}, "/v1/examples/{}": {"get"}, "/v1/live": {"get"}, "/v1/live/events": {"get"},
          "/v1/live/recording": {"get"},
    "/healthz": {"get"}, "/metrics": {"get"}, "/openapi.json": {"get"}}
PAGES = {"/", "/fits", "/fits/{}", "/compare", "/calibration", "/live", "/batches/{}", "/app.js", "/app.css"}


def anonymous(path):
    """A path with {} for its parameters."""
    return re.sub(r"\{[^}]*\}", "{}", path)


class Document:
    """The OpenAPI document of a server, and a record of the parts that requests have covered."""

    def __init__(self, server):
        self.text = server.get("/openapi.json")
        self.content = self.text.json()
        self.paths = {anonymous(path): (path, item) for path, item in self.content["paths"].items()}
        self.covered = set()

    def resolved(self, value):
        while "$ref" in value:
            place = self.content
            for step in value["$ref"].removeprefix("#/").split("/"):
                place = place[step.replace("~1", "/").replace("~0", "~")]
            value = place
        return value

    def operations(self):
        return {(path, method): self.resolved(item[method]) for path,
                (_, item) in self.paths.items() for method in item if method in METHODS}

    def problems(self, code):
        """The examples of a problem with this code."""
        waiting, found = [self.content], []
        while waiting:
            value = waiting.pop()
            if isinstance(value, dict):
                found += [value] if value.get("code") == code and "title" in value else []
                waiting += value.values()
            elif isinstance(value, list):
                waiting += value
        return found

    def errors(self, schema, value):
        """Violations of a schema of this document by a value."""
        schemas = {name: within(each, f"#/$defs/{name}" if "$id" in each else "")
                   for name, each in self.content["components"]["schemas"].items()}
        root = {"$schema": "https://json-schema.org/draft/2020-12/schema", "$defs": schemas, **within(schema)}
        return [f"{error.json_path}: {error.message[:300]}" for error in Draft202012Validator(root).iter_errors(value)]


def within(schema, own_place=""):
    """A schema whose references lead to the document's schemas as $defs. References in a schema with an $id stay in that schema.
    """
    if isinstance(schema, list):
        return [within(each, own_place) for each in schema]
    if not isinstance(schema, dict):
        return schema
    moved = {key: within(value, own_place) for key, value in schema.items() if key != "$id" or not own_place}
    if isinstance(moved.get("$ref"), str):
        place = moved["$ref"].replace("#/components/schemas/", "#/$defs/")
        moved["$ref"] = own_place + moved["$ref"][1:] if own_place else place
    return moved


class Answers(Served):
    """Every answer matches the document."""

    FLAGS = ("--max_samples", "5000", "--live", "run.csv")

    def setUp(self):
        super().setUp()
        self.document = Document(self.server)

    def check(self, method, route, target, body=None, status=200, **headers):
        """Sends a request and compares the answer with the operation of a route; `target` contains the path parameters."""
        answer = self.server.ask(method.upper(), target, body, **headers)
        self.check_described(method, route, answer, status)
        return answer

    def check_described(self, method, route, answer, status):
        what = f"{method} {route} {answer.status}"
        self.assertEqual(answer.status, status, answer)
        responses = self.document.operations()[route, method]["responses"]
        key = next((key for key in (str(answer.status), f"{answer.status // 100}XX", "default") if key in responses), None)
        self.assertIsNotNone(key, f"{what} is not described")
        response = self.document.resolved(responses[key])
        self.document.covered.add((route, method, str(answer.status)))
        if not answer.body:
            self.assertNotIn("content", response, what)
            return
        self.assertIn(answer.type, {name.partition(";")[0].strip(): None for name in response["content"]}, what)
        media = next(value for name, value in response["content"].items() if name.partition(";")[0].strip() == answer.type)
        if answer.type == "application/problem+json":
            problem = answer.json()
            for example in self.document.problems(problem["code"]):
                self.assertEqual(example["title"], problem["title"], what)
        if answer.type.endswith("json"):
            self.assertEqual(self.document.errors(media["schema"], answer.json()), [], what)
        for name, header in response.get("headers", {}).items():
            if self.document.resolved(header).get("required"):
                self.assertIn(name.lower(), answer.headers, what)

    def post(self, route, target, body, content_type, status=200, **headers):
        return self.check("post", route, target, body, status, Content_Type=content_type, **headers)

    def check_fits(self):
        """Checks every operation on fits; returns the location of a fit."""
        fits, fit = "/v1/fits", "/v1/fits/{}"
        place = self.post(fits, "/v1/fits?model=viscous,coulomb", SHORT, "text/csv").headers["location"]
        parts, parts_type = multipart([data_part("a.csv", SHORT), json_part("rig", json.loads(RIG.read_text())),
                                       json_part("options", {"model": "coulomb", "interval": "profile"})])
        self.post(fits, "/v1/fits", parts, parts_type)
        self.post(fits, "/v1/fits", json.dumps({"data": SHORT.decode(), "options": {"closed_form_only": "true"}}),
                  "application/json")
        self.post(fits, "/v1/fits?model=none", SHORT, "text/csv", 400)
        self.post(fits, "/v1/fits", b"time_s,angle_deg\n0,x\n", "text/csv", 422)
        self.post(fits, "/v1/fits", b"<a/>", "application/pdf", 415)
        self.post(fits, "/v1/fits", b"time_s,angle_deg\n" + b"".join(b"%d,1\n" % i for i in range(6000)), "text/csv", 413)
        for body, status in ((SHORT, 200), (b"n,encoder\n" + b"".join(b"%d,%d\n" % (i, i % 7) for i in range(50)), 200),
                             (b"time_s,angle_deg\n" + b"".join(b"%d,1\n" % i for i in range(50)), 200),
                             (b"time_s,angle_deg\n0,x\n", 422)):
            self.post("/v1/previews", "/v1/previews?bob_mass=380g", body, "text/csv", status)
        self.check("get", fits, "/v1/fits?limit=1")
        self.check("get", fits, "/v1/fits?limit=100&model=coulomb&status=converged")
        self.check("get", fits, "/v1/fits?limit=none", status=400)
        self.check("get", fits, "/v1/fits", status=403, Host="evil.example")
        for name in ("", "/request", "/recording", "/samples", "/series", "/sections", "/residuals", "/report", "/markdown"):
            self.check("get", fit + name, place + name)
            self.check("get", fit + name, "/v1/fits/none" + name, status=404)
            self.check("get", fit + name, place + name + "?x=1", status=400)
        readings = f"{fit}/readings"
        for body, status in (({"parameters": {"inertia": 0.05}, "model": "viscous"}, 200), ({"parameters": {"mass": 1}}, 400)):
            self.post(readings, f"{place}/readings", json.dumps(body), "application/json", status)
        self.post(readings, "/v1/fits/none/readings", json.dumps({"parameters": {}}), "application/json", 404)
        self.post(readings, f"{place}/readings", SHORT, "text/csv", 415)
        self.check("post", f"{fit}/refits", f"{place}/refits?model=linear")
        self.post(f"{fit}/refits", f"{place}/refits", json.dumps({"rig": json.loads(RIG.read_text())}), "application/json")
        self.check("post", f"{fit}/refits", "/v1/fits/none/refits", status=404)
        name = json.dumps({"name": "Heavy bob"})
        for content_type in ("application/json", "application/merge-patch+json"):
            self.check("patch", fit, place, name, Content_Type=content_type)
        self.check("patch", fit, place, "{}", 400, Content_Type="application/json")
        self.check("patch", fit, "/v1/fits/none", name, 404, Content_Type="application/json")
        self.check("patch", fit, place, name, 415, Content_Type="text/csv")
        self.check("get", fits, "/v1/fits?name=heavy")
        self.check("delete", fit, place, status=204)
        self.check("delete", fit, place, status=404)

    def check_batches(self):
        batches, batch = "/v1/batches", "/v1/batches/{}"
        body, content_type = multipart([data_part(f"{i}.csv", SHORT if i else b"time_s,angle_deg\n0,x\n") for i in range(3)])
        made = self.post(batches, "/v1/batches?model=viscous", body, content_type, 202)
        self.post(batches, "/v1/batches", SHORT, "text/csv", 415)
        place = made.headers["location"]
        self.assertIn(b"event: done", self.check("get", f"{batch}/events", f"{place}/events").body)
        done = self.check("get", batch, place).json()
        self.assertEqual((done["state"], done["done"], done["failed"]), ("done", 3, 1))
        self.check("get", f"{batch}/agreement", f"{place}/agreement")
        self.check("get", batches, "/v1/batches?limit=5")
        self.check("get", "/v1/fits", f"/v1/fits?batch={done['id']}")
        self.check("get", "/v1/fits/{}", f"/v1/fits/{done['fits'][0]['id']}", status=422)
        for target, method in ((batch, "get"), (f"{batch}/events", "get"), (f"{batch}/agreement", "get"), (batch, "delete")):
            self.check(method, target, target.format("none"), status=404)
        self.check("delete", batch, place + "?keep=all", status=400)
        self.check("delete", batch, place + "?keep=done", status=204)
        self.assertEqual(self.check("get", batch, place).json()["done"], 3)
        self.check("delete", batch, place, status=204)

    def check_others(self):
        simulation = json.dumps({"set": "inertia=0.05,release_angle=0.4,release_time=0.1", "duration": "2"})
        self.post("/v1/simulations", "/v1/simulations", simulation, "application/json")
        self.post("/v1/simulations", "/v1/simulations", simulation, "application/json", Accept="text/csv")
        self.post("/v1/simulations", "/v1/simulations", json.dumps({"model": "none"}), "application/json", 400)
        table = (DATASETS / "textbook_calibration.csv").read_bytes()
        self.post("/v1/calibrations", "/v1/calibrations?bits=10", table, "text/csv")
        self.post("/v1/calibrations", "/v1/calibrations", b"counts,angle_deg\n1,x\n", "text/csv", 422)
        for route in ("/v1/models", "/v1/examples", "/v1/live", "/healthz", "/metrics", "/openapi.json"):
            self.check("get", route, route)
        example = self.server.get("/v1/examples").json()["examples"][0]["name"]
        self.check("get", "/v1/examples/{}", f"/v1/examples/{example}")
        self.check("get", "/v1/examples/{}", "/v1/examples/none", status=404)

    def check_live(self):
        """Checks a recording that ended before the first request: its events end."""
        head = "# sample_rate_hz: 100\ntime_s,angle_deg\n"
        (self.store_folder / "run.csv").write_text(head + "".join(f"{i / 100},{i % 7}\n" for i in range(300)))
        self.wait_until(lambda: self.server.get("/v1/live").json()["samples"] == 300, "the recording is seen")
        self.check("get", "/v1/live", "/v1/live")
        self.check("get", "/v1/live/recording", "/v1/live/recording")
        response = self.server.open("/v1/live/events")
        self.assertEqual((response.status, response.getheader("Content-Type").partition(";")[0]), (200, "text/event-stream"))
        described = self.document.operations()["/v1/live/events", "get"]["responses"]["200"]
        self.assertIn("text/event-stream", self.document.resolved(described)["content"])
        self.document.covered.add(("/v1/live/events", "get", "200"))
        response.close()

    def test_every_answer_is_described_and_every_operation_answers(self):
        self.check_fits()
        self.check_batches()
        self.check_others()
        self.check_live()
        answered = {(route, method) for route, method, status in self.document.covered if status.startswith("2")}
        self.assertEqual({key for key in self.document.operations() if key[0] not in PAGES} - answered, set())

    def test_results_are_those_of_the_result_schema(self):
        for query in ("", "?model=viscous,coulomb", "?closed_form_only=true"):
            result = self.server.post_csv(f"/v1/fits{query}", SHORT).json()
            self.assertEqual([error.message for error in Draft202012Validator(RESULT_SCHEMA).iter_errors(result)], [], query)

    def test_schemas_reject_other_content(self):
        """An object with an unknown key, and a number, violate the schema of each answer."""
        for (route, method), operation in self.document.operations().items():
            if route in PAGES:
                continue
            for status, response in operation["responses"].items():
                media = self.document.resolved(response).get("content", {})
                for content_type, value in media.items():
                    if content_type.endswith("json") and route != "/openapi.json":
                        self.assertNotEqual(self.document.errors(value["schema"], {"nonsense": 1}), [],
                                            f"{method} {route} {status}")
                        self.assertNotEqual(self.document.errors(value["schema"], 3), [], f"{method} {route} {status}")


class Routes(Served):
    def setUp(self):
        super().setUp()
        self.document = Document(self.server)

    def test_the_document_is_openapi_3_1(self):
        self.assertEqual((self.document.text.status, self.document.text.type), (200, "application/json"))
        self.assertRegex(self.document.content["openapi"], r"^3\.1\.\d+$")
        self.assertEqual(set(self.document.content["info"]) & {"title", "version"}, {"title", "version"})
        self.assertEqual(self.document.content["info"]["version"], self.server.get("/healthz").json()["version"])

    def test_the_document_describes_every_route(self):
        described = {path: {method for method in item if method in METHODS} for path, (_, item) in self.document.paths.items()}
        self.assertEqual({path: methods for path, methods in described.items() if path not in PAGES}, ROUTES)

    def test_every_operation_describes_its_parameters_and_a_problem(self):
        names = set()
        for path, (written, item) in self.document.paths.items():
            for method, operation in ((method, item[method]) for method in item if method in METHODS):
                parameters = [self.document.resolved(each)
                              for each in (*item.get("parameters", ()), *operation.get("parameters", ()))]
                self.assertEqual(sorted(each["name"] for each in parameters if each["in"] == "path"),
                                 sorted(re.findall(r"\{([^}]*)\}", written)))
                self.assertIn("operationId", operation, path)
                names.add(operation["operationId"])
        self.assertEqual(len(names), len(self.document.operations()))

    def test_query_parameters_are_those_described(self):
        """Every described parameter is accepted (with any value); an undescribed one is refused by name."""
        for (route, method), operation in self.document.operations().items():
            if route in PAGES:
                continue
            item = self.document.paths[route][1]
            parameters = [self.document.resolved(each)
                          for each in (*item.get("parameters", ()), *operation.get("parameters", ()))]
            bodies = self.document.resolved(operation.get("requestBody", {"content": {}}))["content"]
            body, headers = None, {"Content_Type": "text/csv"} if "text/csv" in bodies else {}
            if "multipart/form-data" in bodies and "text/csv" not in bodies:
                body, headers["Content_Type"] = multipart([data_part("a.csv", SHORT)])
            for name in [each["name"] for each in parameters if each["in"] == "query"]:
                answer = self.server.ask(method.upper(), f"{route.format('none')}?{name}=", body, **headers)
                self.assertNotRegex(answer.body.decode(errors="replace"), f"{name}.* did you mean", f"{method} {route} {name}")
            if "{}" not in route and not route.startswith("/v1/live"):
                answer = self.server.ask(method.upper(), f"{route}?qqqq=1", body, **headers)
                self.check_problem(answer, 400, "bad_request", "qqqq")

    def test_undescribed_paths_and_methods_are_404_or_405(self):
        for path, methods in ROUTES.items():
            self.assertEqual(self.server.get(path.format("none") + "/nonsense").status, 404, path)
            for method in ("GET", "POST", "PUT", "DELETE", "PATCH"):
                if method.lower() not in methods:
                    self.check_problem(self.server.ask(method, path.format("none")), 405, "method_not_allowed")


class Token(Lab):
    def test_the_document_describes_the_token(self):
        content = Document(self.serve()).content
        schemes = content["components"]["securitySchemes"].values()
        self.assertIn(("http", "bearer"), [(scheme["type"], scheme.get("scheme", "").lower()) for scheme in schemes])
        server = self.serve_with_token()
        answer = server.get("/openapi.json", Authorization="Bearer correct-horse-battery-staple")
        self.assertEqual(answer.json()["paths"], content["paths"])

    def serve_with_token(self):
        folder = self.folder / "other"
        folder.mkdir()
        (folder / "token").write_text("correct-horse-battery-staple")
        server = service.Server(folder, "--token_file", "token")
        self.addCleanup(self.end, server)
        return server


if __name__ == "__main__":
    unittest.main()
