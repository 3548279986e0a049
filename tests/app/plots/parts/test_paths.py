import pytest

from app.plots.parts.paths import label_of, words_of


@pytest.mark.parametrize(
    ("path", "expected"),
    [
        ("span.length_m", "span: length [m]"),
        ("conductor.torsional_rigidity_n_m2", "conductor: torsional rigidity [N m\u00b2]"),
        ("damping.vertical_ratio", "damping: vertical ratio"),
        ("supports.left.adjacent_span_m", "supports left: adjacent span [m]"),
        ("wind.air_density_kg_per_m3", "wind: air density [kg/m\u00b3]"),
        ("name", "name"),
    ],
)
def test_fields_are_said_in_words_with_their_unit(path: str, expected: str) -> None:
    assert label_of(path) == expected
    assert words_of(path) == expected.partition(" [")[0]
