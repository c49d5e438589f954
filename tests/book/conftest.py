"""The tests of the built book need a browser, and Playwright: collected if their paths are given.

pytest tests/book/test_pages.py tests/book/test_ends.py

Without the extra ``browser`` they are left out, too, but where a missing part is an error.
"""

import os
from importlib.util import find_spec
from pathlib import Path

from tests.conftest import COMPLETE

NAMES = "test_pages.py", "test_ends.py", "browser.py", "probe.py"
BROWSED = [Path(__file__).with_name(name) for name in NAMES]
PARTS = "playwright", "axe_playwright_python"


def pytest_ignore_collect(collection_path, config):
    if collection_path not in BROWSED:
        return None
    if None in map(find_spec, PARTS) and not os.environ.get(COMPLETE):
        return True
    given = (Path(config.invocation_params.dir, a.split("::")[0]) for a in config.args)
    wanted = collection_path, collection_path.parent
    return None if any(path.resolve() in wanted for path in given) else True
