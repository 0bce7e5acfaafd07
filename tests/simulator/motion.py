# SPDX-License-Identifier: Apache-2.0
"""Integrates the motion piece by piece with DOP853. A piece ends at a reversal, where dry friction jumps, and at each rate
at which the friction law changes its character."""

import collections.abc
import dataclasses

import numpy
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from friction import Bristles
from pendulum import Body, Torque, no_hand

RELATIVE_TOLERANCE, ABSOLUTE_TOLERANCE = 1e-11, 1e-13
BEYOND = 1e-7  # s after friction no longer holds, because at that time the torque is the limit itself
Array = numpy.ndarray


@dataclasses.dataclass(frozen=True)
class Piece:
    """A part of the motion: state(times) gives an array of one row for each component."""

    begin: float  # s
    end: float  # s
    state: collections.abc.Callable[[Array], Array]
    direction: int  # 0 at rest


class Motion:
    """Angle and rate at any time from the release on; before it, `held` gives the angle."""

    def __init__(self, pieces: list[Piece], held: collections.abc.Callable[[Array], Array] | None = None):
        self.pieces = pieces
        self._begins = numpy.array([piece.begin for piece in pieces])
        self._held = held

    @property
    def begin(self) -> float:
        """Time of the release [s]."""
        return self.pieces[0].begin

    @property
    def reversals(self) -> list[float]:
        """Times [s] at which the direction changes or the motion ends."""
        return [after.begin for before, after in zip(self.pieces, self.pieces[1:])
                if before.direction != after.direction]

    def states(self, times: Array) -> Array:
        """States [components x N] at times not before the release."""
        times = numpy.asarray(times, dtype=float)
        which = numpy.clip(numpy.searchsorted(self._begins, times, side="right") - 1, 0, None)
        first = self.pieces[0].state(self._begins[:1])
        states = numpy.empty((len(first), len(times)))
        for index in numpy.unique(which):
            states[:, which == index] = self.pieces[index].state(times[which == index])
        return states

    def _component(self, times: Array, component: int, held: Array) -> Array:
        values, moves = numpy.array(held, dtype=float), times >= self.begin
        if moves.any():
            values[moves] = self.states(times[moves])[component]
        return values

    def angle(self, times: Array) -> Array:
        """Angles [rad]."""
        times = numpy.asarray(times, dtype=float)
        held = self._held(times) if self._held else numpy.full(len(times), self.states(self._begins[:1])[0, 0])
        return self._component(times, 0, held)

    def rate(self, times: Array) -> Array:
        """Rates [rad/s]; 0 before the release, because holds move slowly."""
        times = numpy.asarray(times, dtype=float)
        return self._component(times, 1, numpy.zeros(len(times)))


def _crossing(rate: float, slope: int):
    """An event of solve_ivp: the rate passes this value with this slope."""

    def event(_, state):
        return state[1] - rate

    event.terminal, event.direction = True, slope
    return event


def _solved(derivative, begin: float, end: float, state, events, step: float):
    return solve_ivp(derivative, (begin, end), state, method="DOP853", dense_output=True, events=events, max_step=step,
                     rtol=RELATIVE_TOLERANCE, atol=ABSOLUTE_TOLERANCE)


def _slide(body: Body, hand: Torque, begin: float, end: float, state, direction: int, passed: tuple[float, int] | None):
    """Slides to the next reversal, corner of the law, or end. Returns the piece, the last state and the corner."""
    corners = [(direction * rate, slope) for rate in body.friction.corners() for slope in (1, -1)]
    marks = [(0.0, -direction), *(corner for corner in corners if corner != passed)]

    def derivative(time, current):
        return body.derivative(current.tolist(), direction, hand(time))

    solution = _solved(derivative, begin, end, state, [_crossing(*mark) for mark in marks], body.period / 12)
    last, at = solution.y[:, -1].copy(), None
    if solution.status == 1:
        at = next(mark for mark, times in zip(marks, solution.t_events) if len(times))
        last[1] = at[0]
    return Piece(begin, float(solution.t[-1]), solution.sol, direction), last, at


def _end_of_rest(body: Body, hand: Torque, begin: float, end: float, state: list[float]) -> float:
    """Time at which a hand whose torque falls lets a pendulum on a firm axis go; `end` if friction holds it."""
    if isinstance(body.friction, Bristles):
        return end

    def excess(time):
        return abs(body.torque_to_hold(state, hand(time))) - body.friction.dry(state[0], 0.0)

    if excess(end) <= 0:
        return end
    if excess(begin) >= 0:
        return min(end, begin + BEYOND)
    return min(end, brentq(excess, begin, end, xtol=1e-12) + BEYOND)


def _rest(body: Body, hand: Torque, begin: float, end: float, state):
    """Rests until friction no longer holds the pendulum, or to the end."""
    still = numpy.array(state)
    if not body.support:
        end = _end_of_rest(body, hand, begin, end, state.tolist())
        return Piece(begin, end, lambda times: numpy.repeat(still[:, None], len(times), axis=1), 0), still

    def derivative(_, current):
        return body.derivative_at_rest(current.tolist())

    def breaks_loose(time, current):
        return abs(body.torque_to_hold(current.tolist(), hand(time))) - body.friction.dry(current[0], 0.0)

    breaks_loose.terminal, breaks_loose.direction = True, 1
    solution = _solved(derivative, begin, end, state, [breaks_loose], body.period / 12)
    return Piece(begin, float(solution.t[-1]), solution.sol, 0), solution.y[:, -1].copy()


def swing(body: Body, begin: float, end: float, angle: float, rate: float = 0.0, deflection: float = 0.0,
          hand: Torque = no_hand, hand_leaves: float | None = None, held=None) -> Motion:
    """The motion from `begin` to `end` [s]. A hand may act until `hand_leaves`; a piece ends there."""
    state = numpy.array(body.initial_state(angle, rate, deflection))
    time, pieces, passed = begin, [], None
    while time < end:
        until = hand_leaves if hand_leaves is not None and time < hand_leaves < end else end
        torque = hand if hand_leaves is not None and time < hand_leaves else no_hand
        direction = int(numpy.sign(state[1])) or body.direction_from_rest(state.tolist(), torque(time))
        if direction:
            piece, state, passed = _slide(body, torque, time, until, state, direction, passed)
        else:
            piece, state = _rest(body, torque, time, until, state)
            passed = None
            if piece.end < until and body.support:  # it breaks loose: the torque is the limit itself, so go on just beyond it
                state = state + 1e-9 * numpy.array(body.derivative_at_rest(state.tolist()))
        pieces.append(piece)
        time = piece.end
    return Motion(pieces, held)
