"""Lines from GIS and CIM files for commands that work on one line."""

import json
from pathlib import Path

from tests.app.command_line import galloping, refused

EXAMPLES = Path(__file__).parents[3] / "docs" / "examples"
SPANS = json.loads((EXAMPLES / "spans.geojson").read_text())


def test_a_feature_and_a_segment_are_resolved_like_a_line(tmp_path: Path) -> None:
    feature, defaults, segment = tmp_path / "span.geojson", tmp_path / "defaults.json", tmp_path / "span.xml"
    feature.write_text(json.dumps(SPANS["features"][0]))
    defaults.write_text(json.dumps(SPANS["defaults"]))
    ended = galloping("resolve", str(feature), "--defaults", str(defaults))
    assert ended.returncode == 0, ended.stderr
    line = json.loads(ended.stdout)["line"]
    assert (round(line["span"]["length_m"], 2), line["span"]["level_difference_m"]) == (306.94, 6.5)
    assert "span.length_m: 306.941 m, distance of its coordinates" in ended.stderr
    head, _, rest = (EXAMPLES / "segments.xml").read_text().partition('  <cim:ACLineSegment rdf:ID="_segment-18">')
    segment.write_text(head + "</rdf:RDF>")
    assert rest
    defaults.write_text(json.dumps({name: SPANS["defaults"][name] for name in ("span", "ice")}))
    ended = galloping("resolve", str(segment), "--defaults", str(defaults))
    assert ended.returncode == 0, ended.stderr
    assert json.loads(ended.stdout)["line"]["span"]["length_m"] == 305.5
    assert "in metres, as CIM declares it" in ended.stderr


def test_files_with_several_lines_or_wrong_ones_end_the_command(tmp_path: Path) -> None:
    several = refused("analyse", str(EXAMPLES / "spans.geojson"))
    assert "has 5 lines (feature 1, feature 2, span 1," in several
    wrong = tmp_path / "wrong.geojson"
    wrong.write_text(json.dumps({**SPANS["features"][0], "geometry": {"type": "Polygon"}}))
    assert "/geometry/type: must be LineString or Point" in refused("resolve", str(wrong))
    defaults = tmp_path / "defaults.json"
    defaults.write_text('{"icee": {}}')
    wrong.write_text(json.dumps(SPANS["features"][0]))
    assert "/defaults/icee: unknown field" in refused("resolve", str(wrong), "--defaults", str(defaults))
    (tmp_path / "line.json").write_text("{}")
    assert "/defaults/icee" in refused("resolve", str(tmp_path / "line.json"), "--defaults", str(defaults))
    (tmp_path / "a.xml").write_text("<a/>")
    assert "must be RDF/XML" in refused("resolve", str(tmp_path / "a.xml"))
