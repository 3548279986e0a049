import pytest

from app.plots import Options


def test_an_option_has_its_defaults() -> None:
    assert Options() == Options("svg", "light", None, None, None, "reduced")


@pytest.mark.parametrize(("name", "value"), [("width", 239.0), ("height", 4097.0), ("width", float("nan"))])
def test_sizes_are_bounded(name: str, value: float) -> None:
    with pytest.raises(ValueError, match=f"^{name} must be between 240 and 4096 px, got "):
        Options(**{name: value})  # type: ignore[arg-type]
