"""The result of tied phases names phases where that of a section numbers spans."""

from dataclasses import fields

from engine.result import TABLES
from engine.spec import AmplitudeCurves, Analysis, InterphaseSpacer, Stretching
from tests.builders import phases_line, run


def test_every_row_with_a_span_names_a_phase_instead() -> None:
    asked = Analysis(
        loops=(1,),
        finite_element_loops=(1,),
        wind_speeds=(6.0,),
        amplitude_curves=AmplitudeCurves.REPORTED,
        stretching=Stretching.INCLUDED,
    )
    result = run(phases_line(InterphaseSpacer(62.94, 0.0, ("this", "top"))), asked)
    named = [name for name, table in TABLES.items() if {"span", "phase"} <= {f.name for f in fields(table.row)}]
    assert named == ["critical_wind_speeds", "limit_cycles", "tensions", "amplitude_curves"]
    for name in named:
        rows = [row for row in getattr(result, name) if getattr(row, "kind", "") != "equilibrium"]
        assert rows
        assert {row.span for row in rows} == {None}
        assert {row.phase for row in rows} <= {"this", "top"}
    assert result.section_modes == ()
    assert len(result.phase_modes) == 6
