"""Coefficients over another diameter, and those borrowed from another ice."""

from dataclasses import replace

import pytest

from engine.known.borrowed_coefficients import coefficients
from engine.known.description import KnownAerodynamics, Reference, UnknownShape
from engine.known.provenance import Origin
from engine.outcome import InvalidSpec
from engine.spec import Aerodynamics, MeasuredCoefficients
from tests.engine.known.known_lines import C11

BARE, OUTER = 0.028, 0.042
TABLE = MeasuredCoefficients((0.0, 0.1, 0.2), (1.0, 2.0, 3.0), (1.0, 1.1, 1.2), (0.1, 0.2, 0.3), 0.1, 0.1)
FULL = replace(C11, at_rest=(0.1, 1.2, 0.05), fitted_range=0.3, measured=TABLE)


def test_coefficients_without_ice_stay_as_they_are() -> None:
    found, rows = coefficients(KnownAerodynamics(FULL), BARE, None, {})
    assert found == FULL
    assert rows.rows == ()


def test_a_load_is_the_same_over_either_diameter() -> None:
    found, rows = coefficients(KnownAerodynamics(FULL, reference_diameter=OUTER), BARE, OUTER, {})
    for name in ("vertical", "horizontal"):
        expected = [value * OUTER for value in getattr(FULL, name)]
        assert [value * BARE for value in getattr(found, name)] == pytest.approx(expected)
    assert [value * BARE**2 for value in found.torsional] == pytest.approx([v * OUTER**2 for v in FULL.torsional])
    assert found.at_rest == pytest.approx((0.1 * 1.5, 1.2 * 1.5, 0.05 * 2.25))
    assert found.measured is not None
    assert found.measured.lift == pytest.approx([1.5, 3.0, 4.5])
    assert found.measured.drag == pytest.approx([1.5, 1.65, 1.8])
    assert found.measured.moment == pytest.approx([0.225, 0.45, 0.675])
    assert found.measured.angle == TABLE.angle
    assert rows["ice.aerodynamics.reference_diameter"] == OUTER


@pytest.mark.parametrize(("reference", "diameter"), [(Reference.BARE, BARE), (Reference.ICED, OUTER)])
def test_a_similar_section_refers_to_a_diameter_of_this_line(reference: Reference, diameter: float) -> None:
    found, rows = coefficients(KnownAerodynamics(C11, reference=reference), BARE, OUTER, {})
    assert found.vertical[0] == pytest.approx(C11.vertical[0] * diameter / BARE)
    (row,) = rows.rows
    assert (row.value, row.origin) == (diameter, Origin.COMPUTED)


def test_an_unknown_reference_lies_between_bare_and_iced() -> None:
    found, rows = coefficients(KnownAerodynamics(C11), BARE, OUTER, {})
    assert found == C11
    (row,) = rows.rows
    assert (row.lowest, row.value, row.highest) == (BARE, BARE, OUTER)
    iced, _ = coefficients(KnownAerodynamics(C11), BARE, OUTER, {row.path: OUTER})
    assert iced.vertical[0] == pytest.approx(1.5 * C11.vertical[0])


def test_a_shape_that_stands_for_another_one_has_factors() -> None:
    known = KnownAerodynamics(FULL, reference=Reference.BARE, spread=0.4)
    found, rows = coefficients(known, BARE, OUTER, {"ice.aerodynamics.vertical_factor": 1.3})
    assert found.vertical == pytest.approx([1.3 * value for value in C11.vertical])
    assert found.horizontal == C11.horizontal
    assert found.measured is not None
    assert found.measured.lift == pytest.approx([1.3, 2.6, 3.9])
    ranges = [(row.lowest, row.highest) for row in rows.rows if row.origin is Origin.ASSUMED]
    assert ranges == [pytest.approx((0.6, 1.4))] * 3


def test_a_catalogue_s_shape_without_coefficients_at_rest_gets_assumed_ones() -> None:
    known = KnownAerodynamics(C11, reference=Reference.BARE, origin=Origin.CATALOGUE, source="C11")
    found, rows = coefficients(known, BARE, OUTER, {"ice.aerodynamics_at_rest.horizontal": 1.4})
    assert found.at_rest == (0.0, 1.4, 0.0)
    assert rows["ice.aerodynamics_at_rest.vertical"] == 0.0
    with_rest, rows = coefficients(replace(known, aerodynamics=FULL), BARE, OUTER, {})
    assert with_rest.at_rest == FULL.at_rest
    assert "ice.aerodynamics_at_rest.vertical" not in rows


def test_given_coefficients_without_those_at_rest_stay_without() -> None:
    found, _ = coefficients(KnownAerodynamics(C11, reference_diameter=BARE), BARE, OUTER, {})
    assert found == Aerodynamics(C11.vertical, C11.horizontal, C11.torsional)


def test_an_unknown_shape_is_one_of_several_and_has_the_rows_of_all() -> None:
    open_ = KnownAerodynamics(C11, reference=Reference.BARE, origin=Origin.CATALOGUE, source="C11")
    whole = replace(open_, aerodynamics=replace(FULL, measured=None), source="full")
    unknown = UnknownShape((open_, whole), ("c11", "full"))
    first, rows = coefficients(unknown, BARE, OUTER, {})
    assert first == coefficients(open_, BARE, OUTER, {})[0]
    row = rows.rows[0]
    assert (row.path, row.value, row.lowest, row.highest) == ("ice.aerodynamics.catalogue", 0.0, 0.0, 1.0)
    assert row.choices == ("c11", "full")
    second, others = coefficients(unknown, BARE, OUTER, {row.path: 1.0, "ice.aerodynamics_at_rest.vertical": 0.2})
    assert second == whole.aerodynamics
    assert [one.path for one in others.rows] == [one.path for one in rows.rows]
    with pytest.raises(InvalidSpec, match="must be a whole number, of c11, full"):
        coefficients(unknown, BARE, OUTER, {row.path: 0.5})
    with pytest.raises(InvalidSpec, match="each with a name"):
        UnknownShape((open_,), ())
