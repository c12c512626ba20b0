"""The site: `sphinx-build -W --keep-going -b html docs FOLDER`, with the extra `docs`.

What is made while it is built (recipes, the interface by subject, the list of figures) goes to
`docs/build`, which git leaves alone.
"""

import os
import sys
from importlib.util import find_spec
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))

import made_pages  # noqa: E402
from elastolink import __version__  # noqa: E402
from numpydoc.xref import DEFAULT_LINKS  # noqa: E402

# Kernels of notebooks choose their own way to show pictures.
os.environ.pop("MPLBACKEND", None)
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
# The tutorial uses the command beside this interpreter.
os.environ["PATH"] = os.pathsep.join((str(Path(sys.executable).parent), os.environ["PATH"]))
# The recipe of a mechanism of one's own emits its module there.
os.environ["ELASTOLINK_GENERATED"] = str(HERE / "build" / "modules")

project = "elastolink"
author = "The elastolink authors"
project_copyright = author
version = release = __version__

extensions = [
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "numpydoc",
    "sphinx_gallery.gen_gallery",
    "myst_nb",
]
exclude_patterns = ["build/modules", "build/recipes/*.ipynb", "build/recipes/*.py", "recipes/*"]
templates_path = ["templates"]

# Pages in Markdown; those of docs/notebooks are executed.
myst_enable_extensions = ["dollarmath", "colon_fence"]
myst_heading_anchors = 3
nb_execution_mode = "force"
nb_execution_in_temp = True
nb_execution_timeout = 120
nb_merge_streams = True
nb_execution_raise_on_error = True
nb_ipywidgets_js: dict = {}  # its default asks other hosts

# Recipes: every file is run, its pictures and what it prints are shown.
sphinx_gallery_conf = {
    "examples_dirs": "recipes",
    "gallery_dirs": "build/recipes",
    "filename_pattern": r"\.py",
    "within_subsection_order": "FileNameSortKey",
    "capture_repr": ("_repr_html_",),
    "download_all_examples": False,
    "min_reported_time": 600,
    "write_computation_times": False,
    "show_signature": False,
    "remove_config_comments": True,
    "abort_on_example_error": True,
}

# The interface: from docstrings.
autosummary_generate = True
autodoc_typehints = "none"
autodoc_member_order = "bysource"
numpydoc_show_class_members = False
# Types are links where they are public names; those of Python and NumPy stay words.
numpydoc_xref_param_type = True
numpydoc_xref_ignore = "all"
numpydoc_xref_aliases = {word: word for word in DEFAULT_LINKS} | made_pages.full_names()
add_module_names = False
python_use_unqualified_type_names = True

html_theme = "furo"
html_title = "elastolink"
# Formulas are MathML; their font comes with ziamath.
mathematics = str(Path(find_spec("ziamath").origin).parent / "fonts")
html_static_path = ["static", mathematics]
html_css_files = ["site.css"]
html_math_renderer = "mathml"
html_show_sourcelink = False
html_copy_source = False


def setup(app):
    """Connect what `made_pages` does."""
    made_pages.connect(app)
