"""The paper's figures: identities, published numbers."""

import json
from dataclasses import replace

import numpy as np
import pytest

from lwa import canonical_wave
from validation.scenes.chains import PTFE_BEAD
from validation.studies.figures import MODULI, RECORDED, figures, scaling
from validation.studies.paper import HERTZ, chain_cell


@pytest.fixture(scope="module")
def whole():
    """The report; progress counts the parts of a whole."""
    shown = []

    def progress(parts):
        shown.extend(parts)
        return parts

    report = figures(progress=progress)
    assert shown == [*RECORDED, *MODULI]
    return report


@pytest.fixture(scope="module")
def document(whole):
    return json.loads(json.dumps(whole.document(), allow_nan=False))


def test_the_fitted_exponent_is_the_published_one(document):
    """The lattice scales exactly but for the integrator: V ~ F^{1/6}, published as 0.1666."""
    for row in document["scalings"]:
        assert abs(row["exponent_value"] - 1 / 6) <= 2 * row["exponent_error_value"] + 1e-12
        assert row["exponent_error_value"] < 1e-6
        assert f"{row['exponent_value']:.5f}"[:6] == "0.1666"
    assert [row["modulus_value"] for row in document["scalings"]] == list(MODULI)
    assert document["scaling"] == document["scalings"][0]


def test_the_errors_of_the_scaling_cover_a_finer_run(document):
    """Of speeds and forces at a looser tolerance; a thousandth of them would not cover."""
    rough, fine = scaling(MODULI[0], (1e-7, 1e-6)), document["scaling"]
    for name in ("speed", "force"):
        off = np.abs(np.subtract(getattr(rough, name), fine[f"{name}_value"]))
        share = off / getattr(rough, f"{name}_error")
        assert 1e-3 < share.max() <= 1, name


def test_the_theorys_line_is_parallel_to_the_lattices(document):
    """Speeds of `lwa`'s wave at a bead's peak force; below the lattice's, by one share of them."""
    for row in document["scalings"]:
        ptfe = replace(PTFE_BEAD, material=replace(PTFE_BEAD.material, E=row["modulus_value"]))
        wave = canonical_wave(chain_cell(ptfe=ptfe), HERTZ)
        for F, V in zip(row["force_value"], row["theory_value"], strict=True):
            assert pytest.approx(float(wave.at_force(F, of="bead").speed), rel=1e-9) == V
        share = np.array(row["theory_value"]) / row["speed_value"]
        assert share == pytest.approx(share[0], rel=1e-6)  # both go as F^{1/6}
        assert 0.95 < share[0] < 1


def test_force_records(document):
    for found in document["forces"]:
        assert found["beads"] == list(RECORDED[found["N"]])
        force = np.array(found["force_value"])
        assert force.shape == (3, len(found["time_value"]))
        fronts = (force > 1).argmax(axis=1)  # 1 N; the wall's answer comes later, and higher
        assert np.all(np.diff(fronts) > 0)
        incoming = force[0, : fronts[-1]].max()
        assert 4 < incoming < 14  # N, as on the paper's scale of 2 N per division
    assert [found["N"] for found in document["forces"]] == list(RECORDED)
