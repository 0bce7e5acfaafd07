# SPDX-License-Identifier: Apache-2.0
"""The equation of motion of a pendulum on a real mounting, in SI units.

MODEL.md eq. (2.1) with all torques multiplied by G, and three additions: a spring in parallel, a support that yields, and
the torque of a hand. The state is [angle, rate], then the deflection of the contact if friction has one, then the
displacement [m] and velocity [m/s] of the support if it yields.
"""

import collections.abc
import dataclasses
import math

from friction import Bristles, Sliding

Torque = collections.abc.Callable[[float], float]  # of time [s]; N m


def no_hand(_: float) -> float:
    """The torque of a hand that does not touch the pendulum."""
    return 0.0


@dataclasses.dataclass(frozen=True)
class Support:
    """A support that yields horizontally: mass, spring and damper. The pendulum drives it."""

    mass: float  # kg, without the pendulum
    stiffness: float  # N/m
    damping: float = 0.0  # N s/m


@dataclasses.dataclass(frozen=True)
class Body:
    """A pendulum, its friction and its mounting."""

    inertia: float  # about the pivot, kg m^2
    gravity_torque: float  # G, N m
    friction: Sliding | Bristles
    mass: float = 0.475  # kg; this and gravity matter for supports and loads only
    gravity: float = 9.81  # m/s^2
    spring: float = 0.0  # torsional stiffness in parallel, N m/rad; relaxed at angle 0
    support: Support | None = None
    is_linear: bool = False  # G angle instead of G sin(angle), MODEL.md eq. (2.3)

    @property
    def first_moment(self) -> float:
        """Mass times the distance of its centre from the pivot, kg m."""
        return self.gravity_torque / self.gravity

    @property
    def length(self) -> float:
        """Distance of the centre of mass from the pivot, l_G [m]."""
        return self.first_moment / self.mass

    @property
    def period(self) -> float:
        """Period of small swings without friction [s]."""
        return 2 * math.pi * math.sqrt(self.inertia / (self.gravity_torque + self.spring))

    def initial_state(self, angle: float, rate: float, deflection: float = 0.0) -> list[float]:
        """State with a support at rest."""
        state = [angle, rate]
        if isinstance(self.friction, Bristles):
            state.append(deflection)
        if self.support:
            state += [0.0, 0.0]
        return state

    def restoring_torque(self, angle: float) -> float:
        """Torque towards angle 0 [N m]."""
        return self.gravity_torque * (angle if self.is_linear else math.sin(angle)) + self.spring * angle

    def _support_force(self, state: list[float]) -> float:
        """Force on support and pendulum [N]: spring, damper and the pull along the rod."""
        angle, rate, (place, velocity) = state[0], state[1], state[-2:]
        pull = self.first_moment * rate * rate * math.sin(angle)
        return pull - self.support.stiffness * place - self.support.damping * velocity

    def derivative(self, state: list[float], direction: int, hand: float) -> list[float]:
        """Derivative of the state while the pendulum slides in this direction, under a hand's torque [N m].

        With a support of mass M_s at place x, from the Lagrangian of a pendulum on a carriage:
            I w' + m l cos(angle) x'' = -G sin(angle) - T
            (M_s + m) x'' + m l (cos(angle) w' - sin(angle) w^2) = -k x - d x'
        """
        angle, rate = state[0], state[1]
        contact = []
        if isinstance(self.friction, Bristles):
            torque = self.friction.torque(angle, rate, state[2])
            contact = [self.friction.deflection_rate(angle, rate, state[2])]
        else:
            torque = self.friction.torque(angle, rate, direction)
        drive = hand - self.restoring_torque(angle) - torque
        if not self.support:
            return [rate, drive / self.inertia, *contact]
        coupling, total = self.first_moment * math.cos(angle), self.support.mass + self.mass
        force = self._support_force(state)
        determinant = self.inertia * total - coupling * coupling
        acceleration = (total * drive - coupling * force) / determinant
        return [rate, acceleration, *contact, state[-1], (self.inertia * force - coupling * drive) / determinant]

    def derivative_at_rest(self, state: list[float]) -> list[float]:
        """Derivative of the state while friction holds the pendulum and the support may still move."""
        rest = [0.0] * len(state)
        if self.support:
            rest[-2:] = [state[-1], self._support_force(state) / (self.support.mass + self.mass)]
        return rest

    def torque_to_hold(self, state: list[float], hand: float) -> float:
        """Torque [N m] that friction would have to give to keep the pendulum at rest."""
        torque = hand - self.restoring_torque(state[0])
        if self.support:
            torque -= self.first_moment * math.cos(state[0]) * self.derivative_at_rest(state)[-1]
        return torque

    def direction_from_rest(self, state: list[float], hand: float) -> int:
        """Direction in which the pendulum starts, or 0 if friction holds it, MODEL.md eq. (2.9)."""
        if isinstance(self.friction, Bristles):
            acceleration = self.derivative(state, 0, hand)[1]
            return 0 if abs(acceleration) < 1e-9 else int(math.copysign(1, acceleration))
        torque = self.torque_to_hold(state, hand)
        if abs(torque) <= self.friction.dry(state[0], 0.0) * (1 + 1e-12):
            return 0
        return int(math.copysign(1, torque))


def yielding_support(body: Body, mass_ratio: float, frequency: float, damping_ratio: float = 0.02) -> Support:
    """A support of this mass [pendulums] that swings at this frequency [Hz] when it carries the pendulum."""
    total = body.mass * (1 + mass_ratio)
    natural = 2 * math.pi * frequency
    return Support(body.mass * mass_ratio, total * natural**2, 2 * damping_ratio * total * natural)
