"""The built book in a browser without a network: mathematics, pictures, nothing from outside.

Run by its path, after the book is built: ``python -m pytest tests/book/test_pages.py``. Without a
browser or without the book it fails.
"""

import math
import re
from functools import cache
from pathlib import Path

import nbformat
import pytest
import sympy as sp

import lwa
import validation
from lwa import Cell, Dimer, Material, Sphere, canonical_wave, expand, homogenize
from tests.book.browser import visited
from validation import Scene, measure, simulate

ROOT = Path(__file__).parents[2]
HTML = ROOT / "book" / "_build" / "html"
CHAPTERS = re.findall(r"(?:file|root): (\w+)", (ROOT / "book" / "_toc.yml").read_text())
PAGES = [f"{name}.html" for name in (*CHAPTERS, "genindex", "search")]

PHONE, WINDOW = 390, 1280
"""Widths of a page, in CSS pixels."""
FAULTS = (
    "errors", "unrendered", "merrors", "raw", "broken", "unshown", "silent", "unnamed", "foreign",
    "faint", "cut", "crumbled", "wider",
)  # fmt: skip


@cache
def opened(width, mode):
    for page in PAGES:
        assert (HTML / page).is_file(), (
            f"the book is not built: {page} is missing in {HTML}"
        )
    return visited(HTML, PAGES, width, mode)


@pytest.fixture
def visit():
    return opened(WINDOW, "light")


@pytest.mark.parametrize("mode", ["light", "dark"])
@pytest.mark.parametrize("width", [WINDOW, PHONE])
def test_no_page_has_a_fault(width, mode):
    pages = opened(width, mode).pages
    assert set(pages) == set(PAGES)
    assert not {
        (f, page): seen[f] for page, seen in pages.items() for f in FAULTS if seen[f]
    }


def test_mathematics_pictures_and_addresses(visit):
    for page, report in visit.pages.items():
        assert report["mathjax"] or not report["math"], page
    assert all(
        visit.pages[f"{chapter}.html"]["rendered"] > 4 for chapter in CHAPTERS[1:9]
    )
    assert sum(report["images"] for report in visit.pages.values()) > 2 * len(
        PAGES
    )  # logos
    assert not visit.missing


def test_every_public_name_is_documented_and_no_private_one():
    """No type of a progress function, no text of Python about a type, no mark left unrendered."""
    text = (HTML / "python.html").read_text()
    names = re.findall(r'<dt class="sig[^>]* id="([^"]*)"', text)
    assert not [name for name in names if re.search(r"\._", name)]
    documented = {name.rpartition(".")[2] for name in names}
    documented |= set(re.findall(r'sig-name descname"><span class="pre">(\w+)<', text))
    assert {*lwa.__all__, *validation.__all__} - documented <= {"hertz"}  # a module
    marks = r"Callable\[\[Iterable|PEP 604|Symbol class|\*\*[A-Z][^*]*\*\*|[.;] - \w"
    assert not re.findall(marks, re.sub(r"<[^>]*>", "", text))


@pytest.mark.parametrize("page", PAGES)
def test_a_page_is_small_and_has_a_notebook_of_its_cells(page):
    """With its pictures and scripts at most 2.5 MB, MathJax and the theme aside."""
    text, name = (HTML / page).read_text(), f"_sources/{page[:-5]}.ipynb"
    pictures = {HTML / name for name in re.findall(r'src="(_images/[^"]+)"', text)}
    assert len(text) + sum(file.stat().st_size for file in pictures) < 2_500_000
    assert ("turn.js" in text) == ('class="lwa-' in text)
    if cells := text.count('class="cell_input'):
        assert f'href="{name}"' in text
        nbformat.validate(notebook := nbformat.read(HTML / name, 4))
        assert sum(cell.cell_type == "code" for cell in notebook.cells) >= cells


SPHERES = [
    Sphere.solid("2.38e-3", Material.named(name)) for name in ("steel 316", "PTFE")
]


def numbers(text):
    """The numbers of a printed line, with a minus as the page writes it."""
    return [
        float(x)
        for x in re.findall(r"-?\d[\d.]*(?:e[+-]?\d+)?", text.replace("−", "-"))
    ]


