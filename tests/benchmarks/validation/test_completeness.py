"""Direct integration from a spread of starts ends where the product says, and is noticed where it does not."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from benchmarks.lines import random_line
from benchmarks.starts import Ends, ends
from benchmarks.validation.completeness import Verdict, compared, integration_error, reported
from engine.outcome import Stability
from engine.result import Result
from engine.spec import Damping, Line

SEED, WIND, LONGEST = 4, 12.0, 16
BRISK = Damping(0.001, 0.004, 0.2)  # motions settle in some hundred periods


@cache
def lines() -> list[Line]:
    generator = np.random.default_rng(SEED)
    return [replace(random_line(generator), damping=BRISK)]


@cache
def results() -> list[Result]:
    return reported(lines(), (WIND,))


@cache
def ended() -> Ends:
    return ends(lines(), SEED, (WIND,), LONGEST)


def test_every_attractor_is_reported() -> None:
    found = compared(ended(), results())
    assert found.starts == 2 * 16
    assert {a.verdict for a in found.attractors} == {Verdict.REPORTED}
    rows = {row.loops: row for row in results()[0].limit_cycles if row.stability == "stable"}
    assert {row.kind for row in rows.values()} == {"periodic"}
    assert found.stable == 2
    assert {attractor.case.loops for attractor in found.attractors} >= {1}  # two loops settle more slowly
    for attractor in found.attractors:
        row = rows[attractor.case.loops]
        assert attractor.amplitude[:2] == pytest.approx([row.vertical_m, row.horizontal_m], rel=0.01)
        assert attractor.frequency == pytest.approx(row.frequency_hz, rel=1e-3)


def test_what_is_not_reported_as_stable_is_noticed() -> None:
    (first,) = results()
    judged = tuple(replace(row, stability=Stability.UNSTABLE) for row in first.limit_cycles)
    for changed, verdict in (
        (replace(first, limit_cycles=judged), Verdict.MISJUDGED),
        (replace(first, limit_cycles=(), orbits=()), Verdict.MISSED),
    ):
        found = compared(ended(), [changed])
        assert {a.verdict for a in found.attractors} == {verdict}
        assert found.stable == 0
        assert not found.approaching


def test_method_is_exact_enough() -> None:
    assert integration_error(lines()[:1], SEED) < 1e-4
