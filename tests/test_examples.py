"""The examples of docstrings and of the README are accepted by mypy in strict mode."""

import ast
import doctest
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


def with_examples(source):
    """The text of a module with the examples of its docstrings behind it, one function each."""
    kinds = ast.Module, ast.ClassDef, ast.FunctionDef
    texts = [
        ast.get_docstring(node)
        for node in ast.walk(ast.parse(source))
        if type(node) in kinds
    ]
    for i, text in enumerate(filter(None, texts)):
        lines = "".join(
            part.source for part in doctest.DocTestParser().get_examples(text)
        )
        if lines:
            source += f"\n\ndef _example_{i}() -> None:\n" + re.sub(
                "^(?=.)", "    ", lines, flags=re.M
            )
    return source


@pytest.mark.slow
@pytest.mark.optional("mypy")
def test_mypy_accepts_every_example(tmp_path, monkeypatch):
    from mypy import api

    (readme,) = re.findall(
        r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL
    )
    program = tmp_path / "readme.py"
    program.write_text(readme)
    shadows = []
    for package in ("lwa", "validation"):
        for file in sorted((ROOT / package).rglob("*.py")):
            source = file.read_text()
            if (changed := with_examples(source)) != source:
                shadow = tmp_path / f"{len(shadows)}.py"
                shadow.write_text(changed)
                shadows += ["--shadow-file", str(file.relative_to(ROOT)), str(shadow)]
    assert len(shadows) > 90
    options = ["--strict", "--cache-dir", str(tmp_path / "cache"), *shadows]
    monkeypatch.chdir(ROOT)
    shown, _, status = api.run([*options, "lwa", "validation", str(program)])
    assert status == 0, shown
