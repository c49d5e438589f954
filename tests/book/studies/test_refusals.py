"""Bad options of the book's programs: one line that names the value, exit status 2."""

from importlib import import_module

import pytest

from tests.commands import ended

BAD = [
    ("accuracy --task tea", "tea"),
    ("breather --masses 1,2,3", "masses are 3: breathers are found in cells of one or two"),
    ("breather --detunings 0.0001 --beads 101", "beads is 101: at a detuning of 0.0001 "),
    ("breather --detunings 0.03", "contacts open from"),
    ("collision --second 2", "second is 2"),
    ("disorder --spread 0.6", "spread is 0.6"),
    ("gravity --beads 999", "beads is 999"),
    ("gravity --k 3", "k is 3: one from 1.1 to 1.75"),
    ("gravity --masses m", "mass is m: a number is wanted"),
    ("gravity --masses 7/5,1e9", "the largest mass over the least is 7"),
    ("struck --case other", "case"),
    ("wall --beads 4", "beads is 4"),
    ("wall --moduli 0", "E is 0"),
    ("precompressed --ratios 0", "ratio is 0: it lies between"),
    ("shock --k 3/2 --jumps 1", "there is no shock"),
    ("shock --k 3/2 --duration 5", "duration is 5: at least 100 is wanted"),
    ("shock --k 3/2 --ahead=-1", "contacts of a power law only push"),
    pytest.param(
        "precompressed --masses 1,1,1,1/4 --ratios 30", "masses 1, 1, 1, 1/4, ratio 30: the pulse",
        marks=pytest.mark.slow,
    ),
]  # fmt: skip


@pytest.mark.parametrize(("line", "named"), BAD)
def test_bad_options_are_refused(capsys, line, named):
    program, *options = line.split()
    main = getattr(import_module(f"book.studies.{program}"), program).main
    status, out, err = ended(capsys, main, *options)
    assert (status, out, err.count("\n")) == (2, "", 1)
    assert named in err
