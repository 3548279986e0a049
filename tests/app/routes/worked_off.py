"""Works off batches in this process, with the real engine."""

from typing import Any
from uuid import UUID

import httpx

from app.runtime.settings import Settings
from worker.execute import run_job


def chunks(client: httpx.Client, address: str, status: str = "accepted") -> list[UUID]:
    query = {"batch_id": address.rpartition("/")[2], "status": status}
    return [UUID(job["id"]) for job in client.get("/v1/jobs", params=query).json()["jobs"]]


def work_off(client: httpx.Client, settings: Settings, address: str) -> dict[str, Any]:
    for chunk in chunks(client, address):
        run_job(settings, chunk, "test")
    status: dict[str, Any] = client.get(address).json()
    return status
