"""Derived quantities where the answer is known."""

import unittest

import numpy as np
from bedload.measures import (Grid, angular_velocity, at_points, bed_outline, bed_surface, contact_pairs, coordination,
                              lacey_index, mean_map, mean_power, porosity_map, power_number, running_mean, segregation_intensity,
                              solid_fraction_map, spectrum, surface_slope, toe_and_shoulder)


def lattice(n, d):
    return (np.stack(np.meshgrid(*[np.arange(n)] * 3, indexing="ij"), axis=-1).reshape(-1, 3) + 0.5) * d


class Maps(unittest.TestCase):
    def test_of_porosity_keep_the_volume_of_grains(self):
        x, d = lattice(6, 0.01), 0.01
        grid = Grid.over([0, 0, 0], [0.06, 0.06, 0.06], 0.013)  # cells that cut grains
        solid = solid_fraction_map(grid, x, d / 2)
        self.assertAlmostEqual(solid.sum() * grid.volume, len(x) * np.pi / 6 * d**3, delta=1e-12)
        whole = porosity_map(Grid.over([0, 0, 0], [0.06, 0.06, 0.06], 0.02), x, d / 2)
        np.testing.assert_allclose(whole, 1 - np.pi / 6, atol=1e-12)  # cells that cut none

    def test_of_velocity_weigh_by_mass(self):
        grid = Grid.over([0, 0, 0], [2, 1, 1], 1)
        x = np.array([[0.5, 0.5, 0.5], [0.6, 0.5, 0.5], [3, 0.5, 0.5]])
        found = mean_map(grid, x, np.array([[1.0, 0, 0], [4.0, 2, 0], [9.0, 9, 9]]), np.array([2.0, 1.0, 1.0]))
        np.testing.assert_allclose(found[0, 0, 0], [2, 2 / 3, 0])
        self.assertTrue(np.isnan(found[1, 0, 0]).all())


class Mixing(unittest.TestCase):
    def setUp(self):
        self.x = lattice(20, 0.05)
        self.grid = Grid.over([0, 0, 0], [1, 1, 1], 0.25)

    def test_index_is_0_apart_and_1_at_random(self):
        self.assertAlmostEqual(lacey_index(self.grid, self.x, self.x[:, 2] < 0.5), 0, places=12)
        at_random = np.random.default_rng(1).random(len(self.x)) < 0.5
        self.assertAlmostEqual(lacey_index(self.grid, self.x, at_random), 1, delta=5e-3)
        regular = np.indices((20, 20, 20)).sum(axis=0).ravel() % 2  # better than at random
        self.assertGreater(lacey_index(self.grid, self.x, regular), 1)

    def test_segregation_is_1_apart(self):
        layers = np.where(self.x[:, 2] < 0.25, 2.0, 1.0)
        self.assertAlmostEqual(segregation_intensity(self.grid, self.x, layers), 1, places=12)
        regular = np.indices((20, 20, 20)).sum(axis=0).ravel() % 2
        self.assertLess(segregation_intensity(self.grid, self.x, regular), 0.01)
        with self.assertRaisesRegex(ValueError, "same value"):
            segregation_intensity(self.grid, self.x, np.ones(len(self.x)))


