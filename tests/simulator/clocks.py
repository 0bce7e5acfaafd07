# SPDX-License-Identifier: Apache-2.0
"""When a logger takes its samples, and what it says about it."""

import dataclasses

import numpy

from motion import Array


@dataclasses.dataclass(frozen=True)
class Clock:
    """A logger that means to take `rate` samples a second."""

    rate: float = 100.0  # Hz, as the file says
    true_interval_scale: float = 1.0  # true interval over 1/rate
    drift: float = 0.0  # the stamps run fast by this share
    jitter: float = 0.0  # s, scatter of the true times about stamps that are even
    has_stamps: bool = True  # False: the file has the rate in its header only
    are_made_up: bool = False  # the logger counts its samples and writes multiples of 1/rate, whatever they really took

    def true_times(self, duration: float, rng: numpy.random.Generator) -> Array:
        """True times of the samples [s]."""
        times = self._planned(round(duration * self.rate)) * self.true_interval_scale
        if self.jitter:
            scatter = rng.normal(0, self.jitter, len(times))
            times = times + numpy.clip(scatter, -0.4 / self.rate, 0.4 / self.rate)
        return times

    def stamps(self, count: int) -> Array:
        """Time stamps [s] of the samples on the file's clock."""
        scale = self.true_interval_scale if self._are_read else 1.0
        return self._planned(count) * (scale * (1 + self.drift))

    def _planned(self, count: int) -> Array:
        """When the samples are due [s]. A loop that reads its clock in steps of 4 us takes them up to 40 us late."""
        late = numpy.arange(count) * 7919 % 11 * 4e-6 if self._are_read and not self.jitter else 0.0
        return numpy.arange(count) / self.rate + late

    @property
    def stamp_scale(self) -> float:
        """Seconds of the file's clock in one true second."""
        return (1 + self.drift) * (1.0 if self._are_read else 1 / self.true_interval_scale)

    @property
    def _are_read(self) -> bool:
        """Whether each stamp was read from a clock."""
        return self.has_stamps and not self.are_made_up


def changes_only(stamps: Array, readings: Array) -> tuple[Array, Array]:
    """A send-on-change log: the first row and the rows that differ from the row before."""
    kept = numpy.concatenate([[True], numpy.diff(readings) != 0])
    return stamps[kept], readings[kept]
