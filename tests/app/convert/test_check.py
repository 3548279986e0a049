import math
from collections.abc import Iterator
from typing import Any, Literal, get_args, get_origin

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app import convert
from app.schemas import Analysis
from app.schemas.faults import BadInput, Fault
from tests.app.lines import FULL_LINE, changed, faults


def pointers(document: dict[str, Any]) -> list[str]:
    return [fault.pointer for fault in faults(document)]


BAD_LINES = [
    ("span.length_m", -1.0, "/line/span/length_m"),
    ("span.length_m", 0, "/line/span/length_m"),
    ("span.length_m", math.nan, "/line/span/length_m"),
    ("span.length_m", math.inf, "/line/span/length_m"),
    ("span.length_m", 1e9, "/line/span/length_m"),
    ("span.length_m", "125", "/line/span/length_m"),
    ("span.length_m", True, "/line/span/length_m"),
    ("span.length_m", None, "/line/span/length_m"),
    ("span.elements", 10.5, "/line/span/elements"),
    ("span.elements", 1000, "/line/span/elements"),
    ("span.sag_m", 1.5, "/line/span"),
    ("span.horizontal_tension_n", None, "/line/span"),
    ("span.horizontal_tension_n", 500.0, "/line/span/horizontal_tension_n"),
    ("span", {"length_m": 126.0, "sag_m": 127.0}, "/line/span/sag_m"),
    ("span", {"length_m": 126.0, "catenary_parameter_m": 1.0}, "/line/span/catenary_parameter_m"),
    ("span.level_difference_m", 126.0, "/line/span/level_difference_m"),
    ("span.level_difference_m", -20.0, "/line/supports/right/insulator_length_m"),
    ("wind.yaw_deg", 80.0, "/line/wind/yaw_deg"),
    ("wind.blow_out.drag_coefficient", -1.0, "/line/wind/blow_out/drag_coefficient"),
    ("conductor.area_m2", 4e-4, "/line/conductor"),
    ("conductor.colour", "red", "/line/conductor/colour"),
    ("conductor.axial_torsional_coupling_n_m", 1e6, "/line/conductor/axial_torsional_coupling_n_m"),
    ("conductor", [], "/line/conductor"),
    ("bundle.radius_m", 0.0, "/line/bundle/radius_m"),
    ("bundle.subconductors", 1, "/line/bundle/radius_m"),
    ("bundle", {"positions_m": [[0.0, 0.0], [0.0, 0.0]]}, "/line/bundle/positions_m"),
    ("ice.aerodynamics.vertical", [1.0, 2.0], "/line/ice/aerodynamics/vertical"),
    ("ice.aerodynamics.vertical.1", "x", "/line/ice/aerodynamics/vertical/1"),
    ("ice.eccentricity_y_m", 0.1, "/line/ice/eccentricity_y_m"),
    ("ice.segments.0.to_m", 300.0, "/line/ice/segments/0/to_m"),
    ("ice.segments.0.from_m", 62.94, "/line/ice/segments/0/to_m"),
    ("ice.segments", [{"from_m": 0, "to_m": 20}, {"from_m": 19, "to_m": 40}], "/line/ice/segments/1"),
    ("ice.segments", [{"from_m": 0, "to_m": 1, "aerodynamics_at_rest": FULL_LINE["ice"]["aerodynamics_at_rest"]}],
     "/line/ice/segments/0"),
    ("wind.profile.1.position_m", 0.0, "/line/wind/profile"),
    ("wind.profile.1.position_m", 126.0, "/line/wind/profile/1/position_m"),
    ("wind.profile.0.factor", 0, "/line/wind/profile/0/factor"),
    ("damping.vertical_ratio", 1.0, "/line/damping/vertical_ratio"),
    ("damping.model", "viscous", "/line/damping/model"),
    ("devices.0.position_m", 200.0, "/line/devices/0/position_m"),
    ("devices.0.type", "anchor", "/line/devices/0"),
    ("devices.0.mass_kg", "6", "/line/devices/0/mass_kg"),
    ("devices.2.to_m", 20.0, "/line/devices/2/to_m"),
    ("devices.2.to_m", 200.0, "/line/devices/2/to_m"),
    ("supports.left.insulator_length_m", 0.0, "/line/supports/left/insulator_length_m"),
    ("tags", {"a:b": "c"}, "/line/tags/a:b"),
    ("tags", {"a": 3}, "/line/tags/a"),
    ("name", "a\x00b", "/line/name"),
]  # fmt: skip


