"""How many samples of what is assumed are analysed beside a line."""

from dataclasses import dataclass

from engine.outcome import Fault, require

MOST_SAMPLES = 16_384


@dataclass(frozen=True, slots=True)
class Uncertainty:
    """Number of samples, 0 for none, and their seed."""

    samples: int = 64
    seed: int = 1

    def __post_init__(self) -> None:
        """Check that neither is negative, and that the samples are not too many."""
        require(
            None
            if 0 <= self.samples <= MOST_SAMPLES
            else Fault("uncertainty.samples", self.samples, f"must be from 0 to {MOST_SAMPLES}"),
            None if self.seed >= 0 else Fault("uncertainty.seed", self.seed, "must not be negative"),
        )