class Beds(unittest.TestCase):
    def test_surface_and_outline(self):
        x = lattice(10, 0.01)
        x = x[x[:, 2] < 0.3 * x[:, 0] + 0.02]
        grid = Grid.over([0, 0, 0], [0.1, 0.1, 0.1], 0.01)
        top = bed_surface(grid, solid_fraction_map(grid, x, 0.005))
        columns = x[:, [0, 1]] // 0.01
        for i, j in ((0, 0), (5, 3), (9, 9)):
            own = np.all(columns == [i, j], axis=1)
            self.assertAlmostEqual(top[i, j], x[own, 2].max() + 0.005, places=12)
        outline = bed_outline(np.array([[1.0, 0, 2]]), 0.5, along=0, up=2, cell=0.001)
        self.assertAlmostEqual(outline[:, 1].max(), 2.5, delta=1e-6)
        np.testing.assert_allclose(outline[:, 1], 2 + np.sqrt(0.25 - (outline[:, 0] - 1) ** 2))
        self.assertAlmostEqual(surface_slope(np.array([[0, 0], [1, 1.0], [2, 2]])), 45)

    def test_toe_and_shoulder_are_the_ends_of_the_charge(self):
        d, shell, toe, shoulder = 0.01, 0.5, -35.0, 62.0
        layer = [np.stack([np.full(n, r), np.linspace(toe, shoulder, n)], axis=1)
                 for r in shell - d / 2 - d * np.arange(6) for n in [round(np.radians(shoulder - toe) * r / d)]]
        r, angle = np.concatenate(layer).T
        angle = np.radians(angle)
        ring = np.stack([r * np.sin(angle), 0 * r, -r * np.cos(angle)], axis=1)  # turns from -z to +x: about -y
        bed = np.concatenate([ring + [0, y, 0] for y in np.arange(8) * d]) + [1, 2, 3]
        flight = np.random.default_rng(1).uniform([0.6, 2, 2.6], [1.4, 2.07, 3.4], (2000, 3))
        for x in (bed, np.concatenate([bed, flight])):
            found = toe_and_shoulder(x, d / 2, [1, 0, 3], [0, -1, 0], shell)
            np.testing.assert_allclose(found, [toe, shoulder], atol=1.5)
        turned = toe_and_shoulder(bed, d / 2, [1, 0, 3], [0, 2, 0], shell)
        np.testing.assert_allclose(turned, [-shoulder, -toe], atol=1.5)
        twice = toe_and_shoulder(np.concatenate([bed, bed]), d / 2, [1, 0, 3], [0, -1, 0], shell, frames=2)
        np.testing.assert_allclose(twice, toe_and_shoulder(bed, d / 2, [1, 0, 3], [0, -1, 0], shell))
        sideways = toe_and_shoulder(bed[:, [2, 1, 0]], d / 2, [3, 0, 1], [0, 1, 0], shell, up=[1, 0, 0])
        np.testing.assert_allclose(sideways, [toe, shoulder], atol=1.5)

    def test_toe_and_shoulder_need_a_charge_with_ends(self):
        angle = np.linspace(0, 2 * np.pi, 300, endpoint=False)
        lining = np.concatenate([np.stack([r * np.sin(angle), 0 * angle, r * np.cos(angle)], axis=1)
                                 for r in (0.495, 0.485, 0.475)])
        with self.assertRaisesRegex(ValueError, "lines the whole shell"):
            toe_and_shoulder(lining, 0.005, [0, 0, 0], [0, 1, 0], 0.5)
        with self.assertRaisesRegex(ValueError, "no charge at the shell"):
            toe_and_shoulder(lining[:100] * 0.5, 0.005, [0, 0, 0], [0, 1, 0], 0.5)
        with self.assertRaisesRegex(ValueError, "must not be vertical"):
            toe_and_shoulder(lining, 0.005, [0, 0, 0], [0, 0, 1], 0.5)

    def test_contacts_are_those_of_all_pairs(self):
        random = np.random.default_rng(2)
        for period in (None, [1, 0, 1.2]):
            x, r = random.random((300, 3)) * [1, 1, 1.2], random.uniform(0.02, 0.06, 300)
            apart = x[:, None] - x[None]
            if period:
                for k in (0, 2):
                    apart[..., k] -= period[k] * np.round(apart[..., k] / period[k])
            touch = np.linalg.norm(apart, axis=-1) <= r[:, None] + r + 0.003
            expected = np.argwhere(np.triu(touch, 1))
            np.testing.assert_array_equal(contact_pairs(x, r, 0.003, period), expected)
        self.assertEqual(coordination(lattice(5, 1.0), 0.5001)[62], 6)  # in the middle
        self.assertEqual(len(contact_pairs(np.array([[0.05, 0, 0], [0.95, 0, 0]]), 0.06, period=[1, 0, 0])), 1)


