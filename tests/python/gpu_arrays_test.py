"""Arrays of a run on a GPU, as other programs there see them. Skipped where there is no GPU.

    python tests/python/gpu_arrays_test.py        with the package on PYTHONPATH, as tools/bundle leaves it
"""

import ctypes
import importlib
import unittest

import bedload
import numpy as np
from support import TANK

STORES = ("fluid", "grains", "walls")
CUDA, DEVICE_MEMORY = 2, 2  # DLPack's kDLCUDA; the driver's CU_MEMORYTYPE_DEVICE


class Tensor(ctypes.Structure):
    """DLManagedTensorVersioned of DLPack 1."""

    _fields_ = [("major", ctypes.c_uint32), ("minor", ctypes.c_uint32), ("context", ctypes.c_void_p),
                ("deleter", ctypes.c_void_p), ("flags", ctypes.c_uint64), ("data", ctypes.c_uint64),
                ("device", ctypes.c_int32), ("number", ctypes.c_int32), ("axes", ctypes.c_int32),
                ("code", ctypes.c_uint8), ("bits", ctypes.c_uint8), ("lanes", ctypes.c_uint16),
                ("shape", ctypes.POINTER(ctypes.c_int64)), ("strides", ctypes.POINTER(ctypes.c_int64)),
                ("offset", ctypes.c_uint64)]


def tensor_of(capsule):
    found = ctypes.pythonapi.PyCapsule_GetPointer
    found.restype, found.argtypes = ctypes.c_void_p, [ctypes.py_object, ctypes.c_char_p]
    return Tensor.from_address(found(capsule, b"dltensor_versioned"))


def driver(call, *arguments):
    """A call of the GPU's driver, which knows nothing of Bedload."""
    status = getattr(ctypes.CDLL("libcuda.so.1"), call)(*arguments)
    if status:
        raise OSError(f"{call}: {status}")


def copied_by_driver(interface):
    """What a __cuda_array_interface__ shows, in host memory."""
    kind, shape, strides = np.dtype(interface["typestr"]), interface["shape"], interface["strides"]
    extent = sum((n - 1) * step for n, step in zip(shape, strides)) + kind.itemsize
    raw = np.empty(extent, np.uint8)
    pointer = ctypes.c_uint64(interface["data"][0])
    driver("cuMemcpyDtoH_v2", ctypes.c_void_p(raw.ctypes.data), pointer, ctypes.c_size_t(extent))
    return np.ndarray(shape, kind, raw, strides=strides).copy()


def module(name):
    try:
        return importlib.import_module(name)
    except ImportError:
        raise unittest.SkipTest(f"no {name} here") from None


