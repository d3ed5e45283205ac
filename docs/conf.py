"""The documentation site: `make site` builds it from the pages beside this file."""

import os
import sys
from pathlib import Path

from seacage.conventions import parse_toml

DOCS = Path(__file__).parent
sys.path[:0] = [str(DOCS / "_extensions"), str(DOCS.parent)]

# The notebooks' matrices are small: threads that wait for one another only cost time.
os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

project = "seacage"
author = "seacage developers"
project_copyright = author
version = release = parse_toml((DOCS.parent / "pyproject.toml").read_text(), "pyproject.toml")[
    "project"
]["version"]

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx_copybutton",
    "public_names",
    "flowchart",
    "root_pages",
]
source_suffix = {".md": "myst-nb"}
exclude_patterns = ["_build"]
nitpicky = True
# Of other packages' types; those of our own are links that hold.
nitpick_ignore_regex = [("py:.*", r"(?!seacage\.\w+\.(?!_)).*")]

myst_enable_extensions = ["colon_fence"]
myst_fence_as_directive = ["mermaid"]
myst_heading_anchors = 4
nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_timeout = 600  # of a cell; a machine may be busy
nb_merge_streams = True

autodoc_default_options = {
    "members": True,
    "imported-members": True,
    "exclude-members": "add_note, with_traceback",
    # But for what Python's own classes bring.
    "inherited-members": "object, ABC, Protocol, Exception, int, str, tuple, dict",
}
autodoc_member_order = "groupwise"
autodoc_preserve_defaults = True
autodoc_typehints_format = "short"
napoleon_numpy_docstring = True
napoleon_google_docstring = False
python_maximum_signature_line_length = 88
python_use_unqualified_type_names = True
toc_object_entries = False

html_theme = "furo"
html_title = f"seacage {release}"
html_copy_source = False
html_show_sphinx = False
html_static_path = ["_static"]
html_css_files = ["site.css"]
pygments_style = "friendly"
pygments_dark_style = "github-dark"
copybutton_prompt_text = "$ "