class Bodies(unittest.TestCase):
    def test_spin_and_power(self):
        x = np.random.default_rng(3).random((50, 3))
        np.testing.assert_allclose(angular_velocity(x, np.cross([1.0, -2, 3], x) + [5, 6, 7]), [1, -2, 3])

        class Body:
            path = "body.csv"
            columns = {"time": [0, 1, 2, 4], "power_by_fluid": [9, 1, 3, 5], "power_by_grains": [0, -9, -9, -9]}

            def names(self):
                return list(self.columns)

            def column(self, name):
                return np.array(self.columns[name], float)

        self.assertAlmostEqual(mean_power(Body(), start=1), (2 + 8) / 3 - 9)  # of all that acts on it
        self.assertAlmostEqual(mean_power(Body(), "power_by_fluid", start=1), (2 + 8) / 3)
        self.assertAlmostEqual(power_number(2.0, 1000, 2, 0.1), 25)


class StillFluid:
    """Frames of fluid on a lattice, whose velocity and pressure are linear in z, in a slot periodic along y."""

    def __init__(self, dx, two_d=False):
        self.case = {"fluid": {"dx": dx, "h_over_dx": 1.5, "rho0": 1000.0},
                     "domain": {"min": [0, 0, 0], "max": [0.4, 0.1, 0.2], "periodic": [False, True, False], "two_d": two_d}}
        axes = [np.arange(dx / 2, side, dx) for side in (0.4, 0.1, 0.1)]
        if two_d:
            axes[1] = np.array([0.05])
        self.x = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
        self.fluid = self

    def __len__(self):
        return 2

    def position(self, frame):
        return self.x.copy()

    def get(self, frame, name, default=None):
        return default

    def read(self, frame, name):
        depth = 0.1 - self.x[:, 2]
        return 9810 * depth if name == "pressure" else np.stack([(1 + frame) * depth, 0 * depth, 0 * depth], axis=1)


class Points(unittest.TestCase):
    def test_have_the_fields_of_the_fluid_around_them(self):
        for two_d in (False, True):
            run = StillFluid(0.01, two_d)
            points = np.array([[[0.2, 0.001, 0.05], [0.21, 0.099, 0.062]], [[0.2, 0.05, 0.18], [0.25, 0.05, 0.04]]])
            found = at_points(run, points, ["pressure", "velocity"])
            self.assertEqual(found["pressure"].shape, (2, 2, 2))
            self.assertEqual(found["velocity"].shape, (2, 2, 2, 3))
            np.testing.assert_allclose(found["kernel_sum"][0, 0], 1, atol=0.01)  # across the period too
            np.testing.assert_allclose(found["pressure"][0, 0], [9810 * 0.05, 9810 * 0.038], rtol=0.01)
            np.testing.assert_allclose(found["velocity"][1, 1, 1], [2 * 0.06, 0, 0], rtol=0.01)
            self.assertTrue(np.isnan(found["pressure"][0, 1, 0]))  # above the surface
            self.assertEqual(at_points(run, points, [], frames=[-1])["kernel_sum"].shape, (1, 2, 2))


class Series(unittest.TestCase):
    def test_running_means_are_integrals_over_their_width(self):
        time = np.sort(np.random.default_rng(3).random(400)) * 4  # uneven
        np.testing.assert_allclose(running_mean(time, 3 + 2 * time, 0.5)[50:-50], (3 + 2 * time)[50:-50], atol=1e-9)
        even = np.linspace(0, 4, 4001)
        mean = running_mean(even, np.sin(2 * np.pi * even / 0.5), 0.5)  # over a period
        np.testing.assert_allclose(mean[300:-300], 0, atol=1e-5)
        with self.assertRaisesRegex(ValueError, "must be above 0"):
            running_mean(even, even, 0)

    def test_spectra_have_the_variance_at_its_frequency(self):
        time = np.linspace(0, 20, 4001)
        frequency, density = spectrum(time, 5 + 0.3 * np.sin(2 * np.pi * 2.5 * time))
        self.assertAlmostEqual(frequency[np.argmax(density)], 2.5, delta=0.06)
        variance = np.sum((density[1:] + density[:-1]) / 2 * np.diff(frequency))
        self.assertAlmostEqual(variance, 0.3**2 / 2, delta=0.01 * 0.3**2 / 2)
        with self.assertRaisesRegex(ValueError, "needs 8 values"):
            spectrum(time[:5], time[:5])


if __name__ == "__main__":
    unittest.main()
