# SPDX-License-Identifier: Apache-2.0
"""Friction laws of the independent simulator, in SI units, written from MODEL.md and from textbooks.

A law gives the torque that opposes the motion. `direction` is s of MODEL.md eq. (2.1): the sign of the rate, or at rest
the direction in which the pendulum would start.
"""

import dataclasses
import math

# Beyond this many Stribeck rates exp(-(rate/stribeck_rate)^2) is below 1e-16.
_STRIBECK_REACH = 6.1


@dataclasses.dataclass(frozen=True)
class Sliding:
    """Viscous, dry and quadratic friction, MODEL.md eq. (2.4) to (2.7), with dry friction that may depend on load and place.

    T = b w + s (L P D(w) + c w^2), D = tau_c + (tau_s - tau_c) exp(-(w/w_s)^2).
    L = 1 - load_share + load_share |cos(angle) + w^2 l_G / g| is the force along the rod over the weight.
    P = 1 + place_share sin(place_waves angle + place_phase).
    """

    viscous: float = 0.0  # b, N m s/rad
    coulomb: float = 0.0  # tau_c, N m
    drag: float = 0.0  # c, N m s^2/rad^2
    stiction: float | None = None  # tau_s, N m; None: tau_c
    stribeck_rate: float = 1.0  # w_s, rad/s
    load_share: float = 0.0  # share of dry friction in proportion to the force on the bearing
    length_over_gravity: float = 0.0  # l_G / g, s^2, for load_share
    place_share: float = 0.0
    place_waves: float = 4.0  # waves of friction in one turn
    place_phase: float = 0.0  # rad

    def dry(self, angle: float, rate: float) -> float:
        """Dry friction torque [N m] at this angle [rad] and rate [rad/s]; 0 or more."""
        torque = self.coulomb
        if self.stiction is not None:
            torque += (self.stiction - self.coulomb) * math.exp(-((rate / self.stribeck_rate) ** 2))
        if self.load_share:
            load = abs(math.cos(angle) + self.length_over_gravity * rate * rate)
            torque *= 1 - self.load_share + self.load_share * load
        if self.place_share:
            torque *= 1 + self.place_share * math.sin(self.place_waves * angle + self.place_phase)
        return torque

    def torque(self, angle: float, rate: float, direction: int) -> float:
        """Friction torque [N m]; it opposes the motion."""
        return self.viscous * rate + direction * (self.dry(angle, rate) + self.drag * rate * rate)

    def corners(self) -> tuple[float, ...]:
        """Rates [rad/s] at which the law changes its character, so that an integration step must end there."""
        if self.stiction is None or self.stiction == self.coulomb:
            return ()
        return tuple(self.stribeck_rate * factor for factor in (0.5, 1.0, 2.0, 4.0, _STRIBECK_REACH))


@dataclasses.dataclass(frozen=True)
class Bristles:
    """Dry friction with one internal state, the deflection z [rad] of the contact.

    Dahl (P. R. Dahl, "A solid friction model", Aerospace Corporation TOR-0158(3107-18), 1968):
        dz/dt = w - |w| z stiffness / D,  T = stiffness z + b w
    LuGre (Canudas de Wit, Olsson, Astrom, Lischinsky, IEEE Trans. Automatic Control 40:419, 1995):
        the same dz/dt with D(w) of the Stribeck law,  T = stiffness z + damping dz/dt + b w
    In steady sliding both are the sliding law: z = s D / stiffness.
    """

    sliding: Sliding
    stiffness: float  # N m/rad
    damping: float = 0.0  # N m s/rad; 0 is Dahl

    def deflection_rate(self, angle: float, rate: float, deflection: float) -> float:
        """dz/dt [rad/s]."""
        return rate - abs(rate) * deflection * self.stiffness / self.sliding.dry(angle, rate)

    def torque(self, angle: float, rate: float, deflection: float) -> float:
        """Friction torque [N m], which is a spring's for small motions."""
        drag = self.sliding.drag * rate * abs(rate)
        bristle = self.stiffness * deflection
        if self.damping:
            bristle += self.damping * self.deflection_rate(angle, rate, deflection)
        return self.sliding.viscous * rate + drag + bristle

    def corners(self) -> tuple[float, ...]:
        """Rates [rad/s] at which the law changes its character."""
        return self.sliding.corners()
