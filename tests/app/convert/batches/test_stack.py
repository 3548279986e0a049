from collections.abc import Generator, Sequence
from typing import Any

import pytest

import engine.analysis
from app import convert, schemas
from app.convert import NumberedLine, PointResult, read_analysis, read_line, run_stack
from app.convert.batches import stack
from app.convert.run import point_results
from app.reference.source_lines import example
from app.schemas.faults import BadInput
from engine import spec
from engine.progress import Progress
from engine.result import Result
from tests.app.known_documents import CONTRACT
from tests.app.lines import FULL_LINE, SHORT, changed, close

TWIN = example("c11-twin")
KNOWN = {**CONTRACT, "phases": []}


def results(lines: Sequence[NumberedLine], analysis: dict[str, Any] | None = None) -> dict[int, PointResult]:
    found = [item for item in run_stack(analysis or SHORT, lines) if isinstance(item, PointResult)]
    assert len(found) == len(lines)
    return {point.point: point for point in found}


def alone(line: dict[str, Any], analysis: dict[str, Any] | None = None) -> PointResult:
    (found,) = [i for i in convert.run({"line": line, "analysis": analysis or SHORT}) if isinstance(i, PointResult)]
    return found


def faults(document: object, analysis: dict[str, Any] | None = None) -> list[tuple[str, str]]:
    with pytest.raises(BadInput) as caught:
        read_line(document, read_analysis(analysis or {}))
    return [(fault.pointer, fault.code) for fault in caught.value.faults]


def test_every_line_has_the_numbers_that_it_has_alone() -> None:
    lengths = {number: 80.0 + 3.0 * number for number in range(1, 41)}
    lines = {n: changed("span.length_m", length, TWIN) for n, length in lengths.items()}
    lines[40] = FULL_LINE  # of other elements, so that it is in a stack of its own
    found = results([NumberedLine(n, line) for n, line in lines.items()])
    for number in (1, 20, 40):
        expected = alone(lines[number])
        assert found[number].axes == {"number": number}
        assert close(found[number].static, expected.static)
        for table, rows in expected.tables.items():
            pairs = zip(found[number].tables[table], rows, strict=True)
            assert [pair for pair in pairs if not close(*pair)] == []
    assert found[20].tables["limit_cycles"]


def test_lines_of_other_physics_are_not_computed_together() -> None:
    """A line without coefficients at rest has the source's physics among lines of full physics, as it has alone."""
    known = changed("ice.aerodynamics_at_rest", {"vertical": 0.0, "horizontal": 1.0, "torsional": 0.0}, TWIN)
    lines = {1: TWIN, 2: known, 3: changed("span.length_m", 120.0, TWIN)}
    asked = {**SHORT, "physics": None}
    found = results([NumberedLine(n, line) for n, line in lines.items()], asked)
    for number, line in lines.items():
        expected = alone(line, asked)
        assert found[number].warnings == expected.warnings
        assert found[number].tables["physics"] == expected.tables["physics"]
        cycles = zip(found[number].tables["limit_cycles"], expected.tables["limit_cycles"], strict=True)
        assert all(close(*pair) for pair in cycles)
    assert [found[n].tables["physics"][0]["physics"] for n in (1, 2, 3)] == ["source", "full", "source"]
    assert [any("ice.aerodynamics_at_rest is not given" in text for text in found[n].warnings) for n in (1, 2, 3)] == [
        True,
        False,
        True,
    ]


def test_a_line_that_is_at_fault_fails_alone() -> None:
    slack = changed("span.horizontal_tension_n", 11.0, TWIN)
    found = results([NumberedLine(1, TWIN), NumberedLine(2, slack), NumberedLine(3, {}), NumberedLine(4, TWIN)])
    assert [found[n].failure is None for n in (1, 2, 3, 4)] == [True, False, False, True]
    assert "sag smaller than the span's length" in (found[2].failure or "")
    assert found[1].tables == found[4].tables


def breaking(on: float, error: Exception) -> Any:
    real = engine.analysis.analyse_stack

    def analyse_stack(lines: Sequence[spec.Line], analysis: spec.Analysis) -> Generator[Progress, None, list[Result]]:
        if any(line.span.length == on for line in lines):
            raise error
        return (yield from real(lines, analysis))

    return analyse_stack


def test_a_stack_that_raises_is_run_line_by_line(monkeypatch: pytest.MonkeyPatch) -> None:
    lines = [NumberedLine(n, changed("span.length_m", 100.0 + n, TWIN)) for n in range(1, 6)]
    expected = results(lines)
    monkeypatch.setattr(engine.analysis, "analyse_stack", breaking(103.0, FloatingPointError("overflow in cosh")))
    found = results(lines)
    assert [found[n].failure for n in range(1, 6)] == [None, None, "FloatingPointError: overflow in cosh", None, None]
    assert found[3].tables["limit_cycles"] == []
    for number in (1, 2, 4, 5):
        assert found[number].static == pytest.approx(expected[number].static)


