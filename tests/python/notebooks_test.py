"""The notebooks of the documents run from top to bottom."""

import unittest
from pathlib import Path

import nbformat
from nbclient import NotebookClient
from support import ROOT, folder

NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))


class Notebooks(unittest.TestCase):
    def test_run(self):
        self.assertEqual(len(NOTEBOOKS), 3)
        for path in NOTEBOOKS:
            with self.subTest(notebook=path.name), folder() as place:
                notebook = nbformat.read(path, as_version=4)
                self.assertFalse(any(cell.get("outputs") for cell in notebook.cells), "outputs are not kept")
                where = {"metadata": {"path": place}}
                NotebookClient(notebook, timeout=300, kernel_name="python3", resources=where).execute()
                last = notebook.cells[-1].source
                self.assertIn("assert", last)
                self.assertTrue((Path(place) / "results").is_dir())


if __name__ == "__main__":
    unittest.main()
