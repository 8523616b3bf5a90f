"""The documentation site: `make docs`, into target/docs. Pages are Markdown and read on their own, too."""

from importlib.metadata import version as version_of
from typing import Any

from pygments.lexers.special import TextLexer
from sphinx.application import Sphinx
from sphinx.ext.napoleon import Config, NumpyDocstring

project = "ribbonrs"
author = "The ribbonrs authors"
project_copyright = author
version = release = version_of("ribbonrs")

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.mathjax"]
exclude_patterns = ["figures"]
html_theme = "furo"
html_title = "ribbonrs"

# Formulas between dollars, as on GitHub; links to headings.
myst_enable_extensions = ["dollarmath", "amsmath"]
myst_heading_anchors = 3

# Docstrings say what types are; what stands between single quotes is a link if it is a name of the package.
autodoc_typehints = "none"
autodoc_member_order = "bysource"
default_role = "py:obj"
smartquotes = False  # "full" is an argument
SECTIONS = Config(napoleon_google_docstring=False, napoleon_use_rtype=False, napoleon_use_ivar=True)


def read_sections(app: Sphinx, what: str, name: str, obj: Any, options: Any, lines: list[str]) -> None:
    """Turn numpy's sections into reStructuredText.

    As the extension does, but for properties: there it takes all before the first colon for a type.
    """
    what = "method" if what in ("attribute", "property") else what
    lines[:] = NumpyDocstring(lines, SECTIONS, app, what, name, obj, options).lines()


def setup(app: Sphinx) -> None:
    """Read docstrings, and show tables of numbers as they are: Pygments knows no language csv."""
    app.connect("autodoc-process-docstring", read_sections)
    app.add_lexer("csv", TextLexer)
