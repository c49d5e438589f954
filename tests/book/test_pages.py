"""The built book in a browser without a network: mathematics, pictures, nothing from outside.

Run by its path, after the book is built: ``python -m pytest tests/book/test_pages.py``. Without a
browser or without the book it fails.
"""

import math
import re
from pathlib import Path

import nbformat
import pytest
import sympy as sp

import lwa
import validation
from lwa import (
    Cell,
    Dimer,
    Material,
    Sphere,
    canonical_wave,
    expand,
    homogenize,
)
from tests.book.browser import visited
from validation import Scene, measure, simulate

ROOT = Path(__file__).parents[2]
HTML = ROOT / "book" / "_build" / "html"
CHAPTERS = re.findall(r"(?:file|root): (\w+)", (ROOT / "book" / "_toc.yml").read_text())
PAGES = [f"{name}.html" for name in (*CHAPTERS, "genindex", "search")]

SMALLEST = """<html><head><script>
window.MathJax = {startup: {promise: Promise.resolve()}};
</script></head><body><article>%s</article></body></html>"""


PHONE, WINDOW = 390, 1280
"""Widths of a page, in CSS pixels."""


@pytest.fixture(scope="module")
def visit():
    return opened(None)


def opened(width, mode="light"):
    for page in PAGES:
        assert (HTML / page).is_file(), f"the book is not built: {page} is missing in {HTML}"
    return visited(HTML, PAGES, width, mode)


def found(pages, finding):
    """Pages with a finding."""
    return {page: report[finding] for page, report in pages.items() if report[finding]}


@pytest.mark.parametrize(
    "finding",
    ["errors", "unrendered", "merrors", "raw", "broken", "unshown", "silent", "unnamed", "foreign"],
)
def test_no_page_has_this_fault(visit, finding):
    assert set(visit.pages) == set(PAGES)
    assert not found(visit.pages, finding)


def test_mathematics_pictures_and_addresses(visit):
    for page, report in visit.pages.items():
        assert report["mathjax"] or not report["math"], page
    assert all(visit.pages[f"{chapter}.html"]["rendered"] > 4 for chapter in CHAPTERS[1:9])
    assert sum(report["images"] for report in visit.pages.values()) > 2 * len(PAGES)  # logos
    assert not visit.missing


@pytest.mark.parametrize("mode", ["light", "dark"])
@pytest.mark.parametrize("width", [PHONE, WINDOW])
def test_nothing_is_cut_or_faint(width, mode):
    pages = opened(width, mode).pages
    faults = ("faint", "cut", "crumbled", "wider")
    assert not {fault: there for fault in faults if (there := found(pages, fault))}


def test_every_public_name_is_documented_and_no_private_one():
    documented = set()
    for page in PAGES:
        names = re.findall(r'<dt class="sig[^>]* id="([^"]*)"', (HTML / page).read_text())
        assert not [name for name in names if re.search(r"\._", name)]
        assert not names or page == "api.html"
        documented |= {name.rpartition(".")[2] for name in names}
        signature = r'sig-name descname"><span class="pre">(\w+)<'
        documented |= set(re.findall(signature, (HTML / page).read_text()))
    assert {*lwa.__all__, *validation.__all__} - documented <= {"hertz"}  # a module


def test_the_interface_is_documented_without_generic_text():
    """No type of a progress function, no text of Python about a type, no mark left unrendered."""
    text = re.sub(r"<[^>]*>", "", (HTML / "api.html").read_text())
    marks = r"Callable\[\[Iterable|PEP 604|Symbol class|\*\*[A-Z][^*]*\*\*|[.;] - \w"
    assert not re.findall(marks, text)


def test_every_page_with_cells_has_a_notebook():
    for page in PAGES:
        text = (HTML / page).read_text()
        assert "cell_input" not in text or f'href="_sources/{page[:-5]}.ipynb"' in text
        if "cell_input" in text:
            notebook = nbformat.read(HTML / "_sources" / f"{page[:-5]}.ipynb", 4)
            nbformat.validate(notebook)
            assert sum(cell.cell_type == "code" for cell in notebook.cells) >= text.count(
                'class="cell_input'
            )


