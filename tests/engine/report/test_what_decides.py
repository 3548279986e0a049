"""What the samples add to a verdict."""

from dataclasses import replace
from functools import cache

import pytest

from engine.report.what_decides import in_words, weighed, what_decides
from engine.result import Result, SensitivityRow, UncertaintyRow, columns_of
from tests.builders import run
from tests.engine.uncertainty.den_hartog_line import ASKED, line_of

YES = ("Gallops from 3.0 m/s; at 8 m/s in one loop, 1.20 m peak to peak.", "More.")
NO = ("Stays at rest at the wind speeds asked for, up to 8 m/s.",)


@cache
def plain() -> Result:
    return run(line_of({}), ASKED)


def about(probability: float | None, **changes: int) -> UncertaintyRow:
    example = {name: column.example for name, (_, column) in columns_of(UncertaintyRow).items()}
    overall = {"wind_speed_m_per_s": None, "probability": probability, "unknown": 0, "statically_unstable": 0}
    return UncertaintyRow(**{**example, **overall, **changes})  # type: ignore[arg-type]


def share(path: str, onset: float | None, amplitude: float | None) -> SensitivityRow:
    example = {name: column.example for name, (_, column) in columns_of(SensitivityRow).items()}
    return SensitivityRow(**{**example, "path": path, "onset_total": onset, "amplitude_total": amplitude})  # type: ignore[arg-type]


def found(row: UncertaintyRow, *shares: SensitivityRow) -> Result:
    return replace(plain(), uncertainty=(row,), sensitivities=shares)


DAMPING = share("damping.vertical_ratio", 0.6, 0.2)
SHAPE = share("ice.aerodynamics.vertical_factor", 0.5, 0.7)


def test_without_samples_nothing_is_added() -> None:
    assert what_decides(plain()) is None
    assert weighed(plain(), "yes", YES) == ("yes", " ".join(YES))


def test_the_largest_total_index_on_the_onset_decides_whether() -> None:
    result = found(about(0.7), DAMPING, SHAPE)
    assert what_decides(result) == "damping.vertical_ratio"
    expected = f"{YES[0][:-1]}; the vertical damping decides: probability 0.7. More."
    assert weighed(result, "yes", YES) == ("yes", expected)


def test_where_all_gallop_the_index_on_the_amplitude_decides_how_far() -> None:
    result = found(about(1.0), DAMPING, SHAPE)
    assert what_decides(result) == "ice.aerodynamics.vertical_factor"
    assert weighed(result, "yes", YES[:1])[1].endswith("; the ice shape decides how far: probability 1.")


def test_indices_that_are_not_told_name_nothing() -> None:
    result = found(about(0.7), share("damping.vertical_ratio", None, 0.5))
    assert what_decides(result) is None
    assert weighed(result, "yes", YES[:1])[1].endswith("peak to peak; probability 0.7.")


@pytest.mark.parametrize(
    ("gallops", "probability", "answer"),
    [
        ("yes", 0.5, "yes"),
        ("yes", 0.49, "undecided"),
        ("no", 0.04, "no"),
        ("no", 0.05, "undecided"),
        ("undecided", 0.9, "undecided"),
        ("yes", None, "yes"),
    ],
)
def test_samples_that_contradict_leave_it_undecided(gallops: str, probability: float | None, answer: str) -> None:
    sentences = YES if gallops == "yes" else NO
    decided, sentence = weighed(found(about(probability), DAMPING), gallops, sentences)  # type: ignore[arg-type]
    assert decided == answer
    contradicted = answer == "undecided" != gallops
    assert sentence.startswith("Not decided. With all values as assumed: ") == contradicted


def test_samples_without_an_answer_are_named() -> None:
    result = found(about(1.0, unknown=3, statically_unstable=2), DAMPING)
    assert "probability 1 (5 of 64 samples have no answer)" in weighed(result, "yes", YES)[1]
    assert "no sample tells the probability" in weighed(found(about(None)), "undecided", ("Not decided.",))[1]


@pytest.mark.parametrize(
    ("path", "words"),
    [
        ("ice.aerodynamics_at_rest.vertical", "the ice shape"),
        ("ice.aerodynamics.reference_diameter", "the reference diameter of the coefficients"),
        ("damping.torsional_ratio", "the torsional damping"),
        ("conductor.torsional_rigidity", "the torsional rigidity"),
    ],
)
def test_fields_have_names_in_words(path: str, words: str) -> None:
    assert in_words(path) == words
