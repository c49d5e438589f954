"""Measured files: cells, names and units of columns, and what is refused."""

from contextlib import suppress

import numpy as np
import pytest
from hypothesis import example, given, settings, strategies as st

from lwa import InputError
from validation.scenes.columns import in_si
from validation.scenes.measured import MeasuredFile


@pytest.fixture
def read(tmp_path):
    """Read a text as a measured file."""

    def measured(text, encoding="utf-8", **stated):
        file = tmp_path / "record.csv"
        file.write_bytes(text.encode(encoding))
        return MeasuredFile.read(file, **stated)

    return measured


@pytest.mark.parametrize(
    ("text", "encoding"),
    [
        ("\ufefftime (ms)\tforce (N)\n1,5\t-2e3\n2.5\t4\n", "utf-8"),
        (
            "# 1 MHz; 8 bit\nTime,12:03\n time (ms) , force (N) \r\n1.5,-2e3\r\n\r\n2.5,4",
            "utf-16",
        ),
        (
            'CH2,"time (ms)","force (N)"\n7,"1.5","-2e3"\n8,2.5,4\n9,,\nEnd,of,data\n',
            "latin-1",
        ),
        ("% time(ms)  force (N)\n 1.5 −2e3\n 2.5   4\n\n", "utf-8"),
        ("Zeit;Kraft\ntime/ms;force in N\n1,5;-2000,0;x\n2,5;4;y\n", "latin-1"),
        (
            "D,T,time_ms,force N\na,1:0,1.5,-2e3\n# x\nD,T,time_ms,force N\na,1:1,2.5,4\n",
            "utf-8",
        ),
        ('time (ms), "force (N)"\n"1,5", "-2D3"\n"2,5", + 4\n5",x\n', "utf-8"),
        # Thousands have a sign where another one is that of decimals.
        (
            "day;time / ms;force, N\n28.11.2026;1,5;-2.000\n28.11.2026;2,5;4,0\n",
            "utf-16-le",
        ),
        ('"time\n(ms)"\t"force\n(N)"\n1.5\t-2,000\n2.5\t4\n', "utf-8"),
        ("time (ms);force (N)\n1,5;-2\u202f000\n2,5;4\n", "utf-8"),
        ("time (µs);force (N)\n1.500,0;-2.000,0\n2.500,0;4\n", "utf-8"),
        # A time of day above a signal is a setting.
        ("n,time (ms),force (N)\nT,9:01:02,9:01:02\n1,1.5,-2e3\n2,2.5,4\n", "utf-8"),
    ],
)
def test_separators_decimals_and_what_stands_around_the_numbers(read, text, encoding):
    found = read(text, encoding=encoding).rows("time", "force")
    assert found == pytest.approx(np.array([[1.5e-3, -2000], [2.5e-3, 4]]), rel=1e-15)


def test_rows_of_numbers_above_a_record_belong_to_the_preamble(read):
    """They are few, and lines without numbers follow them; a gap in a record is refused."""
    record = "".join(f"{n},{2 * n}\n" for n in range(40))
    stated = {"columns": {"force": "2"}, "step": "1"}
    file = read(f"Range,5\nOffset,0\nt,CH1\n{record}", **stated)
    assert file.rows("force").ravel().tolist() == list(range(0, 80, 2))
    columns = {"time": "1", "force": "2"}
    for rest in (f"7,\n{record}", f'"1,300.5",7\n{record}'):
        file = read(f"t,CH1\n{record}t,CH1\n{rest}", columns=columns)
        with pytest.raises(InputError, match=r"line 42 is a gap.* head -n 41 keeps"):
            file.rows("time", "force")


def test_a_table_that_lies_is_set_upright(read):
    times = [*range(9)]
    row = ",".join(map(str, times))
    named, stated = f"time,{row}\nforce,{row}", {"time": "1", "force": "2"}
    for file in (read(named), read(f"{row}\n{row}", columns=stated)):
        assert file.rows("time", "force").T.tolist() == [times, times]
    # Numbers of beads in a header do not make the table lie.
    file = read(f"t,{row}\n{row},9\n", columns=stated)
    assert file.rows("time", "force").tolist() == [[0, 1]]


@pytest.mark.parametrize(
    ("unit", "base", "size"),
    [
        ("µs", "s", 1e-6),
        ("uSec", "s", 1e-6),
        ("NS", "s", 1e-9),
        ("Ms", "s", 1e6),
        ("MN", "N", 1e6),
        ("kNewton", "N", 1e3),
        ("mm/s", "m/s", 1e-3),
        ("lbf", "N", None),
        ("min", "s", None),
    ],
)
def test_units_with_any_prefix_in_the_spellings_of_recorders(unit, base, size):
    assert in_si(unit, base) == (size and pytest.approx(size, rel=1e-15))


