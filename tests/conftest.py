"""One profile for all property tests: the same examples on every machine, and no time limit on a shared one."""

from hypothesis import settings

settings.register_profile("softkin", deadline=None, derandomize=True)
settings.load_profile("softkin")
