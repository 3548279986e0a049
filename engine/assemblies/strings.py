"""Suspension strings that swing along and across the line, as joins between spans. Theory section 16."""

import numpy as np

from engine.arrays import BoolArray, FloatArray
from engine.assemblies.assembly import Joins
from engine.assemblies.spans import carried_weights
from engine.mechanics.finite_elements import FIELDS, THETA, U, V, W
from engine.mechanics.static_profile import StaticProfile
from engine.spec import GRAVITY, Line, SuspensionString

SWINGS = (U, W)  # a string holds V and Theta: the clamp or yoke does not turn about the line


def string_joins(
    strings: tuple[SuspensionString, ...], spans: tuple[Line, ...], profile: StaticProfile, freedoms: int
) -> Joins:
    """Return the joins of spans by the strings between them.

    The ends of both spans move together in X and Z. A string of length l and weight W that carries P holds its lower
    end by (P + W/2)/l in both directions, with the mass W/(3 g) of a rigid rod.

    Parameters
    ----------
    strings : tuple of SuspensionString
    spans : tuple of Line
        One more than strings.
    profile : StaticProfile
        Of the spans.
    freedoms : int
        Of one span.
    """
    ends = [(i, swing) for i in range(len(strings)) for swing in SWINGS]
    ties, links = np.zeros((2, len(ends), len(spans) * freedoms))
    for row, (i, swing) in enumerate(ends):
        right_end, left_end = (i + 1) * freedoms - FIELDS + swing, (i + 1) * freedoms + swing
        ties[row, right_end], ties[row, left_end] = 1.0, -1.0
        links[row, [right_end, left_end]] = 0.5  # they are one: half each keeps shares of energy symmetric
    length, weight = (np.array([getattr(string, name) for string in strings]) for name in ("length", "weight"))
    stiffness = (carried_weights(spans, profile) + 0.5 * weight) / length
    mass = weight / (3.0 * GRAVITY)
    return Joins(ties, links, _for_each_swing(stiffness), _for_each_swing(mass))


def held_ends(spans: int, freedoms: int) -> BoolArray:
    """Tell which freedoms the supports of a section hold: (spans, freedoms).

    Strings hold V and Theta of both spans, the dead ends of the section U and W, too.
    """
    held = np.zeros((spans, freedoms), dtype=np.bool_)
    for end in (0, freedoms - FIELDS):
        held[:, [end + V, end + THETA]] = True
    for swing in SWINGS:
        held[0, swing] = held[-1, freedoms - FIELDS + swing] = True
    return held


def _for_each_swing(values: FloatArray) -> FloatArray:
    return np.repeat(values, len(SWINGS))
