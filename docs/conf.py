"""Sphinx settings; what the pages show of results is computed by `_extensions/computed.py` while they are built."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "_extensions"))

from singimpact import __version__

project = "singimpact"
author = copyright = "The singimpact authors"
version = release = __version__
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "computed", "formulas"]
extensions += ["sphinx.ext.mathjax", "sphinx-mathjax-offline"]  # the pages need no network
extensions += ["sphinx_gallery.gen_gallery", "examples", "notebooks"]
sphinx_gallery_conf = {
    "examples_dirs": "gallery",
    "gallery_dirs": "computed/gallery",
    "backreferences_dir": "computed/gallery_uses",  # named in _extensions/examples.py, too
    "doc_module": ("singimpact",),
    "image_scrapers": ("matplotlib", "examples.held_pictures"),
    "reset_modules": ("matplotlib", "examples.remove_written"),
    "reset_modules_order": "both",
    "within_subsection_order": "examples.in_order",
    "nested_sections": False,
    "run_stale_examples": True,  # the package may have changed where a script has not
    "capture_repr": (),
    "first_notebook_cell": "%matplotlib inline",
    "show_signature": False,
    "write_computation_times": False,
    "min_reported_time": 1e9,  # pages do not change where the run time does
}
myst_enable_extensions = ["dollarmath", "amsmath", "colon_fence"]
myst_heading_anchors = 3
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
exclude_patterns = ["build", "gallery"]
html_theme = "furo"
html_title = f"singimpact {__version__}"
html_static_path = ["_static"]
(Path(__file__).parent / "computed" / "pages").mkdir(parents=True, exist_ok=True)
html_extra_path = ["computed/pages"]  # interactive pages of named models
html_css_files = ["narrow.css", "pictures.css"]
smartquotes_action = "D"  # dashes, and no quotes: x'' is a second derivative
add_module_names = False
autodoc_typehints = "none"
autodoc_member_order = "bysource"
napoleon_google_docstring = False
napoleon_use_rtype = False
nitpicky = False
