"""Starts at every wind speed: a further coordinate rests, and stretching raises the frequency."""

from dataclasses import replace

import numpy as np
import pytest

from engine.cycles.starts import energy_starts, explicit_starts
from engine.models.reduced_model import take
from engine.spec import Analysis, Stretching
from tests.builders import hybrid, published, source_line

WINDS = np.array([4.0, 6.0])


def test_explicit_starts_leave_the_relief_coordinate_at_rest_and_stiffen_the_motion() -> None:
    line = source_line(2)
    plain, stretched = hybrid(line, 2), hybrid(line, 2, Analysis(stretching=Stretching.INCLUDED))
    before = explicit_starts(published(line, 2), plain, WINDS, 3)
    after = explicit_starts(published(line, 2), stretched, WINDS, 3)
    assert set(before.wind.tolist()) == {0, 1}
    assert after.orbits.coefficients.shape == (before.member.size, 4, 7)
    assert not after.orbits.coefficients[:, 3].any()
    assert after.orbits.coefficients[:, :3] == pytest.approx(before.orbits.coefficients)
    assert (after.orbits.angular_frequency > before.orbits.angular_frequency).all()


def test_energy_starts_exist_where_the_static_state_grows() -> None:
    model = hybrid(source_line(2), 1)
    starts = energy_starts(model, np.array([1.0, 4.0]), 3)
    assert starts.wind.tolist() == [1]
    assert starts.orbits.wind_speed.tolist() == [4.0]
    unusable = replace(take(model, [0, 0]), statically_unstable=np.array([True, False]))
    assert set(energy_starts(unusable, WINDS, 3).member.tolist()) == {1}
