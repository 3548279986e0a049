"""The relief coordinate: the shape of the static curve with the longitudinal motion that balances it."""

from dataclasses import replace

import numpy as np
import pytest

from engine.mechanics.finite_elements import FIELDS, THETA, U, V, W
from engine.models.relief import relief_displacement
from engine.spec import Support, Supports
from tests.builders import discretized, source_line

HELD = replace(source_line(1), supports=Supports(None, Support(dead_end=True), Support()))


@pytest.mark.parametrize("line", [source_line(2), HELD], ids=["springs", "one dead end"])
def test_longitudinal_forces_vanish_at_every_free_node(line: object) -> None:
    made = discretized(line)  # type: ignore[arg-type]
    displacement = relief_displacement(made)[0]
    force = (made.matrices.stiffness[0] @ displacement)[U::FIELDS]
    free = ~made.matrices.fixed[0, U::FIELDS]
    scale = np.abs(made.matrices.stiffness[0]).max() * np.abs(displacement).max()
    assert np.abs(force[free]).max() < 1e-12 * scale
    assert not displacement[U::FIELDS][~free].any()


def test_it_lifts_the_sag_and_turns_nothing() -> None:
    made = discretized(source_line(2))
    displacement = relief_displacement(made)[0]
    vertical = displacement[V::FIELDS]
    assert vertical[0] == vertical[-1] == 0.0
    assert (vertical[1:-1] > 0.0).all()
    assert not displacement[W::FIELDS].any()
    assert not displacement[THETA::FIELDS].any()
    middle = vertical.size // 2
    # a parabola with (2/L) int f^2 ds = 1 has the height sqrt(15/16)
    assert vertical[middle] == pytest.approx((15.0 / 16.0) ** 0.5, rel=1e-3)
