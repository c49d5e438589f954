"""Tables of the pulses at sensors, and of the speeds from one sensor to the next."""

from __future__ import annotations

from collections.abc import Sequence

from validation.pulses.sensors import READINGS, SPEEDS, Reading, echoes
from validation.report.table import Column, Table


def reading_tables(
    sensors: Sequence[Reading],
    speeds: Sequence[Reading],
    labels: Sequence[str],
    si: bool,
    every: bool = False,
) -> tuple[tuple[Table, ...], str]:
    """Return the tables ``sensors`` and ``speeds``, with later pulses also ``echoes``, and lines on
    the numbers that are missing.

    sensors : with later pulses of a sensor behind its first one. labels : of arrival, peak and
    FWHM. si : True for results in SI units. every : True for all pulses in the table ``sensors``,
    in a column with the number of the pulse at its sensor, False for the first ones.

    The table of the sensors, which is the CSV, also holds the speeds of the first pulses from the
    sensor before; they are not printed twice.
    """
    columns = [Column("", "sensor"), Column("kind"), Column("number")]
    if every:
        columns.append(Column("pulse", "pulse"))
    for name, label in zip(READINGS, labels, strict=True):
        columns.append(Column(name, label, error=True))
    columns += [Column("static_force_value"), Column("missing")]
    columns += [Column(name, error=True) for name in SPEEDS]
    arriving = {f"{r.kind} {r.places[1]}": r.numbers for r in speeds}
    pulses = []
    for r in (r for r in sensors if every or r.pulse == 1):
        before = arriving.get(r.name, {}) if r.pulse == 1 else {}
        row = [r.name, r.kind, *r.places, *([r.pulse] if every else [])]
        row += [*map(r.numbers.get, READINGS), r.static, r.missing, *map(before.get, SPEEDS)]
        pulses.append(tuple(row))
    speed_columns = [Column("", "speed"), Column("kind"), Column("from"), Column("to")]
    units = ("sites/s", "m/s") if si else ("sites/time", "length/time")
    for name, label in zip(SPEEDS, units, strict=True):
        speed_columns.append(Column(name, label, error=True))
    speed_columns.append(Column("missing"))
    legs = ((r.name, r.kind, *r.places, *map(r.numbers.get, SPEEDS), r.missing) for r in speeds)
    tables = [
        Table(tuple(columns), tuple(pulses), "sensors"),
        Table(tuple(speed_columns), tuple(legs), "speeds"),
    ]
    if later := echoes(sensors):
        time = "delay (s)" if si else "delay"
        echo_columns = (
            Column("", "later pulse"),
            Column("kind"),
            Column("number"),
            Column("pulse", "pulse"),
            Column("reflected", "runs", format=lambda back: "back" if back else "on"),
            Column("delay", time, error=True),
            Column("ratio", "peak/first", error=True),
        )
        rows = [
            (r.name, r.kind, *r.places, r.pulse, back, *map(r.numbers.get, ("delay", "ratio")))
            for r, back in later
            if not r.missing
        ]
        tables.append(Table(echo_columns, tuple(rows), "echoes"))
    lines = (
        f"{r.name}{f', pulse {r.pulse}' if r.pulse > 1 else ''}: {r.missing}"
        for r in (*sensors, *speeds)
        if r.missing
    )
    return tuple(tables), "\n".join(lines)
