import pytest

from app.exchange.cim import read_segments
from app.sheets.columns import PlacedLine
from tests.app.exchange.cim_files import an_object, file, pieces

WGS84 = an_object("CoordinateSystem", "_c", CoordinateSystem__crsUrn="urn:ogc:def:crs:EPSG::4326")
PLACE = an_object("Location", "_l", Location__PowerSystemResources="#_s", Location__CoordinateSystem="#_c")


def point(number: str, x: str, y: str, z: str | None = None) -> str:
    height = {} if z is None else {"PositionPoint__zPosition": z}
    return an_object(
        "PositionPoint",
        f"_p{number}",
        PositionPoint__Location="#_l",
        PositionPoint__sequenceNumber=number,
        PositionPoint__xPosition=x,
        PositionPoint__yPosition=y,
        **height,
    )


def read(*objects: str, **attributes: str) -> tuple[list[PlacedLine], list[str]]:
    segment = an_object("ACLineSegment", "_s", **attributes)
    found = read_segments(pieces(file(segment, *objects)), None, 100_000, 100_000)
    return list(found.lines), found.notes.sentences()


def test_positions_come_in_the_order_of_their_numbers() -> None:
    points = [point("10", "14.0", "50.006", "7"), point("9", "14.0", "50.003", "5"), point("1", "14", "50", "1")]
    found, _ = read(WGS84, PLACE, *points)
    assert [line.geometry and line.geometry["coordinates"] for line in found] == [
        [[14.0, 50.0, 1.0], [14.0, 50.003, 5.0]],
        [[14.0, 50.003, 5.0], [14.0, 50.006, 7.0]],
    ]


def test_heights_of_some_positions_are_left_out() -> None:
    (line,), _ = read(WGS84, PLACE, point("1", "14", "50", "1"), point("2", "14", "50.003"))
    assert line.geometry == {"type": "LineString", "coordinates": [[14.0, 50.0], [14.0, 50.003]]}


def test_a_location_may_be_that_of_the_asset_or_named_by_the_segment() -> None:
    place = an_object("Location", "_l", Location__CoordinateSystem="#_c")
    asset = an_object("Asset", "_a", Asset__PowerSystemResources="#_s", Asset__Location="#_l")
    for found, _ in (
        read(WGS84, place, asset, point("1", "14", "50")),
        read(WGS84, place, point("1", "14", "50"), PowerSystemResource__Location="#_l"),
    ):
        assert found[0].geometry == {"type": "Point", "coordinates": [14.0, 50.0]}


@pytest.mark.parametrize(
    ("objects", "words"),
    [
        ([PLACE], "without a CoordinateSystem"),
        ([PLACE, an_object("CoordinateSystem", "_c", CoordinateSystem__crsUrn="local")], "in 'local' were not read"),
        ([PLACE, WGS84, point("2", "458000", "50")], "no longitudes and latitudes"),
        ([PLACE, WGS84, point("2", "east", "50")], "no longitudes and latitudes"),
        ([PLACE, WGS84, point("2", "nan", "50")], "no longitudes and latitudes"),
    ],
)
def test_places_that_cannot_be_read_are_noted(objects: list[str], words: str) -> None:
    (line,), notes = read(*objects, point("1", "14", "50"))
    assert line.geometry is None
    assert words in notes[0]