SPHERES = [Sphere.solid("2.38e-3", Material.named(name)) for name in ("steel 316", "PTFE")]


def numbers(text):
    """The numbers of a printed line, with a minus as the page writes it."""
    return [float(x) for x in re.findall(r"-?\d[\d.]*(?:e[+-]?\d+)?", text.replace("−", "-"))]


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
    beads = [measure(run.time, force - force[0]).peak + force[0] for force in run.bead_force]
    peak, width = (sum(p.peak for p in pulses[2:]) / 2, sum(p.fwhm for p in pulses[2:]) / 2)
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
        pulse, ours = wave.at_force(sp.Float(found["F"], 17), **loads), found["theories"][name]
        assert abs(ours["speed"] / float(pulse.speed) - 1) < 1e-12
        assert abs(ours["width"] / float(pulse.fwhm("force", "time")) - 1) < 1e-4  # midpoint rule
    given = math.sqrt(2 * 9.81e-3 * blow["blow"]) if blow["kind"] == "drop" else blow["blow"]
    assert abs(found["F" if blow["kind"] == "force" else "v"] / given - 1) < 1e-12
    peak, width, speed, beads = lattice_of(blow, found)
    assert abs((found["F"] - load) / peak - 1) < 3e-3  # steps of the page's Verlet
    assert abs(found["lattice"]["width"] / width - 1) < 1e-2
    assert abs(found["lattice"]["speed"] / speed - 1) < 1e-2  # at contact 80, not the mean
    assert found["beads"] == pytest.approx(beads, rel=1e-2)


def test_the_series_of_the_calculator_is_interpolated_well(visit):
    """Between the ratios of its table the width differs from the series by less than 0.5 %."""
    _, found = visit.pages["calculator.html"]["blows"][9]
    theory, ratio = (
        found["theories"]["series in k − 1"],
        sp.Rational(round(1e6 * found["omega"]), 10**6),
    )
    total = expand(Dimer(1, ratio), 8).fwhm("force").at("3/2")
    sites = theory["width"] * found["lattice"]["speed"] / 4.68e-3
    assert abs(sites / float(total.value) - 1) < 5e-3
    assert abs(theory["error"] / float(total.error / total.value) - 1) < 0.2


def test_the_calculator_refuses_by_name(visit):
    """Equal beads have the theory's error; weak blows, extreme ratios and bad input have none."""
    equal, weak, light, negative = (row[1] for row in visit.pages["calculator.html"]["blows"][5:9])
    error = equal["theories"]["canonical wave"]["width"] / equal["lattice"]["width"] - 1
    assert 0.05 < error < 0.08
    assert abs(equal["beads"][0] / equal["F"] - 0.707) < 3e-3
    assert abs(weak["growth"]) > 0.1
    assert "mass ratio" in light["refused"]
    assert "positive" in negative["refused"]


def test_numbers_are_typed_with_a_comma_or_a_point(visit):
    """2,38 is 2.38; a material of one's own is one of the table where its numbers are."""
    report = visit.pages["calculator.html"]
    comma, point, mixed, word = report["typed"]
    assert comma == point == report["own"][0] == dict(map(tuple, report["calculator"]))["force"]
    assert mixed == word
    assert "positive numbers" in word
    assert "density must be positive" in report["own"][1]


def test_a_harder_blow_is_seen_to_run_faster(visit):
    """Scale and clock stay while the slider moves, and the pulse from before runs along."""
    seen = visit.pages["play.html"]["harder"]
    assert seen["scales"][1] >= seen["scales"][0]
    assert seen["paces"][0] == seen["paces"][1]
    assert seen["passed"][1] > seen["passed"][0]
    assert seen["forces"][1] > 2 * seen["forces"][0]


