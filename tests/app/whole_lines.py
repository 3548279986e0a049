"""Strategies for whole requests: lines as a utility would send them, some of their numbers far off, and broken ones.

`assert_is_named` and `assert_answers_every_wind` say what holds for each of them.
"""

import json
import math
from collections.abc import Mapping
from typing import Any

from hypothesis import strategies as st

from app.reference.source_lines import example
from engine.outcome import Outcome

Json = dict[str, Any]

_TWIN = example("c11-twin")
_REASONS = {outcome.value for outcome in Outcome}
_NUMBERS = {
    "frequencies": ("vertical_hz", "horizontal_hz"),
    "limit_cycles": ("observed_at_m", "vertical_m", "horizontal_m", "torsional_rad"),
}
_FACTORS = (-1.0, 0.0, 1e-6, 1e-3, 0.1, 10.0, 1e3, 1e6)
_JUNK = st.one_of(
    st.none(),
    st.booleans(),
    st.sampled_from([math.nan, math.inf, -math.inf, -1, 0, 1e308, 5e-324, "", "1.0", "x\n", [], {}, [[]], 10**30]),
)


def near(value: float, spread: float = 2.0) -> st.SearchStrategy[float]:
    """Return numbers within a factor of a usual one."""
    return st.floats(-1.0, 1.0).map(lambda power: round(value * spread**power, 9))


def _cubic(usual: list[float]) -> st.SearchStrategy[list[float]]:
    return st.lists(st.floats(-3.0, 3.0), min_size=3, max_size=3).map(
        lambda by: [round(value + change, 6) for value, change in zip(usual, by, strict=True)]
    )


def _table(shift: float) -> Json:
    rows = [
        {
            "angle_deg": angle,
            "lift": math.sin(math.radians(3.0 * (angle + shift))),
            "drag": 1.2 - 0.4 * math.cos(math.radians(2.0 * angle)),
            "moment": 0.2 * math.sin(math.radians(2.0 * (angle + shift))),
        }
        for angle in range(0, 100, 10)
    ]
    return {"table": rows, "static_angle_deg": 40.0, "half_range_deg": 25.0}


COEFFICIENTS = st.one_of(
    st.fixed_dictionaries({name: _cubic(usual) for name, usual in _TWIN["ice"]["aerodynamics"].items()}),
    st.floats(-30.0, 30.0).map(_table),
)
AT_REST = st.fixed_dictionaries(
    {"vertical": st.floats(-1.0, 1.0), "horizontal": near(1.0), "torsional": st.floats(-0.5, 0.5)}
)
_RIGIDITY = st.one_of(
    st.fixed_dictionaries({"axial_rigidity_n": near(2.8e7)}),
    st.fixed_dictionaries({"area_m2": near(4.2e-4), "youngs_modulus_pa": near(4.8e10)}),
)
_CONDUCTOR = st.builds(
    lambda given, rigidity: given | rigidity,
    st.fixed_dictionaries(
        {
            "diameter_m": near(0.0286),
            "torsional_rigidity_n_m2": near(101.0),
            "mass_kg_per_m": near(2.379),
            "polar_inertia_kg_m": near(3.334e-4),
        },
        optional={"axial_torsional_coupling_n_m": st.floats(-2.0, 2.0), "rated_strength_n": st.floats(1e4, 1e6)},
    ),
    _RIGIDITY,
)
_BUNDLE = st.one_of(
    st.just({"subconductors": 1}),
    st.fixed_dictionaries(
        {"subconductors": st.integers(2, 4), "radius_m": near(0.24), "orientation_deg": st.floats(0.0, 360.0)},
        optional={"section": st.sampled_from(["rigid", "free"])},
    ),
    st.just({"positions_m": [[0.0, -0.2], [0.0, 0.2]]}),
)
_TIGHTNESS = st.one_of(
    st.fixed_dictionaries({"horizontal_tension_n": near(30000.0)}),
    st.fixed_dictionaries({"catenary_parameter_m": near(1300.0)}),
    st.fixed_dictionaries({"sag_m": near(2.0)}),
)
_SPAN = st.builds(
    lambda given, tightness: given | tightness,
    st.fixed_dictionaries(
        {"length_m": near(130.0, 3.0), "elements": st.integers(4, 6)},
        optional={"level_difference_m": st.floats(-2.0, 2.0)},
    ),
    _TIGHTNESS,
)
_END = st.fixed_dictionaries(
    {},
    optional={
        "dead_end": st.booleans(),
        "adjacent_span_m": st.none() | near(130.0),
        "insulator_length_m": st.none() | near(2.0),
        "insulator_weight_n": near(300.0),
        "yoke": st.sampled_from(["held", "free"]),
    },
)
_SUPPORTS = st.fixed_dictionaries(
    {}, optional={"longitudinal_stiffness_n_per_m": st.none() | near(1e5, 30.0), "left": _END, "right": _END}
)
_SEGMENT = st.fixed_dictionaries(
    {"from_m": st.just(0.0), "to_m": st.floats(1.0, 40.0)},
    optional={
        "aerodynamics": COEFFICIENTS,
        "eccentricity_y_m": st.floats(-0.005, 0.005),
        "eccentricity_z_m": st.floats(-0.005, 0.005),
        "mass_kg_per_m": near(2.4),
    },
)


