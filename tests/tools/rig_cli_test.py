#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs fit_pendulum with every kind of rig, on pendulums and on torsion springs with known truth.

  rig_cli_test.py PATH/TO/fit_pendulum
"""

import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

import swing

TOOL = ""  # path of the binary, from the command line

# A Pohl wheel: k/I, b/I and τ_c/I.
STIFFNESS, VISCOUS, COULOMB = 12.3, 0.02, 0.03  # 1/s², 1/s, 1/s²
AMPLITUDE = 1.7  # rad


def wheel(duration=60.0, rate_hz=50, amplitude=AMPLITUDE, coulomb=COULOMB):
    """Samples (time [s], angle [rad]) of a wheel that starts at rest, exactly: half swings about ±τ_c/k."""
    band, decay = coulomb / STIFFNESS, VISCOUS / 2
    frequency = math.sqrt(STIFFNESS - decay**2)
    half = math.pi / frequency
    angle, begin, samples = amplitude, 0.0, []
    for k in range(int(duration * rate_hz)):
        time = k / rate_hz
        while time - begin >= half and abs(angle) > band:
            centre = math.copysign(band, angle)
            angle = centre - (angle - centre) * math.exp(-decay * half)
            begin += half
        if abs(angle) <= band:
            samples.append((time, angle))
            continue
        centre, t = math.copysign(band, angle), time - begin
        shape = math.exp(-decay * t) * (math.cos(frequency * t) + decay / frequency * math.sin(frequency * t))
        samples.append((time, centre + (angle - centre) * shape))
    return samples


def wheel_csv(unit="rad", levels=0, scale=1.0, seed=7, **kwargs):
    """The text of a recording of the wheel; levels: of an encoder, in a turn; scale: an error of the unit."""
    noise = random.Random(seed)
    step = 2 * math.pi / levels if levels else 0
    lines = [f"time_s,angle_{unit}"]
    for time, angle in wheel(**kwargs):
        reading = angle + noise.gauss(0, step or 0.005 / scale)
        if step:
            reading = round(reading / step) * step
        lines.append(f"{time:.3f},{scale * (math.degrees(reading) if unit == 'deg' else reading):.6f}")
    return "\n".join(lines) + "\n"


class RigTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.write("run.csv", swing.angle_csv())

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")

    def run_tool(self, *flags, rig=None):
        if rig is not None:
            self.write("rig.json", json.dumps(rig))
            flags += ("--rig", "rig.json")
        return subprocess.run([TOOL, *flags], cwd=self.folder, capture_output=True, text=True, encoding="utf-8",
                              timeout=60, check=False)

    def fit(self, *flags, rig=None):
        """The result of a fit that converges, and its text."""
        run = self.run_tool(*flags, "--json", "fit.json", rig=rig)
        self.assertEqual(run.returncode, 0, run.stderr)
        return json.loads((self.folder / "fit.json").read_text(encoding="utf-8")), run.stdout

    def assert_near(self, quantity, truth, unit):
        """The quantity is right within four standard errors."""
        self.assertEqual(quantity["unit"], unit)
        self.assertLess(abs(quantity["estimate"] - truth), 4 * quantity["std_error"])
        self.assertLess(quantity["std_error"], 0.2 * truth)

    def assert_wheel(self, result):
        fit = result["fits"][0]
        self.assertEqual(fit["model"], "linear_coulomb")
        for name, truth, unit in (("gravity_over_inertia", STIFFNESS, "1/s^2"), ("viscous_over_inertia", VISCOUS, "1/s"),
                                  ("coulomb_over_inertia", COULOMB, "1/s^2"), ("decay_time", 2 / VISCOUS, "s"),
                                  ("quality_factor", math.sqrt(STIFFNESS) / VISCOUS, "1")):
            self.assert_near(fit["derived"][name], truth, unit)

    @staticmethod
    def codes(result):
        return [warning["code"] for warning in result["warnings"]]


class Springs(RigTest):
    def test_an_encoder_in_rad_needs_no_flag(self):
        self.write("wheel.csv", wheel_csv(levels=578))
        result, text = self.fit("--data", "wheel.csv")
        self.assert_wheel(result)
        self.assertEqual(self.codes(result).count("linear_restoring_torque"), 1)
        self.assertRegex(" ".join(text.split()), r"Assumed: the restoring torque of a spring \(--gravity sin")
        message = next(warning["message"] for warning in result["warnings"] if warning["code"] == "linear_restoring_torque")
        self.assertIn("their levels are 1/578 of a turn", message)

    def test_degrees_need_no_flag(self):
        self.write("wheel.csv", wheel_csv("deg"))
        result, _ = self.fit("--data", "wheel.csv")
        self.assert_wheel(result)
        self.assertIn("linear_restoring_torque", self.codes(result))

    def test_flag_gives_each_friction_law_the_torque_of_a_spring(self):
        self.write("wheel.csv", wheel_csv())
        result, _ = self.fit("--data", "wheel.csv", "--gravity", "linear")
        self.assert_wheel(result)
        self.assertNotIn("linear_restoring_torque", self.codes(result))
        result, _ = self.fit("--data", "wheel.csv", "--gravity", "linear", "--model", "viscous,coulomb")
        self.assertEqual([fit["model"] for fit in result["fits"]], ["linear", "linear_coulomb"])
        self.assertEqual(result["comparison"]["recommended"], "linear_coulomb")

    def test_two_readings_of_the_unit_are_a_question(self):
        # Smooth readings in rad may be degrees of a pendulum in small swings.
        self.write("wheel.csv", wheel_csv())
        run = self.run_tool("--data", "wheel.csv")
        self.assertEqual(run.returncode, 1)
        self.assertRegex(" ".join(run.stdout.split()), "give --gravity linear for a spring.*or correct the unit to deg")
        self.write("wheel.csv", wheel_csv().replace("angle_rad", "angle_deg"))
        self.assertEqual(self.run_tool("--data", "wheel.csv").returncode, 0)

    def test_a_user_who_chose_gravity_keeps_it(self):
        self.write("wheel.csv", wheel_csv("deg"))
        for flags in (("--gravity", "sin"), ("--model", "coulomb")):
            run = self.run_tool("--data", "wheel.csv", *flags)
            self.assertEqual(run.returncode, 1)
            self.assertRegex(" ".join(run.stdout.split()), "give --gravity linear for a spring")

    def test_a_wire_may_turn_several_times(self):
        self.write("wheel.csv", wheel_csv("deg", amplitude=9))
        run = self.run_tool("--data", "wheel.csv")
        self.assertEqual(run.returncode, 5)
        self.assertRegex(run.stderr, "or give --gravity linear for a spring or wire")
        self.assert_wheel(self.fit("--data", "wheel.csv", "--gravity", "linear")[0])

    def test_stiffness_gives_si(self):
        self.write("wheel.csv", wheel_csv())
        result, text = self.fit("--data", "wheel.csv", rig={"stiffness": {"value": 0.02, "std_dev": 0.0002}})
        self.assert_wheel(result)
        parameters = result["fits"][0]["parameters"]
        self.assert_near(parameters["inertia"], 0.02 / STIFFNESS, "kg m^2")
        self.assert_near(parameters["coulomb"], COULOMB * 0.02 / STIFFNESS, "N m")
        self.assertAlmostEqual(parameters["inertia"]["error_budget"]["rig"] / parameters["inertia"]["estimate"], 0.01,
                               delta=1e-4)
        self.assertRegex(text, "kg m.2 +clock, rig")
        run = self.run_tool("--data", "wheel.csv", "--gravity", "sin", rig={"stiffness": 0.02})
        self.assertEqual(run.returncode, 2, run.stderr)

    def test_known_inertia_gives_the_stiffness(self):
        self.write("wheel.csv", wheel_csv("deg"))
        result, _ = self.fit("--data", "wheel.csv", rig={"inertia": 0.0016})
        self.assert_near(result["fits"][0]["derived"]["stiffness"], 0.0016 * STIFFNESS, "N m/rad")
        self.assert_near(result["fits"][0]["derived"]["coulomb_si"], 0.0016 * COULOMB, "N m")

    def test_a_rig_of_a_pendulum_keeps_gravity(self):
        self.write("wheel.csv", wheel_csv("deg"))
        self.assertEqual(self.run_tool("--data", "wheel.csv", rig=swing.RIG).returncode, 1)


class Pendulums(RigTest):
    RATIO = swing.GRAVITY_TORQUE / swing.TRUTH["inertia"]  # 1/s²

    def derived(self, rig):
        return self.fit("--data", "run.csv", rig=rig)[0]["fits"][0]["derived"]

    def test_length_gives_gravity(self):
        gravity = self.derived({"length": {"value": 0.43, "std_dev": 0.001}})["gravity"]
        self.assert_near(gravity, 0.43 * self.RATIO, "m/s^2")
        exact = self.derived({"length": {"value": 0.43, "std_dev": 0}})["gravity"]
        of_length = math.sqrt(gravity["systematic_std_error"] ** 2 - exact["systematic_std_error"] ** 2)
        self.assertAlmostEqual(of_length, 0.001 * self.RATIO, delta=1e-4)

    def test_gravity_gives_the_effective_length(self):
        self.assert_near(self.derived({"gravity": 9.81})["effective_length"], 9.81 / self.RATIO, "m")

    def test_known_inertia_gives_the_torque(self):
        derived = self.derived({"inertia": 0.079, "mass": 0.475, "gravity": 9.81})
        self.assert_near(derived["gravity_torque"], swing.GRAVITY_TORQUE, "N m")
        self.assert_near(derived["viscous_si"], swing.TRUTH["viscous"], "N m s/rad")
        self.assert_near(derived["coulomb_si"], swing.TRUTH["coulomb"], "N m")
        self.assert_near(derived["center_of_mass"], swing.GRAVITY_TORQUE / (0.475 * 9.81), "m")


class Units(RigTest):
    def test_grams_are_asked_about(self):
        result, text = self.fit("--data", "run.csv", rig=dict(swing.RIG, bob_mass=380, rod_mass=95))
        self.assertEqual(self.codes(result).count("rig_implausible"), 2)
        self.assertIn('"bob_mass" is 380 kg: in g? Write 0.38', " ".join(text.split()))

    def test_centimetres_are_refused(self):
        for key, value, question in (("rod_length", 43, '"rod_length" is 43 m: in cm. Write 0.43'),
                                     ("rod_length", 430, '"rod_length" is 430 m: in mm. Write 0.43'),
                                     ("gravity", 981, '"gravity" is 981 m/s.2: in cm/s.2. Write 9.81'),
                                     ("inertia", 79, '"inertia" is 79 kg m.2: in g m.2. Write 0.079')):
            run = self.run_tool("--data", "run.csv", rig={**swing.RIG, key: value})
            self.assertEqual(run.returncode, 4, run.stderr)
            self.assertRegex(run.stderr, question)

    def test_bare_numbers_have_the_errors_of_their_tools(self):
        result, text = self.fit("--data", "run.csv", "--details", rig=swing.RIG)
        self.assertIn("rig_errors_assumed", self.codes(result))
        self.assertIn("assumed: scales ±1 g, a ruler ±1 mm, gravity ±0.015", " ".join(text.split()))
        lines = {line["name"]: line for line in result["fits"][0]["budget"]}
        self.assertLessEqual({"bob_mass", "rod_mass", "rod_length", "gravity"}, set(lines))
        inertia = result["fits"][0]["parameters"]["inertia"]
        # By hand: 1 mm of 430 mm.
        self.assertAlmostEqual(lines["rod_length"]["parts"]["inertia"] / inertia["estimate"], 1 / 430, delta=1e-7)
        self.assertEqual((lines["rod_length"]["type"], lines["rod_length"]["assumed"]), ("B", True))

    def test_only_a_stated_zero_is_exact(self):
        rig = {key: {"value": value, "std_dev": 0} for key, value in swing.RIG.items()}
        result, _ = self.fit("--data", "run.csv", rig=rig)
        self.assertIn("rig_exact", self.codes(result))
        self.assertFalse([line for line in result["fits"][0]["budget"] if line["source"] == "rig"])


if __name__ == "__main__":
    TOOL = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
