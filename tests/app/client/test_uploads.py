import csv
import gzip
import io
import json
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from app.client.uploads import Upload, as_json, frame, opened
from app.reference.source_lines import example
from app.schemas import Analysis, Line

ANALYSIS = {"loops": [1]}


def sent(lines: Any, analysis: dict[str, Any]) -> tuple[bytes, Upload]:
    with opened(lines, analysis) as upload:
        upload.file.seek(0)
        return upload.file.read(), upload


def test_lines_become_ndjson_behind_their_analysis() -> None:
    line = Line.model_validate(example("c11-twin"))
    body, upload = sent([line, {"reference": "é"}], ANALYSIS)
    assert [json.loads(text) for text in body.splitlines()] == [
        {"analysis": ANALYSIS},
        line.model_dump(mode="json", by_alias=True, exclude_unset=True),
        {"reference": "é"},
    ]
    assert (upload.headers, upload.query(atomic=True)) == ({"Content-Type": "application/x-ndjson"}, "atomic=true")


def test_a_data_frame_becomes_csv_with_its_analysis_in_the_address() -> None:
    body, upload = sent(pd.DataFrame({"reference": ["a"], "span.length_m": [90.0]}), ANALYSIS)
    assert body == b"reference,span.length_m\na,90.0\n"
    assert upload.headers == {"Content-Type": "text/csv"}
    assert upload.query(atomic=False) == "analysis=%7B%22loops%22%3A+%5B1%5D%7D"


def test_arrays_in_cells_are_sent_as_lists() -> None:
    device = {"type": "spacer", "position_m": np.float64(25.0)}
    nested = {"devices": np.array([device]), "ice.aerodynamics.vertical": np.array([1.0, -2.0]), "bundle.x": (1, 2)}
    body, _ = sent(pd.DataFrame([{"reference": "a", **nested}, {"reference": "b"}]), ANALYSIS)
    first, second = csv.DictReader(io.StringIO(body.decode()))
    assert json.loads(first["devices"]) == [device]
    assert json.loads(first["ice.aerodynamics.vertical"]) == [1.0, -2.0]
    assert json.loads(first["bundle.x"]) == [1, 2]
    assert list(second.values()) == ["b", "", "", ""]


@pytest.mark.parametrize(
    ("name", "headers"),
    [
        ("a.csv", {"Content-Type": "text/csv"}),
        ("a.b.jsonl", {"Content-Type": "application/x-ndjson"}),
        ("a.json.gz", {"Content-Type": "application/json", "Content-Encoding": "gzip"}),
        ("a.GeoJSON", {"Content-Type": "application/geo+json"}),
        ("a.xml", {"Content-Type": "application/rdf+xml"}),
        ("a.rdf.gz", {"Content-Type": "application/rdf+xml", "Content-Encoding": "gzip"}),
    ],
)
def test_a_file_is_sent_as_it_is_under_the_type_of_its_name(tmp_path: Path, name: str, headers: dict[str, str]) -> None:
    content = gzip.compress(b"{}") if name.endswith(".gz") else b"{}"
    (tmp_path / name).write_bytes(content)
    body, upload = sent(tmp_path / name, {})
    assert (body, upload.headers) == (content, headers)


def test_what_was_set_is_sent_and_defaults_are_left_to_the_service() -> None:
    assert as_json(Analysis(loops=[2])) == {"loops": [2]}
    assert as_json({"loops": [2]}) == {"loops": [2]}


def test_rows_become_a_frame_in_their_order() -> None:
    made = frame(row for row in ({"number": 2, "sag_m": 1.5}, {"number": 1, "sag_m": None}))
    assert made["number"].tolist() == [2, 1]
    assert made["sag_m"].isna().tolist() == [False, True]


def test_defaults_go_where_the_analysis_goes(tmp_path: Path) -> None:
    defaults = {"ice": {"x": 1}}
    with opened([{"name": "a"}], ANALYSIS, defaults) as upload:
        upload.file.seek(0)
        assert json.loads(upload.file.readline()) == {"analysis": ANALYSIS, "defaults": defaults}
    for name in ("a.geojson", "a.csv", "a.xml"):
        (tmp_path / name).write_bytes(b"")
        with opened(tmp_path / name, ANALYSIS, defaults) as upload:
            assert upload.parameters == {"analysis": json.dumps(ANALYSIS), "defaults": json.dumps(defaults)}
    with opened(tmp_path / "a.geojson", {}) as upload:
        assert upload.parameters == {}
    with pytest.raises(ValueError, match="contains its defaults"), opened(tmp_path / "a.json", {}, defaults):
        pass
