"""Sketches and long drawings of the book's pages."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import sympy as sp
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Circle, Rectangle
from studies.breather import Standing, continued

from lwa import Cell, Dispersion, Envelope, LoadedWave
from lwa.wave.numeric import NumericWave
from validation.scenes.chains import PTFE_BEAD, STEEL_BEAD
from validation.studies.paper import RECORDED, forces

BEAD, INNER = "#8FA3B5", "#E69F00"


def dimer(axes: Axes) -> None:
    """The dimer chain with the names of its displacements."""
    names = ("$u_{j-1}$", "$w_{j-1}$", "$u_j$", "$w_j$", "$u_{j+1}$", "$w_{j+1}$")
    for i, name in enumerate(names):
        light = i % 2 == 1
        radius = 0.42 if light else 0.58
        fill = INNER if light else "#0072B2"
        axes.add_patch(Circle((i, 0), radius, fc=fill, ec="k", lw=0.8))
        mass, ink = ("$m_2$", "k") if light else ("$m_1$", "w")
        axes.text(i, 0, mass, ha="center", va="center", color=ink)
        axes.text(i, 0.72, name, ha="center", va="bottom")
    axes.add_patch(Rectangle((1.41, -0.68), 2, 1.86, fill=False, ls="--", lw=1))
    for right, height, text in ((3, -0.86, "$D$"), (4, -1.32, "$2D$")):
        arrow = dict(arrowstyle="<->", lw=0.9)
        axes.annotate("", (2, height), (right, height), arrowprops=arrow)
        box = dict(fc="w", ec="none", pad=1.5)
        middle = (2 + right) / 2
        axes.text(middle, height, text, ha="center", va="center", bbox=box)
    axes.set(xlim=(-0.9, 5.9), ylim=(-1.5, 1.25), aspect="equal")
    axes.axis("off")


def lattices(figure: Figure, rows: Sequence[dict[str, Any]]) -> None:
    """Four lattices; below them speeds and widths of struck ones, beside the theory's."""
    above, below = figure.subfigures(2, 1, height_ratios=(1, 3))
    _sketch(above.subplots(1, 4))
    speeds, widths = below.subplots(1, 2)
    groups = {"unlike links": "δ", "resonators": "m_r", "packing": "a"}
    for (name, start), marker in zip(groups.items(), "osD", strict=True):
        for row in rows:
            theory = row["speed_theory_value"]
            if not (row["chain"].startswith(start) and theory):
                continue
            point = dict(color=f"C{'osD'.index(marker)}", marker=marker, mfc="none")
            speeds.loglog(row["speed_value"], theory, **point, ls="none", label=name)
            error = 100 * row["fwhm_error_value"]
            widths.semilogx(row["fwhm_value"], error, **point, ls="none")
    equal = [0.09, 1.4]
    speeds.plot(equal, equal, ":", color="0.4")
    widths.axhline(0, ls=":", color="0.4")
    speeds.set(xlabel="speed on the lattice", ylabel="speed by the theory")
    widths.set(xlabel="width on the lattice", ylabel="error of the width in percent")
    ticks = [1, 1.5, 2, 3, 4, 5]
    widths.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    widths.minorticks_off()
    lines, names = speeds.get_legend_handles_labels()
    once = dict(zip(names, lines, strict=True))  # each point is a line with its name
    speeds.legend(once.values(), once.keys())


def _sketch(sketches: Sequence[Axes]) -> None:
    """Unlike links, resonators, farther neighbours and a hexagonal packing."""
    titles = ("unlike links", "resonators", "farther neighbours", "packing")
    for sketch, title in zip(sketches, titles, strict=True):
        packed = title == "packing"
        for i in range(5):
            for row in (0, -1) if packed else (0,):
                place = (0.87 * i, row + i % 2 / 2) if packed else (i, row)
                radius = 0.36 if title == "unlike links" else 0.48
                sketch.add_patch(Circle(place, radius, fc=BEAD, ec="k", lw=0.7))
            if title == "unlike links" and i % 2:
                rubber = Rectangle(
                    (i + 0.36, -0.2), 0.28, 0.4, fc=INNER, ec="k", lw=0.6
                )
                sketch.add_patch(rubber)
            if title == "resonators":
                sketch.add_patch(Circle((i, 0), 0.2, fc=INNER, ec="k", lw=0.6))
            if title == "farther neighbours" and i < 3:
                ends = dict(theta1=0, theta2=180, color="#D55E00", lw=1.2)
                sketch.add_patch(Arc((i + 1, 0.42), 2, 0.7, **ends))
        sketch.set(xlim=(-0.7, 4.7), ylim=(-1.6, 1.1), aspect="equal")
        sketch.set_title(title, fontsize=10)
        sketch.axis("off")


