# SPDX-License-Identifier: Apache-2.0
"""What sensors do to an angle or a rate before it is in a file. Each effect is off by default.

The order is that of a potentiometer with a filter and a converter: mechanics (play), curve, filter, delay, drift, noise,
converter, mean of several conversions. Angles in rad, times in s.
"""

import collections.abc
import dataclasses
import math

import numpy
from numpy.polynomial.legendre import legval
from scipy.signal import lfilter

import noise
from motion import Array

Signal = collections.abc.Callable[[Array], Array]  # of times

FINE_STEP = 2.5e-4  # s, for effects with a memory: play and lag
WARM_UP = 0.5  # s before the first sample


@dataclasses.dataclass(frozen=True)
class Curve:
    """What the sensor shows for an angle x: x + gain x + cubic x (x/scale)^2 + waves + eccentricity + bends(x/scale)."""

    gain: float = 0.0
    cubic: float = 0.0  # share of the angle at `scale`
    scale: float = math.radians(24)
    wave: float = 0.0  # rad, amplitude of a sine over the angle
    wave_length: float = math.radians(60)
    wave_phase: float = 0.0
    eccentricity: float = 0.0  # rad, amplitude of a sine over a turn
    eccentric_phase: float = 0.0
    bends: tuple[float, ...] = ()  # rad, coefficients of Legendre's polynomials

    def __call__(self, angle: Array) -> Array:
        shown = angle * (1 + self.gain + self.cubic * (angle / self.scale) ** 2)
        if self.wave:
            shown = shown + self.wave * numpy.sin(2 * math.pi * angle / self.wave_length + self.wave_phase)
        if self.eccentricity:
            shown = shown + self.eccentricity * numpy.sin(angle + self.eccentric_phase)
        if self.bends:
            shown = shown + legval(angle / self.scale, self.bends)
        return shown


def with_play(values: Array, width: float, place: float = 0.0) -> Array:
    """Output of a play operator: it follows within +- width/2 and stays while the input is inside. At first it is at `place`
    in the gap, from -1 to 1."""
    shown, half = numpy.empty(len(values)), width / 2
    last = float(values[0]) + place * half
    for index, value in enumerate(values.tolist()):
        last = min(max(last, value - half), value + half)
        shown[index] = last
    return shown


def with_lag(values: Array, step: float, lag: float) -> Array:
    """Output of a first-order low-pass filter, exact for an input of straight lines between the values.

    y' = (x - y)/lag over a step h gives y1 = a y0 + b x0 + c x1 with a = exp(-h/lag), c = 1 - (1 - a) lag/h, b = 1 - a - c.
    """
    a = math.exp(-step / lag)
    c = 1 - (1 - a) * lag / step
    b = 1 - a - c
    start = values[0] * (1 - c)  # as if it had been constant before
    return lfilter([c, b], [1, -a], values, zi=[start])[0]


def quantize(values: Array, step: float, offset: float = 0.0) -> Array:
    """The nearest levels of a converter."""
    return step * numpy.round((values - offset) / step) + offset if step else values


@dataclasses.dataclass(frozen=True)
class Sensor:
    """A sensor of angle, or of rate with `zero` as its bias."""

    zero: float = 0.0
    curve: Curve = Curve()
    play: float = 0.0  # full width
    play_place: float = 0.0  # where in the gap the sensor is at first, from -1 to 1
    lag: float = 0.0  # s, first order
    delay: float = 0.0  # s, of a value against its time stamp
    drift: float = 0.0  # over the whole recording, linear
    thermal: float = 0.0  # final size of a drift thermal (1 - exp(-t/thermal_time))
    thermal_time: float = 5.0  # s
    sigma: float = 0.0  # noise of one conversion
    correlation: float = 0.0  # of noise between neighbouring samples
    resolution: float = 0.0
    conversions: int = 1  # whose mean is a reading
    conversion_time: float = 1.12e-4  # s, between conversions; the stamp is that of their middle

    def _filtered(self, signal: Signal, first: float, last: float) -> Signal:
        """The signal after play, curve and lag."""
        if not (self.play or self.lag):
            return lambda times: self.curve(signal(times))
        grid = numpy.arange(first - self.delay - WARM_UP, last + 2 * FINE_STEP, FINE_STEP)
        values = signal(grid)
        if self.play:
            values = with_play(values, self.play, self.play_place)
        values = self.curve(values)
        if self.lag:
            values = with_lag(values, FINE_STEP, self.lag)
        return lambda times: numpy.interp(times, grid, values)

    def zero_motion(self, times: Array, duration: float) -> Array:
        """How far the zero has moved since time 0."""
        return self.drift * times / duration + self.thermal * (1 - numpy.exp(-times / self.thermal_time))

    def read(self, signal: Signal, times: Array, rng: numpy.random.Generator) -> Array:
        """Readings of the signal at these times, which increase from about 0."""
        span = self.conversion_time * (self.conversions - 1) / 2
        seen = self._filtered(signal, times[0] - span, times[-1] + span)
        each = times[:, None] + numpy.linspace(-span, span, self.conversions)[None, :]
        values = seen(each.ravel() - self.delay).reshape(each.shape) + self.zero + self.zero_motion(each, times[-1])
        if self.correlation:
            values = values + noise.autoregressive(rng, self.sigma, self.correlation, len(times))[:, None]
        else:
            values = values + noise.white(rng, self.sigma, each.shape)
        return quantize(values, self.resolution).mean(axis=1)
