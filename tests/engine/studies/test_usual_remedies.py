"""The usual remedies suit the line, and what is left out is said."""

from dataclasses import replace

from engine.spec import Analysis, ChangedTension, Line, Model, Phase, Spacer
from engine.studies.usual_remedies import usual_remedies
from tests.builders import THREE_SPANS, only, section_line, source_line

HYBRID = only(Model.HYBRID)


def kinds(line: Line, analysis: Analysis = HYBRID, separation: float | None = None) -> list[str]:
    return [remedy.kind for remedy in usual_remedies(line, analysis, separation)[0]]


def test_spacers_are_for_bundles_and_move_where_there_are_some() -> None:
    common = ["detuning_pendulum", "torsional_damper"]
    assert kinds(source_line(1)) == [*common, "tension", "tension"]
    assert kinds(source_line(2)) == [*common, "spacer", "tension", "tension"]
    fitted = replace(source_line(2), devices=(Spacer(40.0, 6.5, 0.4),))
    assert kinds(fitted) == [*common, "moved", "tension", "tension"]


def test_interphase_spacers_need_phases_and_the_finite_element_model() -> None:
    line = replace(source_line(2), phases=(Phase("far", 14.0, 0.0), Phase("top", 7.0, 0.0)))
    tried, notes = usual_remedies(line, HYBRID, None)
    assert "interphase_spacer" not in [remedy.kind for remedy in tried]
    assert any("finite_element" in note for note in notes)
    (tie,) = [one for one in usual_remedies(line, Analysis(), None)[0] if one.kind == "interphase_spacer"]
    assert getattr(tie, "device").between == ("this", "top")  # noqa: B009 - the kind says that it has a device


def test_what_does_not_fit_is_left_out_with_its_reason() -> None:
    tried, notes = usual_remedies(section_line(THREE_SPANS, interest=2), HYBRID, None)
    assert {type(remedy) for remedy in tried} == {ChangedTension}
    assert any("section" in note for note in notes)
    assert any("Airflow spoilers were not tried" in note for note in notes)
    assert kinds(source_line(1), separation=60.0) == ["torsional_damper", "tension", "tension"][1:]
