"""A shaken chain under load transmits in Bloch's bands and nowhere else."""

import pytest

from book.studies.transmission import transmission


@pytest.mark.parametrize("masses", [(1, "1/2"), pytest.param((1,), marks=pytest.mark.slow)])
def test_a_shaken_chain_has_blochs_gaps(masses):
    report = transmission(masses, frequencies=4)
    assert report.ok
    rows = report.document()["rows"]
    held = [row for row in rows if row["attenuation_theory_value"] > 0.05]
    assert held
    assert len(held) < len(rows)
    for row in held:
        assert row["attenuation_value"] == pytest.approx(row["attenuation_theory_value"], rel=0.01)
