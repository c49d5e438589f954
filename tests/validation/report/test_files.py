"""Files: a fault of the system becomes one line, and no file is left half-written."""

import errno
import os

import pytest

from lwa import InputError
from validation.report.result import output_file, replacing


def test_places_that_cannot_take_a_file(tmp_path):
    (tmp_path / "folder.svg").mkdir()
    os.mkfifo(tmp_path / "pipe.svg")
    (tmp_path / "loop.svg").symlink_to(tmp_path / "loop.svg")
    before = sorted(tmp_path.iterdir())
    for name, message in {
        "a" * 300 + ".svg": "it cannot be written, File name too long",
        "no/p.svg": "it cannot be written, No such file or directory",
        "folder.svg": "a regular file is wanted",
        "pipe.svg": "a regular file is wanted",
        "loop.svg": "it cannot be written, .*(loop|levels of symbolic links).*",
        "p.txt": "a file ending in .svg is wanted",
        "p\0.svg": "it cannot be written, embedded null byte",
    }.items():
        with pytest.raises(InputError, match=rf"^plot is [^\n]{{,300}}: {message}$"):
            output_file("plot", str(tmp_path / name), (".svg",))
        assert sorted(tmp_path.iterdir()) == before


@pytest.mark.parametrize(
    "fault", [OSError(errno.ENOSPC, "full"), KeyboardInterrupt(), ValueError()]
)
@pytest.mark.parametrize("name", ["p.svg", "a" * 251 + ".svg"])
def test_a_failure_while_writing_leaves_the_old_file(tmp_path, fault, name):
    file = tmp_path / name
    file.write_text("old")
    wanted = InputError if isinstance(fault, OSError) else type(fault)

    def fail():
        with replacing(file) as new:
            new.write_text("half")
            raise fault

    with pytest.raises(wanted) as caught:
        fail()
    assert (file.read_text(), list(tmp_path.iterdir())) == ("old", [file])
    assert wanted is not InputError or str(caught.value).endswith(
        "is not written: full"
    )


def test_a_link_keeps_its_target_and_a_file_its_mode(tmp_path):
    (tmp_path / "far").mkdir()
    target, link, dangling = (tmp_path / n for n in ("far/t.svg", "l.svg", "d.svg"))
    target.write_text("old")
    target.chmod(0o640)
    link.symlink_to("far/t.svg")
    dangling.symlink_to("far/new.svg")
    for file in (link, dangling):
        with replacing(output_file("plot", str(file), (".svg",))) as new:
            new.write_text("whole")
    assert link.is_symlink()
    assert dangling.is_symlink()
    assert (target.read_text(), dangling.read_text()) == ("whole", "whole")
    assert target.stat().st_mode & 0o777 == 0o640
    assert len(list((tmp_path / "far").iterdir())) == 2
