#!/usr/bin/env python3
"""`bedload schema`: every case is valid, what the program refuses is not. Usage: schema_test.py <bedload>"""

import copy
import json
import subprocess
import sys
import tomllib
import unittest
from pathlib import Path

import jsonschema

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = sys.argv.pop(1) if len(sys.argv) > 1 else ROOT / "build/cpu/bedload"
CASES = sorted(
    file
    for folder in ("cases", "docs/tutorial", "docs/examples", "src/cli/templates")
    for file in (ROOT / folder).rglob("*.toml")
    if not file.name.startswith("expect")
)

SMALL = """
title = "dam"
[domain]
min = [0, 0, 0]
max = [0.1, 0.1, "10 cm"]
[fluid]
dx = 0.01
[[fluid.fill]]
min = [0, 0, 0]
max = [0.05, 0.1, 0.05]
velocity = [0, 0, "0.1*z"]
[[wall.body]]
name = "tank"
shape = "tank"
min = [0, 0, 0]
max = [0.1, 0.1, 0.1]
faces = ["x-", "z-"]
[wall.body.motion]
kind = "rotation"
axis = [0, 1, 0]
centre = [0, 0, 0]
rate = "90 rpm"
[grain]
d = "2.7 mm"
e = 0.5
[time]
end = 1
[out]
every = 0.1
"""


class Schema(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        text = subprocess.run([PROGRAM, "schema"], check=True, capture_output=True, text=True).stdout
        cls.schema = json.loads(text)
        jsonschema.Draft7Validator.check_schema(cls.schema)
        cls.validator = jsonschema.Draft7Validator(cls.schema)

    def errors(self, case):
        return [f"{e.json_path}: {e.message}" for e in self.validator.iter_errors(case)]

    def test_every_case_is_valid(self):
        self.assertGreater(len(CASES), 30)
        for file in CASES:
            with self.subTest(file=str(file)):
                self.assertEqual(self.errors(tomllib.loads(file.read_text())), [])

    def test_every_key_is_there_with_its_meaning_and_a_valid_default(self):
        listed = json.loads(subprocess.run([PROGRAM, "list", "--json"], check=True, capture_output=True).stdout)
        for row in listed:
            at = self.schema
            for part in row["path"].split("."):
                at = at["properties"][part.removesuffix("[]")]
                at = at["items"] if part.endswith("[]") else at
            with self.subTest(key=row["key"]):
                self.assertIn(row["meaning"], at["description"])
                if "default" in at and at["default"] not in ("", []):
                    jsonschema.Draft7Validator(at).validate(at["default"])

    def test_what_the_program_refuses_is_not_valid(self):
        small = tomllib.loads(SMALL)
        self.assertEqual(self.errors(small), [])

        def wrong(change, message):
            case = copy.deepcopy(small)
            change(case)
            errors = self.errors(case)
            self.assertTrue(errors and any(message in e for e in errors), errors)

        wrong(lambda c: c["fluid"].update(dy=1), "'dy' was unexpected")
        wrong(lambda c: c.update(fluids={}), "'fluids' was unexpected")
        wrong(lambda c: c["fluid"].update(kernel="gauss"), "'gauss' is not one of")
        wrong(lambda c: c["grain"].update(mu=-1), "-1 is less than the minimum")
        wrong(lambda c: c["grain"].update(mu="0.5 m"), "'0.5 m' is not of type 'number'")
        wrong(lambda c: c["fluid"].update(dx=[1]), "$.fluid.dx")
        wrong(lambda c: c["fluid"].update(dx="fine"), "$.fluid.dx")
        wrong(lambda c: c["fluid"].pop("dx"), "'dx' is a required property")
        wrong(lambda c: c.pop("time"), "'time' is a required property")
        wrong(lambda c: c["wall"]["body"][0].pop("name"), "'name' is a required property")
        wrong(lambda c: c["wall"].update(body={}), "{} is not of type 'array'")
        wrong(lambda c: c["wall"]["body"][0].update(faces=["up"]), "'up' is not one of")
        wrong(lambda c: c["domain"].update(min=[0, 0]), "[0, 0]")


if __name__ == "__main__":
    unittest.main()
