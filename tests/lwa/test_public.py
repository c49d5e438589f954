"""The front doors of both packages: names that are loaded on their first use."""

import ast
from pathlib import Path

import pytest

import lwa
import validation


@pytest.mark.parametrize("package", [lwa, validation])
def test_all_names_exist_and_type_checkers_see_the_same(package):
    for name in package.__all__:
        assert getattr(package, name) is not None
    with pytest.raises(AttributeError, match="nothing"):
        package.nothing  # noqa: B018
    tree = ast.parse(Path(package.__file__).read_text())
    (block,) = (node for node in tree.body if isinstance(node, ast.If))
    typed = {
        name.asname
        for line in block.body
        if isinstance(line, ast.ImportFrom)
        for name in line.names
    }
    assert typed - {"D", "k"} == set(package.__all__)


def test_two_symbols_are_bound_by_name_only():
    assert (lwa.D.name, lwa.k.name) == ("D", "k")
    assert not {"D", "k"} & set(lwa.__all__)
    assert set(lwa.__all__) <= set(dir(lwa))
