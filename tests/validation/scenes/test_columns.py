"""The reader of measured files: units, separators, new names, and what is refused."""

import numpy as np
import pytest

from validation.scenes.columns import LENGTH, TIME, amount, check_span, columns
from validation.scenes.scene import SceneError


def written(tmp_path, text, encoding="utf-8"):
    file = tmp_path / "record.csv"
    file.write_bytes(text.encode(encoding))
    return file


@pytest.mark.parametrize(
    ("column", "size"),
    [
        *(("time (s)", 1), ("time [ms]", 1e-3), ("time (µs)", 1e-6), ("time [\u03bcs]", 1e-6)),
        *(("time (us)", 1e-6), ("time [ns]", 1e-9)),
        *(("bead 15 force (N)", 1), ("bead 15 dynamic force (mN)", 1e-3), ("force (kN)", 1e3)),
        *(("displacement (m)", 1), ("displacement(mm)", 1e-3), ("displacement [ µm ]", 1e-6)),
        *(("speed (m/s)", 1), ("speed (km/s)", 1e3), ("speed_error (mm/s)", 1e-3)),
    ],
)
def test_units_are_read(tmp_path, column, size):
    name = column.partition("(")[0].partition("[")[0].strip()
    file = written(tmp_path, f"{column},strain\n7,2\n")
    found = columns(file, name, "strain")
    assert found[name] == pytest.approx([7 * size], rel=1e-15)
    assert found["strain"].tolist() == [2]


@pytest.mark.parametrize(
    "text",
    [
        "time (ms),force (N)\n1.5,-2e3\n2.5,4\n",
        "time (ms);force (N)\n1,5;-2e3\n2,5;4\n",
        "time (ms);force (N)\n1.5;-2e3\n2.5;4\n",
        "\ufeff# oscilloscope, 1 MHz; 8 bit\n\n#\n time (ms) , force (N) \r\n1.5,-2e3\r\n\r\n2.5,4",
        'CH2,"time (ms)","force (N)"\n7,"1.5","-2e3"\n8,2.5,4\n',
    ],
)
def test_separators_decimals_and_comments(tmp_path, text):
    found = columns(written(tmp_path, text), "time", "force")
    assert found["time"] == pytest.approx([1.5e-3, 2.5e-3], rel=1e-15)
    assert found["force"].tolist() == [-2000, 4]


def test_a_column_is_renamed_with_or_without_its_unit(tmp_path):
    file = written(tmp_path, "time,CH1 t (ms),CH2 [N]\n0,1,2\n")
    for header in ("CH1 t", "CH1 t (ms)"):
        found = columns(file, "time", "force", renamed={"time": header, "force": "CH2"})
        assert (found["time"].tolist(), found["force"].tolist()) == ([1e-3], [2.0])


def test_names_are_compared_without_regard_to_case(tmp_path):
    file = written(tmp_path, "Time (ms),FORCE,T,t\n1,2,3,4\n")
    found = columns(file, "time", "force")
    assert (found["time"].tolist(), found["force"].tolist()) == ([1e-3], [2.0])
    for header, value in (("t", 4.0), ("T", 3.0), ("force", 2.0)):
        assert columns(file, "time", renamed={"time": header})["time"].tolist() == [value]


@pytest.mark.parametrize(
    ("text", "renamed", "named"),
    [
        ("time (min),force\n1,2\n", {}, "column time is in 'min': one of s, ms"),
        ("time (N),force\n1,2\n", {}, "column time is in 'N'"),
        ("time (s),force (lbf)\n1,2\n", {}, "column force is in 'lbf'"),
        ("time,force,force (N)\n1,2,3\n", {}, "one column force is wanted"),
        ("time,strain\n1,2\n", {}, "one column force is wanted"),
        ("# only a comment\n", {}, "one column time is wanted"),
        ("time;force\n1,5;2;3\n1.500,5;2\n", {}, "column time, line 3: '1.500,5'"),
        ("# a\ntime,force\n1,2\n3\n", {}, "column force, line 4: ''"),
        ("time,force\n1,inf\n", {}, "column force, line 2: 'inf'"),
        ("time,force\n1,2\n", {"time": "CH1"}, "one column CH1 is wanted"),
        ("time,force\n1,2\n", {"tme": "force"}, "column is 'tme'"),
    ],
)
def test_bad_files_are_refused_in_one_line(tmp_path, text, renamed, named):
    with pytest.raises(SceneError) as refused:
        columns(written(tmp_path, text), "time", "force", renamed=renamed)
    assert named in str(refused.value)
    assert "\n" not in str(refused.value)


def test_a_text_in_another_encoding_is_refused(tmp_path):
    with pytest.raises(SceneError, match="UTF-8"):
        columns(written(tmp_path, "time (µs),force\n1,2\n", "latin-1"), "time")


def test_amounts_with_a_unit():
    assert amount("4.76 mm", "distance", LENGTH) == pytest.approx(4.76e-3, rel=1e-15)
    assert amount("1e-3", "T", TIME) == 1e-3
    assert amount(" 2.5e3us", "T", TIME) == pytest.approx(2.5e-3, rel=1e-15)
    for text in ("4.76 ft", "-1 mm", "0", "nan", "mm", "1 ms", ""):
        with pytest.raises(SceneError, match="distance is "):
            amount(text, "distance", LENGTH)


@pytest.mark.parametrize("record", [(2.1, 3.0), (-3.0, -0.1), (0.0, 200.0), (-100.0, 100.0)])
def test_a_record_of_another_time_is_refused_with_both_spans(record):
    check_span("f", np.array((-1.0, 2.0)), 2.0)
    check_span("f", np.array((1.9, 199.0)), 2.0)
    with pytest.raises(SceneError, match=f"from {record[0]:g} to {record[1]:g}, .* to 2"):
        check_span("f", np.array(record), 2.0)
