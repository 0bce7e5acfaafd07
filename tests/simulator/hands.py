# SPDX-License-Identifier: Apache-2.0
"""How a hand holds a pendulum and lets it go."""

import dataclasses
import math

import numpy

from motion import Array
from pendulum import Torque


@dataclasses.dataclass(frozen=True)
class Hand:
    """A hand that holds the pendulum at `angle` until `time`.

    It may push: the motion then begins with a rate. Its finger may leave slowly: from `finger_share` of gravity's torque at
    the release (1: the finger alone holds the pendulum), its torque falls to 0 in `finger_time`, as a half cosine. It may
    hold at another angle until it shifts the pendulum just before the release, and creep there: the hold then ends at the
    release angle.
    """

    angle: float  # release angle, rad
    time: float  # release time, s
    push: float = 0.0  # rad/s towards the zero
    finger_share: float = 0.0
    finger_time: float = 0.05  # s
    offset: float = 0.0  # rad, of the hold from the release angle
    shift_time: float = 0.1  # s before the release in which the hand shifts by `offset`
    creep: float = 0.0  # rad during the whole hold

    @property
    def rate(self) -> float:
        """Rate at the release [rad/s]."""
        return -math.copysign(self.push, self.angle) if self.push else 0.0

    @property
    def leaves(self) -> float | None:
        """Time [s] at which the finger has left; None if it leaves at once."""
        return self.time + self.finger_time if self.finger_share else None

    def held(self, times: Array) -> Array:
        """Angle [rad] before the release. The hold is known from time 0 on."""
        before = numpy.clip((self.time - numpy.asarray(times)) / self.shift_time, 0, 1)
        shift = self.offset * (1 - numpy.cos(math.pi * before)) / 2
        return self.angle + shift + self.creep * (times - self.time) / self.time

    def torque(self, gravity_torque: float) -> Torque:
        """The finger's torque [N m] after the release, against gravity's."""
        first = self.finger_share * gravity_torque * math.sin(self.angle)
        return lambda time: first * (1 + math.cos(math.pi * min(1.0, (time - self.time) / self.finger_time))) / 2
