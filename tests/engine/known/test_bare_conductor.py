"""Figures of bare conductors: given before catalogue before estimate."""

from dataclasses import replace

import pytest

from engine.known import estimators
from engine.known.bare_conductor import bare_conductor
from engine.known.description import ConductorData, KnownConductor
from engine.known.provenance import Origin, Provenance
from engine.known.wires import Wires
from engine.outcome import InvalidSpec
from tests.engine.known.known_lines import DRAKE


def origins(values: Provenance) -> dict[str, str]:
    return {row.path.removeprefix("conductor."): row.origin.value for row in values.rows}


def test_a_catalogue_says_most() -> None:
    values = bare_conductor(KnownConductor(row=DRAKE), {}, bare=True)
    assert origins(values) == {
        "diameter": "catalogue",
        "bare_mass": "catalogue",
        "area": "catalogue",
        "aluminium_area": "catalogue",
        "modulus": "catalogue",
        "axial_rigidity": "computed",
        "torsional_rigidity": "assumed",
        "bare_polar_inertia": "assumed",
        "thermal_expansion": "catalogue",
        "rated_strength": "catalogue",
    }
    assert values["conductor.axial_rigidity"] == pytest.approx(468.64e-6 * 69.64e9)
    wires = Wires(402.8e-6, 65.84e-6, 0.02814, 26, 7)
    assert values["conductor.torsional_rigidity"] == pytest.approx(estimators.torsional_rigidity(wires).value)
    assert values["conductor.bare_polar_inertia"] == pytest.approx(estimators.polar_inertia(wires, 1.6281).value)
    assert {row.source for row in values.rows if row.origin is Origin.CATALOGUE} == {"Drake: a table"}


def test_what_is_given_overrides_the_catalogue() -> None:
    given = ConductorData(modulus=74e9, torsional_rigidity=159.0, axial_torsional_coupling=2.0)
    values = bare_conductor(KnownConductor(given, DRAKE), {}, bare=True)
    assert values["conductor.axial_rigidity"] == pytest.approx(468.64e-6 * 74e9)
    found = origins(values)
    assert [found[name] for name in ("modulus", "torsional_rigidity", "axial_torsional_coupling")] == ["given"] * 3
    rigid = bare_conductor(KnownConductor(replace(given, axial_rigidity=3e7), DRAKE), {}, bare=True)
    assert rigid["conductor.axial_rigidity"] == 3e7
    assert "conductor.modulus" not in rigid


def test_diameter_and_mass_are_enough() -> None:
    known = KnownConductor(ConductorData(diameter=0.02814, bare_mass=1.6281))
    values = bare_conductor(known, {}, bare=True)
    true = bare_conductor(KnownConductor(row=DRAKE), {}, bare=True)
    for row in values.rows:
        if row.origin is Origin.ASSUMED:
            assert row.lowest is not None
            assert row.highest is not None
            assert row.lowest <= true[row.path] <= row.highest, row.path
    # The steel follows from the mass.
    assert values["conductor.aluminium_area"] == pytest.approx(402.8e-6, rel=0.02)


def test_chosen_values_replace_estimates_and_what_follows_from_them() -> None:
    known = KnownConductor(ConductorData(diameter=0.02814, bare_mass=1.6281))
    usual = bare_conductor(known, {}, bare=True)
    chosen = bare_conductor(known, {"conductor.area": 460e-6, "conductor.modulus": 70e9}, bare=True)
    assert chosen["conductor.axial_rigidity"] == pytest.approx(460e-6 * 70e9)
    assert chosen["conductor.aluminium_area"] != usual["conductor.aluminium_area"]


def test_pure_aluminium_needs_no_mass_to_say_so() -> None:
    known = KnownConductor(ConductorData(diameter=0.026, area=400e-6, aluminium_wires=61, steel_wires=0))
    values = bare_conductor(known, {}, bare=False)
    assert values["conductor.axial_rigidity"] == pytest.approx(0.87 * 68e9 * 400e-6)
    assert "conductor.bare_polar_inertia" not in values


def test_what_nothing_can_replace_is_asked_for() -> None:
    rule = "must be given, or a conductor of the catalogue that has it be named"
    with pytest.raises(InvalidSpec, match=rf"conductor\.diameter {rule}.*conductor\.bare_mass {rule}"):
        bare_conductor(KnownConductor(), {}, bare=True)
    with pytest.raises(InvalidSpec) as error:
        bare_conductor(KnownConductor(), {}, bare=False)
    assert [fault.field for fault in error.value.faults] == ["conductor.diameter"]