def _one_rest(ice: Json) -> Json:
    """Drop values at rest beside a table, which contains them."""
    return {name: ice[name] for name in ice if name != "aerodynamics_at_rest" or "table" not in ice["aerodynamics"]}


_ICE = st.fixed_dictionaries(
    {"aerodynamics": COEFFICIENTS},
    optional={
        "eccentricity_y_m": st.floats(-0.005, 0.005),
        "eccentricity_z_m": st.floats(-0.005, 0.005),
        "aerodynamics_at_rest": AT_REST,
        "segments": st.lists(_SEGMENT, max_size=1),
    },
).map(_one_rest)
_PROFILE = [{"position_m": 0.0, "factor": 0.7}, {"position_m": 40.0, "factor": 1.3}]
_WIND = st.fixed_dictionaries(
    {},
    optional={
        "air_density_kg_per_m3": near(1.2, 1.2),
        "blow_out": st.none()
        | st.fixed_dictionaries({"wind_speed_m_per_s": st.floats(0.0, 20.0), "drag_coefficient": near(1.0)}),
        "profile": st.sampled_from([[], _PROFILE]),
        "yaw_deg": st.floats(-40.0, 40.0),
    },
)
_DAMPING = st.fixed_dictionaries(
    {"vertical_ratio": near(1e-3, 3.0), "horizontal_ratio": near(1e-3, 3.0), "torsional_ratio": near(0.1, 3.0)},
    optional={"model": st.sampled_from(["constant_coefficient", "constant_ratio"])},
)
_ON_SPAN = st.floats(1.0, 40.0)
_DEVICE = st.one_of(
    st.fixed_dictionaries(
        {"type": st.just("spacer"), "position_m": _ON_SPAN, "mass_kg": near(6.5), "polar_inertia_kg_m2": near(0.4)}
    ),
    st.fixed_dictionaries(
        {"type": st.just("detuning_pendulum"), "position_m": _ON_SPAN, "mass_kg": near(12.0), "arm_m": near(0.35)},
        optional={"angle_deg": st.floats(-30.0, 30.0)},
    ),
    st.fixed_dictionaries(
        {"type": st.just("airflow_spoiler"), "from_m": st.just(2.0), "to_m": _ON_SPAN, "aerodynamics": COEFFICIENTS}
    ),
    st.fixed_dictionaries(
        {
            "type": st.just("torsional_damper"),
            "position_m": _ON_SPAN,
            "mass_kg": near(15.0),
            "polar_inertia_kg_m2": near(1.5),
            "damping_n_m_s": near(2.0),
        }
    ),
)
LINES = st.fixed_dictionaries(
    {"conductor": _CONDUCTOR, "bundle": _BUNDLE, "span": _SPAN, "ice": _ICE, "damping": _DAMPING},
    optional={
        "supports": _SUPPORTS,
        "wind": _WIND,
        "devices": st.lists(_DEVICE, max_size=2),
        "phases": st.just([{"name": "top", "y_m": 7.0}]),
        "required_clearance_m": near(2.0),
    },
)
ANALYSES = st.fixed_dictionaries(
    {
        "loops": st.sampled_from([[1], [2], [1, 2]]),
        "models": st.sampled_from([["hybrid"], ["hybrid", "finite_element"], ["finite_element"]]),
        "wind_speeds_m_per_s": st.lists(st.floats(0.5, 25.0), min_size=1, max_size=2, unique=True),
        "finite_element_loops": st.sampled_from([[1], [1, 2]]),
    },
    optional={
        "closure": st.sampled_from(["exact", "published"]),
        "physics": st.sampled_from(["source", "full", None]),
        "aerodynamic_model": st.sampled_from(["published", "relative_wind"]),
        "longitudinal_inertia": st.sampled_from(["neglected", "condensed"]),
        "stretching": st.sampled_from(["neglected", "included"]),
        "critical_wind_limit_m_per_s": st.floats(1.0, 60.0),
        "harmonics": st.integers(1, 6),
        "static_twist": st.sampled_from([None, "neglected", "where_large", "solved"]),
        "device_effect": st.sampled_from(["neglected", "reported"]),
        "risk": st.sampled_from([None, False]),
        "uncertainty": st.sampled_from([None, {"samples": 8, "seed": 2}]),
    },
)
REQUESTS = st.fixed_dictionaries({"line": LINES, "analysis": ANALYSES})