@pytest.mark.parametrize(("path", "value", "pointer"), BAD_LINES)
def test_one_fault_in_a_line_is_named_by_its_pointer(path: str, value: Any, pointer: str) -> None:
    assert pointers({"line": changed(path, value)}) == [pointer]


@pytest.mark.parametrize(
    ("analysis", "pointer"),
    [
        ({"loops": []}, "/analysis/loops"),
        ({"loops": [1, 1]}, "/analysis"),
        ({"loops": [0]}, "/analysis/loops/0"),
        ({"harmonics": 21}, "/analysis/harmonics"),
        ({"models": ["hybrid", "other"]}, "/analysis/models/1"),
        ({"wind_speeds_m_per_s": [4.0, -1.0]}, "/analysis/wind_speeds_m_per_s/1"),
        ({"wind_speeds_m_per_s": [5.0] * 1001}, "/analysis/wind_speeds_m_per_s"),
        ({"wind_speeds_m_per_s": 4.0}, "/analysis/wind_speeds_m_per_s"),
        ({"wind_speeds_m_per_s": {"start": 6.0, "stop": 4.0, "count": 3}}, "/analysis/wind_speeds_m_per_s"),
        ({"wind_speeds_m_per_s": {"start": 4.0, "stop": 6.0, "count": 10**9}}, "/analysis/wind_speeds_m_per_s/count"),
        ({"closure": "published"}, "/analysis/closure"),
        ({"loop": [1]}, "/analysis/loop"),
    ],
)
def test_one_fault_in_an_analysis_is_named_by_its_pointer(analysis: dict[str, Any], pointer: str) -> None:
    assert pointers({"line": FULL_LINE, "analysis": analysis}) == [pointer]


@pytest.mark.parametrize("span", [{"sag_m": 125.0}, {"catenary_parameter_m": 40.0}, {"horizontal_tension_n": 1000.0}])
def test_a_slack_span_is_taken_up_to_a_sag_of_its_length(span: dict[str, float]) -> None:
    assert pointers({"line": changed("span", {"length_m": 126.0, **span})}) == []


def test_faults_of_schema_parts_and_combination_come_together() -> None:
    line = changed("conductor.diameter_m", -1.0, changed("devices.0.position_m", 200.0))
    line = changed("ice.segments", [{"from_m": 0, "to_m": 20}, {"from_m": 19, "to_m": 40}], line)
    line = changed("devices.1", {"type": "anchor"}, line)
    line = changed("span.elements", 5, line)
    document = {"line": line, "analysis": {"loops": [9]}, "webhook": "x"}
    assert sorted(pointers(document)) == [
        "/analysis/loops",
        "/line/conductor/diameter_m",
        "/line/devices/0/position_m",
        "/line/devices/1",
        "/line/ice/segments/1",
        "/webhook",
    ]


@pytest.mark.parametrize("document", [None, 3, [], "x", {}, {"line": None}, {"line": []}, {"line": {"span": []}}])
def test_what_is_no_request_at_all_is_refused(document: object) -> None:
    with pytest.raises(BadInput):
        convert.read(document)


@pytest.mark.parametrize(
    ("axis", "pointer"),
    [
        ({"parameter": "span.lenght_m", "values": [1]}, "/study/axes/0/parameter"),
        ({"parameter": "devices.7.position_m", "values": [1]}, "/study/axes/0/parameter"),
        ({"parameter": "devices.x.position_m", "values": [1]}, "/study/axes/0/parameter"),
        ({"parameter": "devices.0.type", "values": ["spacer"]}, "/study/axes/0/parameter"),
        ({"parameter": "tags.region", "values": ["x"]}, "/study/axes/0/parameter"),
        ({"parameter": "supports.left.dead_end", "values": [1]}, "/study/axes/0/parameter"),
        ({"parameter": "ice.aerodynamics.vertical", "values": [1]}, "/study/axes/0/parameter"),
        ({"parameter": "span.length_m", "values": [126.0, -1]}, "/study/axes/0/values/1"),
        ({"parameter": "span.length_m", "values": [126.0, "long"]}, "/study/axes/0/values/1"),
        ({"parameter": "span.sag_m", "values": [1.5]}, "/study/axes/0/values/0"),
        ({"parameter": "devices.0.position_m", "values": [20.0, 200.0]}, "/study/axes/0/values/1"),
        ({"parameter": "damping.model", "values": ["constant_ratio", "other"]}, "/study/axes/0/values/1"),
        ({"parameter": "span.length_m", "also": ["span.lenght_m"], "values": [126.0]}, "/study/axes/0/also/0"),
        ({"parameter": "devices.2.from_m", "also": ["devices.2.to_m"], "values": [50.0]}, "/study/axes/0/values/0"),
    ],
)
def test_a_fault_of_a_study_is_named_by_its_pointer(axis: dict[str, Any], pointer: str) -> None:
    assert pointers({"line": FULL_LINE, "study": {"axes": [axis]}}) == [pointer]


