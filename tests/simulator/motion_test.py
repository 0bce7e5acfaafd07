#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the simulated motion against closed forms. Needs python3-scipy."""

import dataclasses
import math
import unittest

import numpy
from scipy.integrate import quad
from scipy.linalg import eigh
from scipy.special import ellipk

from friction import Bristles, Sliding
from hands import Hand
from motion import swing
from pendulum import Body, Support, yielding_support
from presliding_study import INERTIA as STUDIED_INERTIA, stopping_coulomb

INERTIA, GRAVITY_TORQUE = 0.079, 1.8033
FRICTIONLESS = Body(INERTIA, GRAVITY_TORQUE, Sliding())


def with_friction(**values) -> Body:
    return dataclasses.replace(FRICTIONLESS, friction=Sliding(**values))


def amplitudes(body: Body, angle: float, seconds: float = 8.0) -> numpy.ndarray:
    """Absolute angles of release and reversals."""
    motion = swing(body, 0.0, seconds, angle)
    return numpy.abs(motion.angle(numpy.array([0.0, *motion.reversals])))


def energy(body: Body, motion, times) -> numpy.ndarray:
    """Kinetic and potential energy of a rigid pendulum [J]."""
    return body.inertia * motion.rate(times) ** 2 / 2 - body.gravity_torque * numpy.cos(motion.angle(times))


class FreeMotionTest(unittest.TestCase):
    def test_conserves_energy_without_friction(self):
        times = numpy.linspace(0, 20, 401)
        for degrees in (24, 90, 150, 175):
            energies = energy(FRICTIONLESS, swing(FRICTIONLESS, 0.0, 20.0, math.radians(degrees)), times)
            self.assertLess(numpy.ptp(energies), 2e-9 * GRAVITY_TORQUE, degrees)

    def test_period_is_the_elliptic_integral(self):
        for degrees in (1, 24, 90, 150):
            angle = math.radians(degrees)
            expected = 4 * math.sqrt(INERTIA / GRAVITY_TORQUE) * ellipk(math.sin(angle / 2) ** 2)
            reversals = swing(FRICTIONLESS, 0.0, 10.0, angle).reversals
            self.assertAlmostEqual(2 * (reversals[1] - reversals[0]) / expected, 1, delta=1e-9)

    def test_parallel_spring_adds_to_gravity_for_small_swings(self):
        body = dataclasses.replace(FRICTIONLESS, spring=0.4)
        reversals = swing(body, 0.0, 10.0, 1e-4).reversals
        expected = 2 * math.pi * math.sqrt(INERTIA / (GRAVITY_TORQUE + 0.4))
        self.assertAlmostEqual(2 * (reversals[1] - reversals[0]) / expected, 1, delta=1e-8)

    def test_push_is_the_first_rate(self):
        hand = Hand(angle=0.4, time=1.0, push=0.05)
        motion = swing(FRICTIONLESS, hand.time, 3.0, hand.angle, hand.rate, held=hand.held)
        self.assertEqual(motion.rate(numpy.array([1.0]))[0], -0.05)
        self.assertEqual(motion.angle(numpy.array([0.5]))[0], 0.4)

    def test_finger_takes_its_share_of_the_first_acceleration(self):
        hand = Hand(angle=0.4, time=1.0, finger_share=0.3)
        motion = swing(FRICTIONLESS, 1.0, 3.0, 0.4, hand=hand.torque(GRAVITY_TORQUE), hand_leaves=hand.leaves)
        expected = -0.7 * GRAVITY_TORQUE * math.sin(0.4) / INERTIA
        self.assertAlmostEqual(motion.rate(numpy.array([1.001]))[0] / 0.001 / expected, 1, delta=1e-3)
        self.assertAlmostEqual(hand.torque(GRAVITY_TORQUE)(1.05), 0, delta=1e-15)
        # Its impulse is that of 0.3 of gravity's torque over half of its 50 ms.
        late = 0.3 * GRAVITY_TORQUE * math.sin(0.4) * 0.025 / INERTIA
        free = swing(FRICTIONLESS, 1.0, 3.0, 0.4)
        delay = motion.rate(numpy.array([1.05]))[0] - free.rate(numpy.array([1.05]))[0]
        self.assertAlmostEqual(delay / late, 1, delta=0.02)

    def test_finger_with_all_of_the_torque_lets_go_when_dry_friction_no_longer_holds(self):
        body, hand = with_friction(coulomb=0.05), Hand(angle=0.4, time=1.0, finger_share=1.0)
        motion = swing(body, 1.0, 3.0, 0.4, hand=hand.torque(GRAVITY_TORQUE), hand_leaves=hand.leaves)
        # 1 - (1 + cos(pi t/50 ms))/2 of gravity's torque is dry friction's.
        share = 0.05 / (GRAVITY_TORQUE * math.sin(0.4))
        self.assertAlmostEqual(motion.reversals[0], 1 + 0.05 * math.acos(1 - 2 * share) / math.pi, delta=1e-6)
        self.assertLess(motion.rate(numpy.array([1.05]))[0], -0.1)


