"""Densities of ice by kind."""

import pytest

from engine.known.densities import IceKind, density_of


@pytest.mark.parametrize("kind", IceKind)
def test_every_kind_has_a_value_within_its_range_below_solid_ice(kind: IceKind) -> None:
    density = density_of(kind)
    assert 100.0 < density.lowest < density.value < density.highest <= 917.0
    assert density.unit == "kg/m3"
    assert density.source


def test_denser_kinds_are_denser() -> None:
    soft, hard, glaze = (density_of(kind).value for kind in (IceKind.SOFT_RIME, IceKind.HARD_RIME, IceKind.GLAZE))
    assert soft < hard < glaze