def test_a_study_that_fits_is_taken() -> None:
    axes = [
        {"parameter": "devices.0.position_m", "values": [20, 30.5]},
        {"parameter": "damping.model", "values": ["constant_ratio", "constant_coefficient"]},
    ]
    assert faults({"line": FULL_LINE, "study": {"axes": axes}}) == []


def numbers(node: Any, path: tuple[str, ...] = ()) -> Iterator[tuple[str, float]]:
    """Yield the dotted path and the value of every number of a document."""
    items = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
    for key, value in items:
        yield from numbers(value, (*path, str(key)))
    if isinstance(node, int | float) and not isinstance(node, bool):
        yield ".".join(path), node


# The shares of wind sectors sum to one, so none of them varies alone.
FREE_NUMBERS = [(path, value) for path, value in numbers(FULL_LINE) if not path.endswith(".share")]


@pytest.mark.parametrize(("parameter", "value"), FREE_NUMBERS)
def test_every_number_of_a_line_can_be_varied(parameter: str, value: float) -> None:
    near = [value * 0.999, value * 1.001] if isinstance(value, float) else [value]  # the span's end bounds positions
    assert [] in [faults(studied(FULL_LINE, (parameter, [value, other]))) for other in near]


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("supports.longitudinal_stiffness_n_per_m", 1e5),
        ("supports.left.adjacent_span_m", 150.0),
        ("supports.left.insulator_length_m", 2.0),
    ],
)
def test_what_is_left_open_can_be_varied(path: str, value: float) -> None:
    assert faults(studied(FULL_LINE, (path, [value]))) == []


def studied(line: dict[str, Any], *axes: tuple[str, list[Any]]) -> dict[str, Any]:
    return {"line": line, "study": {"axes": [{"parameter": name, "values": values} for name, values in axes]}}


WRONG_AXES = (("span.lenght_m", [1.0]), ("span.length_m", [126.0, -1]))
WRONG_PLACES = ["/study/axes/0/parameter", "/study/axes/1/values/1"]


@pytest.mark.parametrize(
    ("path", "value", "pointer"),
    [
        ("colour", "red", "/line/colour"),
        ("conductor.colour", "red", "/line/conductor/colour"),
        ("span.colour/~", "red", "/line/span/colour~1~0"),
        ("devices.1.colour", "red", "/line/devices/1/colour"),
        ("devices.0.position_m", 300.0, "/line/devices/0/position_m"),
        ("conductor.diameter_m", -1.0, "/line/conductor/diameter_m"),
        ("ice.segments.0.to_m", 300.0, "/line/ice/segments/0/to_m"),
    ],
)
def test_a_fault_of_the_line_hides_no_fault_of_the_study(path: str, value: Any, pointer: str) -> None:
    assert sorted(pointers(studied(changed(path, value), *WRONG_AXES))) == sorted([pointer, *WRONG_PLACES])


def test_a_fault_of_one_axis_hides_none_of_another() -> None:
    document = studied(FULL_LINE, ("span.lenght_m", [math.nan]), ("span.length_m", [math.nan, -1]))
    wanted = ["/study/axes/0/parameter", "/study/axes/0/values/0", "/study/axes/1/values/0", "/study/axes/1/values/1"]
    assert sorted(pointers(document)) == wanted


def test_a_value_is_not_blamed_for_what_is_wrong_with_the_line_already() -> None:
    line = changed("conductor.diameter_m", -1.0, changed("devices.0.position_m", 300.0))
    own = ["/line/conductor/diameter_m", "/line/devices/0/position_m"]
    assert sorted(pointers(studied(line, ("span.length_m", [125.88, 126.0])))) == own
    assert sorted(pointers(studied(line, ("devices.0.position_m", [20.0, 299.0])))) == [*own, "/study/axes/0/values/1"]
    assert sorted(pointers(studied(line, ("conductor.diameter_m", [0.03, -2.0])))) == [*own, "/study/axes/0/values/1"]


