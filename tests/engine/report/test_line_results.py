from dataclasses import replace

from engine.spec import (
    IceSegment,
    Model,
)
from tests.builders import only, run, source_line


def test_den_hartog_takes_the_smallest_coefficient_on_the_span() -> None:
    line = source_line(2)
    stable = replace(line.ice.aerodynamics, vertical=(1.5, 0.0, 0.0))
    half = replace(line, ice=replace(line.ice, segments=(IceSegment(0.0, 62.94, aerodynamics=stable),)))
    whole = replace(line, ice=replace(line.ice, segments=(IceSegment(0.0, 125.88, aerodynamics=stable),)))
    asked = only(Model.HYBRID, wind_speeds=())
    assert run(half, asked).den_hartog.coefficient == -0.1667
    assert run(whole, asked).den_hartog.coefficient == 1.5
    assert not run(whole, asked).den_hartog.unstable
