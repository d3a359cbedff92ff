"""Runs in this process."""

import unittest
from pathlib import Path

import bedload
import numpy as np
from support import TANK, folder, program, write_case


def tables(run):
    return {name: (Path(run) / name).read_bytes() for name in ("diagnostics.csv", "probes/front.csv")}


class Simulations(unittest.TestCase):
    def test_computes_what_the_program_computes(self):
        with folder() as place:
            path, place = write_case(place), Path(place)
            self.assertEqual(program("run", path, "--out", place / "program", "--quiet", "--threads", 1)[0], 0)
            with bedload.Simulation(path, place / "here", threads=1) as tank:
                tank.run()
            self.assertEqual(tables(place / "here"), tables(place / "program"))
            mine, its = (bedload.open_run(place / name) for name in ("here", "program"))
            self.assertEqual(mine.status, "completed")
            self.assertLessEqual({"position", "velocity", "id"}, set(mine.fluid.names()) & set(tank.fluid.names()))
            for store in ("fluid", "grains", "walls"):
                here, there = getattr(mine, store), getattr(its, store)
                for name in there.names():
                    np.testing.assert_array_equal(here.read(-1, name), there.read(-1, name))
            with self.assertRaisesRegex(bedload.FileError, "already holds a run"):
                bedload.Simulation(path, place / "here")

    def test_goes_on_bit_for_bit(self):
        with folder() as place:
            path, place = write_case(place), Path(place)
            with bedload.Simulation(path, place / "whole", threads=1) as whole:
                whole.run()
            half = bedload.Simulation(path, place / "halves", threads=1)
            half.run(0.009)
            saved = half.checkpoint()
            half.close()
            self.assertTrue(saved.exists())
            with bedload.Simulation(path, place / "halves", restart="latest", threads=1) as rest:
                self.assertEqual(rest.step_count, half.step_count)
                rest.run()
                np.testing.assert_array_equal(rest.fluid.by_id("velocity"), whole.fluid.by_id("velocity"))
            self.assertEqual(tables(place / "whole"), tables(place / "halves"))
            with self.assertRaisesRegex(bedload.CaseError, "restart is empty"):
                bedload.Simulation(path, place / "halves", restart="", overwrite=True)
            self.assertEqual(bedload.open_run(place / "halves").status, "completed")
            with self.assertRaisesRegex(bedload.CaseError, "differs from that of the checkpoint"):
                other = bedload.Case(path).with_values({"fluid.mu": 0.002})
                bedload.Simulation(other, place / "halves", restart="latest")

    def test_ranks_give_the_same_bits(self):
        water = TANK[: TANK.index("[grain]")] + TANK[TANK.index("[[probe]]"):] + "[run]\nblock = 1\n"
        with folder() as place:
            path, place = write_case(place, water), Path(place)
            runs = {}
            for ranks in (1, 2):
                with bedload.Simulation(path, place / str(ranks), threads=2, ranks=ranks) as tank:
                    tank.run(0.005)
                    runs[ranks] = tank.fluid.by_id("velocity")
                    parts = tank.ranks()
            np.testing.assert_array_equal(runs[1], runs[2])
            self.assertEqual(tables(place / "1"), tables(place / "2"))
            self.assertEqual(sum(part["fluid"] for part in parts), len(runs[1]))
            self.assertTrue(all(part["ghosts"] > 0 and part["sent"] > 0 for part in parts))
            report = bedload.Case(path).check(threads=2, ranks=2)
            self.assertEqual(sum(part["fluid"] for part in report.ranks), report.fluid)
            with self.assertRaisesRegex(bedload.CaseError, "ranks = 0 must be within 1..256"):
                bedload.Simulation(path, ranks=0)
            for devices, said in ((3, "--devices 3"), ([0, 2], "--devices 0,2"), ([1], "--devices 1,")):
                with self.assertRaisesRegex(bedload.DeviceError, said + ": there is no GPU to use"):
                    bedload.Simulation(path, backend="cpu", devices=devices)

    def test_arrays_are_windows_on_the_solvers_memory(self):
        tank = bedload.Simulation(bedload.Case.from_toml(TANK), threads=1)
        held, rebuilt = [], 0
        for step in tank.steps():
            rebuilt += step.rebuilt
            held += [tank.fluid.velocity, tank.grains.position, tank.fluid.id]
        self.assertGreater(rebuilt, 0)
        for particles in (tank.fluid, tank.grains, tank.walls):
            for name in particles.names():
                with self.subTest(array=name):
                    window, copy = particles[name], particles.copy(name)
                    self.assertEqual(len(window), len(particles))
                    np.testing.assert_array_equal(window, copy)
                    self.assertEqual(window.dtype, copy.dtype)
                    self.assertNotEqual(particles.unit(name), "")
                    if name != "pressure":
                        self.assertFalse(window.flags.writeable)
                        again = particles[name].__array_interface__
                        self.assertEqual(window.__array_interface__["data"], again["data"])
                        self.assertFalse(np.shares_memory(window, copy))
        self.assertEqual(tank.fluid.velocity.strides, (16, 4))
        self.assertEqual(tank.grains.position.dtype, np.float64)
        np.testing.assert_array_equal(tank.fluid.by_id("id"), np.arange(len(tank.fluid)))
        momentum = tank.fluid.mass @ tank.fluid.velocity.astype(float)
        told = tank.diagnostics()
        for k, axis in enumerate("xyz"):
            self.assertAlmostEqual(momentum[k], told[f"fluid_momentum_{axis}"], delta=1e-6)
        with self.assertRaisesRegex(AttributeError, "fluid has no array 'speed', only density"):
            tank.fluid.speed
        del tank
        self.assertEqual(sum(np.isfinite(array).all() for array in held), len(held))  # memory is there still

    def test_calls_back(self):
        tank = bedload.Simulation(bedload.Case.from_toml(TANK), threads=1)
        times = []
        tank.run(0.01, every=0.002, call=lambda s: times.append(s.time))
        self.assertEqual([int(t / 0.002 + 1e-9) for t in times], [0, 1, 2, 3, 4, 5])
        steps = []
        tank.run(call=lambda s: steps.append(s.step_count) or len(steps) < 3)
        self.assertEqual(len(steps), 3)
        self.assertEqual(steps[-1], tank.step_count)
        self.assertLess(tank.time, tank.end)
        self.assertEqual(tank.probe("front").keys(), {"front_x"})
        self.assertIn("power_by_fluid", tank.body("tank"))
        self.assertEqual(tank.units()["fluid_mass"], "kg")
        with self.assertRaisesRegex(bedload.CaseError, "no probe \"back\""):
            tank.probe("back")
        with self.assertRaises(bedload.FileError):
            tank.checkpoint()

    def test_a_breakdown_is_told(self):
        case = bedload.Case.from_toml(TANK)
        case.time.dt, case.time.force_dt = 0.004, True
        with folder() as place:
            with self.assertRaises(bedload.SimulationFault) as caught:
                with bedload.Simulation(case, place + "/run", threads=1) as tank:
                    tank.run(10)
            self.assertRegex(str(caught.exception), "t = ")
            self.assertEqual(bedload.open_run(place + "/run").status, "failed")

    def test_a_drag_law_of_ones_own(self):
        def di_felice(porosity, reynolds):
            away = 1.5 - np.log10(max(reynolds, 1e-30))
            chi = 3.7 - 0.65 * np.exp(-0.5 * away**2)
            return (0.63 * reynolds**0.5 + 4.8) ** 2 * porosity ** (1 - chi) / 24

        def fall(case):
            tank = bedload.Simulation(case, threads=1)
            tank.run(0.01)
            return tank.grains.by_id("drag_force")

        case = bedload.Case.from_toml(TANK)
        expected = fall(case)
        case.drag = bedload.drag_table(di_felice)
        self.assertGreater(np.linalg.norm(expected, axis=1).max(), 1e-5)
        np.testing.assert_allclose(fall(case), expected, rtol=0.02, atol=1e-6)
        case.drag = bedload.drag_table(lambda porosity, reynolds: 2 * di_felice(porosity, reynolds))
        self.assertGreater(np.abs(fall(case)).max(), 1.1 * np.abs(expected).max())


if __name__ == "__main__":
    unittest.main()
