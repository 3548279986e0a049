from dataclasses import replace

from app.pages.measures import FEET, SI
from app.pages.reports import Material, report_html
from app.reference.source_lines import example


def made(material: Material, units: object = SI) -> str:
    return report_html(material, units, lambda name: f"/{name}.svg", "/report.css")  # type: ignore[arg-type]


def test_the_verdict_comes_first_then_line_results_and_method(material: Material) -> None:
    text = made(material)
    verdict = material.found.verdict
    assert verdict is not None
    parts = [
        SI.sentence(verdict["sentence"]),
        "The line and what is assumed",
        "Assumed values",
        "/amplitude.svg",
        "Limits",
    ]
    places = [text.index(part) for part in parts]
    assert places == sorted(places)
    assert "2026-01-31" in text


def test_every_assumed_value_has_its_range_and_source(material: Material) -> None:
    text = made(material)
    assumed = [row for row in material.found.rows("assumptions") if row["origin"] == "assumed"]
    assert text.count('<tr class="assumed">') == len(assumed) > 5
    for row in assumed:
        assert row["source"].split("&")[0].split("'")[0][:40] in text


def test_units_are_those_of_the_reader(material: Material) -> None:
    assert "mph" in made(material, FEET)
    assert "mph" not in made(material)


def test_names_cannot_bring_markup(material: Material) -> None:
    named = replace(material, name='<script src="http://example.org/"></script>')
    assert "<script" not in made(named)


def test_an_explicit_line_shows_all_its_fields(material: Material) -> None:
    tables = {name: rows for name, rows in material.found.tables.items() if name != "assumptions"}
    line = example("c11-twin")
    explicit = replace(material, found=replace(material.found, tables=tables, line=line))
    text = made(explicit)
    assert "ice.aerodynamics.vertical" in text
    assert "-0.1667, -4.0547, 8.3581" in text
    assert f"{line['span']['horizontal_tension_n']:.6g}" in text


def test_long_tables_are_cut_and_say_so(material: Material) -> None:
    cycles = [row for row in material.found.rows("limit_cycles") if row["kind"] == "periodic"][:1] * 100
    found = replace(material.found, tables={**material.found.tables, "limit_cycles": cycles})
    assert "The first 60 of 100 rows" in made(replace(material, found=found, motions=[]))


def test_devices_of_the_line_are_named_beside_their_marks(material: Material) -> None:
    devices = [{"type": "spacer", "position_m": 10.0}] * 2
    found = replace(material.found, line={**material.found.line, "devices": devices})
    assert "Spacer: 2" in made(replace(material, found=found))
    assert "Spacer" not in made(material)
