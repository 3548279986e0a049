"""The rules of a climate."""

import math
from collections.abc import Callable
from dataclasses import replace

import pytest

from engine.outcome import InvalidSpec
from engine.spec import Climate, Icing, Ranged, WindSector

SECTOR = WindSector(direction=0.0, share=1.0, shape=Ranged(2.0), scale=Ranged(6.0))
GLAZE = Icing("glaze", 0.012, hours=Ranged(40.0))
EVENTS = Icing("glaze", events=Ranged(2.0, 1.0, 3.0), event_hours=Ranged(20.0, 10.0, 40.0))


def of(*sectors: WindSector, icing: tuple[Icing, ...] = (GLAZE,)) -> Callable[[], Climate]:
    return lambda: Climate(0.0, sectors, icing)


def iced(**changes: object) -> Callable[[], Climate]:
    return of(SECTOR, icing=(replace(GLAZE, **changes),))  # type: ignore[arg-type]


def parts(*shares: float, step: float = 90.0, width: float | None = None) -> tuple[WindSector, ...]:
    turned = (math.radians(step * i) for i in range(len(shares)))
    return tuple(
        replace(SECTOR, direction=turn, share=share, width=width) for turn, share in zip(turned, shares, strict=True)
    )


@pytest.mark.parametrize(
    ("make", "field", "word"),
    [
        (of(), "climate.sectors", "must hold a sector"),
        (of(SECTOR, icing=()), "climate.icing", "must hold a kind"),
        (of(replace(SECTOR, share=0.9)), "climate.sectors", "sum to 1"),
        (of(*parts(40.0, 30.0, 20.0, 10.0)), "climate.sectors", "looks like percent: 12 % is 0.12"),
        (of(replace(SECTOR, share=-1.0)), "climate.sectors.0.share", "at least zero"),
        (of(replace(SECTOR, shape=Ranged(0.0))), "climate.sectors.0.shape", "greater than zero"),
        (of(replace(SECTOR, scale=Ranged(-6.0))), "climate.sectors.0.scale", "greater than zero"),
        (of(replace(SECTOR, scale=Ranged(6.0, 0.0))), "climate.sectors.0.scale_lowest", "greater than zero"),
        (of(replace(SECTOR, scale=Ranged(6.0, 7.0))), "climate.sectors.0.scale_lowest", "must not exceed"),
        (of(replace(SECTOR, scale=Ranged(6.0, None, 5.0))), "climate.sectors.0.scale_highest", "must reach"),
        (of(replace(SECTOR, direction=math.nan)), "climate.sectors.0.direction", "finite"),
        (of(*parts(0.5, 0.5, step=90.0)), "climate.sectors", "must have a width each"),
        (of(*parts(0.5, 0.5, width=math.radians(200.0))), "climate.sectors", "full circle"),
        (iced(thickness=0.0), "climate.icing.0.thickness", "greater than zero"),
        (iced(hours=Ranged(-1.0)), "climate.icing.0.hours", "at least zero"),
        (iced(hours=Ranged(9000.0)), "climate.icing", "longer than the year"),
        (iced(hours=None), "climate.icing.0", "must have either hours, or events with event_hours"),
        (iced(events=Ranged(2.0)), "climate.icing.0", "must have either hours, or events with event_hours"),
        (iced(hours=None, events=Ranged(2.0)), "climate.icing.0", "must have either"),
        (iced(hours=None, events=Ranged(2.0), event_hours=Ranged(0.0)), "climate.icing.0.event_hours", "greater"),
        (iced(persistence=Ranged(0.0)), "climate.icing.0.persistence", "greater than zero"),
    ],
)
def test_a_broken_rule_names_field_and_slip(make: Callable[[], Climate], field: str, word: str) -> None:
    with pytest.raises(InvalidSpec) as error:
        make()
    assert [fault.field for fault in error.value.faults if word in fault.rule] == [field]


def test_hours_of_icing_are_given_or_those_of_the_events() -> None:
    assert GLAZE.hours_a_year == Ranged(40.0)
    assert EVENTS.hours_a_year == Ranged(40.0, 10.0, 120.0)


def test_a_sector_is_as_wide_as_said_else_its_part_of_the_circle() -> None:
    climate = of(*parts(0.1, 0.2, 0.3, 0.4))()
    assert climate.width(climate.sectors[0]) == pytest.approx(0.5 * math.pi)
    narrow = of(*parts(0.5, 0.5, step=10.0, width=0.1))()
    assert narrow.width(narrow.sectors[1]) == 0.1
