"""run_notebook.py NOTEBOOK: runs every cell; fails if a cell fails or if the notebook draws nothing."""
import sys

import nbclient
import nbformat

notebook = nbformat.read(sys.argv[1], as_version=4)
nbclient.NotebookClient(notebook, timeout=120, kernel_name="python3").execute()
pictures = sum("image/png" in output.get("data", {}) for cell in notebook.cells for output in cell.get("outputs", []))
if pictures == 0:
    sys.exit("no cell drew a figure")
if len(sys.argv) > 2:
    nbformat.write(notebook, sys.argv[2])
print(f"{len(notebook.cells)} cells, {pictures} figures")