def test_a_path_into_a_part_at_fault_is_left_open() -> None:
    line = changed("supports.left", 3, changed("devices.1", {"type": "anchor"}))
    axes = (("supports.right.insulator_weight_n", [1.0]), ("devices.1.mass_kg", [1.0]))
    assert sorted(pointers(studied(line, *axes))) == ["/line/devices/1", "/line/supports/left"]


def test_an_absent_part_can_be_varied_though_the_line_is_at_fault() -> None:
    line = {name: part for name, part in FULL_LINE.items() if name != "wind"}
    document = studied({**line, "colour": "red"}, ("wind.air_density_kg_per_m3", [1.2, -1.0]))
    assert sorted(pointers(document)) == ["/line/colour", "/study/axes/0/values/1"]


@pytest.mark.parametrize(
    "analysis",
    [
        {"closure": "published", "aerodynamic_model": "relative_wind"},
        {"aerodynamic_model": "relative_wind", "loop": [1]},
        {"aerodynamic_model": "relative_wind", "harmonics": 99, "loops": [1, 1]},
    ],
)
def test_a_fault_of_the_analysis_hides_none_that_it_has_with_the_line(analysis: dict[str, Any]) -> None:
    line = {**FULL_LINE, "ice": {**FULL_LINE["ice"], "aerodynamics_at_rest": None}, "wind": {}}
    found = pointers({"line": line, "analysis": analysis})
    assert {"/line/ice/aerodynamics_at_rest"} < set(found)
    assert len(found) == len(set(found))


def test_blow_out_needs_a_drag_or_coefficients_at_rest() -> None:
    line = changed("wind.blow_out.drag_coefficient", None)
    assert pointers({"line": line}) == []
    unknown = changed("ice.aerodynamics_at_rest", None, line)
    assert pointers({"line": unknown}) == ["/line/wind/blow_out/drag_coefficient"]


def test_choices_that_exclude_each_other_are_both_held_against_the_line() -> None:
    line = changed("ice.aerodynamics_at_rest", None)
    found = faults({"line": line, "analysis": {"closure": "published", "aerodynamic_model": "relative_wind"}})
    assert [fault.pointer for fault in found] == [
        "/analysis/closure",
        "/line/ice/aerodynamics_at_rest",
        "/analysis/closure",
    ]
    assert "wind profile" in found[0].detail
    assert "relative wind" in found[2].detail


def test_full_physics_without_coefficients_at_rest_is_refused_and_the_way_out_is_named() -> None:
    line = changed("ice.aerodynamics_at_rest", None)
    (found,) = faults({"line": line, "analysis": {"physics": "full"}})
    assert found.pointer == "/line/ice/aerodynamics_at_rest"
    assert '"physics": "source" does without' in found.detail
    for physics in ("source", None):
        assert pointers({"line": line, "analysis": {"physics": physics}}) == []


def test_full_physics_excludes_the_published_closure() -> None:
    line = changed("wind", {})
    assert pointers({"line": line, "analysis": {"physics": "full", "closure": "published"}}) == ["/analysis/closure"]
    assert pointers({"line": line, "analysis": {"physics": None, "closure": "published"}}) == []


def test_loops_at_fault_are_no_excuse_for_others() -> None:
    line = changed("span.elements", 2)
    assert pointers({"line": line, "analysis": {"loops": [0], "finite_element_loops": []}}) == ["/analysis/loops/0"]
    analysis = {"loops": [0], "finite_element_loops": [1, 3]}
    assert pointers({"line": line, "analysis": analysis}) == ["/analysis/loops/0", "/analysis/finite_element_loops"]


def test_points_that_only_together_do_not_fit_are_named() -> None:
    axes = [
        {"parameter": "span.length_m", "values": [125.88, 100.0]},
        {"parameter": "devices.0.position_m", "values": [20.0, 110.0]},
    ]
    line = changed("devices", FULL_LINE["devices"][:1], changed("wind.profile", [], changed("ice.segments", [])))
    found = faults({"line": line, "study": {"axes": axes}})
    assert [fault.pointer for fault in found] == ["/study/axes"]
    assert "span.length_m = 100.0, devices.0.position_m = 110.0" in found[0].detail


