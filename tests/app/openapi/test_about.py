from pathlib import Path

from app.openapi import about
from tests.app.service import sqlite_settings


def test_the_operator_is_named_as_the_settings_say(tmp_path: Path) -> None:
    assert about(sqlite_settings(tmp_path))["contact"] == {"name": "The operator of this service"}
    named = sqlite_settings(tmp_path, contact_name="North Grid", contact_email="lines@north.example")
    assert about(named)["contact"] == {"name": "North Grid", "email": "lines@north.example"}
