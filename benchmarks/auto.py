"""A branch of limit cycles computed by AUTO through the `xpplab` wheel (GPL; a development extra only)."""

import time
from dataclasses import dataclass

import numpy as np

from engine.arrays import FloatArray
from engine.models.reduced_model import ReducedModel
from engine.numerics import polynomial

VARIABLES = "abcdef"  # q_v, q_w, q_theta and their rates


@dataclass(frozen=True, slots=True)
class Branch:
    """Wind speeds (points,) [m/s], half of peak-to-peak of each coordinate (points, 3), and AUTO's time [s]."""

    wind_speed: FloatArray
    amplitude: FloatArray
    seconds: float


def model_text(model: ReducedModel, wind_speed: float) -> str:
    """Return the equations of one hybrid model as an XPP file, with the wind speed [m/s] as parameter p."""
    inverse = np.linalg.inv(model.mass)
    stiffness, damping = inverse @ model.stiffness, inverse @ model.damping
    table = inverse @ model.load.table[0]
    names = [_local_name(row) for row in model.load.forms[0]]
    lines = [f"par p={wind_speed!r}"]
    lines += [f"x{i}={name}" for i, name in enumerate(names)]
    products = ["*".join(f"x{i}" for i in monomial) for monomial in polynomial.monomials(len(names))]
    lines += [f"y{i}={product}" for i, product in enumerate(products)]
    for i in range(3):
        third = len(products) // 3 + 1
        for part in range(3):
            terms = [f"({table[i, j]:.17g})*y{j}" for j in range(part * third, min((part + 1) * third, len(products)))]
            lines.append(f"l{i}{part}={'+'.join(terms)}")
        linear = [f"({-stiffness[i, j]:.17g})*{VARIABLES[j]}" for j in range(3)]
        linear += [f"({-damping[i, j]:.17g})*{VARIABLES[3 + j]}" for j in range(3)]
        lines.append(f"{VARIABLES[i]}'={VARIABLES[3 + i]}")
        lines.append(f"{VARIABLES[3 + i]}'={'+'.join(linear)}+p*p*(l{i}0+l{i}1+l{i}2)")
    return "\n".join([*lines, "done", ""])


def _local_name(row: FloatArray) -> str:
    component = int(np.flatnonzero(row)[0])
    return VARIABLES[component] if component < 3 else f"{VARIABLES[component]}/p"


def continued_branch(model: ReducedModel, start: float, stop: float, *, intervals: int = 30) -> Branch:
    """Continue the cycles from the first Hopf point between two wind speeds [m/s]; time only the periodic branch."""
    import xpplab  # noqa: PLC0415  a development extra: its absence must not break the other measurements

    with xpplab.Model.from_text(model_text(model, start)) as ode:
        ode.auto.set(
            parmin=start, parmax=stop, ds=0.02, dsmin=1e-6, dsmax=0.4, ntst=intervals, ncol=4, nmax=200, npr=500
        )
        hopf = ode.auto.equilibria("p").first("HB")
        begin = time.perf_counter()
        diagram = ode.auto.continue_from(hopf, "periodic")
        seconds = time.perf_counter() - begin
        points = [p for p in diagram if p.periodic]
        amplitude = [[0.5 * (p.umax[v] - p.umin[v]) for v in _upper(p.umax)] for p in points]
        return Branch(np.array([p.value for p in points]), np.array(amplitude), seconds)


def _upper(values: dict[str, float]) -> list[str]:
    return [next(name for name in values if name.lower() == wanted) for wanted in VARIABLES[:3]]
