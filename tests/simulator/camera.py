# SPDX-License-Identifier: Apache-2.0
"""Pixels of a point on the pendulum in a video."""

import dataclasses
import math

import numpy

from motion import Array


@dataclasses.dataclass(frozen=True)
class Camera:
    """A pinhole camera that looks at the plane of the swing, y downwards.

    A point at (X, Y) [in radii] from the pivot, on a plane turned by `yaw` about the vertical, is at
    x = X cos(yaw)/(1 + X sin(yaw)/distance), y = Y/(1 + X sin(yaw)/distance). The lens multiplies the distance rho from the
    centre of the picture by 1 + lens (rho/half_width)^2. Pixels may be wider than high.
    """

    radius: float = 300.0  # px
    pivot: tuple[float, float] = (320.0, 90.0)  # px
    centre: tuple[float, float] = (320.0, 240.0)  # px
    half_width: float = 320.0  # px
    aspect: float = 0.0  # x is stretched by 1 + aspect
    lens: float = 0.0  # share by which the edge of the picture is moved outwards
    yaw: float = 0.0  # rad
    distance: float = 4.0  # of the camera from the plane, in radii
    level: float = 0.0  # rad, by which the camera is turned in its plane

    def pixels(self, angle: Array) -> tuple[Array, Array]:
        """x and y [px] of the point at these angles [rad]."""
        across, down = numpy.sin(angle + self.level), numpy.cos(angle + self.level)
        depth = 1 + across * math.sin(self.yaw) / self.distance
        x = self.pivot[0] + self.radius * across * math.cos(self.yaw) / depth - self.centre[0]
        y = self.pivot[1] + self.radius * down / depth - self.centre[1]
        magnified = 1 + self.lens * (x * x + y * y) / self.half_width**2
        return self.centre[0] + x * magnified * (1 + self.aspect), self.centre[1] + y * magnified
