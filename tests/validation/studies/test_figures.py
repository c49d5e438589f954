"""The paper's figures: identities, published numbers."""

import json

import numpy as np
import pytest

from validation.studies.paper import (
    HEIGHTS,
    MODULI,
    RECORDED,
    STATED,
    figures,
    fitted_exponent,
    forces,
    scaling,
)


@pytest.fixture(scope="module")
def document():
    """The report; progress counts the parts of a whole."""
    shown = []

    def progress(parts):
        shown.extend(parts)
        return parts

    report = figures(progress=progress)
    assert shown == [*RECORDED, *MODULI]
    return json.loads(json.dumps(report.document(), allow_nan=False))


def test_the_fitted_exponent_is_the_published_one(document):
    """The lattice scales exactly but for the integrator: V ~ F^{1/6}, published as 0.1666."""
    found = document["scaling"]
    off = abs(found["exponent_value"] - 1 / 6)
    assert off <= 2 * found["exponent_error_value"] + 1e-12
    assert f"{found['exponent_value']:.5f}"[:6] == "0.1666"
    assert found["exponent_error_value"] < 1e-6


def test_the_errors_of_the_scaling_cover_a_finer_run(document):
    """Of speeds, forces and the exponent at a looser tolerance; a thirtieth would not cover."""
    fine = document["rows"][: len(HEIGHTS)]
    rough = scaling(MODULI[0], rtol=1e-7)
    shares = []
    for name in ("speed", "force"):
        for row, finer in zip(rough, fine, strict=True):
            off = abs(row[name].value - finer[f"{name}_value"])
            shares.append(off / row[name].error)
    power = fitted_exponent(rough)
    shares.append(
        abs(power.value - document["scaling"]["exponent_value"]) / power.error
    )
    assert 1 / 30 < max(shares) <= 1


def test_the_theorys_line_is_parallel_to_the_lattices(document):
    """Both go as F^{1/6}: the canonical wave's speed is one share of the lattice's, 0.973."""
    for modulus in MODULI:
        rows = [row for row in document["rows"] if row["modulus_value"] == modulus]
        assert [row["height_value"] for row in rows] == list(HEIGHTS)
        share = np.array([row["theory_value"] / row["speed_value"] for row in rows])
        assert share == pytest.approx(share[0], rel=1e-6)
        # The paper's closure, or the peak of a contact's force, gives 0.996 or 0.949.
        assert share[0] == pytest.approx(0.973, abs=0.01)


@pytest.mark.parametrize("N", RECORDED)
def test_force_records(N):
    force = forces(N).bead_force
    assert len(force) == 3
    # Fronts of 1 N; the wall's answer comes later, and higher.
    fronts = (force > 1).argmax(axis=1)
    assert np.all(np.diff(fronts) > 0)
    incoming = force[0, : fronts[-1]].max()
    assert 4 < incoming < 14  # N, as on the paper's scale of 2 N per division


def test_two_of_the_stated_errors_of_the_width_are_near_and_one_is_not(document):
    """9.2 and 22.8 % to 1.5 points; the lines for m1 ≫ m2 and m1 = m2 stand as √2 to 1."""
    limit, real, equal = (row["error_value"] for row in document["widths"])
    assert [row["stated_error_value"] for row in document["widths"]] == [
        *STATED.values()
    ]
    assert (1 + limit) / (1 + equal) == pytest.approx(2**0.5, rel=1e-9)
    assert abs(limit) == pytest.approx(0.092, abs=0.015)
    assert abs(equal) == pytest.approx(0.228, abs=0.015)
    assert abs(real) > 3 * 0.025
