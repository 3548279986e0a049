from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from engine.arrays import FloatArray
from engine.models.reduced_model import ReducedModel, take
from engine.studies.field_models import FieldModels, field_models
from tests.builders import Oscillators, hand_made

BASE = hand_made(Oscillators(np.eye(2), 0.1 * np.eye(2), np.eye(2), {(0, (2,)): 0.3, (1, (0, 0, 3)): -0.2}))
COLUMNS = np.array([1.0, 5.0])


def stiffened(by: Callable[[FloatArray], FloatArray], gap: tuple[float, float] = (2.0, 2.0)) -> FieldModels:
    """Return models over -1 to 1 whose stiffness is a function of the field, in two columns; none within a gap."""

    def models_of(values: FloatArray) -> ReducedModel | None:
        if ((values > gap[0]) & (values < gap[1])).any():
            return None
        copies = take(BASE, np.zeros((values.size, COLUMNS.size), dtype=np.intp))
        return replace(copies, stiffness=copies.stiffness * (by(values)[:, None] * COLUMNS)[..., None, None])

    return field_models(models_of, -1.0, 1.0)


@pytest.mark.parametrize("value", [-1.0, -0.371, 0.0, 0.5, 0.999, 1.0])
def test_a_smooth_model_is_met_between_the_values_at_which_it_was_made(value: float) -> None:
    found, defined = stiffened(np.exp).at(np.full(2, value), np.arange(2))
    assert defined.all()
    assert found.stiffness == pytest.approx(np.exp(value) * COLUMNS[:, None, None] * np.eye(2), rel=1e-9)
    assert found.damping == pytest.approx(np.broadcast_to(0.1 * np.eye(2), (2, 2, 2)), rel=1e-12)
    assert found.load.table == pytest.approx(np.repeat(BASE.load.table, 2, axis=0), rel=1e-12)


def test_panels_are_halved_at_a_kink_and_nowhere_else() -> None:
    models = stiffened(lambda values: 1.0 + np.abs(values - 0.3))
    width = models.high - models.low
    assert models.low[0] == -1.0 and models.high[-1] == 1.0
    assert models.low[1:] == pytest.approx(models.high[:-1])
    assert width.max() == 1.0
    assert width.min() == pytest.approx(2.0 / 2**6)
    (at_kink,) = np.flatnonzero(~models.defined.all(axis=1))
    assert models.low[at_kink] <= 0.3 <= models.high[at_kink]


def test_where_a_value_has_no_line_nothing_is_defined() -> None:
    models = stiffened(np.exp, gap=(0.2, 0.5))
    _, defined = models.at(np.array([0.1, 0.35, 0.6, np.nan]), np.zeros(4, dtype=np.intp))
    assert defined.tolist() == [True, False, True, False]


def test_an_end_without_a_line_is_refused() -> None:
    with pytest.raises(ValueError, match="no line at an end"):
        stiffened(np.exp, gap=(0.9, 1.1))
