from typing import get_args

from app.pages.drawings.device_marks import legend, marks
from app.pages.drawings.svg import Point
from app.schemas.devices import Device

KINDS = [get_args(model.model_fields["type"].annotation)[0] for model in get_args(get_args(Device)[0])]


def place(position: float) -> Point:
    return 2.0 * position, 50.0


def device(kind: str) -> dict[str, object]:
    return (
        {"type": kind, "from_m": 10.0, "to_m": 20.0}
        if kind == "airflow_spoiler"
        else {"type": kind, "position_m": 30.0}
    )


def test_every_kind_of_device_has_a_mark_of_its_own() -> None:
    shapes = {kind: str(next(marks({"devices": [device(kind)]}, place))).partition("</title>") for kind in KINDS}
    assert len({(head.partition("<title>")[0], rest) for head, _, rest in shapes.values()}) == len(KINDS)
    assert "<title>Detuning pendulum</title>" in "".join(shapes["detuning_pendulum"])


def test_marks_stand_where_the_devices_are() -> None:
    (spacer,) = marks({"devices": [device("spacer")]}, place)
    assert 'x="55.5" y="45.5" width="9"' in spacer
    (spoiler,) = marks({"devices": [device("airflow_spoiler")]}, place)
    assert 'd="M20.00 50.00L' in spoiler
    assert 'L40.00 50.00"' in spoiler


def test_the_legend_counts_every_kind_and_pieces_of_ice() -> None:
    line = {"devices": [device("spacer"), device("spacer"), device("balloon")], "ice": {"segments": [{}, {}]}}
    assert [text for _, text in legend(line)] == ["Spacer: 2", "balloon: 1", "Stretch with ice of its own: 2"]
    assert legend({}) == []
