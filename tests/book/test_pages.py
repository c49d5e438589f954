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
    Power,
    Sphere,
    canonical_wave,
    envelope,
    expand,
    hertz,
    homogenize,
    piston,
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
    missing = [page for page in PAGES if not (HTML / page).is_file()]
    assert not missing, f"the book is not built: {missing[0]} is missing in {HTML}"
    return visited(HTML, PAGES, width, mode)


def test_every_page_was_read(visit):
    assert set(visit.pages) == set(PAGES)
    assert not [page for page, report in visit.pages.items() if report["errors"]]


def test_all_mathematics_is_typeset(visit):
    for page, report in visit.pages.items():
        found = report["unrendered"] + report["merrors"] + report["raw"]
        assert not found, f"{page}: {found}"
        assert report["mathjax"] or not report["math"]
    equations = {page: report["rendered"] for page, report in visit.pages.items()}
    for chapter in CHAPTERS[1:9]:
        assert equations[f"{chapter}.html"] > 4


def test_every_picture_is_there(visit):
    assert not {page: r["broken"] for page, r in visit.pages.items() if r["broken"]}
    assert not [page for page, r in visit.pages.items() if r["unshown"]]
    assert sum(report["images"] for report in visit.pages.values()) > 2 * len(
        PAGES
    )  # logo, dark too
    assert not visit.missing


@pytest.mark.parametrize("mode", ["light", "dark"])
@pytest.mark.parametrize("width", [PHONE, WINDOW])
def test_nothing_is_cut_or_faint(width, mode):
    pages = opened(width, mode).pages
    assert not {page: r["faint"] for page, r in pages.items() if r["faint"]}
    assert not {page: r["cut"] for page, r in pages.items() if r["cut"]}
    assert not {page: r["crumbled"] for page, r in pages.items() if r["crumbled"]}
    assert not [page for page, r in pages.items() if r["wider"]]


def test_every_public_name_is_documented_and_no_private_one():
    found = set()
    for page in PAGES:
        names = re.findall(r'<dt class="sig[^>]* id="([^"]*)"', (HTML / page).read_text())
        assert not [name for name in names if re.search(r"\._", name)]
        assert not names or page.startswith("api_")
        found |= {name.rpartition(".")[2] for name in names}
        found |= set(
            re.findall(r'sig-name descname"><span class="pre">(\w+)<', (HTML / page).read_text())
        )
    assert {*lwa.__all__, *validation.__all__} - found <= {"hertz"}  # a module


def test_the_interface_is_documented_without_generic_text():
    """No type of a progress function, no text of Python about a type, no mark left unrendered."""
    for page in PAGES:
        if page.startswith("api_"):
            text = re.sub(r"<[^>]*>", "", (HTML / page).read_text())
            marks = r"Callable\[\[Iterable|PEP 604|Symbol class|\*\*[A-Z][^*]*\*\*|[.;] - \w"
            assert not re.findall(marks, text), page


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


def paper_spheres():
    """Steel and PTFE beads as the calculator weighs them: radius and density."""
    R = sp.Rational("2.38e-3")
    return [
        Sphere(4 * sp.pi.n(30) / 3 * R**3 * sp.Rational(m.density), R, Material(E=m.E, nu=m.nu))
        for m in (hertz.MATERIALS["steel 316"], hertz.MATERIALS["PTFE"])
    ]


def numbers(text):
    """The numbers of a printed line, with a minus as the page writes it."""
    return [float(x) for x in re.findall(r"-?\d[\d.]*(?:e[+-]?\d+)?", text.replace("−", "-"))]


