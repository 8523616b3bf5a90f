"""Settings for every test."""

from hypothesis import settings

# The same examples on every machine, however slow it is.
settings.register_profile("fixed", deadline=None, derandomize=True, database=None)
settings.load_profile("fixed")
