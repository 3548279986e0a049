"""Answers about quotas."""

from app.schemas.fields import Answer, described, example_of


class QuotaUse(Answer):
    """How much of a quota an owner uses."""

    used: int = described("How much the owner has [1]", 12)
    most: int | None = described("The most that the owner may have, null for any number [1]", 200_000)


class QuotaDocument(Answer):
    """What an owner has, and may have."""

    running_jobs: QuotaUse = described("Jobs and chunks of batches that run", {"used": 2, "most": None})
    waiting_jobs: QuotaUse = described("Jobs and chunks of batches that wait", example_of(QuotaUse))
    stored_bytes: QuotaUse = described(
        "Bytes of requests and results, with those that results of waiting and running jobs are expected to take",
        {"used": 1_204_500_000, "most": 100_000_000_000},
    )
    expected_bytes: int = described("The part of them that results of waiting and running jobs may take [1]", 90_000)
