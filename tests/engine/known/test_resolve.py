"""From a known line to an explicit one: every value has one row, and the explicit line is what the rows say."""

from dataclasses import replace

import numpy as np
import pytest

from app.reference.catalogue_row import CatalogueRow as ShippedRow
from app.reference.conductors import shipped
from engine.known.bundles import arranged
from engine.known.description import (
    ConductorData,
    EverydayState,
    KnownAerodynamics,
    KnownConductor,
    KnownDamping,
    KnownIce,
    KnownLine,
    KnownSpan,
)
from engine.known.estimators import torsional_rigidity_of_diameter
from engine.known.ice_sections import Accretion, Shape
from engine.known.provenance import Origin
from engine.known.resolve import end_stiffnesses, resolve
from engine.mechanics.static_profile import static_profile
from engine.outcome import InvalidSpec
from engine.spec import Damping, Section, SectionSpan, Support, Supports, SuspensionString, Wind
from tests.builders import source_line
from tests.engine.known.known_lines import GUIDE, SPARSE, catalogue_row


def explicit(line_number: int = 2) -> KnownLine:
    """Return the source's line, said by its explicit values."""
    line = source_line(line_number)
    given = ConductorData(
        diameter=line.conductor.diameter,
        axial_rigidity=line.conductor.axial_rigidity,
        torsional_rigidity=line.conductor.torsional_rigidity,
        axial_torsional_coupling=line.conductor.axial_torsional_coupling,
    )
    ice = KnownIce(
        KnownAerodynamics(line.ice.aerodynamics),
        mass=line.conductor.mass,
        polar_inertia=line.conductor.polar_inertia,
        eccentricity_y=line.ice.eccentricity_y,
        eccentricity_z=line.ice.eccentricity_z,
    )
    ratios = (line.damping.vertical_ratio, line.damping.horizontal_ratio, line.damping.torsional_ratio)
    damping = KnownDamping(*ratios, line.damping.model)
    return KnownLine(KnownConductor(given), line.bundle, line.span, ice, line.supports, line.wind, damping)


def test_an_explicit_line_comes_back_as_it_is() -> None:
    line = source_line(2)
    held = replace(line.supports, longitudinal_stiffness=1.285e5)
    found = resolve(replace(explicit(), supports=held))
    assert found.line == replace(line, supports=held)
    assert {row.path for row in found.assumptions if row.origin is Origin.ASSUMED} == set()
    assert (found.section, found.everyday, found.iced) == (None, None, None)


def test_the_line_of_the_guide_is_complete() -> None:
    found = resolve(GUIDE)
    line = found.line
    assert line.conductor.mass == pytest.approx(2.2073, rel=1e-4)
    assert line.ice.eccentricity_y == pytest.approx(3.096e-3, rel=1e-3)
    assert line.span.horizontal_tension == pytest.approx(38740.0, rel=1e-3)
    assert found.section is not None
    assert found.section.thickness == 0.012
    assert found.everyday is not None
    assert found.iced is not None
    assert found.everyday.horizontal_tension == pytest.approx(0.2 * 140120.0)
    # The engine hangs the explicit line as the change of state left it.
    profile = static_profile((line,))
    assert profile.sag[0] == pytest.approx(found.iced.sag, rel=1e-12)
    assert np.isfinite(profile.end_stiffness).all()


def test_every_value_has_one_row_and_every_assumption_a_range() -> None:
    for known in (GUIDE, SPARSE, explicit()):
        rows = resolve(known).assumptions
        assert len({row.path for row in rows}) == len(rows)
        for row in rows:
            assert row.source
            assert (row.lowest is not None) == (row.origin is Origin.ASSUMED)


def test_the_rows_are_the_line() -> None:
    found = resolve(GUIDE)
    conductor, line = found.line.conductor, found.line
    (stiffnesses,) = end_stiffnesses([line])
    rows = {row.path: row.value for row in (*found.assumptions, *stiffnesses)}
    for name in ("diameter", "axial_rigidity", "torsional_rigidity", "mass", "polar_inertia", "rated_strength"):
        assert rows[f"conductor.{name}"] == getattr(conductor, name)
    assert rows["ice.eccentricity_z"] == line.ice.eccentricity_z
    assert rows["span.horizontal_tension"] == line.span.horizontal_tension
    assert rows["damping.torsional_ratio"] == line.damping.torsional_ratio
    assert rows["wind.air_density"] == line.wind.air_density
    assert rows["supports.left.adjacent_span"] == line.supports.left.adjacent_span == 280.0
    ends = [rows[f"supports.{name}.longitudinal_stiffness"] for name in ("left", "right")]
    assert ends == static_profile((line,)).end_stiffness[0].tolist()
    # The string alone has the weight that it carries over its length: half of both spans, and iced.
    carried = 2.2073 * 9.81 * 0.5 * (280.0 + 300.0)
    assert ends[0] > carried / 2.4


def test_every_assumed_value_can_be_chosen_and_changes_the_line() -> None:
    for known in (GUIDE, SPARSE):
        usual = resolve(known)
        for row in usual.assumptions:
            if row.origin is not Origin.ASSUMED or row.highest == row.lowest:
                continue
            assert row.highest is not None
            assert row.lowest is not None
            other = row.highest if row.value < row.highest else row.lowest
            changed = resolve(known, {row.path: other})
            assert changed.line != usual.line, row.path
            (again,) = [new for new in changed.assumptions if new.path == row.path]
            assert again.value == other