@st.composite
def far_off(draw: st.DrawFn) -> Json:
    """Return a request of which one or two numbers are many times larger or smaller, zero or negative."""
    request: Json = json.loads(json.dumps(draw(REQUESTS)))  # shares no part with other examples
    for _ in range(draw(st.integers(1, 2))):
        places = [place for place in _leaves(request["line"]) if isinstance(_at(request["line"], place), float)]
        place = draw(st.sampled_from(places))
        _put(request["line"], place, _at(request["line"], place) * draw(st.sampled_from(_FACTORS)))
    return request


@st.composite
def broken(draw: st.DrawFn) -> Json:
    """Return a request one place of which is missing, unknown, or something else than it should be."""
    request: Json = json.loads(json.dumps(draw(REQUESTS)))  # shares no part with other examples
    place = draw(st.sampled_from(_leaves(request)))
    match draw(st.sampled_from(["missing", "unknown", "junk"])):
        case "missing":
            _at(request, place[:-1]).pop(place[-1])
        case "unknown" if isinstance(place[-1], str):
            _put(request, (*place[:-1], f"{place[-1]}_"), 1.0)
        case _:
            _put(request, place, draw(_JUNK))
    return request


def assert_is_named(pointer: str, code: str, detail: str) -> None:
    """See that a fault names a place of the document and says what the rule is."""
    assert pointer == "" or pointer.startswith("/"), (pointer, detail)
    assert code, (pointer, detail)
    assert len(detail.split()) > 1, (pointer, detail)


def assert_answers_every_wind(analysis: Json, tables: Mapping[Any, list[Json]]) -> None:
    """See that every model and wind has its rows, and each row its numbers or the reason for which it has none."""
    for model in analysis["models"]:
        winds = {row["wind_speed_m_per_s"] for row in tables["limit_cycles"] if row["model"] == model}
        assert winds == set(analysis["wind_speeds_m_per_s"]), model
        assert {row["loops"] for row in tables["frequencies"] if row["model"] == model} >= set(analysis["loops"])
    for name, numbers in _NUMBERS.items():
        for row in tables[name]:
            assert row["outcome"] in _REASONS, row
            found = [row[number] for number in numbers]
            whole = all(isinstance(number, float) and math.isfinite(number) for number in found)
            assert whole or row["outcome"] != "converged", row


def _leaves(node: Any, place: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Return the places of everything that is neither an object nor a list."""
    if isinstance(node, dict):
        return [leaf for name, inner in node.items() for leaf in _leaves(inner, (*place, name))]
    if isinstance(node, list):
        return [leaf for number, inner in enumerate(node) for leaf in _leaves(inner, (*place, number))]
    return [place]


def _at(node: Any, place: tuple[Any, ...]) -> Any:
    for token in place:
        node = node[token]
    return node


def _put(node: Any, place: tuple[Any, ...], value: Any) -> None:
    _at(node, place[:-1])[place[-1]] = value
