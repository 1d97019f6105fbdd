"""Sphinx settings of the manual: `./softland manual` builds it of docs/ and results/, which also read well as they are."""

import shutil
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
KATEX = Path("/usr/share/javascript/katex")  # Debian's libjs-katex: equations without a network

project = author = "softland"
html_title = "softland manual"
extensions = ["myst_parser", "sphinx_copybutton"]
root_doc = "docs/manual/contents"
include_patterns = ["docs/**", "results/**", "README.md", "CONTRIBUTING.md", "CHANGELOG.md", "examples/README.md"]
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
smartquotes = False  # an option is --set, not an en dash
suppress_warnings = ["myst.header"]  # pages begin where a forge shows them

html_theme = "furo"
html_show_sourcelink = False
html_static_path = ["static"]
html_css_files = ["manual.css", "katex/katex.min.css"]
html_js_files = ["katex/katex.min.js", "katex/contrib/auto-render.js", "equations.js"]
mathjax_path = "equations.js"  # instead of a copy of MathJax in a network
html_copy_source = False


def add_katex(app, error):
    """Copies KaTeX with its fonts into the built pages, and leads from the top of the folder to the first page."""
    if error or app.builder.name != "html":
        return
    folder = Path(app.outdir)
    shutil.copytree(KATEX, folder / "_static" / "katex", dirs_exist_ok=True, ignore=shutil.ignore_patterns("*.mjs"))
    (folder / "index.html").write_text('<!DOCTYPE html><meta charset="utf-8"><title>softland manual</title>'
                                       '<meta http-equiv="refresh" content="0; url=docs/index.html">\n'
                                       '<a href="docs/index.html">softland manual</a>\n', encoding="utf-8")


def leave_out_of_contents(app, doctree):
    """Pages outside docs/ are reached by links; the contents at the side name the first of the results alone."""
    page = app.env.docname
    if not page.startswith("docs/") and page != "results/README":
        app.env.metadata[page]["orphan"] = True


def setup(app):
    app.connect("build-finished", add_katex)
    app.connect("doctree-read", leave_out_of_contents)
