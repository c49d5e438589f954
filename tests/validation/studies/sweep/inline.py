"""What the sweep's tests share."""

from concurrent.futures import Executor, Future


class Inline(Executor):
    """Computes at once, and keeps a list of what; the call number ``stop`` raises ``error``."""

    def __init__(self, stop=None, error=KeyboardInterrupt):
        self.calls, self.stop, self.error = [], stop, error

    def submit(self, fn, /, *arguments):
        if len(self.calls) == self.stop:
            raise self.error
        self.calls.append(arguments[:2])
        future = Future()
        try:
            future.set_result(fn(*arguments))
        except Exception as error:
            future.set_exception(error)
        return future
