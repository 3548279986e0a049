"""The load in the form that direct integration evaluates is the load itself, less its linear part."""

from dataclasses import replace

import numpy as np
import pytest

from engine.checks.wind_polynomials import wind_polynomials
from engine.models.reduced_model import force, force_gradient
from engine.numerics import polynomial
from tests.engine.motions import MODELS, perturbed


@pytest.mark.parametrize(
    ("name", "points", "rows"),
    [
        ("hybrid, relative wind", 1, 3),  # with a relief coordinate, on which no wind acts
        ("finite element", 50, 2),  # the square and the cube of the angle of attack
        ("finite element, relative wind", 1, 6),  # integrated along the span: six forces of their own
    ],
)
def test_the_terms_are_those_of_the_load_without_its_linear_part(name: str, points: int, rows: int) -> None:
    model = perturbed(MODELS[name]())
    member = np.array([2, 0, 2, 1])
    terms = wind_polynomials(model.load, member)
    assert terms.table.shape[:3] == (member.size, points, rows)
    m = model.mass.shape[-1]
    state = np.random.default_rng(3).normal(scale=0.3, size=(member.size, 2 * m))
    monomials = polynomial.powers(np.einsum("spla,sa->spl", terms.forms, state))[..., terms.forms.shape[2] :]
    found = np.einsum("spor,sprt,spt->so", terms.outward, terms.table, monomials)
    stack = np.zeros((4, 1, 2 * m))
    for i, own in enumerate(member.tolist()):
        stack[own, 0] = state[i]
        linear = force_gradient(model, np.zeros_like(stack))[own, 0] @ state[i]
        expected = force(model, stack)[own, 0] - linear
        assert found[i] == pytest.approx(expected, rel=1e-9, abs=1e-9 * np.abs(expected).max())


def test_coefficients_that_overflowed_are_left_as_they_are() -> None:
    model = MODELS["finite element"]()
    endless = replace(model.load, table=np.full_like(model.load.table, np.inf))
    terms = wind_polynomials(endless, np.zeros(1, dtype=np.intp))
    assert terms.table.shape[2] == model.mass.shape[-1]
    assert np.isinf(terms.table).all()