def test_a_choice_must_be_an_assumed_value_within_its_range() -> None:
    with pytest.raises(InvalidSpec, match=r"span\.length is no assumed value, got 200\.0"):
        resolve(GUIDE, {"span.length": 200.0})
    with pytest.raises(InvalidSpec, match=r"damping\.vertical_ratio must lie between 0\.0005 and 0\.005, got 0\.5"):
        resolve(GUIDE, {"damping.vertical_ratio": 0.5})


def test_a_line_of_which_little_is_said_resolves() -> None:
    found = resolve(SPARSE)
    assumed = {row.path for row in found.assumptions if row.origin is Origin.ASSUMED}
    assert assumed == {
        "conductor.torsional_rigidity",
        "conductor.bare_polar_inertia",
        "ice.accretion.density",
        "ice.accretion.angle",
        "span.everyday.temperature",
        "span.temperature",
        "span.ruling_span",
        "span.everyday.share_of_rated_strength",
        "ice.aerodynamics.reference_diameter",
        "supports.left.adjacent_span",
        "supports.right.adjacent_span",
        "damping.vertical_ratio",
        "damping.horizontal_ratio",
        "damping.torsional_ratio",
        "wind.air_density",
    }
    assert found.line.supports.left.adjacent_span == 300.0
    assert found.line.ice.eccentricity_z < 0.0


def test_supports_wind_and_damping_are_kept() -> None:
    supports = Supports(left=Support(dead_end=True), right=Support(insulator_length=3.0, insulator_weight=400.0))
    stiff = Supports(longitudinal_stiffness=2e5)
    known = replace(SPARSE, supports=supports, wind=Wind(1.2, yaw=0.3), damping=KnownDamping(0.002, 0.003, 0.04))
    found = resolve(known)
    assert found.line.supports.left == supports.left
    assert found.line.supports.right == replace(supports.right, adjacent_span=300.0)
    assert found.line.wind == Wind(1.2, yaw=0.3)
    assert found.line.damping == Damping(0.002, 0.003, 0.04)
    origins = {row.path: row.origin for row in found.assumptions}
    both, held, none = end_stiffnesses([resolve(GUIDE).line, replace(found.line, supports=stiff), found.line])
    assert (len(both), held) == (2, [])
    origins |= {row.path: row.origin for row in none}
    assert origins["wind.air_density"] is Origin.GIVEN
    assert origins["supports.right.insulator_length"] is Origin.GIVEN
    assert "supports.left.adjacent_span" not in origins
    assert "supports.left.longitudinal_stiffness" not in origins
    assert origins["supports.right.longitudinal_stiffness"] is Origin.COMPUTED


def test_a_given_stiffness_makes_neighbours_needless() -> None:
    found = resolve(replace(SPARSE, supports=Supports(longitudinal_stiffness=2e5)))
    rows = {row.path: row.origin for row in found.assumptions}
    assert rows["supports.longitudinal_stiffness"] is Origin.GIVEN
    assert "supports.left.adjacent_span" not in rows
    assert found.line.supports.longitudinal_stiffness == 2e5


def test_a_section_holds_the_ends_and_has_the_ruling_span() -> None:
    spans = (SectionSpan(280.0), SectionSpan(300.0), SectionSpan(330.0))
    strings = (SuspensionString(2.4, 600.0), SuspensionString(2.4, 600.0))
    section = Section(spans, strings, span_of_interest=2)
    found = resolve(replace(SPARSE, section=section))
    rows = {row.path: row for row in found.assumptions}
    assert found.line.section == section
    assert found.line.supports == Supports()
    assert rows["span.ruling_span"].origin is Origin.COMPUTED
    assert rows["span.ruling_span"].value == pytest.approx((84.889e6 / 910.0) ** 0.5)
    assert not [path for path in rows if path.startswith("supports")]


@pytest.mark.parametrize("subconductors", [1, 2, 3, 4, 6])
@pytest.mark.parametrize("shape", [Shape.UNIFORM, Shape.CRESCENT, Shape.D_SHAPE])
def test_lines_of_different_make_resolve(subconductors: int, shape: Shape) -> None:
    bundle = arranged(subconductors, None if subconductors == 1 else 0.4, None)
    ice = replace(GUIDE.ice, accretion=Accretion(shape, mass=1.2))
    found = resolve(replace(GUIDE, bundle=bundle, ice=ice))
    assert len(found.line.bundle.positions) == subconductors
    assert found.line.conductor.mass == pytest.approx(1.6281 + 1.2)
    assert (abs(found.line.ice.eccentricity_z) > 1e-3) == (shape is not Shape.UNIFORM)


@pytest.mark.parametrize("row", shipped(), ids=lambda row: f"{row.designation} {row.name}")
def test_every_shipped_conductor_makes_a_line(row: ShippedRow) -> None:
    conductor = catalogue_row(row)
    # 40 MPa are an everyday stress of any conductor; ASTM's tables have no strength.
    assert row.area_m2 is not None
    everyday = EverydayState(horizontal_tension=40e6 * row.area_m2, temperature=15.0)
    span = KnownSpan(250.0, everyday, -5.0)
    ice = replace(GUIDE.ice, accretion=Accretion(Shape.CRESCENT, 0.008, angle=0.0))
    found = resolve(replace(GUIDE, conductor=KnownConductor(row=conductor), span=span, ice=ice))
    assert found.iced is not None
    assert found.iced.horizontal_tension > 40e6 * row.area_m2
    assert found.line.conductor.mass > row.mass_kg_per_m
    by_diameter = torsional_rigidity_of_diameter(row.diameter_m)
    assert by_diameter.lowest < found.line.conductor.torsional_rigidity < by_diameter.highest
