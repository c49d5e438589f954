"""Files: a fault of the system becomes one line, and no file is left half-written."""

import pytest

from lwa import InputError
from validation.report.study import output_file, replacing


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("folder.svg", "a regular file is wanted"),
        ("p\0.svg", "it cannot be written, embedded null byte"),
    ],
)
def test_a_place_that_cannot_take_a_file(tmp_path, name, message):
    (tmp_path / "folder.svg").mkdir()
    with pytest.raises(
        InputError, match=rf"^plot is [^\n]{{,300}}: {message}; try plot="
    ):
        output_file("plot", str(tmp_path / name), (".svg",))
    assert [file.name for file in tmp_path.iterdir()] == ["folder.svg"]


def test_an_interrupt_while_writing_leaves_the_old_file(tmp_path):
    file = tmp_path / ("a" * 251 + ".svg")  # the longest name that a disk takes
    file.write_text("old")

    def stop():
        with replacing(file) as new:
            new.write_text("half")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        stop()
    assert file.read_text() == "old"
    assert list(tmp_path.iterdir()) == [file]


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
