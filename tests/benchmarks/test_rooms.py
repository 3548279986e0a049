"""The picture of the packages: it shows each of them, and no two boxes overlap."""

from xml.etree import ElementTree

from benchmarks import rooms

OUTSIDE = {"app.data", "app.vendor"}  # they hold no Python


def test_every_package_and_every_module_at_the_door_has_a_box() -> None:
    shown = {box.room.name for box in rooms.boxes(rooms.ROOT)}
    for top in rooms.COLUMNS:
        inside = {f"{top}.{path.stem}" for path in (rooms.ROOT / top).iterdir() if not path.stem.startswith("_")}
        assert inside - OUTSIDE <= shown


def test_each_box_has_a_head() -> None:
    heads = {box.room.name: box.room.head for box in rooms.boxes(rooms.ROOT)}
    assert len(heads) > 30
    assert [name for name, head in heads.items() if not head] == []


def test_boxes_do_not_overlap() -> None:
    placed = rooms.boxes(rooms.ROOT)
    for one in placed:
        for other in placed:
            beside = one.x + one.width <= other.x or other.x + other.width <= one.x
            below = one.y + one.height <= other.y or other.y + other.height <= one.y
            assert one is other or beside or below


def test_the_picture_is_svg_and_each_importer_of_the_engine_has_an_arrow() -> None:
    picture = ElementTree.fromstring(rooms.picture(rooms.ROOT))
    assert picture.tag.endswith("svg")
    assert len(picture.findall("{*}polygon")) == len(rooms.BORDER)


def test_the_stored_picture_is_the_one_of_this_tree() -> None:
    assert rooms.PICTURE.read_text() == rooms.picture(rooms.ROOT), "draw it with `python -m benchmarks.rooms`"
