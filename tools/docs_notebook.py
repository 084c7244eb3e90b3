#!/usr/bin/env python3
"""usage: tools/docs_notebook.py NOTEBOOK.ipynb OUT.ipynb [PICTURE.png]
Executes a notebook of docs/examples in its folder. Writes the notebook with its output, and its last picture. Needs an environment with the wheel
of tools/python and PyPI's nbclient, ipykernel and matplotlib."""
import base64
import pathlib
import sys

import nbclient
import nbformat


def pictures(notebook):
    """Returns every PNG that cells show."""
    for cell in notebook.cells:
        for output in cell.get("outputs", []):
            if "image/png" in output.get("data", {}):
                yield base64.b64decode(output["data"]["image/png"])


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    source, out = map(pathlib.Path, sys.argv[1:3])
    notebook = nbformat.read(source, as_version=4)
    nbclient.NotebookClient(notebook, timeout=1800, kernel_name="python3", resources={"metadata": {"path": str(source.parent)}}).execute()
    notebook.metadata = {"kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"}}
    for cell in notebook.cells:
        cell.metadata = {}  # removes the times at which it ran
    nbformat.write(notebook, out)
    for picture in sys.argv[3:]:
        pathlib.Path(picture).write_bytes(list(pictures(notebook))[-1])


if __name__ == "__main__":
    main()
