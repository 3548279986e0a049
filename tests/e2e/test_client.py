"""The examples of docs/client.md, run in their order against the whole service."""

import re
from pathlib import Path
from typing import Any

import pytest

from tests.documents import hasty_settings
from tests.embedded import serving
from tests.servers import free_port

PAGE = Path(__file__).parents[2] / "docs" / "client.md"


def test_examples_of_the_page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    examples = re.findall(r"```python\n(.*?)```", PAGE.read_text(), re.DOTALL)
    assert len(examples) == 5
    names: dict[str, Any] = {}
    with serving(hasty_settings(tmp_path), free_port()) as (_, http):
        monkeypatch.setenv("GALLOPING_URL", str(http.base_url))
        for example in examples:
            exec(compile(example, str(PAGE), "exec"), names)
    assert names["result"].critical_wind_speeds[0].wind_speed_m_per_s == pytest.approx(2.40, abs=0.02)
    assert names["picture"].startswith(b"%PDF-")
    assert names["summary"]["status"].tolist() == ["successful"] * 4
    assert names["summary"]["reference"].tolist() == ["L100", "L110", "L120", "L130"]
    assert len(names["frame"]) == 4
    assert names["resolved"].line["conductor"]["rated_strength_n"] == pytest.approx(140_120.0)
    assert names["kept"][0].conductor.name == "Ours"
