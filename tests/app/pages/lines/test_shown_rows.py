from app.pages.lines.shown_rows import shown_rows

TEXTS = {
    "line.devices.0.type": "airflow_spoiler",
    "line.devices.1.type": "interphase_spacer",
    "line.ice.segments.0.aerodynamics_at_rest.vertical": "0.1",
    "line.section.spans.0.rest": "",
}


def test_rows_have_their_parts_which_are_open_where_they_are_needed_or_filled() -> None:
    lists = shown_rows(TEXTS)
    spoiler, spacer = lists["line.devices"].rows
    assert {part.name: part.is_open for part in spoiler.parts if part.name} == {
        "aerodynamics": True,
        "aerodynamics_at_rest": False,
    }
    assert [part.name for part in spacer.parts] == [""]
    piece = lists["line.ice.segments"].rows[0]
    assert {part.name for part in piece.parts if part.name and part.is_open} == {"aerodynamics_at_rest"}
    assert piece.parts[0].name == ""


def test_a_row_has_json_where_its_kind_may_have_some() -> None:
    lists = shown_rows({**TEXTS, "line.devices.2.type": "spacer", "line.devices.2.rest": '{"colour": "red"}'})
    assert [row.rest for row in lists["line.devices"].rows] == ["", None, '{"colour": "red"}']
    assert lists["line.section.spans"].rows[0].rest == ""


def test_the_next_row_is_offered_with_the_kind_of_the_last_one() -> None:
    assert shown_rows(TEXTS)["line.devices"].next_kind == "interphase_spacer"
    assert shown_rows({})["line.devices"].next_kind == "spacer"


def test_an_unknown_kind_is_kept() -> None:
    (row,) = shown_rows({"line.devices.0.type": "balloon"})["line.devices"].rows
    assert (row.kind, [list(part.fields) for part in row.parts]) == ("balloon", [[]])


def test_a_list_is_full_at_its_bound() -> None:
    full = {f"line.phases.{number}.name": "x" for number in range(20)}
    assert shown_rows(full)["line.phases"].is_full
    assert not shown_rows(TEXTS)["line.phases"].is_full
