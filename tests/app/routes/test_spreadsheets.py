"""Spreadsheets as programs of several countries save them, posted as batches."""

import csv
import io
import json
from collections.abc import Iterator
from datetime import date
from pathlib import Path
from typing import Any
from uuid import UUID

import httpx
import openpyxl
import pytest

from app.export.formats import XLSX
from app.runtime.settings import Settings
from tests.app import service
from tests.app.lines import SHORT
from tests.app.service import work_off
from tests.in_process import run_job

CASES = Path(__file__).parents[1] / "sheets" / "cases"
PLAIN = (CASES / "elements_10_0.csv").read_text()


@pytest.fixture
def client(settings: Settings) -> Iterator[httpx.Client]:
    with service.running(settings) as running:
        yield running


def post(client: httpx.Client, body: bytes, media_type: str = "text/csv", **query: str) -> httpx.Response:
    parameters = {"analysis": json.dumps(SHORT), **query}
    return client.post("/v1/batches", params=parameters, content=body, headers={"Content-Type": media_type})


def again(delimiter: str, decimal_comma: bool, rows: int = 1) -> str:
    """Write the plain case with another delimiter and decimal commas."""
    header, row = csv.reader(io.StringIO(PLAIN))
    buffer = io.StringIO()
    writer = csv.writer(buffer, delimiter=delimiter)
    writer.writerow(header)
    for _ in range(rows):
        writer.writerow([row[0], *(cell.replace(".", ",") if decimal_comma else cell for cell in row[1:])])
    return buffer.getvalue()


def stored(client: httpx.Client, settings: Settings, answer: httpx.Response) -> list[dict[str, Any]]:
    assert answer.status_code == 202, answer.text
    work_off(client, settings, answer.headers["location"])
    text = client.get(f"{answer.headers['location']}/results").text
    return [json.loads(line) for line in text.splitlines()]


def test_truth_and_whole_numbers_are_taken_as_excel_writes_them(client: httpx.Client) -> None:
    for name in ("excel_true", "elements_10_0"):
        answer = post(client, (CASES / f"{name}.csv").read_bytes(), atomic="true")
        assert (answer.status_code, answer.json()["notes"]) == (202, []), answer.text


def test_one_odd_byte_is_told_of_and_its_row_runs(client: httpx.Client) -> None:
    raw = (CASES / "one_latin1_byte.csv").read_bytes()
    answer = post(client, raw, atomic="true")
    rows = len(raw.strip().splitlines()) - 1
    assert (answer.status_code, answer.json()["lines"]["accepted"]) == (202, rows), answer.text
    (note,) = answer.json()["notes"]
    assert "not UTF-8; read as Windows-1252" in note
    assert client.get(answer.headers["location"]).json()["notes"] == [note]


def test_a_european_sheet_has_the_same_results(client: httpx.Client, settings: Settings) -> None:
    (plain,) = stored(client, settings, post(client, PLAIN.encode()))
    answer = post(client, again(";", decimal_comma=True).encode("utf-16"), atomic="true")
    assert answer.json()["notes"] == [
        "Cells are separated by semicolons.",
        "Decimal commas were read as decimal points.",
        "The text was read as UTF-16.",
    ]
    (found,) = stored(client, settings, answer)
    assert client.get(answer.headers["location"]).json()["lines"]["reused"] == 1  # the same input to the last digit
    assert (found["limit_cycles"], found["static"]) == (plain["limit_cycles"], plain["static"])


def test_faults_have_the_number_that_the_spreadsheet_shows(client: httpx.Client) -> None:
    header, first, second, third = again("\t", decimal_comma=True, rows=3).splitlines()
    second = second.replace("125,88", "1.125,88")
    third = third.replace("30000,0", "-1")
    body = "\r\n".join([header, "", first, "\t\t", second, third, ""])
    answer = post(client, body.encode())
    assert answer.status_code == 202, answer.text
    found = [(error["number"], error["row"], error["pointer"]) for error in answer.json()["errors"]]
    assert found == [(2, 5, "/span/length_m"), (3, 6, "/span/horizontal_tension_n")]
    assert answer.json()["errors"][0]["reference"] == "A1"  # a row keeps its reference beside a wrong cell
    refused = post(client, body.encode(), atomic="true")
    assert [error["detail"][:6] for error in refused.json()["errors"]] == ["row 5:", "row 6:"]


