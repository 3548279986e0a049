from dataclasses import replace

from engine.spec import (
    AerodynamicModel,
    AirflowSpoiler,
    Analysis,
    IceSegment,
    Model,
    Spacer,
)
from tests.builders import ICE_AT_40, run, source_line


def test_heavy_devices_and_uneven_ice_carry_a_warning() -> None:
    line = source_line(1)
    span_mass = 2.379 * 125.88
    light = replace(line, devices=(Spacer(60.0, 0.09 * span_mass, 0.0),))
    heavy = replace(line, devices=(Spacer(60.0, 0.11 * span_mass, 0.0),))
    uneven = replace(line, ice=replace(line.ice, segments=(IceSegment(0.0, 50.0, mass=3.0),)))
    analysis = Analysis(wind_speeds=(), models=(Model.HYBRID,))
    assert [len(run(x, analysis).warnings) for x in (line, light, heavy, uneven)] == [0, 0, 1, 1]


BOTH = Analysis(loops=(1, 2), wind_speeds=(2.0, 4.0, 6.0), finite_element_loops=(1, 2))


def test_an_ill_conditioned_mass_matrix_is_said_to_be_one() -> None:
    line = source_line(1)
    least = line.conductor.mass * (line.ice.eccentricity_y**2 + line.ice.eccentricity_z**2)

    def warnings(share: float) -> tuple[str, ...]:
        conductor = replace(line.conductor, polar_inertia=least * (1.0 + share))
        return run(replace(line, conductor=conductor), replace(BOTH, wind_speeds=())).warnings

    assert not any("ill-conditioned" in text for text in warnings(1e-3))
    (said,) = (text for text in warnings(1e-9) if "ill-conditioned" in text)
    assert "1.0e-09" in said
    assert not any("ill-conditioned" in text for text in run(source_line(2), BOTH).warnings)


def test_coefficients_at_rest_taken_from_the_line_are_named() -> None:
    line, known = source_line(1), replace(ICE_AT_40, at_rest=(0.0, 1.0, 0.0))
    segments = (IceSegment(0.0, 9.0, ICE_AT_40), IceSegment(9.0, 12.0, mass=2.4), IceSegment(12.0, 20.0, known))
    spoilers = (Spacer(60.0, 1.0, 0.0), AirflowSpoiler(30.0, 40.0, ICE_AT_40), AirflowSpoiler(40.0, 50.0, known))
    line = replace(line, ice=replace(line.ice, aerodynamics=known, segments=segments), devices=spoilers)
    asked = Analysis(wind_speeds=(), models=(Model.HYBRID,), aerodynamic_model=AerodynamicModel.RELATIVE_WIND)
    (said,) = (text for text in run(line, asked).warnings if "at rest" in text)
    assert "ice.segments.0, devices.1 " in said
    published = replace(asked, aerodynamic_model=AerodynamicModel.PUBLISHED)
    assert not any("at rest" in text for text in run(line, published).warnings)
