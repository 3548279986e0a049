"""How a computation ended, what is known of a motion's stability, and the error that a broken rule raises."""

from dataclasses import dataclass
from enum import StrEnum


class Outcome(StrEnum):
    """How one point of an analysis ended; every member carries its sentence."""

    CONVERGED = ("converged", "The equations are satisfied to the tolerance.")
    NO_CONVERGENCE = ("no_convergence", "Newton's method did not converge from any start.")
    STATICALLY_UNSTABLE = (
        "statically_unstable",
        "The static state is unstable even without wind: the ice moment exceeds the torsional stiffness.",
    )
    OUTSIDE_FIT = (
        "outside_fit",
        "The motion leaves the range of the load: the angles of attack to which the coefficients were fitted, or the "
        "velocities up to which the expanded load holds.",
    )
    BEYOND_DATA = (
        "beyond_data",
        "The motion is larger than the input can vouch for: its angle of attack passes 30 degrees and no fitted range "
        "is given, or its amplitude passes the static sag.",
    )
    NO_BOUNDED_MOTION = (
        "no_bounded_motion",
        "No stable motion was found, and every motion integrated from small and large starts passed an angle of attack "
        "of 180 degrees: nothing in the equations bounds the motion.",
    )
    SLACK = ("slack", "The conductor goes slack during the motion, which the model does not describe.")
    LIMIT_REACHED = ("limit_reached", "The computation reached a set limit before it was complete.")

    sentence: str

    def __new__(cls, value: str, sentence: str) -> "Outcome":
        """Return a member whose value is the word that results carry."""
        member = str.__new__(cls, value)
        member._value_ = value
        member.sentence = sentence
        return member


class Stability(StrEnum):
    """What is known of a motion's stability; an undecided stability is unknown, never stable."""

    STABLE = "stable"
    UNSTABLE = "unstable"
    UNKNOWN = "unknown"


@dataclass(frozen=True, slots=True)
class Fault:
    """One broken rule: dotted path of the field (`span.length`), the value found there and the rule in words."""

    field: str
    value: object
    rule: str

    def __str__(self) -> str:
        """Return field, rule and value as one sentence."""
        return f"{self.field} {self.rule}, got {self.value!r}"


class InvalidSpec(ValueError):
    """A specification breaks one or more rules; `faults` holds a fault for each."""

    def __init__(self, *faults: Fault) -> None:
        """Store the faults, at least one, and join their sentences."""
        self.faults = faults
        super().__init__("; ".join(str(fault) for fault in faults))


def require(*faults: Fault | None) -> None:
    """Raise `InvalidSpec` with every fault that is not None, if there is any.

    Raises
    ------
    InvalidSpec
        If at least one fault is not None.
    """
    found = [fault for fault in faults if fault is not None]
    if found:
        raise InvalidSpec(*found)