def experiment(column: Axes, panels: Sequence[Axes]) -> None:
    """The paper's column, and forces of three beads in two of its chains beside the theory."""
    for j, y in enumerate((10.4, *range(8, 0, -1))):  # striker above, wall below
        fill = "#F2E6C9" if j % 2 else BEAD
        column.add_patch(Circle((0, y), 0.5, fc=fill, ec="k", lw=0.8))
    column.add_patch(Rectangle((-0.9, 0.2), 1.8, 0.3, fc="0.6"))
    column.add_patch(Rectangle((-0.42, 3.94), 0.84, 0.12, fc="C1"))
    line = dict(arrowstyle="-", lw=0.7)
    text = dict(fontsize=8.5, va="center")
    column.annotate("sensor", (0.4, 4), (0.75, 4), arrowprops=line, **text)
    column.annotate("", (0, 9), (0, 9.85), arrowprops=dict(arrowstyle="->"))
    column.text(0.75, 10.4, "striker", **text)
    column.set(xlim=(-1, 2.2), ylim=(0, 11), aspect="equal")
    column.axis("off")
    records = {N: forces(N) for N in (1, 2)}
    panels[1].sharey(panels[0])
    for axes, (N, record) in zip(panels, records.items(), strict=True):
        for bead, force in zip(RECORDED[N], record.bead_force, strict=True):
            axes.plot(1e3 * record.time, force, label=f"bead {bead}")
        axes.set_title(f"{N}:1 chain", loc="left", fontsize=11)
        axes.set(xlabel="time in ms", xlim=(0.25, 1.4))
    steel, ptfe, _ = (float(force.max()) for force in records[1].bead_force)
    theory = _papers_wave((steel + ptfe) / 2)
    time = records[1].time
    for i, force in enumerate(records[1].bead_force):
        highest = np.maximum.accumulate(force)
        half = (highest > 0.5 * force.max()) & (force < 0.3 * force.max())
        before_the_echo = int(np.argmax(half))
        arrival = time[np.argmax(force[:before_the_echo])]
        line = theory.curve(time - arrival, "force", "bead")
        label = None if i else "theory"
        panels[0].plot(1e3 * time, line, color="k", lw=0.9, ls="-", label=label)
    panels[0].set(ylabel="force of the bead in N", ylim=(0, 13))
    for axes in panels:
        axes.legend(loc="upper center", ncols=2, fontsize=9)


def _papers_wave(force: float) -> Any:
    """The paper's wave in its chain of steel and PTFE, at the peak force of a bead."""
    from lwa import homogenize

    chain = Cell.of_spheres([STEEL_BEAD, PTFE_BEAD])
    return homogenize(chain, k="3/2").pde.traveling_wave().at_force(force, of="bead")


DETUNINGS = ("1/2000", "1/1000", "1/500", "1/250", "1/125")


def standing(chain: Cell, edge: Envelope) -> tuple[dict[str, Standing], list[Any]]:
    """Breathers of a chain under 20 N, and orbits followed until contacts open."""
    found = {}
    for detuning in DETUNINGS:
        theory = edge.breather(detuning=detuning)
        cells = 2 * int(7 * theory.width) + 3
        found[detuning] = Standing(chain, 1.5, theory, cells, load=20.0)
    deepest = [found[DETUNINGS[-1]].orbit]
    pressed = deepest[0].chain
    step = 5e-4 * float(edge.frequency)
    while True:
        last = deepest[-1]
        times = np.linspace(0, last.period / 2, 101)
        stretch = -(pressed.strains @ last.displacements(times)).T
        if np.any(stretch >= pressed.rest):
            return found, deepest
        deepest.append(continued(last, last.frequency - step))


