"""The tests of the built book need a browser, and Playwright: collected if their paths are given.

pytest tests/book/test_pages.py tests/book/test_ends.py
"""

from pathlib import Path

NAMES = "test_pages.py", "test_ends.py", "browser.py", "probe.py"
BROWSED = [Path(__file__).with_name(name) for name in NAMES]


def pytest_ignore_collect(collection_path, config):
    if collection_path not in BROWSED:
        return None
    given = (Path(config.invocation_params.dir, a.split("::")[0]) for a in config.args)
    wanted = collection_path, collection_path.parent
    return None if any(path.resolve() in wanted for path in given) else True
