"""Cells that were copied from a sheet or a file of text, as a reader pastes them into the form."""

import re

from app.pages.lines.numbers import as_number


def pasted_cells(text: str, columns: int) -> list[list[str]]:
    """Return the cells of each line of a text; a head of the columns and empty lines are left out.

    Cells are parted by tabs, else semicolons, else spaces, else commas. A single column has one cell a line, since a
    comma in it is that of a number.
    """
    lines = [_cells(line, columns) for line in text.splitlines() if line.strip()]
    has_head = len(lines) > 1 and all(as_number(cell) is None for cell in lines[0])
    return lines[1:] if has_head else lines


def _cells(line: str, columns: int) -> list[str]:
    if columns == 1:
        return [line.strip()]
    for mark in ("\t", ";"):
        if mark in line:
            return [cell.strip() for cell in line.split(mark)]
    parted = re.split(r"[,]?\s+", line.strip())
    return parted if len(parted) > 1 else line.strip().split(",")
