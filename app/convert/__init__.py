"""The border to the engine: JSON documents in, plain rows out. Units change here and nowhere else."""

from app.convert.check import read, request_faults, with_further_faults
from app.convert.clearance import EllipseMethodName, clearances, ellipse
from app.convert.fit import fit
from app.convert.mode_shapes import mode_shapes
from app.convert.run import TABLES, Advance, PointResult, Table, columns, run
from app.convert.stack import STACK, NumberedLine, read_analysis, read_line, run_stack, seconds_a_line
from engine import ENGINE_VERSION

__all__ = [
    "ENGINE_VERSION",
    "STACK",
    "TABLES",
    "Advance",
    "EllipseMethodName",
    "NumberedLine",
    "PointResult",
    "Table",
    "clearances",
    "columns",
    "ellipse",
    "fit",
    "mode_shapes",
    "read",
    "read_analysis",
    "read_line",
    "request_faults",
    "run",
    "run_stack",
    "seconds_a_line",
    "with_further_faults",
]