def lattice_of(blow, found):
    """Pulse of a hundred beads at contact 80 by the engine: peak, width, speed, forces of beads."""
    load, cell = blow["load"], Cell.of_spheres(paper_spheres())
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
    peak, width = (
        (p + q) / 2 for p, q in ((pulses[2].peak, pulses[3].peak), (pulses[2].fwhm, pulses[3].fwhm))
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
    E = [1e9 * x / (1 - nu**2) for x, nu in ((193, 0.3), (1.46, 0.46))]
    modulus, R = 1 / sum(1 / e for e in E), 1.19e-3
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
    load, cell = blow["load"], Cell.of_spheres(paper_spheres())
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
    _, found = visit.pages["calculator.html"]["blows"][10]
    theory = found["theories"]["series in k − 1"]
    total = (
        expand(Dimer(1, sp.Rational(round(1e6 * found["omega"]), 10**6)), 8).fwhm("force").at("3/2")
    )
    sites = theory["width"] * found["lattice"]["speed"] / 4.58e-3
    assert abs(sites / float(total.value) - 1) < 5e-3
    assert abs(theory["error"] / float(total.error / total.value) - 1) < 0.2


def test_the_calculator_refuses_by_name(visit):
    """Equal beads have the theory's error; weak blows, extreme ratios and bad input have none."""
    blows = [found for _, found in visit.pages["calculator.html"]["blows"][5:10]]
    equal, weak, light, negative, heavy = blows
    error = equal["theories"]["canonical wave"]["width"] / equal["lattice"]["width"] - 1
    assert 0.05 < error < 0.08
    assert abs(equal["beads"][0] / equal["F"] - 0.707) < 3e-3
    assert abs(weak["growth"]) > 0.1
    assert "mass ratio" in light["refused"]
    assert "positive" in negative["refused"]
    assert "refused" in heavy or heavy["omega"] > 1


def test_a_harder_blow_is_seen_to_run_faster(visit):
    """Scale and clock stay while the slider moves, and the pulse from before runs along."""
    seen = visit.pages["play.html"]["harder"]
    assert seen["scales"][1] >= seen["scales"][0]
    assert seen["paces"][0] == seen["paces"][1]
    assert seen["passed"][1] > seen["passed"][0]
    assert seen["forces"][1] > 2 * seen["forces"][0]


def test_presets_shock_and_breather(visit):
    """Each thing that moves shows the numbers of the theory beside it."""
    assert visit.pages["exact.html"]["presets"] == [0.3428, 0.6]
    seen = visit.pages["shocks.html"]["shock"]
    rule = piston(
        Cell([1], spacing=1),
        Power("3/2"),
        sp.Rational(str(seen["v"])),
        ahead=sp.Rational(str(seen["p0"])),
    )
    assert seen["edge"] == pytest.approx(float(rule.leading_speed()), rel=1e-9)
    assert 1.85 < seen["fastest"] / seen["v"] < 2  # from below, as the train grows
    seen = visit.pages["modes.html"]["breather"]
    bottom = float(envelope(Dimer(1, "1/2", spacing=1), Power("3/2"), background=1).frequency)
    assert abs(seen["rate"] / bottom - (1 - seen["nu"])) < 1e-3 < seen["nu"]


def test_the_chain_on_the_page_is_the_chain_of_python(visit):
    """Speed and peak force of forty beads by both programs."""
    of_page = visit.pages["play.html"]["chain"]
    cell = Dimer(1, "0.2733", spacing=1)
    scene = Scene.of_cell(cell, 20, "3/2", velocities=(1,), duration=44.0, samples=8801,
                          contact_sensors=(12, 34))  # fmt: skip
    run = simulate(scene)
    pulses = [measure(run.time, force) for force in run.contact_force]
    speed = 22 / (pulses[1].arrival - pulses[0].arrival)
    assert abs(of_page["speed"] / speed - 1) < 2e-3
    assert abs(of_page["force"] / pulses[0].peak - 1) < 2e-3


def test_controls_have_names(visit):
    """Canvases and sliders are named for screen readers."""
    for page in ("intro.html", "play.html", "calculator.html"):
        assert not visit.pages[page]["unnamed"]
    assert visit.pages["play.html"]["sliders"] == 4
    script = HTML / "_static" / "turn.js"
    assert script.stat().st_size < 32_000
    for page in PAGES:
        turns = 'class="lwa-' in (HTML / page).read_text()
        assert ("turn.js" in (HTML / page).read_text()) == turns, page


def test_a_page_is_small(visit):
    """A page, its pictures and its scripts: at most 2.5 MB, MathJax and the theme aside."""
    for page in PAGES:
        text = (HTML / page).read_text()
        pictures = {HTML / name for name in re.findall(r'src="(_images/[^"]+)"', text)}
        assert len(text) + sum(file.stat().st_size for file in pictures) < 2_500_000, page


def test_pictures_have_alternative_texts(visit):
    assert not {page: r["silent"] for page, r in visit.pages.items() if r["silent"]}


def test_no_request_leaves_the_machine(visit):
    assert not visit.foreign


@pytest.mark.parametrize(
    ("body", "key"),
    [
        (r'<span class="math">\(x\)</span>', "unrendered"),
        (r"<p>\(x\)</p>", "raw"),
        ("<p>$$x$$</p>", "raw"),
        (
            '<span class="math"><mjx-container><mjx-merror>x</mjx-merror></mjx-container></span>',
            "merrors",
        ),
        ('<img src="nowhere.png">', "broken"),
        ("<pre>&lt;Figure size 650x520 with 1 Axes&gt;</pre>", "unshown"),
        ('<svg width="9" height="9"></svg>', "silent"),
        ('<div role="img">x</div>', "unnamed"),
    ],
)
def test_a_fault_of_a_page_is_found(tmp_path, body, key):
    (tmp_path / "page.html").write_text(SMALLEST % body)
    seen = visited(tmp_path, ["page.html"])
    assert seen.pages["page.html"][key]
    assert ("/nowhere.png" in seen.missing) == (key == "broken")


@pytest.mark.parametrize(
    "style", ["", "overflow-x: hidden", "overflow-x: auto", "max-width: 100%; overflow-x: auto"]
)
def test_a_cut_line_is_found(tmp_path, style):
    """Only what scrolls by itself, within the page, is whole."""
    line = f'<pre style="{style}">{"long " * 100}</pre>'
    (tmp_path / "page.html").write_text(SMALLEST % line)
    seen = visited(tmp_path, ["page.html"], PHONE).pages["page.html"]
    assert bool(seen["cut"]) == ("auto" not in style)
    assert seen["wider"] == (not style)


@pytest.mark.parametrize("color", ["#999", "#222"])
def test_faint_text_is_found(tmp_path, color):
    (tmp_path / "page.html").write_text(SMALLEST % f'<p style="color: {color}">words</p>')
    seen = visited(tmp_path, ["page.html"]).pages["page.html"]
    assert seen["faint"] == (["words"] if color == "#999" else [])


@pytest.mark.parametrize("wrap", ["anywhere", "normal"])
def test_a_word_of_one_letter_a_line_is_found(tmp_path, wrap):
    """Such a word is neither cut nor wider than the page: no other check finds it."""
    cell = f'<td><span class="pre" style="overflow-wrap: {wrap}">crumbs</span></td>'
    row = f"<table style='width: 80px'><tr>{cell}<td>{'long' * 20}</td></tr></table>"
    (tmp_path / "page.html").write_text(SMALLEST % f'<div style="overflow: auto">{row}</div>')
    seen = visited(tmp_path, ["page.html"], PHONE).pages["page.html"]
    assert seen["crumbled"] == (["crumbs"] if wrap == "anywhere" else [])


@pytest.mark.parametrize("width", [300, 900])
def test_a_cut_picture_is_found(tmp_path, width):
    picture = f'<div style="overflow: hidden"><svg width="{width}" height="9"></svg></div>'
    (tmp_path / "page.html").write_text(SMALLEST % picture)
    seen = visited(tmp_path, ["page.html"], PHONE).pages["page.html"]
    assert bool(seen["cut"]) == (width > PHONE)


def test_a_request_is_found(tmp_path):
    (tmp_path / "page.html").write_text(SMALLEST % '<img src="https://example.org/picture.png">')
    assert visited(tmp_path, ["page.html"]).foreign == ["https://example.org/picture.png"]
