"""MathJax 3 beside the pages, at ``mathjax/``: reading the book needs no network.

The files come from the package `sphinx-mathjax-offline` of the Python package index, which is
fetched once with pip, checked against its SHA-256 and kept in ``_build/mathjax-wheel``.
"""

from __future__ import annotations

import hashlib
import subprocess
import sys
import zipfile
from pathlib import Path
from shutil import rmtree

from sphinx.application import Sphinx
from sphinx.errors import ExtensionError

PACKAGE = "sphinx-mathjax-offline==0.0.2"
WHEEL = "sphinx_mathjax_offline-0.0.2-py3-none-any.whl"
SHA256 = "206418155b2ff2f57496fb8501fdccae3da978e53031ff296c73729ba16062c4"
INSIDE = "sphinx-mathjax-offline/static/mathjax/"
WANTED = (
    "startup.js",
    "core.js",
    "input/tex.js",
    "input/tex/extensions/",
    "output/chtml.js",
    "output/chtml/fonts/",
    "a11y/assistive-mml.js",
)
"""Files of MathJax that pages load: TeX input, HTML output with its fonts, MathML for listeners."""


def fetched(
    folder: Path, package: str = PACKAGE, name: str = WHEEL, sum: str = SHA256
) -> Path:
    """Return a package's wheel, downloaded into the folder unless it is there."""
    wheel = folder / name
    if not wheel.exists():
        pip = (sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check")
        options = ("--no-deps", "--only-binary=:all:", "--dest", str(folder))
        subprocess.run([*pip, "download", *options, package], check=True)
    found = hashlib.sha256(wheel.read_bytes()).hexdigest()
    if found != sum:
        wheel.unlink()
        raise ExtensionError(f"{name} has the SHA-256 {found}, not {sum}")
    return wheel


def unpack(app: Sphinx, error: Exception | None) -> None:
    """Put the wanted files into the finished book."""
    if error is not None or app.builder.format != "html":
        return
    out = Path(app.outdir)
    rmtree(out / "mathjax", ignore_errors=True)  # another build may have put more there
    with zipfile.ZipFile(fetched(out.parent / "mathjax-wheel")) as wheel:
        for name in wheel.namelist():
            relative = name.removeprefix(INSIDE)
            if (
                name.startswith(INSIDE)
                and relative.startswith(WANTED)
                and relative[-1] != "/"
            ):
                target = out / "mathjax" / relative
                target.parent.mkdir(parents=True, exist_ok=True)
                target.write_bytes(wheel.read(name))


def without_icons_script(app: Sphinx, error: Exception | None) -> None:
    """Empty the script of 1.5 MB that draws icons: the theme's font has them as well."""
    if error is None and app.builder.format == "html":
        Path(app.outdir, "_static", "scripts", "fontawesome.js").write_text("")


def without_thebe(
    app: Sphinx, page: str, template: str, context: dict, doctree: object
) -> None:
    """Leave out sphinx-thebe's scripts: they would run cells on a server, which is off."""
    files = context.get("script_files", [])
    context["script_files"] = [
        file
        for file in files
        if "thebe" not in str(getattr(file, "filename", file) or "")
        and "THEBE" not in str(getattr(file, "attributes", {}).get("body", ""))
    ]


def setup(app: Sphinx) -> dict[str, bool]:
    """Sphinx's hook."""
    app.connect("html-page-context", without_thebe, priority=900)
    app.connect("build-finished", unpack)
    app.connect("build-finished", without_icons_script)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
