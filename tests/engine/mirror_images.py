"""The mirror image of a line, which moves as the line does."""

from dataclasses import replace

from engine.spec import Device, IceSegment, Line, StretchDevice


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


def _mirrored_segment(segment: IceSegment, length: float) -> IceSegment:
    return replace(segment, start=max(length - segment.stop, 0.0), stop=length - segment.start)


def _mirrored_device(device: Device, length: float) -> Device:
    if isinstance(device, StretchDevice):
        return replace(device, start=max(length - device.stop, 0.0), stop=length - device.start)
    return replace(device, position=max(length - device.position, 0.0))
