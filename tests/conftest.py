"""Settings of hypothesis for all tests: no wall time is asserted, on noisy machines."""

from hypothesis import settings

settings.register_profile("lwa", deadline=None, max_examples=40, derandomize=True)
settings.load_profile("lwa")
