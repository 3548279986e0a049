import asyncio
from typing import Any

import pytest

from app import convert, schemas
from app.convert import PointResult
from app.interactive import Busy, Previews
from app.pages.charts.whole_curves import with_whole_curves
from app.pages.findings import Findings
from app.reference.source_lines import example
from tests.app.lines import SHORT


def computed(**analysis: Any) -> Findings:
    request = {"line": example("c11-twin"), "analysis": {**SHORT, **analysis}}
    document = schemas.JobRequest.model_validate(request).kept()
    (point,) = (item for item in convert.run(document) if isinstance(item, PointResult))
    return Findings(0, [{"point": 0}], document["line"], document["analysis"], point.tables)


def whole(found: Findings, document: dict[str, Any] | None = None) -> tuple[Findings, str | None]:
    return asyncio.run(with_whole_curves(Previews(60.0), "owner", document or {}, found))


@pytest.fixture(scope="module")
def bare() -> Findings:
    """Give the findings of a job that did not ask for curves."""
    return computed()


def test_curves_begin_at_the_onset_though_the_job_asked_for_none(bare: Findings) -> None:
    assert bare.rows("amplitude_curves") == []
    found, note = whole(bare)
    winds = [row["wind_speed_m_per_s"] for row in found.rows("amplitude_curves")]
    onset = min(row["wind_speed_m_per_s"] for row in bare.rows("critical_wind_speeds"))
    assert min(winds) == pytest.approx(onset)
    assert onset < 4.0
    assert found.rows("limit_cycles") == bare.rows("limit_cycles")
    assert note is None


def test_curves_that_the_job_has_are_left_alone() -> None:
    asked = computed(amplitude_curves="reported")
    assert whole(asked) == (asked, None)


def test_where_curves_are_not_those_of_the_job_a_sentence_says_so(
    bare: Findings, monkeypatch: pytest.MonkeyPatch
) -> None:
    both = Findings(0, bare.points, bare.line, {**bare.analysis, "models": ["hybrid", "finite_element"]}, bare.tables)
    found, note = whole(both)
    assert found.rows("amplitude_curves")
    assert note is not None
    assert "those of the hybrid model" in note
    study: dict[str, Any] = {"study": {"axes": [{}]}}
    assert whole(bare, study)[0] is bare
    assert "only the motions at its wind speeds" in (whole(bare, study)[1] or "")

    async def busy(*_: object) -> None:
        raise Busy

    monkeypatch.setattr(Previews, "compute", busy)
    assert whole(bare)[0] is bare
    assert "only the motions at its wind speeds" in (whole(bare)[1] or "")


def test_phases_that_a_spacer_ties_start_no_preview_and_a_sentence_says_so(
    bare: Findings, monkeypatch: pytest.MonkeyPatch
) -> None:
    started: list[object] = []

    async def compute(*given: object) -> None:
        started.append(given)
        raise Busy

    monkeypatch.setattr(Previews, "compute", compute)
    spacer = {"type": "interphase_spacer", "position_m": 62.94, "mass_kg": 30.0, "between": ["this", "top"]}
    line = {**example("c11-twin"), "devices": [spacer], "phases": [{"name": "top", "y_m": 7.0}]}
    request = {"line": line, "analysis": {**SHORT, "models": ["hybrid", "finite_element"]}}
    document = schemas.JobRequest.model_validate(request).kept()
    tied = Findings(0, bare.points, document["line"], document["analysis"], bare.tables)
    found, note = whole(tied)
    assert (found is tied, started) == (True, [])
    assert "only the motions at its wind speeds" in (note or "")