def test_the_pulse_before_stays_while_a_slider_is_dragged(visit):
    assert visit.pages["play.html"]["dragged"] == [2, 0.5]
    assert visit.pages["exact.html"]["presets"] == [0.6, 0.3428]


def test_each_thing_to_turn_asks_first(visit):
    """Nothing is shown before the answer, but on the first page, where nothing can be turned."""
    for page, report in visit.pages.items():
        things = len(re.findall('class="lwa-', (HTML / page).read_text()))
        plain = page == "intro.html"
        assert (report["asked"], report["early"]) == (things - plain, plain), page


def test_the_script_is_small_and_loaded_where_it_is_used(visit):
    assert visit.pages["play.html"]["sliders"] == 4
    assert (HTML / "_static" / "turn.js").stat().st_size < 36_000
    for page in PAGES:
        text = (HTML / page).read_text()
        assert ("turn.js" in text) == ('class="lwa-' in text), page


def test_a_page_is_small(visit):
    """A page, its pictures and its scripts: at most 2.5 MB, MathJax and the theme aside."""
    for page in PAGES:
        text = (HTML / page).read_text()
        pictures = {HTML / name for name in re.findall(r'src="(_images/[^"]+)"', text)}
        assert len(text) + sum(file.stat().st_size for file in pictures) < 2_500_000, page


LINE = f'<pre style="%s">{"long " * 100}</pre>'
CELL = '<td><span class="pre" style="overflow-wrap: %s">crumbs</span></td>'
ROW = f"<div style='overflow: auto'><table style='width: 80px'><tr>{CELL}<td>{'long' * 20}</td>"
PICTURE = '<div style="overflow: hidden"><svg width="%d" height="9"></svg></div>'
FAULTS = [
    (r'<span class="math">\(x\)</span>', "unrendered", True),
    (r"<p>\(x\)</p>", "raw", True),
    ("<p>$$x$$</p>", "raw", True),
    ('<span class="math"><mjx-merror>x</mjx-merror></span>', "merrors", True),
    ('<img src="nowhere.png">', "broken", True),
    ('<img src="https://example.org/picture.png">', "foreign", True),
    ('<img src="nowhere.png">', "foreign", False),
    ("<script>fetch('https://example.org/x').catch(() => 0)</script>", "foreign", True),
    ("<pre>&lt;Figure size 650x520 with 1 Axes&gt;</pre>", "unshown", True),
    ('<svg width="9" height="9"></svg>', "silent", True),
    ('<div role="img">x</div>', "unnamed", True),
    (LINE % "", "cut", True),
    (LINE % "", "wider", True),
    (LINE % "overflow-x: hidden", "cut", True),
    (LINE % "overflow-x: hidden", "wider", False),
    (LINE % "overflow-x: auto", "cut", False),
    (LINE % "max-width: 100%; overflow-x: auto", "cut", False),
    (PICTURE % 900, "cut", True),
    (PICTURE % 300, "cut", False),
    ('<p style="color: #999">words</p>', "faint", True),
    ('<p style="color: #222">words</p>', "faint", False),
    (ROW % "anywhere", "crumbled", True),  # neither cut nor wider than the page
    (ROW % "normal", "crumbled", False),
]
"""Body of a page at the width of a phone, a finding, and whether the finding is made."""


@pytest.fixture(scope="module")
def faulty(tmp_path_factory):
    """Visit to a page for each body."""
    folder = tmp_path_factory.mktemp("faults")
    for i, (body, _, _) in enumerate(FAULTS):
        (folder / f"{i}.html").write_text(SMALLEST % body)
    return visited(folder, [f"{i}.html" for i in range(len(FAULTS))], PHONE)


@pytest.mark.parametrize("i", range(len(FAULTS)), ids=[fault[1] for fault in FAULTS])
def test_a_fault_of_a_page_is_found(faulty, i):
    _, finding, made = FAULTS[i]
    assert bool(faulty.pages[f"{i}.html"][finding]) == made


def test_a_missing_file_is_found(faulty):
    assert "/nowhere.png" in faulty.missing