class GpuArrays(unittest.TestCase):
    def setUp(self):
        try:
            self.tank = bedload.Simulation(bedload.Case.from_toml(TANK), backend="cuda")
        except bedload.DeviceError as why:
            self.skipTest(str(why))
        self.tank.run(0.005)

    def each(self, check):
        """check(store, name, array) for all that is in device memory."""
        for store in STORES:
            for name in getattr(self.tank, store).names():
                array = getattr(self.tank, store)[name]
                if isinstance(array, bedload.DeviceArray):
                    with self.subTest(array=f"{store}.{name}"):
                        check(store, name, array)

    def test_tell_what_they_are(self):
        seen = set()

        def check(store, name, array):
            seen.add(f"{store}.{name}")
            interface = array.__cuda_array_interface__
            pointer, read_only = interface["data"]
            self.assertTrue(read_only)
            self.assertEqual(interface["version"], 3)
            self.assertIsNone(interface["stream"])
            self.assertEqual(interface["shape"], array.shape)
            self.assertEqual(len(array), len(getattr(self.tank, store)))
            where = ctypes.c_uint(0)
            driver("cuPointerGetAttribute", ctypes.byref(where), 2, ctypes.c_uint64(pointer))
            self.assertEqual(where.value, DEVICE_MEMORY)

            self.assertEqual(array.__dlpack_device__(), (CUDA, 0))
            capsule = array.__dlpack__(stream=1, max_version=(1, 0))
            tensor, scalar = tensor_of(capsule), array.dtype.itemsize
            self.assertEqual((tensor.major, tensor.flags, tensor.data + tensor.offset), (1, 1, pointer))  # 1: read only
            self.assertEqual((tensor.device, tensor.number, tensor.bits, tensor.lanes), (CUDA, 0, 8 * scalar, 1))
            self.assertEqual(tensor.code, {"f": 2, "u": 1}[array.dtype.kind])
            self.assertEqual(tuple(tensor.shape[:tensor.axes]), array.shape)
            self.assertEqual(tuple(scalar * n for n in tensor.strides[:tensor.axes]), interface["strides"])

        self.each(check)
        for store in STORES:
            self.assertLessEqual({f"{store}.{name}" for name in ("position", "velocity", "id")}, seen)
        self.assertEqual(self.tank.grains.position.dtype, np.float64)
        self.assertEqual(self.tank.fluid.velocity.__cuda_array_interface__["strides"], (16, 4))

    def test_hold_what_the_host_is_told(self):
        def check(store, name, array):
            copy = getattr(self.tank, store).copy(name)
            self.assertEqual((copy.dtype, copy.shape), (array.dtype, array.shape))
            np.testing.assert_array_equal(copied_by_driver(array.__cuda_array_interface__), copy)
            np.testing.assert_array_equal(np.asarray(array), copy)
            np.testing.assert_array_equal(array[:3], copy[:3])
            if name == "id":
                np.testing.assert_array_equal(np.sort(copy), np.arange(len(array)))

        self.each(check)
        momentum = self.tank.fluid.copy("mass") @ self.tank.fluid.copy("velocity").astype(float)
        told = self.tank.diagnostics()
        self.assertGreater(abs(momentum[0]), 1e-4)
        for k, axis in enumerate("xyz"):
            self.assertAlmostEqual(momentum[k], told[f"fluid_momentum_{axis}"], delta=1e-6)
        self.assertIsInstance(self.tank.fluid.pressure, np.ndarray)

    def test_are_taken_over_by_cupy(self):
        cupy = module("cupy")

        def check(store, name, array):
            for theirs in (cupy.asarray(array), cupy.from_dlpack(array)):
                self.assertEqual(theirs.data.ptr, array.__cuda_array_interface__["data"][0])
                np.testing.assert_array_equal(theirs.get(), array.copy())

        self.each(check)

    def test_are_taken_over_by_torch(self):
        torch = module("torch")

        def check(store, name, array):
            theirs = torch.from_dlpack(array)
            self.assertEqual(theirs.data_ptr(), array.__cuda_array_interface__["data"][0])
            np.testing.assert_array_equal(theirs.cpu().numpy(), array.copy())

        self.each(check)

    def test_outlive_steps_and_the_simulation(self):
        held, rebuilt, before = [], 0, None
        for step in self.tank.steps():
            rebuilt += step.rebuilt
            held += [self.tank.fluid.velocity, self.tank.grains.position, self.tank.fluid.id]
        self.assertGreater(rebuilt, 0)
        last = self.tank.grains.position
        expected = self.tank.grains.copy("position")
        del self.tank
        for array in held:  # no longer right, but memory that is there
            self.assertTrue(np.isfinite(copied_by_driver(array.__cuda_array_interface__)).all())
        np.testing.assert_array_equal(last.copy(), expected)

    def test_are_there_in_callbacks(self):
        times, speeds = [], []

        def look(tank):
            times.append(tank.time)
            speeds.append(np.linalg.norm(np.asarray(tank.fluid.velocity), axis=1).max())
            self.assertEqual(tank.probe("front").keys(), {"front_x"})

        self.tank.run(0.015, every=0.002, call=look)
        self.assertEqual([int(t / 0.002 + 1e-9) for t in times], [2, 3, 4, 5, 6, 7])
        self.assertGreater(speeds[-1], speeds[0])
        steps = []
        self.tank.run(call=lambda s: steps.append(s.step_count) or len(steps) < 3)
        self.assertEqual((len(steps), steps[-1]), (3, self.tank.step_count))


if __name__ == "__main__":
    unittest.main(verbosity=2)
