#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the simulated sensors, clocks, noise and camera against closed forms. Needs python3-scipy."""

import math
import unittest

import numpy

import noise
from camera import Camera
from clocks import Clock, changes_only
from hands import Hand
from sensors import Curve, Sensor, quantize, with_lag, with_play

TIMES = numpy.arange(2000) / 100


def generator() -> numpy.random.Generator:
    return numpy.random.default_rng(7)


class ConverterTest(unittest.TestCase):
    def test_rounding_adds_a_twelfth_of_a_squared_step_of_variance(self):
        values = noise.white(generator(), 3.0, 200_000)
        error = quantize(values, 1.0) - values
        self.assertAlmostEqual(error.var(), 1 / 12, delta=0.001)
        self.assertLessEqual(numpy.abs(error).max(), 0.5)
        self.assertAlmostEqual(numpy.corrcoef(error, values)[0, 1], 0, delta=0.01)

    def test_mean_of_conversions_has_finer_levels_and_less_variance(self):
        sensor = Sensor(sigma=2.0, resolution=1.0, conversions=4)
        readings = sensor.read(lambda times: 0 * times, numpy.arange(50_000) / 100, generator())
        numpy.testing.assert_allclose(readings * 4, numpy.round(readings * 4), atol=1e-9)
        self.assertAlmostEqual(readings.var(), (4 + 1 / 12) / 4, delta=0.03)

    def test_autoregressive_noise_has_its_spread_and_correlation(self):
        values = noise.autoregressive(generator(), 2.0, 0.9, 400_000)
        self.assertAlmostEqual(values.std(), 2.0, delta=0.03)
        for lag in (1, 5):
            self.assertAlmostEqual(numpy.corrcoef(values[:-lag], values[lag:])[0, 1], 0.9**lag, delta=0.02)


class DynamicsTest(unittest.TestCase):
    def test_lag_delays_a_ramp_by_itself(self):
        ramp = Sensor(lag=0.02).read(lambda times: 3 * times, TIMES[100:], generator())
        numpy.testing.assert_allclose(ramp, 3 * (TIMES[100:] - 0.02), atol=1e-9)

    def test_lag_has_the_response_of_a_first_order_filter(self):
        omega, lag = 5.0, 0.02
        found = Sensor(lag=lag).read(lambda times: numpy.sin(omega * times), TIMES[100:], generator())
        gain, phase = 1 / math.hypot(1, omega * lag), math.atan(omega * lag)
        numpy.testing.assert_allclose(found, gain * numpy.sin(omega * TIMES[100:] - phase), atol=1e-6)

    def test_lag_starts_as_if_the_first_value_had_lasted(self):
        numpy.testing.assert_allclose(with_lag(numpy.full(50, 0.7), 0.001, 0.02), 0.7, atol=1e-12)

    def test_delay_shifts_the_signal(self):
        found = Sensor(delay=0.01).read(numpy.sin, TIMES, generator())
        numpy.testing.assert_allclose(found, numpy.sin(TIMES - 0.01), atol=1e-12)

    def test_play_follows_by_half_its_width_on_each_side(self):
        signal = numpy.sin(numpy.linspace(0, 6 * math.pi, 6001))
        shown = with_play(signal, 0.2)
        rising = numpy.diff(signal, prepend=signal[0]) > 0
        middle = (numpy.abs(signal) < 0.5) & (numpy.arange(6001) > 1500)
        numpy.testing.assert_allclose((signal - shown)[middle & rising], 0.1, atol=1e-9)
        numpy.testing.assert_allclose((signal - shown)[middle & ~rising], -0.1, atol=1e-9)
        self.assertAlmostEqual(shown.max(), 0.9, delta=1e-9)
        numpy.testing.assert_allclose(with_play(signal, 0.2, 1.0)[:5], 0.1, atol=1e-9)