@pytest.mark.parametrize("name", ["list", "range", "spacer", "detuning_pendulum", "airflow_spoiler"])
def test_a_field_with_the_name_of_a_type_is_named(name: str) -> None:
    line = changed(f"tags.{name}", 3, changed(f"devices.0.{name}", 1, changed(f"ice.segments.0.{name}", 1)))
    axis = {"parameter": "span.length_m", "values": [1.0], name: 1}
    speeds = {"start": 4.0, "stop": 6.0, "count": 3, name: 1}
    document = {
        "line": line,
        "analysis": {"wind_speeds_m_per_s": speeds},
        "study": {"axes": [axis]},
        name: 1,
    }
    assert set(pointers(document)) >= {
        f"/line/tags/{name}",
        f"/line/devices/0/{name}",
        f"/line/ice/segments/0/{name}",
        f"/analysis/wind_speeds_m_per_s/{name}",
        f"/study/axes/0/{name}",
        f"/{name}",
    }
    assert pointers({name: None}) == ["/line", f"/{name}"]


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=10),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=10), inner, max_size=4),
    max_leaves=10,
)
PATHS = st.sampled_from(sorted({path for path, _, _ in BAD_LINES} | {"devices", "wind", "ice", "supports", "span"}))


@settings(max_examples=200)
@given(PATHS, JSON)
def test_whatever_stands_in_a_field_is_taken_or_named(path: str, value: Any) -> None:
    found = faults({"line": changed(path, value)})
    assert all(isinstance(fault, Fault) and fault.detail for fault in found)


@settings(max_examples=100)
@given(JSON)
def test_whatever_comes_as_a_request_is_refused_with_reasons(document: Any) -> None:
    assert faults(document)


def test_the_design_wind_is_asked_for_where_no_wind_speeds_are_named() -> None:
    line = {**FULL_LINE, "design_wind_m_per_s": 10.0}

    def speeds(analysis: dict[str, Any]) -> Any:
        return convert.read({"line": line, "analysis": analysis}).kept()["analysis"]["wind_speeds_m_per_s"]

    assert speeds({}) == [4.0, 5.0, 6.0, 10.0]
    assert speeds({"wind_speeds_m_per_s": [4.0, 5.0, 6.0]}) == [4.0, 5.0, 6.0]
    kept = convert.read({"line": line}).kept()
    assert convert.read(kept).kept() == kept
    with pytest.raises(BadInput) as caught:
        convert.read({"line": {**line, "design_wind_m_per_s": -3.0}})
    assert [fault.pointer for fault in caught.value.faults] == ["/line/design_wind_m_per_s"]


def test_too_many_loops_beside_the_default_ones_are_named() -> None:
    many = {"loops": [1, 2, 3, 4, 5, 6, 7]}
    (fault,) = faults({"line": FULL_LINE, "analysis": many})
    assert fault.pointer.startswith("/analysis")
    assert "6 different numbers" in fault.detail


LOOPS = st.lists(st.integers(1, 8), max_size=10, unique=True)


def words(kind: object) -> list[str]:
    """Return the words that a field takes, if it takes any."""
    if get_origin(kind) is Literal:
        return list(get_args(kind))
    return [word for part in get_args(kind) for word in words(part) if isinstance(word, str)]


OPTIONS = {name: words(field.annotation) for name, field in Analysis.model_fields.items() if name != "models"}
ANALYSES = st.fixed_dictionaries(
    {},
    optional={
        **{name: st.sampled_from(choices) for name, choices in OPTIONS.items() if choices},
        "loops": LOOPS.filter(bool),
        "finite_element_loops": LOOPS,
        "harmonics": st.integers(1, 20),
        "critical_wind_limit_m_per_s": st.floats(0.1, 100.0),
        "wind_speeds_m_per_s": st.lists(st.floats(0.1, 100.0), max_size=20),
    },
)


@settings(max_examples=150)
@given(ANALYSES)
def test_no_analysis_that_the_schema_allows_is_a_defect(analysis: dict[str, Any]) -> None:
    Analysis.model_validate(analysis)
    for fault in faults({"line": FULL_LINE, "analysis": analysis}):
        assert fault.pointer
    try:
        convert.read_analysis(analysis)
    except BadInput as error:
        assert all(fault.pointer.startswith("/analysis") for fault in error.faults)
