"""The native core: built as a user's `pip` builds it, and asked what the package is asked. `python -m tests.native`."""
