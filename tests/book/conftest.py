"""The test of the built book needs a browser and runs only if its path is given.

pytest tests/book/test_pages.py
"""

from pathlib import Path

PAGES = Path(__file__).with_name("test_pages.py")


def pytest_ignore_collect(collection_path, config):
    if collection_path != PAGES:
        return None
    given = (Path(config.invocation_params.dir, a.split("::")[0]) for a in config.args)
    return (
        None if any(path.resolve() in (PAGES, PAGES.parent) for path in given) else True
    )
