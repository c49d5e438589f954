"""The package's front door: a name in a public signature is imported from `lwa`, or named here."""

import inspect
import re
import subprocess
import sys
import zipfile
from collections import Counter
from pathlib import Path

import pytest

import lwa

WORDS = re.compile(r"(?<![.'\"\w])[A-Za-z_]\w*(?:\.\w+)*")
OTHERS = re.compile(
    r"(sp|np|click)\.\w+|None|Any|Self|Literal|Mapping|Sequence|Callable|Iterable|Iterator|ClassVar"
    r"|fmpq|fmpq_mpoly|fmpq_mpoly_ctx|NDArray|ArrayLike|Fraction|Decimal|NamedTuple|int|float|bool|str|tuple|list|dict|set|object"
    # of derivations from within, and names of types alone: found in the modules of lwa
    r"|JetAlgebra|Partition|Term|CoefficientRing|Powers|Model|Solution|Jet"
    r"|Array|Quantity|NumericBackground|Statics?"
)


def signatures(name, found):
    """(where, annotation) of a class or function: its own and its public methods'."""
    if inspect.isclass(found):
        for key, annotation in inspect.get_annotations(found).items():
            yield f"{name}.{key}", annotation
        members = inspect.getmembers_static(found)
        for key, member in members:
            wrapped = getattr(member, "fget", None) or getattr(member, "func", None) or member
            wrapped = getattr(wrapped, "__func__", wrapped)
            public = inspect.isfunction(wrapped) and wrapped.__module__.startswith("lwa")
            if public and (not key.startswith("_") or key == "__init__"):
                for part, annotation in inspect.get_annotations(wrapped).items():
                    yield f"{name}.{key}({part})", annotation
    elif inspect.isfunction(found):
        for part, annotation in inspect.get_annotations(found).items():
            yield f"{name}({part})", annotation


def plain(annotation):
    """Its text, without the texts in it."""
    text = getattr(annotation, "__forward_arg__", str(annotation))
    return re.sub(r"(['\"]).*?\1", "", text)


@pytest.mark.parametrize("name", lwa.__all__)
def test_every_name_in_a_public_signature_is_importable(name):
    missing = {
        (where, word)
        for where, annotation in signatures(name, getattr(lwa, name))
        for word in WORDS.findall(plain(annotation))
        if not OTHERS.fullmatch(word) and word not in lwa.__all__
    }
    assert not missing


def test_all_names_exist_and_are_sorted():
    assert sorted(lwa.__all__) == sorted(set(lwa.__all__))
    for name in lwa.__all__:
        assert getattr(lwa, name) is not None
    with pytest.raises(AttributeError, match="nothing"):
        lwa.nothing  # noqa: B018


def test_short_names_are_bound_by_name_only():
    assert (lwa.D.name, lwa.k.name) == ("D", "k")
    assert not {"D", "k"} & set(lwa.__all__)
    assert set(lwa.__all__) <= set(dir(lwa))


def test_completion_offers_each_name_once():
    assert Counter(lwa.__dir__()).most_common(1)[0][1] == 1


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
