import numpy as np
import pytest

from engine.outcome import Outcome
from engine.report.internal_resonances import internal_resonance_rows, motion_shares, nearest_ratio
from engine.result import FrequencyRow
from engine.spec import Analysis, Model
from tests.builders import only, run, source_line


@pytest.mark.parametrize(
    ("ratio", "expected"),
    [(0.92, (1, 1)), (1.19, (1, 1)), (1.24, (3, 2)), (2.3, (2, 1)), (0.52, (1, 2)), (9.0, (3, 1)), (0.7, (2, 3))],
)
def test_the_nearest_ratio_is_the_one_of_least_relative_difference(ratio: float, expected: tuple[int, int]) -> None:
    assert nearest_ratio(ratio) == expected


def test_the_three_frequencies_make_three_ratios() -> None:
    rows = internal_resonance_rows([FrequencyRow(Model.HYBRID, 2, 0.8, 0.4, 2.52)])
    assert [(row.directions, row.nearest_ratio) for row in rows] == [
        ("horizontal:vertical", "1:2"),
        ("torsional:vertical", "3:1"),
        ("torsional:horizontal", "3:1"),
    ]
    assert [row.frequency_ratio for row in rows] == pytest.approx([0.5, 3.15, 6.3])
    assert [row.detuning for row in rows] == pytest.approx([0.0, 0.05, 1.1], abs=1e-12)
    assert {(row.model, row.loops) for row in rows} == {(Model.HYBRID, 2)}


def test_a_frequency_that_there_is_not_has_no_ratio() -> None:
    row = FrequencyRow(Model.HYBRID, 1, 0.48, 0.45, None, Outcome.STATICALLY_UNSTABLE)
    assert [found.directions for found in internal_resonance_rows([row])] == ["horizontal:vertical"]


def test_shares_are_those_of_the_mean_kinetic_energy() -> None:
    generator = np.random.default_rng(4)
    mass, direction = generator.uniform(1.0, 3.0, (2, 6)), np.array([0, 0, 1, 1, 2, 2])
    coefficients = generator.normal(size=(2, 6, 7))
    time = 2.0 * np.pi * np.arange(64) / 64
    rate = np.zeros((2, 6, time.size))
    for k in (1, 2, 3):
        cosine, sine = coefficients[..., 2 * k - 1, None], coefficients[..., 2 * k, None]
        rate += k * (sine * np.cos(k * time) - cosine * np.sin(k * time))
    energy = (mass[..., None] * rate**2).mean(axis=-1)
    expected = np.stack([energy[:, direction == i].sum(axis=-1) for i in range(3)], axis=-1)
    expected /= expected.sum(axis=-1, keepdims=True)
    np.testing.assert_allclose(motion_shares(mass, coefficients, direction), expected, rtol=1e-12)


def test_bundles_move_vertically_in_one_loop_and_horizontally_in_two() -> None:
    """The source's finding (section 5.1) in terms of energy, at the closest resonance of its lines."""
    result = run(source_line(2), only(Model.HYBRID, wind_speeds=(4.0,)))
    pairs = {(row.loops, row.directions): row for row in result.internal_resonances}
    assert pairs[2, "horizontal:vertical"].nearest_ratio == "1:1"
    assert abs(pairs[2, "horizontal:vertical"].detuning) == pytest.approx(0.0005, abs=2e-4)
    one, two = (row for row in result.limit_cycles if row.kind == "periodic")
    assert one.vertical_share is not None and two.horizontal_share is not None
    assert one.vertical_share > 0.99
    assert two.horizontal_share > 0.9
    shares = (two.vertical_share, two.horizontal_share, two.torsional_share)
    assert sum(share or 0.0 for share in shares) == pytest.approx(1.0)


def test_rest_has_no_shares_and_every_model_its_ratios() -> None:
    result = run(source_line(2), Analysis(loops=(1,), wind_speeds=(1.0,), finite_element_loops=()))
    assert {row.vertical_share for row in result.limit_cycles} == {None}
    assert [row.model for row in result.internal_resonances] == [Model.HYBRID] * 3 + [Model.FINITE_ELEMENT] * 3
