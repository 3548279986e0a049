"""Which form a line document has: spelled out as an analysis takes it, or as an engineer knows it, to be resolved."""

from collections.abc import Mapping

_FORMS: Mapping[str, frozenset[str]] = {
    "conductor": frozenset(
        {
            "catalogue",
            "bare_mass_kg_per_m",
            "bare_polar_inertia_kg_m",
            "aluminium_area_m2",
            "thermal_expansion_per_k",
            "aluminium_wires",
            "steel_wires",
        }
    ),
    "bundle": frozenset({"spacing_m", "arrangement"}),
    "span": frozenset({"everyday", "ruling_span_m", "temperature_c"}),
    "ice": frozenset({"accretion"}),
}
_OF_AERODYNAMICS = frozenset({"catalogue", "reference_diameter_m"})
# What an analysis needs and resolving estimates from what else is said.
_ESTIMATED: Mapping[str, frozenset[str]] = {
    "conductor": frozenset({"torsional_rigidity_n_m2", "polar_inertia_kg_m"}),
    "ice": frozenset({"aerodynamics"}),
    "damping": frozenset({"vertical_ratio", "horizontal_ratio", "torsional_ratio"}),
}
_RIGIDITY = "axial_rigidity_n"
_METAL = frozenset({"area_m2", "youngs_modulus_pa"})
_TENSIONS = frozenset({"horizontal_tension_n", "catenary_parameter_m", "sag_m"})


def is_known_form(line: object) -> bool:
    """Tell whether a line document has a form that the explicit line has not, or leaves out what can be estimated."""
    if not isinstance(line, dict):
        return False
    ice = line.get("ice")
    coefficients = ice.get("aerodynamics") if isinstance(ice, dict) else None
    parts = [(line.get(name), forms) for name, forms in _FORMS.items()]
    return _lacks_estimates(line) or any(
        isinstance(part, dict) and not forms.isdisjoint(part)
        for part, forms in (*parts, (coefficients, _OF_AERODYNAMICS))
    )


def _lacks_estimates(line: Mapping[str, object]) -> bool:
    """Tell whether something is not said that resolving estimates; a part that is no object has other faults."""
    parts = {**line, "damping": line.get("damping", {})}
    if any(
        isinstance(part := parts.get(name), dict) and not needed <= _said(part) for name, needed in _ESTIMATED.items()
    ):
        return True
    conductor, span = line.get("conductor"), line.get("span")
    bare = isinstance(conductor, dict) and _RIGIDITY not in _said(conductor) and _METAL - _said(conductor) != set()
    return bare or (isinstance(span, dict) and _TENSIONS.isdisjoint(_said(span)))


def _said(part: Mapping[str, object]) -> set[str]:
    return {name for name, value in part.items() if value is not None}
