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
        package.nothing  # noqa: B018 - to read it is refused
    source = Path(package.__file__)
    stub = source.with_suffix(".pyi")
    tree = ast.parse((stub if stub.exists() else source).read_text())
    imports = (
        node.names for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)
    )
    typed = {name.asname for names in imports for name in names}
    assert typed - {"D", "k", None} == set(package.__all__)
    assert Path(package.__file__).with_name("py.typed").exists()
    bound_by_name = {"D", "k", "__version__"}
    assert set(dir(package)) - bound_by_name == set(package.__all__)
    assert (lwa.D.name, lwa.k.name) == ("D", "k")  # bound by name only
