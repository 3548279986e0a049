from app import schemas
from app.convert.sound_parts import SoundAxis, pruned, sound_analysis, sound_axes, sound_parts
from app.schemas.faults import Fault
from tests.app.lines import FULL_LINE, changed


def test_unknown_fields_are_cut_out_and_the_document_is_left_alone() -> None:
    document = {"line": {"a": [{"x": 1, "y": 2}, {"x": 3}], "b/c": 4}, "colour": "red"}
    faults = [Fault(p, "unknown_field", "") for p in ("/colour", "/line/a/0/x", "/line/b~1c", "/line/a/7/x")]
    kept = pruned(document, [*faults, Fault("/line/a/1/x", "greater_than", "")])
    assert kept == {"line": {"a": [{"y": 2}, {"x": 3}]}}
    assert document["colour"] == "red"
    assert document["line"] == {"a": [{"x": 1, "y": 2}, {"x": 3}], "b/c": 4}


def test_parts_are_taken_that_are_sound_by_themselves() -> None:
    line = changed("span.length_m", -1.0, changed("devices.1", {"type": "anchor"}))
    del line["supports"], line["ice"]
    parts = sound_parts(line)
    assert parts.span is None
    assert parts.ice is None  # it has no default
    assert parts.supports == schemas.Supports()
    assert parts.conductor == schemas.Conductor.model_validate(FULL_LINE["conductor"])
    assert [device if device is None else device.type for device in parts.devices] == [
        "spacer",
        None,
        "airflow_spoiler",
    ]
    assert sound_parts({"devices": 3}).devices == []


def test_choices_at_fault_are_left_out_and_loops_are_one() -> None:
    found = sound_analysis({"loops": [0], "harmonics": 99, "closure": "published", "critical_wind_limit_m_per_s": 12.0})
    assert found is not None
    assert (found.loops, found.harmonics, found.closure, found.critical_wind_limit) == ([1], 5, "published", 12.0)
    assert sound_analysis([]) is None


def test_axes_keep_their_sound_values_with_their_numbers() -> None:
    good = {"parameter": "span.length_m", "also": ["span.sag_m"], "values": [1.0, None, "word", [2]]}
    study = {"axes": [{"parameter": "no path", "values": [1.0]}, good, {"parameter": "span.sag_m", "values": [1.0]}]}
    assert sound_axes(study) == [SoundAxis(1, ("span.length_m", "span.sag_m"), [(0, 1.0), (2, "word")])]
    assert sound_axes({"axes": {}}) == []
