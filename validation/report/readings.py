"""Tables of the pulses at sensors, and of the speeds from one sensor to the next."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from validation.pulses.sensors import READINGS, SPEEDS, Reading
from validation.report.table import Column, Table


def reading_tables(
    sensors: Sequence[Reading],
    speeds: Sequence[Reading],
    labels: Sequence[str],
    si: bool,
    every: bool = False,
) -> tuple[tuple[Table, Table], str]:
    """Return the tables ``sensors`` and ``speeds``, and lines on the numbers that are missing.

    labels : of arrival, peak and FWHM. si : True for results in SI units. every : True for a column
    with the number of the pulse at its sensor.

    The table of the sensors, which is the CSV, also holds the speeds of the first pulses from the
    sensor before; they are not printed twice.
    """
    pulse_columns = (
        *(Column("", "sensor"), Column("kind"), Column("number")),
        *[Column("pulse", "pulse")] * every,
        *(*_measured(READINGS, labels), Column("static_force_value"), Column("missing")),
        *(Column(name, error=True) for name in SPEEDS),
    )
    speed_columns = (
        *(Column("", "speed"), Column("kind"), Column("from"), Column("to")),
        *_measured(SPEEDS, ("sites/s", "m/s") if si else ("sites/time", "length/time")),
        Column("missing"),
    )
    arriving = {f"{r.kind} {r.places[1]}": _numbers(r, SPEEDS) for r in speeds}
    pulses = tuple(
        (
            *(*_place(r), *[r.pulse] * every, *_numbers(r, READINGS), r.static, r.missing),
            *(arriving[r.name] if r.pulse == 1 and r.name in arriving else (None, None)),
        )
        for r in sensors
    )
    times = tuple((*_place(r), *_numbers(r, SPEEDS), r.missing) for r in speeds)
    tables = Table(pulse_columns, pulses, "sensors"), Table(speed_columns, times, "speeds")
    return tables, "\n".join(f"{r.name}: {r.missing}" for r in (*sensors, *speeds) if r.missing)


def _measured(names: Sequence[str], labels: Sequence[str]) -> Iterator[Column]:
    """Yield columns of measured numbers."""
    return (Column(name, label, error=True) for name, label in zip(names, labels, strict=True))


def _place(reading: Reading) -> tuple[Any, ...]:
    """Return the first cells of a row: a reading's name, kind, and numbers of its sensors."""
    return reading.name, reading.kind, *reading.places


def _numbers(reading: Reading, names: Sequence[str]) -> list[Any]:
    """Return the cells of a reading."""
    return [reading.numbers.get(name) for name in names]
