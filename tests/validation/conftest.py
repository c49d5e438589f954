"""The engine, compiled once, and rows of the study `limits` without a lattice run."""

import pytest

from validation.pulses.pulse import Measured
from validation.studies.limits import EQUAL, EXPONENTS, LIGHT, Comparison
from validation.waves.theory import LEADING_POWERS, theory_at, theory_values


@pytest.fixture(scope="session", autouse=True)
def _engine(engine):
    """Compile the engine in one process of the tests."""


@pytest.fixture(scope="session")
def limits_rows():
    """Rows of `limits` as its laws have them."""
    rows = []
    for omega in (EQUAL, LIGHT):
        for k in EXPONENTS:
            theory = theory_values(theory_at(k, omega))
            for quantity, law in LEADING_POWERS.items():
                error = 0.9 * float(law.coefficient * (k - 1) ** law.order)
                lattice = float(theory[quantity]) / (1 + error)
                found = Measured(lattice, lattice * (1 + 1e-7))
                rows.append(Comparison(quantity, k, omega, theory[quantity], found, law.bound(k)))
    return rows
