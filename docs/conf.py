"""The documentation site: `make docs`, into target/docs. Pages are Markdown and read on their own, too."""

from importlib.metadata import version as version_of

from pygments.lexers.special import TextLexer
from sphinx.application import Sphinx

project = "ribbonrs"
author = copyright = "The ribbonrs authors"  # noqa: A001
version = release = version_of("ribbonrs")

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.mathjax", "sphinx.ext.napoleon"]
exclude_patterns = ["figures"]
html_theme = "furo"
html_title = "ribbonrs"

# Formulas between dollars, as on GitHub; links to headings.
myst_enable_extensions = ["dollarmath", "amsmath"]
myst_heading_anchors = 3

napoleon_google_docstring = False
napoleon_use_rtype = False
autodoc_member_order = "bysource"
# Signatures keep the names of the source, ArrayLike rather than what it stands for.
autodoc_type_aliases = {"ArrayLike": "ArrayLike", "Amplitude": "Amplitude", "Array": "Array"}


def setup(app: Sphinx) -> None:
    """Show tables of numbers as they are: Pygments knows no language csv."""
    app.add_lexer("csv", TextLexer)
