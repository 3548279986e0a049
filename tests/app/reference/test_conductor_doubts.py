import math
from dataclasses import replace
from typing import Any

import pytest

from app.reference.catalogue_row import CatalogueRow
from app.reference.conductor_doubts import doubts, mixed_expansion
from app.reference.conductors import named

(HAWK,) = named("242-AL1/39-ST1A")
(LAYERED,) = named("94-AL1/15-ST1A")
(PLAIN,) = named("147-AL1")


@pytest.mark.parametrize(
    ("row", "changes", "word"),
    [
        (HAWK, {"mass_kg_per_m": 0.9762 * 1.05}, "mass"),
        (HAWK, {"mass_kg_per_m": 0.9762 * 0.95}, "mass"),
        (HAWK, {"diameter_m": 28.1e-3}, "circle"),
        (HAWK, {"youngs_modulus_pa": 90e9}, "modulus"),
        (HAWK, {"youngs_modulus_pa": 62e9}, "modulus"),
        (HAWK, {"thermal_expansion_per_k": 19.9e-6}, "expansion"),
        (HAWK, {"thermal_expansion_per_k": 17.0e-6}, "expansion"),
        (HAWK, {"rated_strength_n": 8489.0}, "strength"),
        (HAWK, {"aluminium_area_m2": 300e-6}, "aluminium"),
        (LAYERED, {"diameter_m": 14.3e-3}, "layers"),
        (LAYERED, {"aluminium_wire_diameter_m": 2.10e-3}, "wires"),
        (PLAIN, {"diameter_m": 16.4e-3}, "layers"),
    ],
)
def test_a_wrong_figure_is_told_by_its_name(row: CatalogueRow, changes: dict[str, Any], word: str) -> None:
    assert doubts(row) == []
    assert any(word in sentence for sentence in doubts(replace(row, **changes)))


def test_the_two_rows_that_sources_misprint_are_found() -> None:
    """Gull has the mass of another conductor in ohmly's table, 70-AL3/11-ST1A wires of 1.75 mm in Moseroth's."""
    gull = replace(
        HAWK,
        aluminium_wires=54,
        aluminium_area_m2=337.3e-6,
        area_m2=381.0e-6,
        diameter_m=25.38e-3,
        mass_kg_per_m=0.932,
        youngs_modulus_pa=70e9,
        thermal_expansion_per_k=19.3e-6,
    )
    assert doubts(gull) == ["the mass, 0.932 kg/m, is not that of its areas, about 1.276 kg/m"]
    thin = replace(
        LAYERED,
        aluminium_wire_diameter_m=1.75e-3,
        steel_wire_diameter_m=1.44e-3,
        aluminium_area_m2=69.9e-6,
        area_m2=81.3e-6,
        diameter_m=11.7e-3,
        mass_kg_per_m=0.282,
        rated_strength_n=33960.0,
    )
    assert [sentence.split(",")[0] for sentence in doubts(thin)] == [
        "26 wires of 1.75 mm have 62.54 mm2 of aluminium",
        "the diameter",
    ]


def test_what_is_not_known_is_not_doubted() -> None:
    unknown = replace(
        HAWK,
        area_m2=None,
        aluminium_area_m2=None,
        aluminium_wires=None,
        steel_wires=None,
        rated_strength_n=None,
        youngs_modulus_pa=None,
    )
    assert doubts(unknown) == []
    assert unknown.stranding is None


def test_wires_that_strain_alike_expand_by_their_mean_weighted_with_stiffness() -> None:
    """Two bars in parallel: E1 A1 (a1 - a) + E2 A2 (a2 - a) = 0."""
    expansion = mixed_expansion(0.14, 55e9, 190e9)
    assert math.isclose(0.86 * 55e9 * (23e-6 - expansion), 0.14 * 190e9 * (expansion - 11.5e-6), rel_tol=1e-12)
