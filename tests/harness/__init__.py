"""A harness that parses, checks and executes Structured Text as text. The way in is `library.compile_st`."""
