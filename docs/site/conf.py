"""Sphinx, for the site that `make docs` builds: everything comes from the folder, and nothing from a network."""

import re

project = "Softkin"
author = project
copyright = "Softkin, MIT licence"
extensions = ["myst_parser", "sphinx.ext.autodoc"]
html_theme = "furo"
html_title = "Softkin"
html_copy_source = False
html_show_sphinx = False
html_show_search_summary = False  # a summary is fetched, which a page from disk cannot do
myst_enable_extensions = ["attrs_inline"]
myst_heading_anchors = 4
# Structured Text has no lexer; `Mechanism` is a name of the package and of the vocabulary.
suppress_warnings = ["misc.highlighting_failure", "ref.python"]
autodoc_typehints = "signature"
autodoc_member_order = "bysource"
autodoc_typehints_format = "short"
default_role = "code"
python_use_unqualified_type_names = True
python_maximum_signature_line_length = 90

ARGUMENT = re.compile(r"^(\w+): (?=\S)")


def as_text(app, what, name, obj, options, lines):
    """Docstrings are plain text: only names in backticks are marked, and a line `argument: …` begins a paragraph."""
    given = [line for line in lines if not line.startswith("Alias for field number")]  # which no one has written
    plain = (re.sub(r"([*|\\])", r"\\\1", line) for line in given)
    lines[:] = [
        one for line in plain for one in (["", ARGUMENT.sub(r"**\1**: ", line)] if ARGUMENT.match(line) else [line])
    ]


def setup(app):
    """Hear of every docstring before it is read."""
    app.connect("autodoc-process-docstring", as_text)
