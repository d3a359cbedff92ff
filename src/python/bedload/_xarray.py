"""Frames as an xarray.Dataset whose values are read on demand."""

import functools

import numpy as np
import xarray as xr
from xarray.backends import BackendArray
from xarray.core import indexing


class _Particles:
    """Positions of the particles of each frame in the list of all ids."""

    def __init__(self, frames):
        self.frames = frames
        each = [self.ids(k) for k in range(len(frames))]
        self.all = np.unique(np.concatenate(each)) if each else np.zeros(0, np.uint32)
        self.constant = all(len(ids) == len(self.all) for ids in each)

    @functools.lru_cache(maxsize=256)
    def ids(self, frame):
        return self.frames.read(frame, "id")

    def places(self, frame):
        return np.searchsorted(self.all, self.ids(frame))


class _Field(BackendArray):
    """One array over (time, particle[, axis])."""

    def __init__(self, frames, particles, name):
        self.frames, self.particles, self.name = frames, particles, name
        first = frames.read(0, name)
        self.shape = (len(frames), len(particles.all), *first.shape[1:])
        self.dtype = first.dtype
        if not particles.constant and not np.issubdtype(self.dtype, np.floating):
            self.dtype = np.dtype(float)

    def __getitem__(self, key):
        return indexing.explicit_indexing_adapter(key, self.shape, indexing.IndexingSupport.OUTER, self._read)

    def _read(self, key):
        time, *rest = key
        wanted = np.arange(len(self.frames))[time]
        read = [self._frame(frame)[tuple(_outer(rest, self.shape[1:]))] for frame in np.atleast_1d(wanted)]
        return np.stack(read) if np.ndim(wanted) else read[0]

    def _frame(self, frame):
        out = np.empty(self.shape[1:], self.dtype)
        if not self.particles.constant:
            out.fill(np.nan)
        out[self.particles.places(frame)] = self.frames.read(frame, self.name)
        return out


def _outer(key, shape):
    """Independent indices of each axis as one index of NumPy; integers drop their axis."""
    if sum(isinstance(k, np.ndarray) for k in key) < 2:
        return key
    return np.ix_(*(np.arange(n)[k] for k, n in zip(key, shape)))


def dataset_of(frames):
    """See Frames.to_xarray."""
    particles = _Particles(frames)
    variables = {}
    for name in frames.names():
        if name == "id":
            continue
        data = _Field(frames, particles, name)
        dims = ("time", "particle", "axis", "component")[: len(data.shape)]
        variables[name] = (dims, indexing.LazilyIndexedArray(data), {"units": frames.unit(name)})
    coordinates = {
        "time": ("time", frames.times, {"units": "s"}),
        "particle": ("particle", particles.all, {"long_name": "id of the particle"}),
        "axis": ["x", "y", "z"],
    }
    return xr.Dataset(variables, coordinates, {"source": str(frames.path)})
