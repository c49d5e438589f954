"""Plain `pytest` passes this directory by, its doctests too; a file that it is given runs."""

collect_ignore_glob = ["*.py"]
