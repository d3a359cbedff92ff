"""Sweeps over keys."""

import json
import unittest
from pathlib import Path

import bedload
from support import TANK, folder, program, write_case


class Sweeps(unittest.TestCase):
    def test_runs_what_is_missing(self):
        case = bedload.Case.from_toml(TANK.replace("end = 0.02", "end = 0.012"))
        keys = {"fluid.mu": [1e-3, 0.1], "grain.rho": [2500, -1]}
        with folder() as place:
            told = []
            first = bedload.sweep(case, keys, place, workers=2, threads=1, report=lambda point: told.append(point.status))
            self.assertEqual([point.status for point in first], ["completed", "failed"] * 2)
            self.assertEqual(sorted(told), ["completed"] * 2 + ["failed"] * 2)
            self.assertEqual(first.failed[0].message, "--set grain.rho=-1: grain.rho = -1 must be > 0")
            energies = first.to_pandas(lambda run: {"energy": run.diagnostics["fluid_kinetic_energy"][-1]})
            self.assertEqual(list(energies.columns), ["fluid.mu", "grain.rho", "energy"])
            self.assertGreater(energies.energy[0], energies.energy[1])  # the thicker is slower

            begun = first[0].folder  # as if it had been interrupted behind its checkpoint
            whole = (begun / "diagnostics.csv").read_bytes()
            (begun / "summary.json").unlink()
            (begun / "diagnostics.csv").write_bytes(b"".join(whole.splitlines(True)[:-1]))
            for late in sorted((begun / "checkpoints").glob("step_*.h5"))[1:]:
                late.unlink()
            again = bedload.sweep(case, keys, place, workers=2, threads=1)
            self.assertEqual([point.reused for point in again], [False, False, True, False])
            self.assertEqual((begun / "diagnostics.csv").read_bytes(), whole)
            self.assertGreater(json.loads((begun / "summary.json").read_text())["steps"], 0)

            case.fluid.rho0 = 1100  # another case: nothing of it is there
            other = bedload.sweep(case, [{"fluid.mu": 1e-3, "grain.rho": 2500}], place, threads=1)
            self.assertFalse(other[0].reused)
            self.assertGreater(other[0].run.diagnostics["fluid_mass"][0], 0.43)

    def test_takes_files_and_programs(self):
        with folder() as place:
            path = write_case(place, TANK.replace("end = 0.02", "end = 0.001"))
            done = bedload.sweep(path, {"domain.max": [[0.2, 0.2, 0.2]]}, Path(place) / "out", threads=1)
            self.assertEqual((len(done), done.failed), (1, []))
            with self.assertRaisesRegex(bedload.FileError, "no such program"):
                bedload.sweep(path, {"fluid.mu": [1]}, Path(place) / "out", program="/nowhere/bedload")
            with self.assertRaisesRegex(bedload.CaseError, "same values"):
                bedload.sweep(path, {"fluid.mu": [1, 1]}, Path(place) / "out")


if __name__ == "__main__":
    unittest.main()
