import pytest

from app.pages.lines.pasted_cells import pasted_cells


@pytest.mark.parametrize(
    ("text", "columns", "cells"),
    [
        ("angle\tlift\n-5\t0,31\n0\t0,28\n", 2, [["-5", "0,31"], ["0", "0,28"]]),
        ("-5;0,31\r\n\r\n0; 0,28", 2, [["-5", "0,31"], ["0", "0,28"]]),
        (" -5   0.31\n0, 0.28", 2, [["-5", "0.31"], ["0", "0.28"]]),
        ("-5,0.31\n0,0.28", 2, [["-5", "0.31"], ["0", "0.28"]]),
        ("speed\n4,5\n5", 1, [["4,5"], ["5"]]),
        ("top\tsix\nlow\tfour", 2, [["low", "four"]]),
        ("top", 2, [["top"]]),
        (" \n", 2, []),
    ],
)
def test_cells_are_parted_as_sheets_and_files_part_them(text: str, columns: int, cells: list[list[str]]) -> None:
    assert pasted_cells(text, columns) == cells
