"""A line with its samples, held to a span whose onset is a formula."""

from functools import cache

import numpy as np
import pytest

from engine.known.provenance import Assumption, Origin
from engine.progress import Progress, driven, finished
from engine.result import Result
from engine.spec import Uncertainty
from engine.uncertainty.inputs import Choice, Interval
from engine.uncertainty.weighing import Unknowns, analyse_with_samples, intervals
from tests.builders import run
from tests.engine.uncertainty.den_hartog_line import ASKED, INPUTS, RATIO, UNKNOWNS, WINDS, constant, line_of, onset


@cache
def weighed(count: int = 256) -> Result:
    return finished(analyse_with_samples(line_of({}), ASKED, UNKNOWNS, Uncertainty(count, 1)))


def probability_at(wind: float) -> float:
    """Return the probability of an onset below a wind speed: the mean over a fine grid of densities and slopes."""
    ratio, density, factor = INPUTS
    middles = np.linspace(0.001, 0.999, 500, dtype=np.float64)
    product = density.at(middles)[:, None] * factor.at(middles)
    share = np.log(wind * product / constant() / ratio.lowest) / np.log(ratio.highest / ratio.lowest)
    return float(np.mean(np.clip(share, 0.0, 1.0)))


def test_probabilities_are_those_of_quadrature() -> None:
    overall, *rows = weighed().uncertainty
    assert [row.wind_speed_m_per_s for row in rows] == list(WINDS)
    assert 0.02 < probability_at(WINDS[0]) < probability_at(WINDS[1]) < probability_at(WINDS[2]) < 0.98
    for row in rows:
        assert row.wind_speed_m_per_s is not None
        truth = probability_at(row.wind_speed_m_per_s)
        assert row.probability == pytest.approx(truth, abs=0.015)  # 256 independent samples scatter by 0.03
        assert row.probability_lowest < truth < row.probability_highest
        assert row.gallops + row.rests == row.samples == 256
    assert overall.probability == rows[-1].probability  # the highest wind speed is the worst


def test_the_onset_has_its_quantiles() -> None:
    row = weighed().uncertainty[0]
    for quantile, share in ((row.onset_p05_m_per_s, 0.05), (row.onset_p50_m_per_s, 0.5), (row.onset_p95_m_per_s, 0.95)):
        assert quantile is not None
        assert probability_at(quantile) == pytest.approx(share, abs=0.015)


def test_indices_on_the_onset_are_those_of_the_formula() -> None:
    def variance(lowest: float, highest: float) -> float:
        """Return the variance of the logarithm of a uniform value."""
        values = np.linspace(lowest, highest, 200_001)
        return float(np.var(np.log((values[1:] + values[:-1]) / 2.0)))

    ratio, density, factor = INPUTS
    own = {
        ratio.path: np.log(ratio.highest / ratio.lowest) ** 2 / 12.0,
        density.path: variance(density.lowest, density.highest),
        factor.path: variance(factor.lowest, factor.highest),
    }
    whole = sum(own.values())
    for row in weighed().sensitivities:
        assert row.onset_first_order == pytest.approx(own[row.path] / whole, abs=1e-3)
        assert row.onset_total == pytest.approx(own[row.path] / whole, abs=1e-3)
        assert row.onset_explained == pytest.approx(1.0, abs=1e-3)
    (row,) = [row for row in weighed().sensitivities if row.path == RATIO]
    assert row.onset_at_lowest_m_per_s == pytest.approx(onset(ratio.lowest, 1.2929, 1.0), rel=1e-6)
    assert row.onset_at_highest_m_per_s == pytest.approx(onset(ratio.highest, 1.2929, 1.0), rel=1e-6)
    assert row.vertical_at_highest_m == 0.0
    assert row.vertical_at_lowest_m is not None
    assert row.vertical_at_lowest_m > 0.1


def test_the_verdict_names_the_probability_and_what_decides() -> None:
    (row,) = weighed().verdict
    plain = run(line_of({}), ASKED)
    assert row.probability_gallops == weighed().uncertainty[0].probability
    assert row.what_decides == RATIO
    assert plain.verdict[0].sentence.endswith(" peak to peak.")
    added = f"; the vertical damping decides: probability {row.probability_gallops:.2g}."
    assert row.sentence == plain.verdict[0].sentence.removesuffix(".") + added
    assert weighed().limit_cycles == plain.limit_cycles


def test_an_estimate_says_how_far_it_has_come() -> None:
    row = weighed().uncertainty[1]
    half = weighed(128).uncertainty[1]
    assert row.probability is not None
    assert half.probability is not None
    assert row.probability_change == pytest.approx(row.probability - half.probability)
    assert row.onset_p50_change_m_per_s is not None
    assert abs(row.onset_p50_change_m_per_s) < 0.1


def test_the_seed_decides_the_samples() -> None:
    again = finished(analyse_with_samples(line_of({}), ASKED, UNKNOWNS, Uncertainty(128, 1)))
    assert again.uncertainty == weighed(128).uncertainty
    assert again.sensitivities == weighed(128).sensitivities
    other = finished(analyse_with_samples(line_of({}), ASKED, UNKNOWNS, Uncertainty(128, 2)))
    assert other.uncertainty[1].onset_p50_m_per_s != again.uncertainty[1].onset_p50_m_per_s


@pytest.mark.parametrize(
    ("unknowns", "asked"), [(UNKNOWNS, Uncertainty(0, 1)), (Unknowns((), line_of), Uncertainty(64, 1))]
)
def test_without_samples_the_result_is_that_of_the_line(unknowns: Unknowns, asked: Uncertainty) -> None:
    found = finished(analyse_with_samples(line_of({}), ASKED, unknowns, asked))
    assert found.verdict == run(line_of({}), ASKED).verdict
    assert (found.uncertainty, found.sensitivities) == ((), ())


def test_progress_rises_and_names_the_samples() -> None:
    steps: list[Progress] = []
    driven(analyse_with_samples(line_of({}), ASKED, UNKNOWNS, Uncertainty(32, 1)), steps.append)
    fractions = [step.fraction for step in steps]
    assert fractions == sorted(fractions)
    assert fractions[-1] == 1.0
    assert any(step.step.startswith("samples 1 to") for step in steps)


def test_only_assumed_values_with_a_range_are_uncertain() -> None:
    rows = (
        Assumption("a", 1.0, "m", Origin.GIVEN, "as given"),
        Assumption("b", 1.0, "m", Origin.ASSUMED, "assumed", 1.0, 1.0),
        Assumption("c", 15.0, "degC", Origin.ASSUMED, "assumed", 5.0, 25.0),
        Assumption("d", 2.0, "", Origin.ASSUMED, "assumed", 1.0, 3.0),
    )
    found = intervals(rows)
    assert [(one.path, isinstance(one, Interval) and one.logarithmic) for one in found] == [("c", False), ("d", True)]


def test_a_choice_among_several_is_one_uncertain_input() -> None:
    rows = (
        Assumption("shape", 0.0, "", Origin.ASSUMED, "assumed", 0.0, 2.0, ("a", "b", "c")),
        Assumption("only", 0.0, "", Origin.ASSUMED, "assumed", 0.0, 0.0, ("a",)),
    )
    assert intervals(rows) == (Choice("shape", 0.0, (1.0, 1.0, 1.0)),)
