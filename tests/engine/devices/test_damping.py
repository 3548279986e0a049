"""The damping of devices in the reduced models, against the motion of the shapes at the device."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import pytest

from engine.arrays import FloatArray
from engine.mechanics.modes import directional_shapes
from engine.models.hybrid import joint_model
from engine.models.reduced_model import ReducedModel
from engine.spec import Analysis, Line, PointDevice
from engine.spec.devices import Matrix
from tests.builders import discretized, finite_element, hybrid, source_line

POSITION = 31.0
COEFFICIENT = 7.5


@dataclass(frozen=True, slots=True)
class Dashpot(PointDevice):
    """A device that damps V and Theta together, as one that hangs beside the reference curve does."""

    def damping(self) -> Matrix:
        still = (0.0, 0.0, 0.0, 0.0)
        beside = 0.2
        return (
            still,
            (0.0, COEFFICIENT, 0.0, COEFFICIENT * beside),
            still,
            (0.0, COEFFICIENT * beside, 0.0, COEFFICIENT * beside**2),
        )


LINE = replace(source_line(2), devices=(Dashpot(POSITION, 0.0),))
BARE = replace(LINE, devices=(PointDevice(POSITION, 0.0),))


def joint(line: Line) -> ReducedModel:
    """Return the model of one and two loops that may move together, with a leading axis of length 1."""
    made = discretized(line)
    shapes = directional_shapes(made.matrices, made.profile.arc_length, (1, 2))
    return joint_model(made, shapes, (1, 2), Analysis())


def motion_at(model: ReducedModel, line: Line) -> FloatArray:
    """Interpolate V + 0.2 Theta of each coordinate at the device, linearly in the arc between close nodes: (m,)."""
    made = discretized(line)
    nodes = model.shapes.shape[-1]
    arc = float(made.profile.arc_length[0])
    x = np.linspace(0.0, arc, nodes)
    # The arc is longer than the span by the sag's share, evenly enough for the tolerance here.
    place = POSITION / line.span.length * arc
    shapes = model.shapes[0]
    return np.array([np.interp(place, x, own[0] + 0.2 * own[2]) for own in shapes])


@pytest.mark.parametrize("build", [hybrid, finite_element, joint], ids=["hybrid", "finite element", "joint"])
def test_damping_is_that_of_the_motion_at_the_device(build: Callable[[Line], ReducedModel]) -> None:
    model, bare = build(LINE), build(BARE)
    gained = model.damping[0] - bare.damping[0]
    motion = motion_at(model, LINE)
    assert gained == pytest.approx(COEFFICIENT * np.outer(motion, motion), rel=0.02, abs=1e-3 * gained.max())
    assert (model.mass == bare.mass).all()
    assert (model.stiffness == bare.stiffness).all()
