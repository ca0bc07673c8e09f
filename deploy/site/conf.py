# Configures Sphinx, which turns the manual pages into the site. The script `make` runs it on a folder with
# copies of the pages.
import os

project = "Turnpoint"
author = "The Turnpoint authors"
extensions = ["myst_parser"]
root_doc = "README"
source_suffix = {".md": "markdown"}
myst_heading_anchors = 4
html_theme = "theme"
html_theme_path = [os.path.dirname(os.path.abspath(__file__))]
html_title = "Turnpoint"
html_copy_source = html_use_index = False
html_permalinks_icon = "#"
pygments_style = "default"
# Examples contain words that are neither Python nor TOML; do not report them.
suppress_warnings = ["misc.highlighting_failure"]
