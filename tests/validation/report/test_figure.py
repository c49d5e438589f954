"""Pictures: complete files or none."""

import pytest

from lwa import InputError
from validation.report import figure
from validation.studies.porter2008.experiment import paper

SIGNATURES = {".png": b"\x89PNG", ".pdf": b"%PDF", ".svg": b"<?xml"}


@pytest.fixture(scope="module")
def result():
    return paper(beads=20, sensors=(8, 15))


@pytest.mark.parametrize("suffix", figure.SUFFIXES)
def test_every_format(result, tmp_path, suffix):
    file = tmp_path / f"picture{suffix}"
    figure.save(result, figure.plot_file(str(file)))
    assert file.read_bytes().startswith(SIGNATURES[suffix])
    assert list(tmp_path.iterdir()) == [file]


def test_the_paper_picture_shows_both_sensors(result):
    (axes,) = figure.figure(result).axes
    lattice, theory = axes.lines[:2]
    assert lattice.get_label() == "bead 8, lattice"
    # the theory's pulse stands where the lattice's does
    assert theory.get_xdata()[theory.get_ydata().argmax()] == pytest.approx(
        lattice.get_xdata()[lattice.get_ydata().argmax()], rel=0.01
    )


def test_the_limits_picture_shows_every_quantity_at_every_k(limits_result):
    left, right = figure.figure(limits_result).axes
    for axes in (left, right):
        assert len(axes.containers) == 4
        assert all(len(c.lines[0].get_xdata()) == 3 for c in axes.containers)


def test_a_failure_leaves_the_old_picture(result, tmp_path, monkeypatch):
    file = tmp_path / "picture.png"
    file.write_bytes(b"old")

    class Broken:
        def savefig(self, name, dpi):
            with open(name, "wb") as half:
                half.write(b"half")
            raise OSError("disk full")

    monkeypatch.setattr(figure, "figure", lambda result: Broken())
    with pytest.raises(InputError, match=r"picture.png is not written: disk full$"):
        figure.save(result, file)
    assert file.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [file]


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("picture", r"plot is .*picture: a file ending in .pdf, .png, .svg is wanted"),
        ("picture.txt", r"plot is .*: a file ending in"),
        ("none/picture.png", r"plot is .*: the folder .*none does not exist"),
        ("folder.png", r"plot is .*: a file that can be written is wanted"),
    ],
)
def test_bad_files(tmp_path, name, message):
    (tmp_path / "folder.png").mkdir()
    with pytest.raises(InputError, match=f"^{message}"):
        figure.plot_file(str(tmp_path / name))