def breathers(
    left: Axes,
    right: Axes,
    edge: Envelope,
    found: dict[str, Standing],
    deepest: list[Any],
) -> None:
    """Displacements in one breather, and amplitudes over the frequency, in nm."""
    one = found["1/250"]
    light = one.beads[1] == 1  # the aluminium balls
    cells = one.beads[0][light]
    width = float(one.theory.width)
    sign = (-1.0) ** cells
    square = float((one.theory.amplitude[1] / edge.mode[1] / 2) ** 2)
    envelope = one.theory.displacements(np.arange(cells[0], cells[-1] + 1))[:, 1]
    lasting = -float(sum(edge.mean_strain)) * square * width * np.tanh(cells / width)
    stayed = one.orbit.coefficients[light, 0]
    swing = one.orbit.amplitude[light]
    for dots, line, color, name in (
        (sign * swing, sign * envelope, "C1", "amplitude"),
        (stayed, lasting, "C0", "static part"),
    ):
        label = f"{name}, envelope"
        left.plot(cells, 1e9 * line, color=color, ls="-", lw=1.2, label=label)
        left.plot(cells, 1e9 * dots, ".", color=color, ms=5, label=f"{name}, lattice")
    left.set(xlabel="cell", ylabel="displacement (nm)", ylim=(-500, 1400))
    tight = dict(columnspacing=1, handlelength=1.2)  # names fit between the axes
    left.legend(loc="upper center", ncols=2, fontsize=7.5, **tight)
    top = float(edge.frequency)
    orbits = [standing.orbit for standing in found.values()] + deepest[1::2]
    places = [orbit.frequency / top for orbit in orbits]
    amplitudes = [1e9 * orbit.amplitude.max() for orbit in orbits]
    right.plot(places, amplitudes, ".", color="C1", ms=5, label="lattice")
    deltas = [sp.Rational(n, 2000) for n in range(1, 46)]
    line = [1e9 * float(edge.breather(detuning=d).amplitude[1]) for d in deltas]
    right.plot(
        [1 - d for d in deltas], line, color="C1", ls="-", lw=1.2, label="envelope"
    )
    last = deepest[-1]
    place, height = last.frequency / top, 1e9 * last.amplitude.max()
    right.plot(place, height, "x", color="k", ms=7, label="contacts open")
    right.legend(fontsize=7.5)
    right.set(xticks=(0.98, 0.99, 1), xlabel="frequency over the edge's")
    right.set_ylabel("amplitude (nm)")


def strip(axes: Axes, ratios: Sequence[str], measured: Sequence[Any]) -> Any:
    """Errors of the theories' widths over the mass ratio, and the loss of force; the image."""
    errors = np.array([one.widths for one in measured]).T
    decay = np.array([max(one.pulse.decay, 0) for one in measured])
    shade = np.vstack([np.abs(errors), 10 * decay])
    scale = np.log10(np.clip(shade, 1e-3, 0.3))
    image = axes.imshow(scale, cmap="YlGnBu", vmin=-3.2, vmax=-0.3, aspect="auto")
    for (i, j), size in np.ndenumerate(shade):
        if np.isnan(size):
            box = Rectangle(
                (j - 0.5, i - 0.5), 1, 1, fc="none", ec="0.8", hatch="//", lw=0
            )
            axes.add_patch(box)
            continue
        text = f"{100 * decay[j]:.2f}" if i == 3 else f"{100 * errors[i, j]:+.1f}"
        if i == 2:
            text += f"\n±{100 * measured[j].estimate:.2g}"
        ink = "w" if size > 0.06 else "k"
        place = dict(ha="center", va="center", fontsize=9, color=ink)
        axes.text(j, i, text.replace("-", "−"), **place)
    axes.set_xticks(
        range(len(ratios)), [f"{float(sp.Rational(r)):.2g}" for r in ratios]
    )
    axes.set_xlabel(r"mass ratio $\omega = m_2/m_1$, spheres")
    axes.grid(False)
    return image


