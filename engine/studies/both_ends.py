"""A line as seen from both ends: motions are observed at the first antinode, and a device may leave another one larger.

The mirror image of a line moves as the line does, and is observed at the other end.
"""

import math
from collections.abc import Sequence
from dataclasses import replace

from engine.arrays import placed
from engine.result import Result
from engine.spec import Analysis, Device, IceSegment, Line, PointDevice, StretchDevice
from engine.uncertainty.outcomes import SampleOutcome, State
from engine.uncertainty.runs import analysed

Views = tuple[Result, ...]
"""The result of a line, and that of its mirror image if it is not its own."""
ALIKE = 1e-6  # of the span: places nearer than this are the same


def mirrored(line: Line) -> Line:
    """Return the mirror image of a single span, with those of its phases."""
    length = line.span.length
    segments = tuple(_mirrored_segment(segment, length) for segment in reversed(line.ice.segments))
    profile = tuple((length - position, factor) for position, factor in reversed(line.wind.profile))
    phases = tuple(replace(phase, line=None if phase.line is None else mirrored(phase.line)) for phase in line.phases)
    return replace(
        line,
        span=replace(line.span, level_difference=-line.span.level_difference),
        supports=replace(line.supports, left=line.supports.right, right=line.supports.left),
        ice=replace(line.ice, segments=segments),
        wind=replace(line.wind, profile=profile),
        devices=tuple(_mirrored_device(device, length) for device in line.devices),
        phases=phases,
    )


def is_symmetric(line: Line) -> bool:
    """Return whether ice, wind and devices are those of the mirror image; a section counts as its own image."""
    return line.section is not None or _places(line) == _places(mirrored(line))


def views(lines: Sequence[Line], analysis: Analysis) -> list[Views | State]:
    """Analyse lines, and the mirror images of those that are not symmetric, as one stack."""
    seen_twice = [not is_symmetric(line) for line in lines]
    images = [mirrored(line) for line, twice in zip(lines, seen_twice, strict=True) if twice]
    results = analysed([*lines, *images], analysis)
    found: list[Views | State] = []
    for own, other in zip(results[: len(lines)], placed(results[len(lines) :], seen_twice), strict=True):
        pair = (own,) if other is None else (own, other)
        both = tuple(one for one in pair if isinstance(one, Result))
        found.append(both if len(both) == len(pair) else State.UNKNOWN)
    return found


def larger(one: SampleOutcome, other: SampleOutcome) -> SampleOutcome:
    """Return the outcome of a sample that was seen from both ends: the one that moves more, or has no answer."""
    sizes = [math.hypot(*each.overall.amplitudes[:2]) for each in (one, other)]
    return other if math.isnan(sizes[1]) or sizes[1] > sizes[0] else one


def _places(line: Line) -> set[tuple[object, ...]]:
    """Return what stands where, places rounded."""
    grain = ALIKE * line.span.length
    devices: list[tuple[object, ...]] = []
    for device in line.devices:
        if isinstance(device, PointDevice):
            devices.append((round(device.position / grain), replace(device, position=0.0)))
        else:
            ends = (round(device.start / grain), round(device.stop / grain))
            devices.append((*ends, replace(device, start=0.0, stop=1.0)))
    segments = [
        (round(s.start / grain), round(s.stop / grain), replace(s, start=0.0, stop=1.0)) for s in line.ice.segments
    ]
    profile = [(round(position / grain), factor) for position, factor in line.wind.profile]
    return {*devices, *segments, *profile}


def _mirrored_segment(segment: IceSegment, length: float) -> IceSegment:
    return replace(segment, start=max(length - segment.stop, 0.0), stop=length - segment.start)


def _mirrored_device(device: Device, length: float) -> Device:
    if isinstance(device, StretchDevice):
        return replace(device, start=max(length - device.stop, 0.0), stop=length - device.start)
    return replace(device, position=max(length - device.position, 0.0))
