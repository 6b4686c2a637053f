"""The notebooks of docs/notebooks run from top to bottom, and draw their pictures.

    notebooks.py DMISE [NAME..]      --out DIR: writes them there with their output
"""
import os
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
try:
    import ipykernel  # noqa: F401
    import matplotlib  # noqa: F401
    import nbclient
    import nbformat
    import sklearn  # noqa: F401
except ImportError as missing:
    print(f"skipped: {missing.name} is not installed (./dmise setup --tests)")
    sys.exit(77)
if not list((ROOT / "build/python/dmise").glob("_engine.*.so")):
    print("skipped: the module is not built (target dmise_engine)")
    sys.exit(77)
os.environ["PYTHONPATH"] = str(ROOT / "build/python")
os.environ["PYDEVD_DISABLE_FILE_VALIDATION"] = "1"  # the debugger prints of frozen modules otherwise
PICTURES = {"design_a_sensor": 2, "what_accuracy_costs": 1, "train_a_detector": 2, "plug_in_a_tracker": 1}


def pictures_of(notebook):
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    return sum("image/png" in output.get("data", {}) for output in outputs)


def run(path, out):
    """What was wrong; empty if nothing was."""
    notebook = nbformat.read(path, as_version=4)
    nbformat.validate(notebook)
    if any(cell.get("outputs") for cell in notebook.cells):
        return "is kept without output"
    try:
        nbclient.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(path.parent)}}).execute()
    except nbclient.exceptions.CellExecutionError as error:
        return str(error)
    finally:
        if out:
            nbformat.write(notebook, out / path.name)
    drawn = pictures_of(notebook)
    return "" if drawn == PICTURES[path.stem] else f"draws {drawn} pictures, not {PICTURES[path.stem]}"


def main(dmise, *arguments):
    names = list(arguments)
    out = pathlib.Path(names.pop(names.index("--out") + 1)) if "--out" in names else None
    names = [name for name in names if name != "--out"] or sorted(PICTURES)
    os.environ["PATH"] = f"{pathlib.Path(dmise).resolve().parent}:{os.environ['PATH']}"
    left_out = {path.stem for path in (ROOT / "docs/notebooks").glob("*.ipynb")} - set(PICTURES)
    wrong = {name: run(ROOT / f"docs/notebooks/{name}.ipynb", out) for name in names} | dict.fromkeys(left_out, "is not tested")
    for name, reason in wrong.items():
        print(f"{name}: {reason or 'ok'}")
    return 1 if any(wrong.values()) else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