def shock(above: Axes, below: Axes, over: Any, train: Any) -> Any:
    """A shock's train with its edges, and the strain over place and time; the image."""
    for curve in train.curves:
        # Two of the edges nearly coincide: their names stand in the legend, not beside them.
        edge = len(curve.x) == 2
        label = curve.label if edge else None
        above.plot(curve.x, curve.y, curve.style, lw=1.3, label=label)
    above.legend(loc="lower left")
    above.set(ylabel="strain at the last time")
    found = over.map
    look = dict(cmap="Blues", shading="nearest", rasterized=True)
    image = below.pcolormesh(found.x, found.y, found.values, **look)
    below.grid(False)
    below.set(xlabel=over.x, ylabel=over.y)
    return image


def observers(
    panels: Sequence[Axes],
    paper: NumericWave,
    first: NumericWave,
    canonical: NumericWave,
) -> None:
    """Length of the pulse of spheres over the mass ratio, in two closures and three fields."""
    left, right = panels
    omega = np.geomspace(1e-2, 1e2, 401)
    left.semilogx(omega, paper.width(1.5, omega), label="paper's closure")
    left.semilogx(omega, first.width(1.5, omega), label="full closure")
    left.axvline(0.123 / 0.45, color="k", lw=1.2, ls=":")
    right.semilogx(omega, first.width(1.5, omega), "C1--", label="beads $m_1$")
    right.semilogx(omega, first.width(1.5, 1 / omega), "C2-.", label="beads $m_2$")
    right.semilogx(omega, canonical.width(1.5, omega), "k-", lw=1.2, label="canonical")
    left.set(ylabel=r"length $\pi/(\beta D)$ in sites", ylim=(0, None))
    left.set_title("field of the beads $m_1$", loc="left", fontsize=11)
    right.set_title("full closure, three fields", loc="left", fontsize=11)
    right.tick_params(labelleft=True)
    for axes in panels:
        axes.set_xlabel(r"mass ratio $\omega = m_2/m_1$")
        axes.legend()


def bands(axes: Axes, chain: Dispersion) -> None:
    """Both branches of a linear dimer, with their long-wave series."""
    kappa = np.linspace(0, np.pi / 2, 200)
    wide = dict(color="0.75", ls="-", lw=5, solid_capstyle="butt")
    lines = axes.plot(kappa / np.pi, chain.bands.branches(kappa), **wide)
    lines[0].set_label("exact")
    for order, look in ((4, dict(color="C1", ls="--")), (12, dict(color="C0", ls="-"))):
        for series in (chain.acoustic, chain.optical):
            squared = np.zeros(len(kappa))
            for n, coefficient in series(order).items():
                squared += float(coefficient) * kappa**n
            squared[squared <= 0] = np.nan
            label = f"series, order {order}" if series == chain.acoustic else None
            axes.plot(kappa / np.pi, np.sqrt(squared), label=label, **look)
    (_, low), (high, _) = chain.bands.edges()
    axes.axhspan(low, high, color="#56B4E9", alpha=0.15, lw=0)
    axes.text(0.02, (low + high) / 2, "no wave", va="center", fontsize=10)
    axes.set_xlabel(r"wavenumber $\kappa/\pi$ (1/2: the end of the zone)")
    axes.set(ylabel=r"frequency $\Omega$", xlim=(0, 0.5), ylim=(0, 2.75))
    axes.legend(loc="center right", bbox_to_anchor=(1, 0.61))


def ridges(figure: Figure, runs: dict[str, Any]) -> None:
    """Force in every contact of struck chains, by their mass ratio, over place and time."""
    panels = figure.subplots(1, 2, sharex=True, sharey=True)
    for axes, (ratio, run) in zip(panels, runs.items(), strict=True):
        place = np.array(run.scene.contact_sensors) + 0.5
        look = dict(cmap="magma_r", norm="asinh", shading="nearest", rasterized=True)
        image = axes.pcolormesh(place, run.time, run.contact_force.T, **look)
        image.norm.linear_width = 0.02  # weak ripples are seen, too
        image.norm.vmin = 0
        image.norm.vmax = 0.5
        axes.grid(False)
        axes.set_title(rf"$\omega = {ratio}$", loc="left")
        axes.set_xlabel("position $x/D$")
    panels[0].set_ylabel("time $t$ ($m_1 = A = D = 1$)")
    bar = figure.colorbar(image, ax=panels, pad=0.01)
    bar.ax.set_title("$F$", fontsize=11)
    bar.set_ticks([0, 0.05, 0.2, 0.5], labels=["0", "0.05", "0.2", "0.5"])
    bar.minorticks_off()