@pytest.mark.parametrize(
    ("header", "units", "size"),
    [
        ("time (s),CH1", {"force": "kN"}, 1e3),
        ("time (s),CH1 (V)", {"ch1": "1.5 kN/V"}, 1.5e3),
        ("time (s),CH1 (mV)", {"ch1": "10 mV/N"}, 0.1),
        ("time (s),CH1 (kV)", {"ch1": "10 mV/N"}, 1e5),
        ("time (s),CH1 (10 V)", {"ch1": "N/V"}, 1),
        ("time (s),CH1", {"2": "-2"}, -2),
        ("time (s),CH1 (m/s^2)", {"CH1": "0.029 N/m/s^2"}, 0.029),
        ("time (s),CH1\nms,kN", {}, 1e3),  # a header's unit stands above a row's
        ("time (s),CH1 (mN)", {"force": "kN"}, 1e3),
        ("time,CH1", {}, 1),
        ("time,CH1", {"force": "-3"}, -3),
    ],
)
def test_units_are_stated_by_the_user_or_by_the_file(read, header, units, size):
    text = f"{header}\n1,7\n"
    file = read(text, columns={"force": "CH1"}, units=units)
    assert file.rows("time", "force") == pytest.approx(
        np.array([[1, 7 * size]]), rel=1e-15
    )
    assert file.si == (header != "time,CH1")


@pytest.mark.parametrize(
    ("columns", "units", "step", "found"),
    [
        ({}, {}, "", [1, 2]),
        ({"time": "1", "force": "force (n)"}, {"1": "ms"}, "", [0, 2]),
        # A unit is that of the column of this name, not of a header that has it.
        ({"time": "1", "force": "4"}, {"1": "ms", "Force": "2 N/V"}, "", [0, 6]),
        ({"force": "volt"}, {"4": "2 N/V"}, "0.5 us", [0, 6]),
    ],
)
def test_a_column_is_named_by_its_lowest_header_or_by_its_number(
    read, columns, units, step, found
):
    text = "time,off,Volt\nCH1,time (s),FORCE (N),Volt\n0,1,2,3\n"
    file = read(text, columns=columns, units=units, step=step)
    assert file.rows("time", "force").tolist() == [found]


@pytest.mark.parametrize(
    ("text", "times"),
    [
        ("time,1 force,2 force\n1,5,6\n", {1: [1], 2: [1]}),
        ("Time,Time,2 force,1 force\n1,2,5,6\n", {2: [1], 1: [2]}),
        # Beads come first.
        ("time,2 force,time,bead 1 force\n1,5,2,6\n", {1: [2], 2: [1]}),
        ("1 force,time,2 force\n5,1,6\n,2,7\n", {1: [1], 2: [1, 2]}),
        (
            "time,bead 1 force,bead 1 velocity,bead 2 velocity\n1,5,2,6\n",
            {1: [1], 2: [1]},
        ),
    ],
)
def test_one_time_is_that_of_all_sensors_or_the_first_that_of_the_first(
    read, text, times
):
    """A bead whose force is there is read by its force."""
    found = read(text).records()
    assert {record.number: record.time.tolist() for record in found} == times
    assert [record.values[0] for record in found if record.number == 1] in ([5], [6])


def test_times_of_the_sensors_are_stated_by_the_numbers_of_their_columns(read):
    file = read("a,1 force,b,2 force\n1,5,2,6\n", columns={"time": "1,3"})
    assert [record.time.item() for record in file.records()] == [1, 2]


@pytest.mark.parametrize(
    ("unit", "units", "key", "turned"),
    [
        ("mV", {"2": "12.5 N/mV"}, "2", "-12.5 N/mV"),
        ("N", {}, "force", "-N"),
        ("mV", {"force": "-N"}, "force", "N"),
    ],
)
def test_an_inverted_record_is_turned_by_the_users_own_statement(
    read, unit, units, key, turned
):
    (record,) = read(f"time (s),force ({unit})\n1,7\n2,8\n", units=units).records()
    assert (record.key, record.turned[key]) == (key, turned)


HEAD = "time (s),force (N)\n"
STATED = {"columns": {"force": "2"}}


