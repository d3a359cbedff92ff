#!/usr/bin/env python3
"""The documents name what there is: cases of the tutorial, snippets, keys. Usage: docs_test.py <bedload>"""

import ast
import json
import re
import subprocess
import sys
import tempfile
import tomllib
import unittest
from pathlib import Path

import jsonschema

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = sys.argv.pop(1) if len(sys.argv) > 1 else ROOT / "build/cpu/bedload"
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md")), *sorted(ROOT.glob("cases/*/README.md"))]
FENCE = re.compile(r"^```(\w*)\n(.*?)^```", re.MULTILINE | re.DOTALL)


def output(*arguments):
    return subprocess.run([PROGRAM, *arguments], check=True, capture_output=True, text=True).stdout


def plain(name):
    """As the program compares words."""
    return re.sub(r"[\W_]", "", name).lower()


def below(key, table):
    return key == table or key.startswith(table + ".")


def without_required(schema):
    """A snippet may leave out what a case must have."""
    if isinstance(schema, dict):
        return {k: without_required(v) for k, v in schema.items() if k != "required" or not isinstance(v, list)}
    return [without_required(v) for v in schema] if isinstance(schema, list) else schema


class Documents(unittest.TestCase):
    def test_every_step_of_the_tutorial_is_in_order(self):
        files = sorted((ROOT / "docs/tutorial").glob("*.toml"))
        self.assertGreaterEqual(len(files), 5)
        text = (ROOT / "docs/tutorial.md").read_text()
        for file in files:
            with self.subTest(file=file.name):
                self.assertIn(f"](tutorial/{file.name})", text)
                check = [PROGRAM, "check", file, "--backend", "cpu", "--threads", "1"]
                ran = subprocess.run(check, capture_output=True, text=True)
                self.assertEqual(ran.returncode, 0, ran.stderr)
                self.assertNotIn("warning", ran.stdout)

    def test_the_case_of_the_readme_is_in_order(self):
        (case,) = [text for language, text in FENCE.findall((ROOT / "README.md").read_text())
                   if language == "toml" and "[domain]" in text]
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder, "dam.toml")
            file.write_text(case)
            check = [PROGRAM, "check", file, "--backend", "cpu", "--threads", "1", "--set", "fluid.dx=0.005"]
            ran = subprocess.run(check, capture_output=True, text=True)
        self.assertEqual(ran.returncode, 0, ran.stderr)
        self.assertNotIn("warning", ran.stdout)

    def test_rules_stand_in_their_pages_and_are_held(self):
        def words(text):
            return " ".join(text.split())

        tests = set()
        for file in (ROOT / "tests").rglob("*.cpp"):
            tests |= set(re.findall(r"^TEST(?:_F|_P)?\(\w+, (\w+)\)", file.read_text(), re.MULTILINE))
        rows = re.findall(r"^\| ([\w/]+\.md) \| (.+) \| (.+?) \| (.*?) ?\|$", (ROOT / "tests/rules.md").read_text(),
                          re.MULTILINE)
        self.assertGreater(len(rows), 40)
        for page, sentence, kind, held in rows:
            with self.subTest(page=page, sentence=sentence):
                self.assertIn(words(sentence), words((ROOT / "docs" / page).read_text()))
                named = re.findall(r"`(\w+)`", held)
                self.assertEqual(bool(named), not kind.startswith("none"))
                self.assertLessEqual(set(named), tests)

    def test_the_mixture_begins_as_one(self):
        case = ROOT / "docs/examples/mixture/case.toml"
        with tempfile.TemporaryDirectory() as folder:
            run = [PROGRAM, "run", case, "--out", folder, "--set", "time.end=1e-4", "--set", "probe.0.min=[0, 0, 0]",
                   "--set", "probe.0.max=[0.024, 0.024, 0.04]", "--backend", "cpu", "--quiet"]
            ran = subprocess.run(run, capture_output=True, text=True)
            self.assertEqual(ran.returncode, 0, ran.stderr)
            names, first = (Path(folder) / "probes/mixture.csv").read_text().splitlines()[:2]
            row = dict(zip(names.split(","), map(float, first.split(","))))
        volume = 0.024 * 0.024 * 0.04
        self.assertAlmostEqual(row["mass [kg]"] / (1000 * 0.75 * volume), 1, delta=0.02)
        self.assertAlmostEqual(row["porosity [-]"], 0.75, delta=0.02)

    def test_what_pages_show_of_files_stands_there(self):
        for page, folder, languages, least in (("tutorial.md", "tutorial", {"toml"}, 9),
                                               ("howto/build.md", "examples/drag_law", {"cmake", "cpp"}, 2),
                                               ("howto/mixture.md", "examples/mixture", {"toml"}, 2)):
            files = [file.read_text() for file in (ROOT / "docs" / folder).iterdir()]
            shown = [text for language, text in FENCE.findall((ROOT / "docs" / page).read_text())
                     if language in languages]
            self.assertGreaterEqual(len(shown), least)
            for text in shown:
                with self.subTest(page=page, shown=text[:60]):
                    self.assertTrue(any(text in file for file in files))

    def test_the_reference_has_every_name_of_the_package_with_its_docstring(self):
        package = ROOT / "src/python/bedload"
        sys.path.insert(0, str(package.parent))
        import bedload

        shown = re.findall(r"^::: ([\w.]+)$", (ROOT / "docs/python_api.md").read_text(), re.MULTILINE)
        homes = {name: f"bedload.{home}.{name}" for name, home in bedload._HOMES.items() if home}
        self.assertLessEqual(set(homes.values()), set(shown))
        for path in shown:
            _, module, *name = path.split(".")
            body = ast.parse((package / f"{module}.py").read_text()).body
            found = [node for node in body if isinstance(node, (ast.ClassDef, ast.FunctionDef))
                     and (node.name in name if name else not node.name.startswith("_"))]
            self.assertTrue(found, path)
            members = [member for node in found if isinstance(node, ast.ClassDef) for member in node.body
                       if isinstance(member, ast.FunctionDef) and not member.name.startswith("_")]
            for node in found + members:
                with self.subTest(of=path, name=node.name):
                    self.assertTrue(ast.get_docstring(node))

    def test_snippets_are_valid(self):
        validator = jsonschema.Draft7Validator(without_required(json.loads(output("schema"))))
        tried = 0
        for page in PAGES:
            for language, text in FENCE.findall(page.read_text()):
                if language != "toml":
                    continue
                with self.subTest(page=str(page.relative_to(ROOT)), snippet=text[:60]):
                    errors = [f"{e.json_path}: {e.message}" for e in validator.iter_errors(tomllib.loads(text))]
                    self.assertEqual(errors, [])
                tried += 1
        self.assertGreater(tried, 5)

    def test_keys_that_are_named_exist(self):
        keys = {row["key"] for row in json.loads(output("list", "--json"))}
        tables = {key[:dot] for key in keys for dot in range(len(key)) if key[dot] == "."}
        name = re.compile(r"\b((?:%s)(?:\.\w+)+)" % "|".join(sorted({key.split(".")[0] for key in keys if "." in key})))
        named = 0
        for page in PAGES:
            text = page.read_text()
            spans = re.findall(r"`([^`\n]+)`", FENCE.sub("", text)) + re.findall(r"--set '?([\w.]+)=", text)
            for span in spans:
                if re.search(r"\.(toml|csv|vtkhdf|xdmf|md|py|cpp|hpp|png|stl)\b|::|/", span):
                    continue
                for found in name.findall(span):
                    key = re.sub(r"\.\d+(?=\.|$)", "", found)
                    with self.subTest(page=str(page.relative_to(ROOT)), key=found):
                        self.assertIn(key, keys | tables)
                    named += 1
        self.assertGreater(named, 200)

    def test_counts_of_limiters_are_those_of_the_program(self):
        written = set(re.findall(r'\{"(\w+)", "-",', (ROOT / "src/measure/measure.cpp").read_text()))
        others = {"fluid_count", "fluid_pairs_through_walls", "overlap_max", "coordination_number", "grain_count",
                  "clump_count", "grains_outside", "porosity_min", "wet_grains", "bodies_outside", "rebuilds"}
        self.assertLess(others, written)
        diagnostics = (ROOT / "docs/results.md").read_text().split("\n## Contacts of the grains")[0]
        shown = set(re.findall(r"`(\w+)` \[-\]", diagnostics))
        self.assertEqual(shown, written - others)
        limiters = (ROOT / "docs/model.md").read_text().split("## Clamps and limiters")[1].split("\n## ")[0]
        self.assertLessEqual(shown, set(re.findall(r"`(\w+)`", limiters)))

    def test_words_of_other_programs_are_those_of_the_program(self):
        words = {}
        for word in json.loads(output("list", "words", "--json")):
            words.setdefault(plain(word["name"]), []).append(word)
        text = (ROOT / "docs/faq.md").read_text()
        table = text[text.index("| there | here |"):].split("\n\n")[0]
        named = 0
        for row in table.splitlines()[2:]:
            there, here = re.split(r"(?<!\\) \| ", row.strip("| "), maxsplit=1)
            meant = [set(re.findall(r"\w+(?:\.\w+)*", span)) for span in re.findall(r"`([^`]+)`", here)]
            shown = set().union(*meant)
            for name in re.findall(r"`([^`]+)`", there):
                with self.subTest(name=name):
                    self.assertIn(plain(name), words)
                    known = [key for word in words[plain(name)] for key in word["keys"]]
                    notes = " ".join(word["note"] for word in words[plain(name)])
                    self.assertTrue(any(below(key, other) for key in known for other in shown)
                                    or any(key in notes for key in shown), (known, shown))
                    named += 1
            keys = {key for name in re.findall(r"`([^`]+)`", there) for word in words.get(plain(name), [])
                    for key in [*word["keys"], *re.findall(r"\w+(?:\.\w+)+", word["note"])]}
            for key in shown:
                if "." in key:
                    with self.subTest(key=key):
                        self.assertTrue(any(below(key, other) or below(other, key) for other in keys), keys)
        self.assertGreater(named, 40)


if __name__ == "__main__":
    unittest.main()