def lattice_of(blow, found):
    """Pulse of a hundred beads at contact 80 by the engine: peak, width, speed, forces of beads."""
    load, cell = blow["load"], Cell.of_spheres(SPHERES)
    before_the_echo = 92 * 4.76e-3 / found["lattice"]["speed"]
    scene = Scene.of_cell(
        cell, 50, "3/2", velocities=(found["v"],), duration=before_the_echo, samples=20001,
        contact_sensors=(40, 41, 80, 81), bead_sensors=(80, 81), precompression=float(load),
        wall=float(cell.stiffnesses[0]) if load else None,
    )  # fmt: skip
    run = simulate(scene)
    pulses = [measure(run.time, force - force[0]) for force in run.contact_force]
    times = sum(p.arrival for p in pulses[2:]) - sum(p.arrival for p in pulses[:2])
    beads = [
        measure(run.time, force - force[0]).peak + force[0] for force in run.bead_force
    ]
    peak, width = (
        sum(p.peak for p in pulses[2:]) / 2,
        sum(p.fwhm for p in pulses[2:]) / 2,
    )
    return peak, width, 80 * 4.76e-3 / times, beads


def test_the_calculator_prints_what_it_computes(visit):
    """The first lines hold the lattice's numbers, the others those of the theories, by `lwa`."""
    told = visit.pages["calculator.html"]["calculator"]
    shown = {name: numbers(text) for name, text in told if name != "theory"}
    _, found = visit.pages["calculator.html"]["blows"][0]
    assert shown["force"] == [float(f"{found['F']:.4g}"), 1.37]
    assert shown["speed"] == [float(f"{found['lattice']['speed']:.4g}")]
    assert shown["width"] == [float(f"{1e6 * found['lattice']['width']:.4g}")]
    assert shown["pressure"][1] == pytest.approx(shown["pressure"][0] / 1.6, rel=1e-2)
    modulus, R = 1 / ((1 - 0.3**2) / 193e9 + (1 - 0.46**2) / 1.46e9), 1.19e-3
    highest = 1e-6 * (6 * found["F"] * modulus**2 / (math.pi**3 * R**2)) ** (1 / 3)
    assert shown["pressure"][0] == pytest.approx(highest, rel=5e-3)
    theories = {text.partition(":")[0]: text for name, text in told if name == "theory"}
    assert list(theories) == ["canonical wave", "paper's closure", "series in k − 1"]
    assert "refuses" in theories["series in k − 1"]
    assert not [text for _, text in told if "NaN" in text]


@pytest.mark.parametrize("n", range(5))
def test_the_calculator_with_and_without_load(visit, n):
    """Theories by the same closed forms, the beads of the page against the validated lattice."""
    blow, found = visit.pages["calculator.html"]["blows"][n]
    load, cell = blow["load"], Cell.of_spheres(SPHERES)
    loads = {"precompression": sp.Rational(load)} if load else {}
    closed = {"canonical wave": canonical_wave(cell, "3/2")}
    if not load:
        closed["paper's closure"] = homogenize(cell, k="3/2").pde.traveling_wave()
    for name, wave in closed.items():
        pulse, ours = (
            wave.at_force(sp.Float(found["F"], 17), **loads),
            found["theories"][name],
        )
        assert abs(ours["speed"] / float(pulse.speed) - 1) < 1e-12
        assert (
            abs(ours["width"] / float(pulse.fwhm("force", "time")) - 1) < 1e-4
        )  # midpoint rule
    given = (
        math.sqrt(2 * 9.81e-3 * blow["blow"])
        if blow["kind"] == "drop"
        else blow["blow"]
    )
    assert abs(found["F" if blow["kind"] == "force" else "v"] / given - 1) < 1e-12
    peak, width, speed, beads = lattice_of(blow, found)
    assert abs((found["F"] - load) / peak - 1) < 3e-3  # steps of the page's Verlet
    assert abs(found["lattice"]["width"] / width - 1) < 1e-2
    assert (
        abs(found["lattice"]["speed"] / speed - 1) < 1e-2
    )  # at contact 80, not the mean
    assert found["beads"] == pytest.approx(beads, rel=1e-2)


def test_the_series_of_the_calculator_is_interpolated_well(visit):
    """Between the ratios of its table the width differs from the series by less than 0.5 %."""
    _, found = visit.pages["calculator.html"]["blows"][9]
    theory = found["theories"]["series in k − 1"]
    ratio = sp.Rational(round(1e6 * found["omega"]), 10**6)
    total = expand(Dimer(1, ratio), 8).fwhm("force").at("3/2")
    sites = theory["width"] * found["lattice"]["speed"] / 4.68e-3
    assert abs(sites / float(total.value) - 1) < 5e-3
    assert abs(theory["error"] / float(total.error / total.value) - 1) < 0.2