class StudyTest(unittest.TestCase):
    def test_friction_of_the_study_stops_a_linear_pendulum_after_so_many_half_swings(self):
        for half_swings in (6, 20):
            coulomb = stopping_coulomb(0.003, 0.4, half_swings)
            body = Body(STUDIED_INERTIA, GRAVITY_TORQUE, Sliding(viscous=0.003, coulomb=coulomb), is_linear=True)
            motion = swing(body, 0.0, 20.0, 0.4)
            turns = numpy.abs(motion.angle(numpy.array(motion.reversals)))
            self.assertAlmostEqual(len(turns), half_swings, delta=1)
            self.assertLess(turns[-1], coulomb / GRAVITY_TORQUE)


class SlidingFrictionTest(unittest.TestCase):
    def test_coulomb_takes_the_same_angle_from_each_half_swing_of_a_linear_pendulum(self):
        body = dataclasses.replace(with_friction(coulomb=0.02), is_linear=True)
        motion = swing(body, 0.0, 8.0, 0.3)
        found = numpy.abs(motion.angle(numpy.array([0.0, *motion.reversals])))
        numpy.testing.assert_allclose(-numpy.diff(found), 2 * 0.02 / GRAVITY_TORQUE, rtol=1e-8)  # MODEL.md eq. (6.8)
        numpy.testing.assert_allclose(numpy.diff(motion.reversals), math.pi * math.sqrt(INERTIA / GRAVITY_TORQUE), rtol=1e-8)

    def test_coulomb_brings_it_to_rest_within_the_band(self):
        body = with_friction(coulomb=0.2)
        motion = swing(body, 0.0, 8.0, 0.5)
        self.assertEqual(motion.pieces[-1].direction, 0)
        self.assertLess(abs(math.sin(motion.angle(numpy.array([8.0]))[0])), 0.2 / GRAVITY_TORQUE)
        self.assertEqual(motion.rate(numpy.array([8.0]))[0], 0)

    def test_friction_holds_a_pendulum_that_is_released_within_the_band(self):
        motion = swing(with_friction(coulomb=0.2), 0.0, 2.0, 0.1)
        self.assertEqual([piece.direction for piece in motion.pieces], [0])

    def test_viscous_takes_the_same_share_from_each_half_swing_of_a_linear_pendulum(self):
        body = dataclasses.replace(with_friction(viscous=0.02), is_linear=True)
        found = amplitudes(body, 0.3)
        zeta = 0.02 / 2 / math.sqrt(INERTIA * GRAVITY_TORQUE)
        expected = math.exp(-math.pi * zeta / math.sqrt(1 - zeta**2))
        numpy.testing.assert_allclose(found[1:] / found[:-1], expected, rtol=1e-8)

    def check_half_swing(self, body: Body, dry, square: float):
        """With torque D(angle) + k rate^2, rate^2 solves a linear equation in the angle. It is 0 at both ends of a half
        swing, so that the integral of (G sin x - D(x)) exp(-2 k x/I) over it is 0, for a motion towards smaller angles."""
        first, second = amplitudes(body, 0.6)[:2]

        def integrand(x):
            return (GRAVITY_TORQUE * math.sin(x) - dry(x)) * math.exp(-2 * square * x / INERTIA)

        lost = quad(lambda x: abs(integrand(x)), -second, first, limit=200)[0]
        self.assertAlmostEqual(quad(integrand, -second, first, epsabs=1e-13)[0] / lost, 0, delta=1e-9)

    def test_drag_solves_the_equation_of_energy(self):
        self.check_half_swing(with_friction(coulomb=0.01, drag=0.005), lambda x: 0.01, 0.005)

    def test_dry_friction_in_proportion_to_the_load_solves_the_equation_of_energy(self):
        body = with_friction(coulomb=0.05, load_share=1.0, length_over_gravity=0.04)
        self.check_half_swing(body, lambda x: 0.05 * math.cos(x), 0.05 * 0.04)

    def test_dry_friction_that_depends_on_the_angle_solves_the_equation_of_energy(self):
        body = with_friction(coulomb=0.05, place_share=0.3, place_waves=5.0, place_phase=1.0)
        self.check_half_swing(body, lambda x: 0.05 * (1 + 0.3 * math.sin(5 * x + 1)), 0.0)

    def test_stribeck_has_the_limits_of_a_wide_and_a_narrow_zone(self):
        wide = amplitudes(with_friction(coulomb=0.01, stiction=0.03, stribeck_rate=1e4), 0.4)
        numpy.testing.assert_allclose(wide, amplitudes(with_friction(coulomb=0.03), 0.4), rtol=1e-6)
        narrow = amplitudes(with_friction(coulomb=0.01, stiction=0.03, stribeck_rate=1e-4), 0.4)
        numpy.testing.assert_allclose(narrow, amplitudes(with_friction(coulomb=0.01), 0.4), rtol=1e-6)

    def test_stribeck_zone_takes_the_energy_of_its_integral(self):
        # Near a turning point rate^2 = 2 a x, so the zone takes (tau_s - tau_c) w_s^2/(2 a) of energy, at both ends.
        stribeck_rate, more = 0.05, 0.02
        loss = more * stribeck_rate**2 / (2 * GRAVITY_TORQUE * math.sin(0.4) / INERTIA) * 2
        without, with_zone = (amplitudes(with_friction(coulomb=0.01, **zone), 0.4)[1] for zone in (
            {}, {"stiction": 0.01 + more, "stribeck_rate": stribeck_rate}))
        change = GRAVITY_TORQUE * (math.cos(with_zone) - math.cos(without))
        self.assertAlmostEqual(change / loss, 1, delta=0.03)


