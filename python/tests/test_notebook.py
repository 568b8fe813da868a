"""The example notebook runs, and its results are those that it was committed with."""

import json
from pathlib import Path

NOTEBOOK = Path(__file__).parents[2] / "examples" / "impact.ipynb"


def test_the_notebook_says_what_it_said(capsys) -> None:
    cells = [c for c in json.loads(NOTEBOOK.read_text())["cells"] if c["cell_type"] == "code"]
    printed = [o["text"] for c in cells for o in c["outputs"] if o["output_type"] == "stream"]
    names: dict[str, object] = {}
    for cell in cells:
        exec("".join(cell["source"]), names)
    said = capsys.readouterr().out
    assert said == "".join("".join(text) for text in printed)
