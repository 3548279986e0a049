"""The torsional damper: what it adds to C, and what it does to a line that torsion drives."""

from dataclasses import replace

import numpy as np
import pytest

from engine.models.critical_wind_speeds import critical_wind_speeds
from engine.models.reduced_model import ReducedModel
from engine.outcome import InvalidSpec
from engine.spec import Aerodynamics, Damping, Ice, Line, Model, Spacer, TorsionalDamper
from tests.builders import discretized, finite_element, hybrid, only, run, source_line

COEFFICIENT = 1e-3
MIDDLE = 62.94


def driven_by_torsion(*devices: TorsionalDamper | Spacer) -> Line:
    """Return a single conductor whose moment alone feeds the motion: a_theta1 < 0, nothing else, no eccentricity."""
    nothing = (0.0, 0.0, 0.0)
    ice = Ice(Aerodynamics(nothing, nothing, (-0.7272, 0.2935, 5.9704)))
    return replace(source_line(1), ice=ice, damping=Damping(0.001, 0.001, 0.001), devices=devices)


def onset(model: ReducedModel, direction: int) -> float:
    """Return the lowest critical wind speed of a direction."""
    crossings = critical_wind_speeds(model, 60.0)
    return float(crossings.wind_speed[model.direction[crossings.coordinate] == direction].min())


@pytest.mark.parametrize("loops", [1, 2, 3])
@pytest.mark.parametrize("position", [MIDDLE, 31.47, 10.0])
def test_torsional_damping_gains_c_times_the_square_of_the_shape(loops: int, position: float) -> None:
    damper, spacer = TorsionalDamper(position, 2.0, 0.1, 7.5), Spacer(position, 2.0, 0.1)
    model, without = (hybrid(replace(source_line(2), devices=(d,)), loops) for d in (damper, spacer))
    made = discretized(source_line(2))
    arc = made.profile.arc_length[0]
    share = float(np.interp(position, np.linspace(0.0, 125.88, 3), [0.0, 0.5, 1.0]))  # of the arc, nearly
    shape = np.interp(share * arc, np.linspace(0.0, arc, model.shapes.shape[-1]), model.shapes[0, 2, 2])
    gained = (model.damping - without.damping)[0]
    assert gained[2, 2] == pytest.approx(7.5 * shape**2, rel=0.03, abs=0.01)
    assert np.delete(gained.ravel(), 8) == pytest.approx(0.0, abs=1e-12)
    assert (model.mass == without.mass).all()


def test_an_even_shape_of_a_light_damper_is_a_sine() -> None:
    """Without eccentric ice the torsional mode is sin(pi s/L), so that mid-span gains c and the quarter point c/2."""
    bare = hybrid(driven_by_torsion()).damping[0, 2, 2]
    for position, share in ((MIDDLE, 1.0), (31.47, 0.5)):
        model = hybrid(driven_by_torsion(TorsionalDamper(position, 0.0, 0.0, COEFFICIENT)))
        assert model.damping[0, 2, 2] - bare == pytest.approx(share * COEFFICIENT, rel=3e-3)


def test_the_critical_wind_speed_of_torsion_rises_with_its_damping() -> None:
    """The moment -a_theta1 d/2 Theta'/U feeds in proportion to U: U_c is proportional to the damping of torsion."""
    bare = hybrid(driven_by_torsion())
    damped = hybrid(driven_by_torsion(TorsionalDamper(MIDDLE, 0.0, 0.0, COEFFICIENT)))
    ratio = float(damped.damping[0, 2, 2] / bare.damping[0, 2, 2])
    assert ratio > 2.5
    assert onset(damped, 2) / onset(bare, 2) == pytest.approx(ratio, rel=1e-6)


def test_the_finite_element_model_agrees() -> None:
    line = driven_by_torsion(TorsionalDamper(MIDDLE, 0.0, 0.0, COEFFICIENT))
    assert onset(finite_element(line, (1,)), 2) == pytest.approx(onset(hybrid(line), 2), rel=1e-3)


def test_an_analysis_has_the_onset_of_the_damped_line() -> None:
    asked = only(Model.HYBRID, loops=(1,), wind_speeds=())
    bare, damped = (
        run(line, asked).critical_wind_speeds[0].wind_speed_m_per_s
        for line in (driven_by_torsion(), driven_by_torsion(TorsionalDamper(MIDDLE, 0.0, 0.0, COEFFICIENT)))
    )
    assert damped > 2.5 * bare


@pytest.mark.parametrize("field", ["position", "mass", "polar_inertia", "coefficient"])
def test_negative_values_are_refused(field: str) -> None:
    with pytest.raises(InvalidSpec) as caught:
        replace(TorsionalDamper(10.0, 2.0, 0.1, 7.5), **{field: -1.0})
    assert [(fault.field, fault.rule) for fault in caught.value.faults] == [
        (field, "must be a finite number of at least zero")
    ]
