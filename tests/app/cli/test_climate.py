import json
from pathlib import Path

from tests.app.command_line import galloping

TABLE = """time,wind_speed_m_per_s,wind_direction_deg,ice_load_kg_per_m
2026-01-01T00:00,5,270,0
2026-01-01T01:00,6,270,0.5
"""


def test_the_climate_of_a_weather_record_is_printed(tmp_path: Path) -> None:
    sheet = tmp_path / "weather.csv"
    sheet.write_text(TABLE)
    ended = galloping("climate", str(sheet), "--line-azimuth-deg", "0")
    assert ended.returncode == 0
    (winds,) = json.loads(ended.stdout)["climate"]["record"]["events"]
    assert winds == [6.0]
    sheet.write_text(TABLE.replace(",6,", ",fast,"))
    refused = galloping("climate", str(sheet), "--line-azimuth-deg", "0")
    assert refused.returncode == 2
    assert "/rows/3/wind_speed_m_per_s" in refused.stderr
    assert "cannot be read" in galloping("climate", str(tmp_path / "no.csv"), "--line-azimuth-deg", "0").stderr