class CurveTest(unittest.TestCase):
    def test_terms_add(self):
        angle = numpy.array([math.radians(24)])
        self.assertAlmostEqual(Curve(gain=0.01)(angle)[0], 1.01 * angle[0])
        self.assertAlmostEqual(Curve(cubic=0.005)(angle)[0], 1.005 * angle[0])
        self.assertAlmostEqual(Curve(wave=0.01, wave_length=4 * angle[0])(angle)[0], angle[0] + 0.01)
        self.assertAlmostEqual(Curve(eccentricity=0.02)(angle)[0], angle[0] + 0.02 * math.sin(angle[0]))

    def test_drifts_reach_their_size(self):
        linear = Sensor(drift=0.1).read(lambda times: 0 * times, TIMES, generator())
        numpy.testing.assert_allclose(linear, 0.1 * TIMES / TIMES[-1], atol=1e-12)
        thermal = Sensor(thermal=0.1, thermal_time=5.0).read(lambda times: 0 * times, TIMES, generator())
        self.assertAlmostEqual(thermal[500], 0.1 * (1 - math.exp(-1)))

    def test_zero_is_added_once(self):
        self.assertAlmostEqual(Sensor(zero=0.3, conversions=4).read(lambda times: 0 * times, TIMES, generator())[5], 0.3)


class HandTest(unittest.TestCase):
    def test_hold_is_beside_the_release_angle_until_the_hand_shifts(self):
        hand = Hand(angle=0.4, time=1.9, offset=0.01)
        numpy.testing.assert_allclose(hand.held(numpy.array([0.0, 1.0, 1.79, 1.85, 1.9])), [0.41, 0.41, 0.41, 0.405, 0.4])

    def test_creep_ends_at_the_release_angle(self):
        hand = Hand(angle=0.4, time=2.0, creep=0.01)
        numpy.testing.assert_allclose(hand.held(numpy.array([0.0, 1.0, 2.0])), [0.39, 0.395, 0.4])


class ClockTest(unittest.TestCase):
    def test_wrong_rate_in_the_header(self):
        clock = Clock(rate=100, true_interval_scale=1.03, has_stamps=False)
        self.assertAlmostEqual(clock.true_times(20, generator())[100], 1.03)
        self.assertAlmostEqual(clock.stamps(200)[100], 1.0)
        self.assertAlmostEqual(clock.stamp_scale, 1 / 1.03)

    def test_made_up_stamps_are_even_whatever_the_loop_takes(self):
        clock = Clock(rate=100, true_interval_scale=1.03, are_made_up=True)
        self.assertAlmostEqual(clock.true_times(20, generator())[100], 1.03)
        self.assertAlmostEqual(clock.stamps(200)[100], 1.0)
        self.assertAlmostEqual(clock.stamp_scale, 1 / 1.03)

    def test_fast_stamps_and_jitter(self):
        late = 2000 * 7919 % 11 * 4e-6
        self.assertAlmostEqual(Clock(drift=1e-4).stamps(2001)[2000], 1.0001 * (20 + late))
        times = Clock(jitter=2e-4).true_times(200, generator())
        self.assertAlmostEqual((times - numpy.arange(len(times)) / 100).std(), 2e-4, delta=1e-5)

    def test_log_of_changes_keeps_the_first_row_and_the_changes(self):
        stamps, readings = changes_only(numpy.arange(6.0), numpy.array([1, 1, 2, 2, 1, 1]))
        self.assertEqual(stamps.tolist(), [0, 2, 4])
        self.assertEqual(readings.tolist(), [1, 2, 1])


class CameraTest(unittest.TestCase):
    ANGLE = numpy.radians(numpy.array([-60.0, -10.0, 0.0, 25.0]))

    def test_picture_of_a_true_camera_has_the_angle(self):
        camera = Camera(level=0.01)
        x, y = camera.pixels(self.ANGLE)
        numpy.testing.assert_allclose(numpy.arctan2(x - camera.pivot[0], y - camera.pivot[1]), self.ANGLE + 0.01)  # (14.4)

    def test_each_fault_does_what_it_says(self):
        plain = Camera()
        x, y = plain.pixels(self.ANGLE)
        wide, same = Camera(aspect=0.01).pixels(self.ANGLE)
        numpy.testing.assert_allclose(wide - 320, 1.01 * (x - 320))
        numpy.testing.assert_allclose(same, y)
        bent, _ = Camera(lens=0.02).pixels(self.ANGLE)
        share = ((x - 320) ** 2 + (y - 240) ** 2) / 320**2
        numpy.testing.assert_allclose(bent - 320, (x - 320) * (1 + 0.02 * share))
        far, _ = Camera(yaw=0.2, distance=1e9).pixels(self.ANGLE)
        numpy.testing.assert_allclose(far - 320, (x - 320) * math.cos(0.2), atol=1e-6)


if __name__ == "__main__":
    unittest.main()
