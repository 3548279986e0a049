from typing import Any

import pytest

from app.convert.known.forms import is_known_form
from app.reference.source_lines import example
from tests.app.known_documents import LINES

EXPLICIT = {"explicit"}


@pytest.mark.parametrize("name", LINES)
def test_forms_beyond_the_explicit_line_are_told(name: str) -> None:
    assert is_known_form(LINES[name]) is (name not in EXPLICIT)


@pytest.mark.parametrize(
    ("part", "field", "known"),
    [
        ("damping", "torsional_ratio", True),
        ("conductor", "polar_inertia_kg_m", True),
        ("conductor", "axial_rigidity_n", True),
        ("span", "horizontal_tension_n", True),
        ("conductor", "mass_kg_per_m", False),
        ("ice", "aerodynamics", True),
        ("span", "length_m", False),
        ("ice", "eccentricity_y_m", False),
    ],
)
def test_a_line_that_lacks_what_is_estimated_is_a_known_one(part: str, field: str, known: bool) -> None:
    line = example("c11-twin")
    del line[part][field]
    assert is_known_form(line) is known


@pytest.mark.parametrize("line", [None, [], "line", {"damping": 3, "conductor": [], "span": None}])
def test_what_is_no_line_has_other_faults(line: Any) -> None:
    assert is_known_form(line) is False
