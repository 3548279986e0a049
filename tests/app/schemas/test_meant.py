import pytest

from app.schemas.meant import meant


@pytest.mark.parametrize(
    ("location", "said"),
    [
        (["line", "span", "tension_n"], "; did you mean horizontal_tension_n?"),
        (["span", "tension_n"], "; did you mean horizontal_tension_n?"),
        (["line", "span", "lenght_m"], "; did you mean length_m?"),
        (["line", "conductor", "rts"], "; did you mean rated_strength_n?"),
        (["line", "devices", 0, "postion_m"], "; did you mean position_m?"),
        (["analysis", "wind_speed_m_per_s"], "; did you mean wind_speeds_m_per_s?"),
        (["line", "length_m"], "; did you mean /line/span/length_m?"),
        (
            ["line", "conductor", "diameter_mm"],
            '; did you mean diameter_m, perhaps as {"value": ..., "unit": "mm"}?',
        ),
        (
            ["line", "span", "horizontal_tension_kn"],
            '; did you mean horizontal_tension_n, perhaps as {"value": ..., "unit": "kN"}?',
        ),
        (
            ["line", "ice", "aerodynamics", "table"],
            "; table belongs to another form of aerodynamics than the fields beside it",
        ),
        (["line", "nonsense"], ""),
    ],
)
def test_the_field_that_was_meant_is_named(location: list[object], said: str) -> None:
    assert meant(location) == said


@pytest.mark.parametrize(
    ("location", "word"),
    [
        (["span"], '{"line": {"span": ...}}'),
        (["line", "line"], "is a line already"),
        (["line", "analysis"], "beside the line"),
    ],
)
def test_a_line_that_is_wrapped_wrongly_is_told(location: list[object], word: str) -> None:
    assert word in meant(location)