def upright(panels: Sequence[Axes], chains: Sequence[Any]) -> None:
    """Width over depth, from the study's panels of equal spheres and of a dimer.

    Fronts of weak blows in both, and pulses of three strong blows in equal spheres.
    """
    left, right = panels
    for i, (chain, name) in enumerate(
        zip(chains, ("equal spheres", "dimer"), strict=True)
    ):
        front, theory = chain.curves[:2]
        left.loglog(front.x, front.y, f"C{i}{'os'[i]}", mfc="none", label=name)
        below = theory.x >= front.x[0]  # the study draws the line from the top on
        left.loglog(theory.x[below], theory.y[below], f"C{i}-", lw=1)
    equal = chains[0].curves[2:]  # a pulse and its solitary wave for each blow
    for i, (pulse, alone) in enumerate(zip(equal[::2], equal[1::2], strict=True)):
        right.loglog(pulse.x, pulse.y, f"C{i}{'osD'[i]}", label=pulse.label)
        label = "solitary waves" if i == 2 else None
        right.loglog(alone.x, alone.y, f"C{i}--", lw=1, label=label)
    left.set(ylabel="FWHM of the velocity in sites")
    right.set(ylabel="FWHM of the force in sites")
    for axes, ticks in ((left, [8, 10, 12, 15, 18]), (right, [2, 5, 10, 20, 40])):
        axes.set(xlabel="depth in sites")
        axes.set_yticks(ticks, [str(tick) for tick in ticks])
        axes.minorticks_off()
        axes.legend()


def forms(
    axes: Axes,
    exponents: Sequence[sp.Rational],
    exact: Sequence[float],
    theories: dict[str, Callable[[sp.Rational], Any]],
) -> None:
    """Errors of the theories' widths of equal beads, against exact waves, over k - 1."""
    for (name, width), marker in zip(theories.items(), "osD^", strict=True):
        errors = []
        for k, truth in zip(exponents, exact, strict=True):
            error = abs(float(width(k)) / truth - 1)
            errors.append(max(error, 1e-13))  # rounding
        axes.loglog([k - 1 for k in exponents], errors, marker=marker, label=name)
    axes.axvline(0.5, color="0.6", lw=0.8, ls="-")
    axes.text(0.47, 3e-12, "spheres", fontsize=10, color="0.3", ha="right")
    axes.set_xlabel(r"$\varepsilon = k - 1$")
    axes.set(ylabel="relative error of the FWHM", ylim=(1e-13, 2))
    axes.legend(loc="lower center", bbox_to_anchor=(0.62, 0))  # beside the curves


def laws(panels: Sequence[Axes], waves: dict[str, LoadedWave]) -> None:
    """Force over compression, and speed over peak strain, of laws by name."""
    left, right = panels
    heights = 0.3 * np.linspace(0.05, 1, 40) ** 2  # densest where speeds rise steeply
    for name, wave in waves.items():
        left.plot(heights, wave.law.at(heights), label=name)
        right.plot(heights, [float(wave.field.speed(sp.Float(B))) for B in heights])
    left.set(xlabel=r"compression $\delta$", ylabel="force $F$", ylim=(0, 1))
    right.set(xlabel="peak strain $B$", ylabel="speed $V_s$")
    right.set(yscale="log", ylim=(0.2, 10))
    ticks = [0.2, 0.5, 1, 2, 5, 10]
    right.set_yticks(ticks, [f"{tick:g}" for tick in ticks])
    right.minorticks_off()
    left.legend(loc="upper right", fontsize=9)
