"""The border to the engine: JSON documents in, plain rows out. Units change here and nowhere else."""

from app.convert.batches.costs import estimate, seconds_a_line
from app.convert.batches.sizes import bytes_a_line, expected_bytes
from app.convert.batches.stack import STACK, NumberedLine, kept_analysis, read_analysis, read_line, run_stack
from app.convert.check import read, request_faults, with_further_faults
from app.convert.clearance import EllipseMethodName, clearances, ellipse
from app.convert.fit import fit
from app.convert.known import (
    OwnRows,
    explicit_line,
    explicit_request,
    is_known_form,
    is_known_request,
    known_of,
    resolve_document,
    resolve_line,
)
from app.convert.mode_shapes import mode_shapes
from app.convert.remedies import remedies
from app.convert.run import Advance, PointResult, run
from app.convert.tables import TABLES_BY_ADDRESS, columns, example_row, example_tables
from engine import ENGINE_VERSION
from engine.result import TABLES, Column, DenHartog, StaticState, Table, Tables, columns_of

__all__ = [
    "ENGINE_VERSION",
    "STACK",
    "TABLES",
    "TABLES_BY_ADDRESS",
    "Advance",
    "Column",
    "DenHartog",
    "EllipseMethodName",
    "NumberedLine",
    "OwnRows",
    "PointResult",
    "StaticState",
    "Table",
    "Tables",
    "bytes_a_line",
    "clearances",
    "columns",
    "columns_of",
    "ellipse",
    "estimate",
    "example_row",
    "example_tables",
    "expected_bytes",
    "explicit_line",
    "explicit_request",
    "fit",
    "is_known_form",
    "is_known_request",
    "kept_analysis",
    "known_of",
    "mode_shapes",
    "read",
    "read_analysis",
    "read_line",
    "remedies",
    "request_faults",
    "resolve_document",
    "resolve_line",
    "run",
    "run_stack",
    "seconds_a_line",
    "with_further_faults",
]
