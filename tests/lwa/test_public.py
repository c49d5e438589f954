"""The package's front door: a name in a public signature is imported from `lwa`, or named here."""

import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

import lwa


def test_all_names_exist_and_are_sorted():
    assert sorted(lwa.__all__) == sorted(set(lwa.__all__))
    for name in lwa.__all__:
        assert getattr(lwa, name) is not None
    with pytest.raises(AttributeError, match="nothing"):
        lwa.nothing  # noqa: B018
    # bound by name only
    assert (lwa.D.name, lwa.k.name) == ("D", "k")
    assert not {"D", "k"} & set(lwa.__all__)
    assert set(lwa.__all__) <= set(dir(lwa))


def test_the_package_is_imported_from_a_zip(tmp_path):
    """Public names are read from the package's source, which need not be a file of its own."""
    package = Path(lwa.__file__).parent
    with zipfile.ZipFile(tmp_path / "app.zip", "w") as app:
        for name in ("__init__.py", "base/__init__.py", "base/lazy.py"):
            app.write(package / name, f"lwa/{name}")
    code = "import sys; sys.path[:0] = ['app.zip']; import lwa; print(lwa.__file__, *lwa.__all__)"
    call = [sys.executable, "-c", code]
    run = subprocess.run(call, cwd=tmp_path, capture_output=True, text=True, timeout=60)
    file, *names = run.stdout.split()
    assert "app.zip" in file
    assert names == lwa.__all__