def test_the_calculator_refuses_by_name(visit):
    """Equal beads have the theory's error; weak blows, extreme ratios and bad input have none.

    2,38 is 2.38; a material of one's own is one of the table where its numbers are."""
    report = visit.pages["calculator.html"]
    equal, weak, light, negative = (row[1] for row in report["blows"][5:9])
    error = equal["theories"]["canonical wave"]["width"] / equal["lattice"]["width"] - 1
    assert 0.05 < error < 0.08
    assert abs(equal["beads"][0] / equal["F"] - 0.707) < 3e-3
    assert abs(weak["growth"]) > 0.1
    assert "mass ratio" in light["refused"]
    assert "positive" in negative["refused"]
    comma, point, mixed, word = report["typed"]
    assert (
        comma
        == point
        == report["own"][0]
        == dict(map(tuple, report["calculator"]))["force"]
    )
    assert mixed == word
    assert "positive numbers" in word
    assert "density must be positive" in report["own"][1]


def test_a_harder_blow_is_seen_to_run_faster(visit):
    """Scale and clock stay while the slider is dragged, and the pulse from before runs along."""
    seen = visit.pages["play.html"]["harder"]
    assert seen["scales"][1] >= seen["scales"][0]
    assert seen["paces"][0] == seen["paces"][1]
    assert seen["passed"][1] > seen["passed"][0]
    assert seen["forces"][1] > 2 * seen["forces"][0]
    assert visit.pages["play.html"]["dragged"] == [2, 0.5]
    assert visit.pages["exact.html"]["presets"] == [0.6, 0.3428]


def test_each_thing_to_turn_asks_first(visit):
    """Nothing is shown before the answer, but on the first page, where nothing can be turned."""
    for page, report in visit.pages.items():
        things = len(re.findall('class="lwa-', (HTML / page).read_text()))
        plain = page == "intro.html"
        assert (report["asked"], report["early"]) == (things - plain, plain), page
    assert visit.pages["play.html"]["sliders"] == 4
    assert (HTML / "_static" / "turn.js").stat().st_size < 36_000


SMALLEST = """<html><head><script>
window.MathJax = {startup: {promise: Promise.resolve()}};
</script></head><body><article>%s</article></body></html>"""
LINE = f'<pre style="%s">{"long " * 100}</pre>'
CELL = '<td><span class="pre" style="overflow-wrap: %s">crumbs</span></td>'
TABLE = f"<table style='width: 80px'><tr>{CELL}<td>{'long' * 20}</table>"
ROW = f"<div style='overflow: auto'>{TABLE}</div>"
SVG = '<svg aria-label="x" width="%d" height="9"></svg>'
PICTURE = f'<div style="overflow: hidden; width: 200px">{SVG}</div>'
BAD = {
    "unrendered": [r'<span class="math">x</span>'],
    "raw": [r"<p>\(x\)</p>", "<p>$$x</p>"],
    "merrors": ["<mjx-merror>x</mjx-merror>"],
    "foreign": ["<script>fetch('https://example.org/x').catch(() => 0)</script>"],
    "unshown": ["<pre>&lt;Figure size 650x520 with 1 Axes&gt;</pre>"],
    "broken": ['<img alt="x" src="nowhere.png">'],
    "silent": ['<svg width="9" height="9"></svg>'],
    "unnamed": ['<div role="img">x</div>'],
    "faint": ['<p style="color: #999">words</p>'],
    "crumbled": [ROW % "anywhere"],  # neither cut nor wider than the page
    "cut": [LINE % "", LINE % "overflow-x: hidden", PICTURE % 300],
}
GOOD = [
    LINE % "overflow-x: auto", LINE % "max-width: 100%; overflow-x: auto", PICTURE % 150,
    '<p style="color: #222">words</p>', ROW % "normal",
]  # fmt: skip
"""Bodies of pages at the width of a phone: each of the bad ones is found once, no good one."""


def test_each_fault_is_found(tmp_path):
    bodies = [body for several in BAD.values() for body in several], GOOD
    for name, parts in zip(("bad", "good"), bodies, strict=True):
        (tmp_path / f"{name}.html").write_text(SMALLEST % "".join(parts))
    visit = visited(tmp_path, ["bad.html", "good.html"], PHONE)
    bad, good = visit.pages["bad.html"], visit.pages["good.html"]
    assert {fault: len(bad[fault]) for fault in BAD} == {f: len(BAD[f]) for f in BAD}
    assert bad["wider"]
    assert not [fault for fault in FAULTS if good[fault]]
    assert "/nowhere.png" in visit.missing
