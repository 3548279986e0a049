from typing import Any

from app.pages.batches.overviews import Wanted, overview


def feature(number: int, *, tags: dict[str, str] | None = None, **said: Any) -> dict[str, Any]:
    line = {
        "number": number,
        "name": f"span {number}",
        "reference": None,
        "asset_id": "L204",
        "status": "successful",
        "gallops": "yes",
        "unknown_motions": False,
        "vertical_peak_to_peak_m": float(number),
    }
    return {"geometry": None, "properties": {**line, **said}, "tags": tags or {}}


FEATURES = [
    feature(1, tags={"region": "north", "voltage": "400"}),
    feature(2, tags={"region": "south"}),
    feature(3, gallops="undecided", vertical_peak_to_peak_m=None),
    feature(4, status="rejected", gallops=None, vertical_peak_to_peak_m=None, name=None),
    feature(5, status="accepted", gallops=None, vertical_peak_to_peak_m=None),
    feature(6, unknown_motions=True),
    feature(7, tags={"region": "north"}, gallops="no", vertical_peak_to_peak_m=None),
]


def test_unknown_motions_come_first_and_what_waits_last() -> None:
    found = overview(FEATURES, Wanted())
    assert [line["number"] for line in found.lines] == [6, 3, 4, 2, 1, 7, 5]
    assert found.answers == {"yes": 3, "no": 1, "undecided": 1}
    assert found.values("vertical_peak_to_peak_m") == [6.0, 2.0, 1.0]


def test_lines_are_wanted_by_their_answer_and_by_any_of_their_names() -> None:
    assert [line["number"] for line in overview(FEATURES, Wanted("no")).lines] == [7]
    assert [line["number"] for line in overview(FEATURES, Wanted(name="SPAN 2")).lines] == [2]
    assert len(overview(FEATURES, Wanted("yes", "l204")).lines) == 3
    assert overview(FEATURES, Wanted(name="nowhere")).lines == []


def test_lines_are_wanted_by_a_tag_or_by_its_key() -> None:
    assert overview(FEATURES, Wanted()).tags == {"region:north": 2, "voltage:400": 1, "region:south": 1}
    assert overview(FEATURES, Wanted(tag="region:north")).numbers == {1, 7}
    assert overview(FEATURES, Wanted("yes", tag="region")).numbers == {1, 2}
    assert overview(FEATURES, Wanted(tag="region:nor")).numbers == set()


def test_accents_of_what_is_wanted_may_be_written_in_either_form() -> None:
    lines = [feature(1, reference="Bra\u030al\u00f8s", tags={"\u00f8y": "Sj\u00e6lland \u00e5"}), feature(2)]
    assert overview(lines, Wanted(name="br\u00e5L")).numbers == {1}
    assert overview(lines, Wanted(tag="\u00f8y:Sj\u00e6lland a\u030a")).numbers == {1}
    assert overview(lines, Wanted(name="bral")).numbers == set()


def test_what_is_wanted_stays_in_the_address() -> None:
    assert Wanted().query == ""
    assert Wanted("yes", "a&b", "region:north").query == "gallops=yes&name=a%26b&tag=region%3Anorth"