def test_a_job_may_come_with_a_mark_or_in_utf16(client: httpx.Client) -> None:
    for encoding in ("utf-8-sig", "utf-16"):
        line = json.loads((CASES / "utf8_bom.json").read_text("utf-8-sig"))
        body = json.dumps({"line": line, "analysis": SHORT}).encode(encoding)
        answer = client.post("/v1/jobs", content=body, headers={"Content-Type": "application/json"})
        assert answer.status_code in {200, 202}, answer.text


def workbook(rows: list[list[Any]]) -> bytes:
    book = openpyxl.Workbook()
    sheet = book.active
    assert sheet is not None
    for row in rows:
        sheet.append(row)
    file = io.BytesIO()
    book.save(file)
    return file.getvalue()


def test_a_workbook_has_the_same_results_and_gets_a_workbook(client: httpx.Client, settings: Settings) -> None:
    sixteen_digits = PLAIN.replace("28418105.783999998", "28418105.784")  # openpyxl writes no more
    (plain,) = stored(client, settings, post(client, sixteen_digits.encode()))
    header, row = csv.reader(io.StringIO(sixteen_digits))
    values = [float(cell) if cell[:1].isdigit() or cell[:1] == "-" else cell for cell in row]
    values[header.index("ice.eccentricity_z_m")] = "-0,00063"  # text, as in a sheet of another country
    wrong = [date(2026, 5, 1) if name == "span.length_m" else value for name, value in zip(header, values, strict=True)]
    answer = post(client, workbook([list(header), values, [], wrong]), XLSX)
    (error,) = answer.json()["errors"]
    assert (error["row"], error["pointer"], error["code"]) == (4, "/span/length_m", "csv_value")
    first, _ = stored(client, settings, answer)
    assert client.get(answer.headers["location"]).json()["lines"]["reused"] == 1
    assert first["limit_cycles"] == plain["limit_cycles"]
    address = f"{answer.headers['location']}/results"
    found = client.get(address, params={"format": "xlsx"})
    assert found.headers["content-type"] == XLSX
    book = openpyxl.load_workbook(io.BytesIO(found.content))
    assert book.sheetnames == ["summary", "columns"]
    names, solved, rejected = book["summary"].iter_rows(values_only=True)
    told = dict(zip(names, solved, strict=True))
    wanted = json.loads(client.get(address, params={"table": "summary"}).text.splitlines()[0])
    assert told["reference"] == "A1" and told["onset_m_per_s"] == pytest.approx(wanted["onset_m_per_s"], rel=1e-15)
    assert told["sentence"] == wanted["sentence"]
    assert dict(zip(names, rejected, strict=True))["status"] == "rejected"


def test_tables_of_a_job_come_as_workbooks(client: httpx.Client, settings: Settings) -> None:
    line = json.loads((CASES / "utf8_bom.json").read_text("utf-8-sig"))
    answer = client.post("/v1/jobs", json={"line": line, "analysis": SHORT})
    run_job(settings, UUID(answer.json()["id"]))
    address = f"{answer.headers['location']}/results/limit-cycles"
    found = client.get(address, headers={"Accept": XLSX})
    assert (found.status_code, found.headers["content-type"]) == (200, XLSX)
    names, *rows = openpyxl.load_workbook(io.BytesIO(found.content))["limit_cycles"].iter_rows(values_only=True)
    wanted = client.get(address).json()["limit_cycles"]
    assert len(rows) == len(wanted) > 0
    for row, other in zip(rows, wanted, strict=True):
        assert dict(zip(names, row, strict=True)) == {
            name: pytest.approx(value, rel=1e-14) if isinstance(value, float) else value
            for name, value in other.items()
        }


def test_what_is_no_workbook_is_refused(client: httpx.Client) -> None:
    answer = post(client, b"reference,name\n", XLSX)
    assert (answer.status_code, answer.json()["errors"][0]["code"]) == (422, "xlsx_invalid")