class BristlesTest(unittest.TestCase):
    def test_stiff_bristles_are_dry_friction(self):
        sliding = Sliding(viscous=0.003, coulomb=0.02)
        times = numpy.linspace(0, 4, 101)
        dry = swing(dataclasses.replace(FRICTIONLESS, friction=sliding), 0.0, 4.0, 0.4).angle(times)
        errors = []
        for stiffness in (20.0, 80.0):
            body = dataclasses.replace(FRICTIONLESS, friction=Bristles(sliding, stiffness))
            motion = swing(body, 0.0, 4.0, 0.4, deflection=-0.02 / stiffness)
            errors.append(numpy.abs(motion.angle(times) - dry).max())
        # The contact turns around within an angle of 0.02/stiffness, which takes a time in proportion to its root.
        self.assertLess(errors[0], 0.01)
        self.assertAlmostEqual(errors[0] / errors[1], 2, delta=0.3)

    def test_dahl_is_a_spring_for_tiny_motions(self):
        body = dataclasses.replace(FRICTIONLESS, friction=Bristles(Sliding(coulomb=0.02), 2.0))
        reversals = swing(body, 0.0, 3.0, 1e-6).reversals
        expected = 2 * math.pi * math.sqrt(INERTIA / (GRAVITY_TORQUE + 2.0))
        self.assertAlmostEqual(2 * (reversals[1] - reversals[0]) / expected, 1, delta=1e-3)

    def test_steady_lugre_is_the_stribeck_law(self):
        sliding = Sliding(viscous=0.003, coulomb=0.02, stiction=0.03, stribeck_rate=0.1)
        law = Bristles(sliding, 5.0, 0.01)
        for rate in (-1.0, -0.05, 0.02, 2.0):
            deflection = math.copysign(sliding.dry(0, rate) / 5.0, rate)
            self.assertAlmostEqual(law.deflection_rate(0, rate, deflection), 0, delta=1e-15)
            direction = int(math.copysign(1, rate))
            self.assertAlmostEqual(law.torque(0, rate, deflection), sliding.torque(0, rate, direction), delta=1e-15)


class SupportTest(unittest.TestCase):
    def test_heavy_stiff_support_is_rigid(self):
        times = numpy.linspace(0, 5, 101)
        friction = Sliding(viscous=0.003, coulomb=0.004)
        rigid = swing(dataclasses.replace(FRICTIONLESS, friction=friction), 0.0, 5.0, 0.4).angle(times)
        body = dataclasses.replace(FRICTIONLESS, friction=friction)
        body = dataclasses.replace(body, support=yielding_support(body, 1e6, 10))
        numpy.testing.assert_allclose(swing(body, 0.0, 5.0, 0.4).angle(times), rigid, atol=2e-6)

    def test_conserves_energy_without_damping(self):
        body = dataclasses.replace(FRICTIONLESS, support=Support(1.0, 3000.0))
        angle, rate, place, velocity = swing(body, 0.0, 10.0, 1.0).states(numpy.linspace(0, 10, 401))
        kinetic = (INERTIA * rate**2 + (1.0 + body.mass) * velocity**2) / 2
        kinetic += body.first_moment * numpy.cos(angle) * rate * velocity
        total = kinetic - GRAVITY_TORQUE * numpy.cos(angle) + 3000.0 * place**2 / 2
        self.assertLess(numpy.ptp(total), 2e-9)

    def test_slow_mode_has_its_eigenfrequency(self):
        body = dataclasses.replace(FRICTIONLESS, support=Support(1.0, 300.0))
        mass = [[INERTIA, body.first_moment], [body.first_moment, 1.0 + body.mass]]
        squares, modes = eigh([[GRAVITY_TORQUE, 0], [0, 300.0]], mass)
        self.assertLess(squares[0], GRAVITY_TORQUE / INERTIA)
        state = 1e-4 / modes[0, 0] * modes[:, 0]  # the slow mode alone
        half = math.pi / math.sqrt(squares[0])
        derivative = numpy.array([body.derivative([state[0], 0.0, state[1], 0.0], 1, 0.0)[k] for k in (1, 3)])
        numpy.testing.assert_allclose(derivative, -squares[0] * state, rtol=1e-6)
        motion = swing(body, 0.0, 2 * half, 1e-4)
        self.assertAlmostEqual(motion.reversals[-1] / half, round(motion.reversals[-1] / half), delta=0.1)


if __name__ == "__main__":
    unittest.main()
