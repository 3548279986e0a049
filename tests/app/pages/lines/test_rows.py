import pytest

from app.pages.lines.row_lists import row_lists
from app.pages.lines.rows import STEP, WINDS, changed, fields_in, is_blank, numbered, rows_in

TWO = {
    "line.name": "A line",
    "line.devices.4.type": "spacer",
    "line.devices.4.position_m": "20",
    "line.devices.9.type": "detuning_pendulum",
    "line.devices.9.arm_m": "0.35",
}


def devices(texts: dict[str, str]) -> list[dict[str, str]]:
    return rows_in(texts)["line.devices"]


def test_rows_are_found_in_the_order_of_their_numbers_and_numbered_from_0() -> None:
    assert [row["type"] for row in devices(TWO)] == ["spacer", "detuning_pendulum"]
    texts = numbered(TWO)
    assert texts["line.devices.1.arm_m"] == "0.35"
    assert texts["line.name"] == "A line"
    assert "line.devices.9.arm_m" not in texts
    assert "line.devices.1.arm_m" in fields_in(texts)
    assert "line.devices.1.polar_inertia_kg_m2" not in fields_in(texts)


def test_of_too_many_rows_one_more_than_allowed_is_left() -> None:
    assert len(rows_in({f"line.phases.{number}.name": "x" for number in range(5000)})["line.phases"]) == 21


def test_names_that_only_look_like_rows_are_none() -> None:
    strange = {"line.devices.x.mass_kg": "1", f"line.devices.{'9' * 5000}.mass_kg": "1", "line.nothing.0.mass_kg": "1"}
    assert devices(strange) == []
    assert numbered(strange) == strange


def test_a_row_is_added_with_the_kind_that_was_chosen_and_its_first_control_has_the_focus() -> None:
    found = changed({**numbered(TWO), "add.line.devices": "airflow_spoiler"}, "add line.devices")
    assert found is not None
    assert [row["type"] for row in devices(found.texts)] == ["spacer", "detuning_pendulum", "airflow_spoiler"]
    assert found.focus == "line-devices-2-type"
    assert found.said.startswith("Device 3 is added")
    phase = changed({}, "add line.phases")
    assert phase is not None
    assert (len(rows_in(phase.texts)["line.phases"]), phase.focus) == (1, "line-phases-0-name")


def test_a_row_is_copied_behind_itself() -> None:
    found = changed(numbered(TWO), "copy line.devices 0")
    assert found is not None
    assert [row.get("position_m") for row in devices(found.texts)] == ["20", "20", None]
    assert found.focus == "line-devices-1-type"


def test_the_focus_goes_to_what_takes_the_place_of_a_removed_row() -> None:
    found = changed(numbered(TWO), "remove line.devices 0")
    assert found is not None
    assert [row["type"] for row in devices(found.texts)] == ["detuning_pendulum"]
    assert found.focus == "line-devices-0"
    last = changed(found.texts, "remove line.devices 0")
    assert last is not None
    assert (devices(last.texts), last.focus) == ([], "add-line-devices")


@pytest.mark.parametrize("text", ["", "add", "add line.nothing", "remove line.devices 7", "fill line.devices", "x y 1"])
def test_changes_that_make_no_sense_change_nothing(text: str) -> None:
    assert changed(numbered(TWO), text) is None


def test_a_full_list_takes_no_more_rows() -> None:
    full = {f"line.section.strings.{number}.length_m": "1" for number in range(19)}
    for change in ("add line.section.strings", "copy line.section.strings 3"):
        found = changed(full, change)
        assert found is not None
        assert found.refused
        assert "19" in found.said
        assert len(rows_in(found.texts)["line.section.strings"]) == 19


@pytest.mark.parametrize(
    ("said", "listed"),
    [
        (("2", "4", "", "0,5"), ["2", "2.5", "3", "3.5", "4"]),
        (("2", "4", "3", ""), ["2", "3", "4"]),
        (("2", "4", "3", "1.5"), ["2", "3.5"]),
        (("0.1", "0.3", "", "0.1"), ["0.1", "0.2", "0.3"]),
    ],
)
def test_evenly_spaced_wind_speeds_are_listed_and_the_range_becomes_empty(
    said: tuple[str, ...], listed: list[str]
) -> None:
    names = (f"{WINDS}.start", f"{WINDS}.stop", f"{WINDS}.count", STEP)
    found = changed(dict(zip(names, said, strict=True)), f"fill {WINDS}")
    assert found is not None
    assert [row[""] for row in rows_in(found.texts)[WINDS]] == listed
    assert not any(found.texts[name] for name in names)


@pytest.mark.parametrize(
    "said",
    [
        ("4", "2", "", "1"),
        ("2", "4", "", "0"),
        ("2", "4", "", "-1"),
        ("2", "4", "1", ""),
        ("2", "4", "", "1e-9"),
        ("2", "4", "", ""),
        ("", "4", "3", ""),
        ("2", "inf", "", "1"),
        ("2", "4", "nan", ""),
        ("2", "4", "", "1e-320"),
    ],
)
def test_what_makes_no_list_of_wind_speeds_is_refused(said: tuple[str, ...]) -> None:
    names = (f"{WINDS}.start", f"{WINDS}.stop", f"{WINDS}.count", STEP)
    texts = dict(zip(names, said, strict=True))
    found = changed(texts, f"fill {WINDS}")
    assert found is not None
    assert found.refused
    assert found.texts == texts
    assert str(row_lists()[WINDS].most) in found.said


def test_a_row_is_blank_until_something_but_its_kind_is_typed() -> None:
    assert is_blank({"type": "spacer", "mass_kg": " ", "rest": ""})
    assert not is_blank({"type": "spacer", "mass_kg": "0"})


TABLE = "line.ice.aerodynamics.table"


def test_rows_of_a_sheet_follow_those_that_were_typed() -> None:
    typed = {f"{TABLE}.0.angle_deg": "-30", f"{TABLE}.1.rest": "", f"paste.{TABLE}": "Angle\tLift\n-20\t0,3\n-10\t0,2"}
    found = changed(typed, f"paste {TABLE}")
    assert found is not None
    assert not found.refused
    rows = rows_in(found.texts)[TABLE]
    assert [row["angle_deg"] for row in rows] == ["-30", "-20", "-10"]
    assert rows[2]["lift"] == "0,2"
    assert (found.focus, found.texts[f"paste.{TABLE}"]) == ("line-ice-aerodynamics-table-1-angle_deg", "")
    winds = changed({f"paste.{WINDS}": "4\n4,5"}, f"paste {WINDS}")
    assert winds is not None
    assert [row[""] for row in rows_in(winds.texts)[WINDS]] == ["4", "4,5"]
    assert winds.focus == "analysis-wind_speeds_m_per_s-0"


@pytest.mark.parametrize("text", ["", "1\t2\t3\t4\t5", "1\t2\t3\t4\n" * 1001])
def test_a_sheet_that_does_not_fit_is_refused_as_a_whole(text: str) -> None:
    found = changed({f"paste.{TABLE}": text}, f"paste {TABLE}")
    assert found is not None
    assert (found.refused, found.focus) == (True, f"paste-{TABLE.replace('.', '-')}")
    assert "4 cells" in found.said
    assert rows_in(found.texts)[TABLE] == []
    assert changed({"paste.line.devices": "1"}, "paste line.devices") is None
