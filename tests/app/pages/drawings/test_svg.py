from xml.etree import ElementTree

from app.pages.drawings.svg import element, path, picture


def test_what_comes_from_outside_is_escaped() -> None:
    drawn = picture((10.0, 5.5), 'a "name" <script>', [element("text", "<b>", x=1 / 3, class_="x")], "drawing", "about")
    root = ElementTree.fromstring(drawn)
    assert root.get("aria-label") == 'a "name" <script>'
    assert [child.tag for child in root] == ["title", "desc", "text"]
    assert root[2].text == "<b>"
    assert root[2].get("x") == "0.333333"
    assert root.get("viewBox") == "0 0 10 5.5"


def test_paths_go_through_their_points() -> None:
    assert path([(0.0, 1.0), (2.5, 3.25)]) == "M0.00 1.00L2.50 3.25"
    assert path([(0.0, 1.0), (2.5, 3.25)], closed=True).endswith("Z")
