"""Cases as objects."""

import json
import unittest
from pathlib import Path

import bedload
from support import ROOT, TANK, folder, program, write_case


class Cases(unittest.TestCase):
    def test_errors_are_the_programs_sentences(self):
        wrong = [("dx = 0.01", "dx = -0.01"), ("dx = 0.01", "dy = 0.01"), ("[time]\nend = 0.02", "[time]"),
                 ("max = [0.05, 0.1, 0.08]", "max = [0.05, 0.1, 0.08"), ('direction = "x+"', 'direction = "w"'),
                 ("[domain]", 'drag = {law = "table", porosity = [0.5, 0.4], reynolds = [0, 1], factor = [1, 1]}\n[domain]'),
                 ("max = [0.05, 0.1, 0.08]", "max = [0.05, 0.1, 0.3]"), ("end = 0.02", "end = 0.02\ndt = 0.01")]
        for old, new in wrong:
            with self.subTest(new=new), folder() as place:
                path = write_case(place, TANK.replace(old, new, 1))
                code, _, told = program("check", path)
                self.assertEqual(code, 2)
                with self.assertRaises(bedload.CaseError) as caught:
                    bedload.Case(path).check()
                self.assertEqual(str(caught.exception) + "\n", told)

    def test_errors_tell_the_line_of_python(self):
        case = bedload.Case.from_toml(TANK, "tank.toml")
        case.fluid.dx = -1  # this line
        line = next(n for n, text in enumerate(Path(__file__).read_text().splitlines(), 1) if "# this line" in text)
        with self.assertRaisesRegex(bedload.CaseError, rf"^case_test\.py:{line}: fluid\.dx = -1 must be > 0"):
            case.check()
        case.fluid.dx = 0.01
        case.fluid.fill[0].max = (0.05, 0.1)
        told = r"^case_test\.py:\d+: fluid\.fill\.max = \[0\.05, 0\.1\] must be three"
        with self.assertRaisesRegex(bedload.CaseError, told):
            case.check()

    def test_a_case_from_nothing_is_that_of_its_file(self):
        case = bedload.Case()
        case.title = "tank"
        case.domain = {"min": [-0.1, -0.1, -0.1], "max": [0.2, 0.2, 0.2]}
        case.fluid.dx = 0.01
        case.fluid.fill.add(min=[0, 0, 0], max=[0.05, 0.1, 0.08])
        case.wall.body.add(name="tank", shape="tank", min=[0, 0, 0], max=[0.1, 0.1, 0.12])
        case.grain.d = "10 mm"
        case["grain.fill"] = [{"positions": [[0.05, 0.05, 0.02], [0.061, 0.05, 0.02], [0.03, 0.05, 0.06]]}]
        case.probe.add(name="front", type="front", direction="x+")
        case.time.end, case.out.every, case["checkpoint.every"] = 0.02, 0.005, 0.01
        other = bedload.Case.from_toml(TANK)
        self.assertEqual(case.resolved(), other.resolved())
        self.assertNotEqual(case, other)  # "10 mm"
        self.assertEqual(bedload.Case.from_toml(case.to_toml()), case)
        report = case.check(threads=1)
        self.assertEqual((report.fluid, report.grains), (5 * 10 * 8, 3))
        self.assertEqual(report.step_limits[report.active_limit], min(report.step_limits.values()))

    def test_check_says_what_the_program_says(self):
        for body in ("", '[[wall.body]]\nname = "pier"\nshape = "box"\nmin = [0.02, 0.02, 0]\nmax = [0.03, 0.03, 0.1]\n'):
            with self.subTest(body=body), folder() as place:
                path = write_case(place, TANK.replace("every = 0.005", "every = 1e-6") + body)
                code, out, told = program("check", path, "--threads", 1)
                self.assertEqual(code, 0, told)
                lines = out.splitlines()
                report = bedload.Case(path).check(threads=1)
                self.assertEqual(report.warnings,
                                 [line.removeprefix("warning: ") for line in lines if line.startswith("warning: ")])
                self.assertTrue(any("out.every" in warning for warning in report.warnings))
                printed = {line[:10].strip() + ": " + line[11:] for line in lines}
                self.assertGreater(len(report.notes), 3)
                for note in report.notes:
                    self.assertTrue(note in printed or "note: " + note in printed, note)
                about = {"viscosity", "density", "resolution", "lattice", "shifting", "tension", "waves", "wake",
                         "contacts", "kernel", "sizes", "bed", "mirror", "viscometer", "note"}
                self.assertEqual(sum(line.split(":")[0] in about for line in printed), len(report.notes))

    def test_shipped_cases_survive_being_written(self):
        for path in sorted(ROOT.glob("cases/*/case.toml"))[::4]:
            with self.subTest(case=path.parent.name):
                case = bedload.Case(path)
                again = bedload.Case.from_toml(case.to_toml(), str(path))
                self.assertEqual(again.resolved(), case.resolved())

    def test_keys_that_are_not_given_tell_their_default(self):
        case = bedload.Case()
        with self.assertRaisesRegex(AttributeError, "fluid.rho0 is not given; its default: 1000"):
            case.fluid.rho0
        with self.assertRaisesRegex(AttributeError, "fluid has no key 'rho'"):
            case.fluid.rho
        self.assertNotIn("fluid", case)  # looking makes nothing
        self.assertEqual(len(case), 0)
        self.assertEqual(bedload.keys()["fluid.rho0"]["unit"], "kg/m3")
        case.fluid = {}
        self.assertIn("fluid", case)

    def test_a_copy_is_its_own(self):
        case = bedload.Case.from_toml(TANK)
        other = case.with_values({"fluid.dx": 0.02, "wall.body.0.name": "box"})
        self.assertEqual((case.fluid.dx, other.fluid.dx), (0.01, 0.02))
        self.assertEqual((case.wall.body.named("tank").name, other.wall.body[0].name), ("tank", "box"))
        with self.assertRaises(KeyError):
            other.wall.body.named("tank")
        with self.assertRaisesRegex(IndexError, "probe.3: this case has 1 probe, indexed from 0"):
            case.with_values({"probe.3.every": 0.1})
        with self.assertRaisesRegex(IndexError, "inlet.0: this case has no inlet"):
            case.with_values({"inlet.0.rate": 0.1})
        self.assertNotIn("inlet.0.rate", case)

    def test_the_package_brings_the_program_and_its_types(self):
        code, out, _ = program("list", "--json")
        self.assertEqual(code, 0)
        self.assertEqual({row["path"] for row in json.loads(out)}, set(bedload.keys()))
        home = Path(bedload.__file__).parent
        self.assertTrue((home / "py.typed").exists())
        self.assertIn("def snapshot(self, store: str) -> dict", (home / "_bedload.pyi").read_text())
        self.assertEqual(program("--version")[1].split()[1], bedload.__version__)
        with self.assertRaises(bedload.FileError):
            bedload.Case("nowhere.toml")


if __name__ == "__main__":
    unittest.main()
