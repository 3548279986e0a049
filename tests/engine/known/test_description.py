"""Rules of what is said about a line."""

from collections.abc import Callable

import pytest

from engine.known.description import ConductorData, EverydayState, KnownAerodynamics, KnownIce, Reference
from engine.known.ice_sections import Accretion, Shape
from engine.outcome import InvalidSpec
from tests.engine.known.known_lines import C11

ICE = Accretion(Shape.UNIFORM, 0.01)


@pytest.mark.parametrize(
    ("build", "fault"),
    [
        (lambda: ConductorData(diameter=-0.03), r"conductor\.diameter must be a finite number greater than zero"),
        (lambda: ConductorData(steel_wires=-1), r"conductor\.steel_wires must be a finite number of at least zero"),
        (
            lambda: ConductorData(area=4e-4, aluminium_area=5e-4),
            r"aluminium_area must not exceed the area \(0\.0004 m2\)",
        ),
        (
            lambda: ConductorData(diameter=28.1),
            r"conductor\.diameter must lie between .* m: 28\.1 mm is 0\.0281 m, got 28",
        ),
        (
            lambda: ConductorData(bare_mass=1628.0),
            r"conductor\.bare_mass must lie between .*: 1,628 kg/km is 1\.628 kg/m",
        ),
        (lambda: ConductorData(area=468.6), r"conductor\.area must lie between .*: 468\.6 mm2 is 468\.6e-6 m2"),
        (lambda: ConductorData(modulus=74.0), r"conductor\.modulus must lie between .*: 74 GPa is 74e9 Pa, got 74"),
        (lambda: ConductorData(rated_strength=140.1), r"conductor\.rated_strength must lie between .*: 140\.1 kN is"),
        (lambda: ConductorData(thermal_expansion=18.9), r"conductor\.thermal_expansion must lie between .* 18\.9e-6"),
        (
            lambda: ConductorData(bare_mass=16.28, area=468.6e-6),
            r"conductor\.bare_mass must be that of metal wires, 2,500 to 9,500 kg/m3 .* it makes 34742, got 16\.28",
        ),
        (EverydayState, r"span\.everyday must have exactly one of share_of_rated_strength, horizontal_tens"),
        (lambda: EverydayState(0.2, sag=8.0), r"span\.everyday must have exactly one of .* got \(0\.2, 8\.0\)"),
        (lambda: EverydayState(20.0), r"share_of_rated_strength must be below 1, as a fraction; 20 % is 0\.2, got 20"),
        (lambda: EverydayState(28e3), r"share_of_rated_strength must be below 1, as a fraction, got 28000"),
        (lambda: EverydayState(sag=-8.0), r"span\.everyday\.sag must be a finite number greater than zero"),
        (
            lambda: EverydayState(0.2, wind_pressure=-1.0),
            r"span\.everyday\.wind_pressure must be a finite number of at",
        ),
        (lambda: KnownAerodynamics(C11, spread=1.0), r"ice\.aerodynamics\.spread must be below 1"),
        (lambda: KnownAerodynamics(C11, 0.03, Reference.ICED), r"ice\.aerodynamics\.reference must be absent where"),
        (
            lambda: KnownIce(KnownAerodynamics(C11), ICE, mass=2.3),
            r"conductor\.mass must be absent with ice\.accretion",
        ),
        (
            lambda: KnownIce(KnownAerodynamics(C11), ICE, eccentricity_y=0.0),
            r"ice\.eccentricity_y must be absent with ice\.accretion, which it follows from, got 0\.0",
        ),
    ],
)
def test_a_broken_rule_is_named(build: Callable[[], object], fault: str) -> None:
    with pytest.raises(InvalidSpec, match=fault):
        build()


def test_aac_has_no_steel_and_a_coupling_may_be_negative() -> None:
    data = ConductorData(steel_wires=0, axial_torsional_coupling=-3.0)
    assert (data.steel_wires, data.axial_torsional_coupling) == (0, -3.0)
