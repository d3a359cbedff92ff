"""Derived quantities where the answer is known."""

import unittest

import numpy as np
from bedload.measures import (Grid, angular_velocity, bed_outline, bed_surface, contact_pairs, coordination,
                              lacey_index, mean_map, mean_power, porosity_map, power_number, segregation_intensity,
                              solid_fraction_map, surface_slope)


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


if __name__ == "__main__":
    unittest.main()
