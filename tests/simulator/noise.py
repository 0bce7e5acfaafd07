# SPDX-License-Identifier: Apache-2.0
"""Seeded noise."""

import math

import numpy
from scipy.signal import lfilter

from motion import Array


def white(rng: numpy.random.Generator, sigma: float, shape: int | tuple[int, ...]) -> Array:
    """Independent normal noise."""
    return sigma * rng.standard_normal(shape)


def autoregressive(rng: numpy.random.Generator, sigma: float, correlation: float, count: int) -> Array:
    """AR(1) noise of this standard deviation and correlation of neighbours, stationary from the first sample on."""
    steps = rng.standard_normal(count)
    steps[1:] *= math.sqrt(1 - correlation**2)
    return sigma * lfilter([1.0], [1.0, -correlation], steps)
