from dataclasses import replace

from engine.spec import Analysis, Span, Supports
from tests.builders import run, source_line


def test_a_mode_nearer_to_longitudinal_than_to_vertical_is_not_called_vertical() -> None:
    """On soft supports the longitudinal mode crosses the vertical one in two loops at a sag of 6.26 % of the span."""
    asked = Analysis(loops=(2,), finite_element_loops=(2,), wind_speeds=())
    for sag, direction in ((0.0626, "longitudinal"), (0.066, "vertical")):
        line = replace(source_line(2), span=Span(126.0, sag=sag * 126.0), supports=Supports(1e3))
        rows = run(line, asked).critical_wind_speeds
        assert [row.model for row in rows] == ["hybrid", "finite_element"]
        assert {row.direction for row in rows} == {direction}
