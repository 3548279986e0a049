"""The examples for operators in docs/examples/: held against the schemas and tools that their readers use."""

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import kubernetes_validate
import pytest
import yaml
from prometheus_client.parser import text_string_to_metric_families

from app.convert import ENGINE_VERSION
from app.main import create_app
from app.operation import metrics
from app.runtime.settings import Settings
from app.runtime.version import SERVICE_VERSION
from app.storage.migration import migrate
from tests.app import service

EXAMPLES = Path(__file__).parents[2] / "docs" / "examples"
MONITORING = EXAMPLES / "monitoring"
NAME = re.compile(r"\b(?:galloping|process)_[a-z_]+\b")
SUFFIXES = ("", "_bucket", "_count", "_sum", "_total", "_info")


@pytest.fixture(scope="module")
def objects() -> list[dict[str, Any]]:
    listed = yaml.safe_load((EXAMPLES / "kubernetes" / "galloping.yaml").read_text())
    assert listed["kind"] == "List"
    return list(listed["items"])


def test_kubernetes_knows_every_field_of_the_manifests(objects: list[dict[str, Any]]) -> None:
    assert {one["kind"] for one in objects} >= {"Deployment", "Job", "Secret", "Service"}
    for one in objects:
        kubernetes_validate.validate(one, "1.32", strict=True)


def test_pods_have_no_privileges_and_limits_and_the_settings_that_are_there(objects: list[dict[str, Any]]) -> None:
    pods = [one["spec"]["template"]["spec"] for one in objects if one["kind"] in {"Deployment", "Job"}]
    assert len(pods) == 3
    for pod in pods:
        (container,) = pod["containers"]
        assert pod["securityContext"]["runAsNonRoot"] and container["securityContext"]["readOnlyRootFilesystem"]
        assert container["resources"]["limits"]["memory"]
        assert container["image"] == f"galloping:{SERVICE_VERSION}"
    (settings,) = [one["data"] for one in objects if one["kind"] == "ConfigMap"]
    (secret,) = [one["stringData"] for one in objects if one["kind"] == "Secret"]
    files = {name: Path(value).name for name, value in settings.items() if name.endswith("_FILE")}
    assert set(files.values()) == set(secret)
    known = {name.upper() for name in Settings.model_fields}
    assert {name.removeprefix("GALLOPING_").removesuffix("_FILE") for name in settings} <= known


@pytest.mark.parametrize("unit", ["api", "migrate", "worker"])
def test_systemd_takes_the_units(unit: str, tmp_path: Path) -> None:
    analyze = shutil.which("systemd-analyze")
    if analyze is None:
        pytest.skip("systemd-analyze is not installed")
    for path in (EXAMPLES / "systemd").iterdir():
        text = path.read_text().replace("/opt/galloping/bin/galloping", sys.executable)
        (tmp_path / path.name).write_text(text)
    found = subprocess.run(
        [analyze, "verify", "--man=no", str(tmp_path / f"galloping-{unit}.service")],
        capture_output=True,
        text=True,
        timeout=60.0,
        check=False,
    )
    assert (found.returncode, found.stderr) == (0, "")


def test_rules_and_dashboard_name_only_metrics_that_are_there(tmp_path: Path) -> None:
    settings = service.sqlite_settings(tmp_path)
    migrate(settings)
    state = create_app(settings).state
    state.requests.observe("GET", "/v1/jobs", 200, 0.1)
    text, _ = metrics.text(state.requests, state.readers, "text/plain")
    families = {family.name for family in text_string_to_metric_families(text.decode())}
    there = {family + suffix for family in families for suffix in SUFFIXES}
    rules = yaml.safe_load((MONITORING / "alerts.yml").read_text())["groups"][0]["rules"]
    dashboard = json.loads((MONITORING / "dashboard.json").read_text())
    expressions = [rule["expr"] for rule in rules]
    expressions += [target["expr"] for panel in dashboard["panels"] for target in panel["targets"]]
    assert len(expressions) > 20
    assert {name for one in expressions for name in NAME.findall(one)} <= there
    assert ENGINE_VERSION in text.decode()


@pytest.mark.parametrize(
    "arguments",
    [
        ("check", "rules", "alerts.yml"),
        ("test", "rules", "alerts_test.yml"),
        ("check", "config", "--syntax-only", "prometheus.yml"),
    ],
)
def test_promtool_takes_the_rules(arguments: tuple[str, ...]) -> None:
    promtool = shutil.which("promtool")
    if promtool is None:
        pytest.skip("promtool is not installed")
    checked = subprocess.run(
        [promtool, *arguments], cwd=MONITORING, capture_output=True, text=True, timeout=60.0, check=False
    )
    assert checked.returncode == 0, checked.stdout + checked.stderr