@pytest.mark.parametrize(
    ("text", "stated", "named"),
    [
        (
            "time (s),force (lbf)\n1,2\n",
            {},
            "unit of force is 'lbf'.*'force': '\\? N/lbf'",
        ),
        ("time,force\n1,2\n", {"units": {"force": "N"}}, "unit of time is missing"),
        (f"{HEAD}1,2\n", {"units": {"force": "x N/V"}}, "unit of force is 'x N/V'"),
        (f"{HEAD}1,2\n", {"units": {"CH9": "N"}}, "no column is 'CH9': found"),
        (
            "TIME (s),CH1\n0.1,2\n",
            {},
            "2 'CH1' 2; try columns={'force': '2'}, units={'force': '\\? N'}$",
        ),
        # Settings in the first column: the numbers are those of the others.
        (
            "Length,9,0,1\nSource,CH1,0,2\n" + ",,1,3\n" * 30,
            {},
            "found 3 '' 1, 4 '' 3; try columns={'time': '3', 'force': '4'}$",
        ),
        # Units tell before the entries do: times in us may rise by 1, as numbers of lines.
        (
            "n,t (us),a,b (N)\n0,0,2,5\n1,1,4,7\n2,2,1,6\n",
            {},
            "try columns={'time': '2', 'force': '4'}$",
        ),
        # Numbers of samples are no times.
        (
            "X,CH1\n0,2\n1,3\n2,1\n",
            {},
            "try columns={'force': '2'}, step='\\? us', units={'force': '\\? N'}$",
        ),
        ("time (s),V (N)\n0,2\n0,3\n1,4\n", STATED, "increase.* step='\\? us'$"),
        (
            HEAD + "".join(f"{n // 3},2\n" for n in range(600)),
            {},
            "increase.* step='0.3333",
        ),
        # A second part of a file begins anew.
        ("time (s),V (N)\n0,2\n1,3\n0,4\n", STATED, "time falls behind 1: "),
        (
            "t1,a,t2,b\n0,2,5,1\n3,5,7,3\n4,4,8,2\n",
            {"columns": {"1 force": "2", "2 force": "4"}},
            "try columns={'1 force': '2', '2 force': '4', 'time': '1,3'}$",
        ),
        ("time,V,V\n1,2,3\n", {"columns": {"force": "V"}}, "2 columns are 'V'"),
        (f"{HEAD}1,2\n", {"columns": {"force": "fource"}}, "near: force .N.: found"),
        ("time,force\n1,2\n", {"columns": {"bead x": "1"}}, "column is 'bead x'"),
        ("\x00\xff\n", {"encoding": "latin-1"}, "record.csv: it is no table"),
        ('{"time_value": [0, 1]}', {}, "it is no table but JSON; try: lwa-"),
        ("a,b\nc,d\n", {}, "found no numbers$"),
        ("time,force\n1,2\n1.5,∞\n2,3\n", {}, "line 3 holds ∞, the signal is clipped"),
        (
            "time,1 force,time\n1,5,2\n3,5,4\n",
            {},
            "2 columns are 'time': .* columns={'time': '1'}",
        ),
        (f"{HEAD}1,2\n", {"columns": {"force": "9"}}, "no row .*'2'}$"),
        # A long header of digits is no number of a column.
        (f"{HEAD}1,2\n", {"columns": {"force": "1" * 40 + "x"}}, "no column is"),
        (f"{HEAD}1,2\n2,+OL\n3,4\n", {}, "line 3 holds ∞"),
        (f"{HEAD}1,2\n2,9.9E37\n3,4\n", {}, "line 3 holds ∞"),
        (
            f"{HEAD}1,2\n2,1_0\n3,4\n",
            {"step": "1"},
            "line 3 is a gap in the record: '2,1_0'",
        ),
        (f"{HEAD}1,2\n", {"step": "x"}, "step is 'x': .* step='\\? us'$"),
        (f"{HEAD}1,2\n", {"units": {"time": "? s"}}, "unit of time is '\\? s'"),
        ("time (s),force (10 N)\n1,2\n", {}, "'10 N': .*units={'force': '10 N'}$"),
        (f"{HEAD}1,2\n2,\n3,\n4,\n5,6\n6,7\n7,8\n8,9\n", {}, "line 3 is a gap"),
        ("rate 5\nSample rate: 2 MHz,\nn,CH1\n0,2\n1,3\n", {}, "step='2 MHz'"),
    ],
)
def test_a_bad_file_is_refused(read, text, stated, named):
    with pytest.raises(InputError, match=named):
        read(text, **stated).records()


cells = st.sampled_from(
    ["time", "force", "1", "-2.5e3", "1,5", "", "∞", "x (N)", "ms", '"', "#"]
)
rows = st.lists(st.lists(cells, max_size=4), max_size=6)
texts = st.builds(
    lambda rows, mark, end: end.join(mark.join(row) for row in rows),
    rows,
    st.sampled_from([",", ";", "\t", " ", " , "]),
    st.sampled_from(["\n", "\r\n", "\r"]),
)


@settings(max_examples=40)
@given(texts | st.text(max_size=80), st.sampled_from(["utf-8", "utf-16", "latin-1"]))
@example('"\n1', "utf-8")
def test_any_text_is_read_or_refused(tmp_path_factory, text, encoding):
    file = tmp_path_factory.mktemp("any") / "record.csv"
    file.write_bytes(text.encode(encoding, "replace"))
    for stated in ({}, {"columns": {"time": "1", "8 force": "2"}}, {"step": "1 ms"}):
        with suppress(InputError):
            MeasuredFile.read(file, **stated).records()
