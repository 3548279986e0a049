"""Samples of a line as an engineer knows it, asked for in a request."""

from functools import cache
from typing import Any

import pytest

from app import convert
from app.convert.known.samples import TIED, Analysed, with_what_is_known
from app.reference.ice_shapes import ICE_SHAPES
from app.schemas.faults import BadInput
from engine import spec
from engine.analysis import analyse
from engine.known.resolve import resolve
from engine.progress import finished
from tests.app.known_documents import CONTRACT, LINES, changed
from tests.builders import source_line

ANALYSIS = {"loops": [1], "models": ["hybrid"], "wind_speeds_m_per_s": [4.0, 10.0]}
LYING = changed(ice={**CONTRACT["ice"], "accretion": {"shape": "crescent", "thickness_m": 0.012}})


def tables(request: dict[str, Any]) -> dict[str, list[dict[str, Any]]]:
    complete = convert.read(convert.explicit_request(request)).kept()
    (point,) = [item for item in convert.run(complete) if isinstance(item, convert.PointResult)]
    return point.tables


@cache
def sampled(count: int = 16) -> dict[str, list[dict[str, Any]]]:
    return tables({"line": LYING, "analysis": {**ANALYSIS, "uncertainty": {"samples": count, "seed": 3}}})


def test_a_known_line_has_samples_at_every_wind_speed() -> None:
    rows = sampled()["uncertainty"]
    assert [row["wind_speed_m_per_s"] for row in rows] == [None, 4.0, 10.0]
    assert {(row["samples"], row["seed"]) for row in rows} == {(16, 3)}
    (verdict,) = sampled()["verdict"]
    assert verdict["probability_gallops"] == rows[0]["probability"]
    assert "probability" in verdict["sentence"]


def test_sensitivities_have_the_names_and_units_of_the_document() -> None:
    assumed = {row["path"]: row for row in sampled()["assumptions"] if row["origin"] == "assumed"}
    rows = {row["path"]: row for row in sampled()["sensitivities"]}
    assert set(rows) == {path for path, row in assumed.items() if row["lowest"] < row["highest"]}
    for path, row in rows.items():
        assert row["lowest"] == pytest.approx(assumed[path]["lowest"])
        assert row["highest"] == pytest.approx(assumed[path]["highest"])
    angle = rows["ice.accretion.angle_deg"]
    assert angle["distribution"] == "uniform"
    assert angle["highest"] - angle["lowest"] > 90.0
    assert rows["conductor.torsional_rigidity_n_m2"]["distribution"] == "log_uniform"


def test_what_decides_is_a_field_of_the_document() -> None:
    (verdict,) = sampled(64)["verdict"]
    assert verdict["what_decides"] in {row["path"] for row in sampled(64)["sensitivities"]}


def test_samples_do_not_change_the_motions() -> None:
    without = tables({"line": LYING, "analysis": {**ANALYSIS, "uncertainty": {"samples": 0}}})
    assert without["uncertainty"] == without["sensitivities"] == []
    assert without["limit_cycles"] == sampled()["limit_cycles"]
    assert without["verdict"][0]["probability_gallops"] is None


def test_64_samples_are_the_default_where_something_is_assumed() -> None:
    found = tables({"line": LYING, "analysis": ANALYSIS})
    assert found["uncertainty"][0]["samples"] == 64
    explicit = convert.resolve_document(LYING)["line"]
    assert tables({"line": explicit, "analysis": ANALYSIS})["uncertainty"] == []


def test_a_study_has_no_samples() -> None:
    study = {"axes": [{"parameter": "span.length_m", "values": [300.0]}]}
    assert tables({"line": LYING, "analysis": ANALYSIS, "study": study})["uncertainty"] == []


@pytest.mark.parametrize(("field", "value"), [("samples", -1), ("samples", 20_000), ("seed", -1), ("draws", 3)])
def test_what_cannot_be_asked_is_refused(field: str, value: int) -> None:
    with pytest.raises(BadInput) as caught:
        convert.read({"line": convert.resolve_document(LYING)["line"], "analysis": {"uncertainty": {field: value}}})
    assert [fault.pointer for fault in caught.value.faults] == [f"/analysis/uncertainty/{field}"]


def test_what_is_assumed_of_tied_phases_is_listed_and_said_not_to_be_sampled() -> None:
    known = convert.known_of(convert.read(convert.explicit_request({"line": LINES["tied to a phase"]})))
    assert known is not None
    line = resolve(known).line
    assert [phase.name for phase in line.phases] == ["top", "ground wire"]
    result = finished(
        analyse(source_line(2), spec.Analysis(loops=(1,), models=(spec.Model.HYBRID,), wind_speeds=(5.0,)))
    )
    told = finished(with_what_is_known(result, Analysed(line, spec.Analysis(), ()), known, spec.Uncertainty(8)))
    assert told.warnings == (*result.warnings, TIED)
    assert (told.uncertainty, told.sensitivities) == ((), ())
    assert {row.path for row in told.assumptions} >= {"damping.vertical_ratio", "conductor.torsional_rigidity_n_m2"}


def test_a_shape_that_nobody_knows_is_drawn_among_those_of_the_catalogue_and_decides() -> None:
    line = {**LINES["of unknown shape"], "phases": []}
    del line["climate"]
    asked = {"samples": 32, "seed": 1}
    found = tables({"line": line, "analysis": {**ANALYSIS, "wind_speeds_m_per_s": [10.0], "uncertainty": asked}})
    (row,) = (row for row in found["sensitivities"] if row["distribution"] == "choice")
    assert row["path"] == "ice.aerodynamics.catalogue"
    (assumed,) = (one for one in found["assumptions"] if one["path"] == row["path"])
    assert (assumed["value"], assumed["lowest"], assumed["highest"]) == (0.0, 0.0, len(ICE_SHAPES) - 1.0)
    assert all(shape.name in assumed["source"] for shape in ICE_SHAPES)
    (verdict,) = found["verdict"]
    assert verdict["what_decides"] == "ice.aerodynamics.catalogue"
    # One of both shapes is stable by Den Hartog's criterion, and a Sobol sequence draws each for half of the samples.
    assert verdict["probability_gallops"] == pytest.approx(0.5, abs=0.1)
    assert f"the ice shape decides: probability {verdict['probability_gallops']:.2g}" in verdict["sentence"]
    named = {**line, "ice": {**line["ice"], "aerodynamics": {"catalogue": ICE_SHAPES[0].name}}}
    assert convert.resolve_document(named)["line"] == convert.resolve_document(line)["line"]