def test_a_defect_fails_its_line_without_showing_its_inside(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(engine.analysis, "analyse_stack", breaking(125.88, IndexError("secret path")))
    (point,) = results([NumberedLine(7, TWIN)]).values()
    assert point.failure == "RuntimeError: the computation stopped on an internal error; the log has the details"
    assert point.failed_internally


@pytest.mark.parametrize(
    "error", [RuntimeError("generator raised StopIteration"), AttributeError("x"), MemoryError(), AssertionError()]
)
def test_a_line_that_breaks_in_any_way_leaves_its_chunk_going(
    monkeypatch: pytest.MonkeyPatch, error: Exception
) -> None:
    lines = [NumberedLine(n, changed("span.length_m", 100.0 + n, TWIN)) for n in range(1, 8)]
    monkeypatch.setattr(engine.analysis, "analyse_stack", breaking(104.0, error))
    assert [number for number, point in results(lines).items() if point.failure is not None] == [4]


def test_a_line_whose_rows_cannot_be_packed_fails_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    def packed(points: Any, lines: Sequence[spec.Line], found: Sequence[Result]) -> Any:
        if any(line.span.length == 104.0 for line in lines):
            raise AttributeError("x")
        return point_results(points, lines, found)

    lines = [NumberedLine(n, changed("span.length_m", 100.0 + n, TWIN)) for n in range(1, 8)]
    monkeypatch.setattr(stack, "point_results", packed)
    assert [number for number, point in results(lines).items() if point.failure is not None] == [4]


def test_what_stops_a_computation_stops_all_of_its_lines(monkeypatch: pytest.MonkeyPatch) -> None:
    lines = [NumberedLine(n, changed("span.length_m", 100.0 + n, TWIN)) for n in range(1, 8)]
    monkeypatch.setattr(engine.analysis, "analyse_stack", breaking(104.0, TimeoutError()))
    with pytest.raises(TimeoutError):
        list(run_stack(SHORT, lines, stops=(TimeoutError,)))


def test_progress_rises_to_the_end() -> None:
    lines = convert.STACK + convert.STACK // 4
    items = list(run_stack(SHORT, [NumberedLine(n, TWIN) for n in range(1, lines + 1)]))
    fractions = [item.fraction for item in items if isinstance(item, convert.Advance)]
    assert fractions == [0.0, 0.8, 1.0]
    assert f"lines {convert.STACK + 1} to {lines} of {lines}" in [
        item.step for item in items if isinstance(item, convert.Advance)
    ]


def test_faults_of_a_line_point_from_its_root() -> None:
    assert faults(changed("span.length_m", -1.0, TWIN)) == [("/span/length_m", "greater_than_equal")]
    assert faults({**TWIN, "colour": "red"}) == [("/colour", "unknown_field")]
    assert faults(changed("span.horizontal_tension_n", 11.0, TWIN)) == [("/span/horizontal_tension_n", "inconsistent")]
    assert faults([1]) == [("", "not_an_object")]


def test_faults_of_the_schema_and_beyond_it_are_told_together() -> None:
    line = changed(
        "devices", [{"type": "spacer", "position_m": 900.0, "mass_kg": 1.0, "polar_inertia_kg_m2": 0.1}], TWIN
    )
    found = faults({**line, "colour": "red"})
    assert ("/colour", "unknown_field") in found
    assert any(pointer.startswith("/devices/0") for pointer, _ in found)


def test_what_the_analysis_needs_of_the_line_is_told() -> None:
    found = faults(TWIN, {"aerodynamic_model": "relative_wind"})
    assert [code for _, code in found] == ["inconsistent"]


def test_faults_of_the_analysis_point_below_analysis() -> None:
    with pytest.raises(BadInput) as caught:
        read_analysis({"loops": [], "colour": 1})
    assert {fault.pointer for fault in caught.value.faults} == {"/analysis/loops", "/analysis/colour"}


def test_a_line_comes_back_as_it_was_read() -> None:
    line = read_line(TWIN, read_analysis({}))
    assert isinstance(line, schemas.Line)
    assert line.span.length == 125.88


def numbered(number: int, line: dict[str, Any]) -> NumberedLine:
    explicit, known = convert.explicit_line(line)
    return NumberedLine(number, read_line(explicit, read_analysis(SHORT)).model_dump(by_alias=True), known)


def test_lines_in_engineers_forms_list_what_is_assumed_and_have_no_samples_unless_asked() -> None:
    found = results([numbered(1, KNOWN), numbered(2, TWIN), numbered(3, changed("span.length_m", 280.0, KNOWN))])
    assert found[1].tables["assumptions"] == convert.resolve_document(KNOWN)["assumptions"]
    assert found[2].tables["assumptions"] == []
    lengths = [row["value"] for row in found[3].tables["assumptions"] if row["path"] == "span.length_m"]
    assert lengths == [280.0]
    assert [point.tables["uncertainty"] for point in found.values()] == [[], [], []]


def test_samples_that_a_batch_asks_for_are_those_of_the_line_alone() -> None:
    asked = {**SHORT, "uncertainty": {"samples": 16, "seed": 5}}
    found = results([numbered(1, KNOWN), numbered(2, TWIN)], asked)
    request = convert.read(convert.explicit_request({"line": KNOWN, "analysis": asked}))
    (expected,) = [item for item in convert.run(request.kept()) if isinstance(item, PointResult)]
    for name in ("uncertainty", "sensitivities", "verdict"):
        assert found[1].tables[name] == expected.tables[name], name
        assert found[1].verdict == expected.verdict
    assert found[1].tables["uncertainty"][0]["samples"] == 16
    assert found[2].tables["uncertainty"] == []


def test_each_line_of_a_batch_has_its_own_design_wind_where_no_wind_speeds_are_named() -> None:
    unnamed = {name: value for name, value in SHORT.items() if name != "wind_speeds_m_per_s"}
    asked = convert.kept_analysis(read_analysis(unnamed))
    found = results([NumberedLine(1, TWIN), NumberedLine(2, {**TWIN, "design_wind_m_per_s": 8.0})], asked)
    winds = {n: {row["wind_speed_m_per_s"] for row in point.tables["limit_cycles"]} for n, point in found.items()}
    assert winds == {1: {4.0, 5.0, 6.0}, 2: {4.0, 5.0, 6.0, 8.0}}
    assert "; at 8 m/s in one loop" in found[2].tables["verdict"][0]["sentence"]
