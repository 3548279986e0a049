import re
from xml.etree import ElementTree

from app.plots.canvas.svg import tidied

MARKS = "\n".join(
    f'   <use xlink:href="#m0123456789" x="{x}.123456" y="2.5" style="fill: #ff0000"/>' for x in range(20)
)
GIVEN = f"""<?xml version="1.0" encoding="utf-8" standalone="no"?>
<svg xmlns:xlink="http://www.w3.org/1999/xlink" width="75pt" height="60.5pt" viewBox="0 0 75 60.5" version="1.1">
 <metadata>
  <date/>
 </metadata>
 <defs>
  <style type="text/css">*{{stroke-linejoin: round}}</style>
 </defs>
 <g id="figure_1">
  <g id="patch_1">
   <path d="M 0.123456 60.5
L 75.000000 60.5
z
" style="fill: #ffffff"/>
  </g>
  <g id="text_1">
   <!-- name -->
   <text style="font-size: 9px; font-family: 'DejaVu Sans'" x="1.23456" y="2" transform="rotate(-0 1 2)">a &lt;b</text>
  </g>
  <g id="line2d_1">
   <defs>
    <path id="m0123456789" d="M 0 1 L 1 0" style="fill: #ff0000"/>
   </defs>
   <g>
{MARKS}
   </g>
  </g>
 </g>
</svg>
"""


def test_it_has_title_description_size_and_real_text() -> None:
    root = ElementTree.fromstring(tidied(GIVEN, "A & B", "What", 2.0))
    assert (root.get("width"), root.get("height"), root.get("viewBox")) == ("200", "161.333", "0 0 75 60.5")
    assert [child.text for child in root[:2]] == ["A & B", "What"]
    assert root.get("role") == "img"
    (text,) = root.iter("{http://www.w3.org/2000/svg}text")
    assert (text.text, text.get("x"), text.get("transform")) == ("a <b", "1.23", None)
    assert "sans-serif" in str(root.get("font-family"))


def test_paths_are_rounded_and_groups_without_a_look_are_gone() -> None:
    svg = tidied(GIVEN, "x", "y", 1.0)
    assert 'd="M0.12 60.5 75 60.5z"' in svg
    assert "<g" not in svg
    assert "metadata" not in svg


def test_many_markers_stand_along_one_path() -> None:
    svg = tidied(GIVEN, "x", "y", 1.0)
    assert "<use" not in svg
    marked = re.search(r'<path d="M([^"]*)" style="fill: none; marker: url\(#(\S+)\)"/>', svg)
    assert marked is not None
    assert marked[1].split()[:4] == ["0.12", "2.5", "1.12", "2.5"]
    assert f'<marker id="{marked[2]}"' in svg


def test_names_differ_between_pictures() -> None:
    one, other = (
        set(re.findall(r'id="([^"]*)"', tidied(text, "x", "y", 1.0))) for text in (GIVEN, GIVEN.replace("75", "76"))
    )
    assert one
    assert not one & other
