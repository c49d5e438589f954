"""The reader of measured files: units that are stated, and what is refused."""

import re

import pytest

from validation.scenes.columns import MeasuredFile
from validation.scenes.scene import SceneError


def read(tmp_path, text, *wanted, encoding="utf-8", **options):
    file = tmp_path / "record.csv"
    file.write_bytes(text.encode(encoding))
    return MeasuredFile.read(file, *(wanted or ("time", "force")), **options)


def values(file, *names):
    return [file.column(name).tolist() for name in names]


UNITS = {
    **{"time [ms]": 1e-3, "time [\u03bcs]": 1e-6, "time (us)": 1e-6, "time (ns)": 1e-9},
    **{"displacement(mm)": 1e-3, "displacement [ µm ]": 1e-6, "speed (km/s)": 1e3},
    **{"speed_error (mm/s)": 1e-3, "force_error (kN)": 1e3},
}


def test_units_are_read(tmp_path):
    for column, size in UNITS.items():
        name = re.match(r"\w+", column)[0]
        file = read(tmp_path, f"{column},strain\n7,2\n", name)
        assert file.column(name) == pytest.approx([7 * size], rel=1e-15), column


@pytest.mark.parametrize(
    ("header", "units", "size"),
    [
        ("time (s),CH1", {"force": "kN"}, 1e3),
        ("time (s),CH1 (V)", {"ch1": "1.5 kN/V"}, 1.5e3),
        ("time (s),CH1", {"CH1": "-2 N/V"}, -2),
        ("time (s),CH1 (pC)", {"CH1": "5 mN/pC"}, 5e-3),
        ("time (s),CH1\nms", {"force": "kN"}, 1e3),
        ("time,CH1", {}, 1),
    ],
)
def test_units_are_stated_by_header_row_or_user(tmp_path, header, units, size):
    file = read(tmp_path, f"{header}\n1,7\n", renamed={"force": "CH1"}, units=units)
    assert file.column("time").tolist() == [1]
    assert file.column("force") == pytest.approx([7 * size], rel=1e-15)


@pytest.mark.parametrize(
    "text",
    [
        "\ufefftime (ms)\tforce (N)\n1,5\t-2e3\n2.5\t4\n",
        "# 1 MHz; 8 bit\n\nTime,12:03\n time (ms) , force (N) \r\n1.5,-2e3\r\n\r\n2.5,4",
        'CH2,"time (ms)","force (N)"\n7,"1.5","-2e3"\n8,2.5,4\n9,,\n',
    ],
)
def test_separators_decimals_and_lines_before_the_header(tmp_path, text):
    found = values(read(tmp_path, text), "time", "force")
    assert found == [pytest.approx([1.5e-3, 2.5e-3], rel=1e-15), [-2000, 4]]


def test_names_are_compared_without_regard_to_case_but_for_renamed_ones(tmp_path):
    text = "Time (s),FORCE (N),T (s),t (s)\n1,2,3,4\n"
    assert values(read(tmp_path, text), "time", "force") == [[1], [2]]
    for header, value in (("t", 4.0), ("T", 3.0), ("FORCE", 2.0), ("T (s)", 3.0)):
        file = read(
            tmp_path, text.replace("(N)", "(s)"), "time", renamed={"time": header}
        )
        assert values(file, "time") == [[value]]


@pytest.mark.parametrize(
    ("text", "times"),
    [
        ("time,1 force,time,2 force\n1,5,2,6\n", {1: [1], 2: [2]}),
        ("Time,Time,2 force,1 force\n1,2,5,6\n", {2: [1], 1: [2]}),
        (
            "time,2 force,time,bead 1 force\n1,5,2,6\n",
            {1: [2], 2: [1]},
        ),  # beads come first
        ("force,time\n5,1\n,2\n", {None: [1]}),
        ("1 force,time,2 force\n5,1,6\n,2,7\n", {1: [1], 2: [1, 2]}),
    ],
)
def test_one_time_is_that_of_all_sensors_or_the_first_that_of_the_first_force(
    tmp_path, text, times
):
    file = read(tmp_path, text)
    found = {
        number: file.record(*at)[0].tolist()
        for (_, number), at in file.sensors().items()
    }
    assert list(found.items()) == list(times.items())


HEAD = "time (s),force (N)\n"


@pytest.mark.parametrize(
    ("text", "options", "named"),
    [
        (
            "time (s),force (lbf)\n1,2\n",
            {},
            "force has the unit 'lbf': --unit states one of N",
        ),
        (
            "time (s),force (V)\n1,2\n",
            {},
            "one of N, mN, kN, Newton, or such as 12.5 N/V",
        ),
        ("time (s),force\n1,2\n", {}, "column force has no unit"),
        ("time,force\n1,2\n", {"units": {"force": "N"}}, "column time has no unit"),
        (f"{HEAD}1,2\n", {"units": {"force": "mN"}}, "'N' and is given 'mN'"),
        (
            f"{HEAD}1,2\n",
            {"units": {"force": "12.5 N/V"}},
            "'N' and is given '12.5 N/V'",
        ),
        ("time (s),force (mV)\n1,2\n", {"units": {"force": "12.5 N/V"}}, "12.5 N/mV"),
        (f"{HEAD}1,2\n", {"units": {"force": "x N/V"}}, "is given 'x N/V'"),
        (f"{HEAD}1,2\n", {"units": {"CH9": "N"}}, "unit is of 'CH9'"),
        ("time (s),force (N),force (N)\n1,2,3\n", {}, "one column force is wanted"),
        ("time,strain\n1,2\n", {}, "no line names time, force: --column"),
        (
            "time,lateral force\nbead 8 time,force\n",
            {},
            "no line names time, force: --column",
        ),
        ("\x00\xff\n", {"encoding": "latin-1"}, "--column"),
        ("time;force\n1,5;2;3\n1.500,5;2\n", {}, "column time, line 3: '1.500,5'"),
        ("# a\ntime,force\n1,2\n3\n4,5\n", {}, "column force, line 4: ''"),
        ("time,force\n1,inf\n", {}, "column force, line 2: 'inf'"),
        (
            "time,force\n1,2\n",
            {"renamed": {"time": "CH1"}},
            "no line names time, force, CH1",
        ),
        (
            "time,force\n1,2\n",
            {"renamed": {"8 force": "CH1"}},
            "no line names time, force, CH1",
        ),
        (
            "time,force\n1,2\n",
            {"renamed": {"bead x force": "force"}},
            "column is 'bead x force'",
        ),
    ],
)
def test_bad_files_are_refused_in_one_line(tmp_path, text, options, named):
    with pytest.raises(SceneError, match=rf"^[^\n]*{re.escape(named)}[^\n]*$"):
        values(read(tmp_path, text, **options), "time", "force")


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("time,1 force\n1,2\n,3\n", "1 force has more samples than times"),
        ("time,1 force,time\n1,5,2\n", "2 columns time and 1 of forces"),
        ("time,time,1 force,2 force,3 force\n", "2 columns time and 3 of forces"),
        ("time,force,2 force\n", "'force', '2 force'.: each sensor is wanted once"),
        ("time,2 force,contact 2 dynamic force\n", "each sensor is wanted once"),
    ],
)
def test_sensors_without_a_time_or_a_number_of_their_own_are_refused(
    tmp_path, text, named
):
    file = read(tmp_path, text)
    with pytest.raises(SceneError, match=named):
        [file.record(*places) for places in file.sensors().values()]
