"""Bedload from Python: write and check cases, run them in this process, read results, sweep over keys.

    import bedload

    case = bedload.Case("dam.toml")
    case.fluid.dx = "2 mm"
    with bedload.Simulation(case, out="results/dam") as dam:
        dam.run(every=0.1, call=lambda s: print(s.time, s.fluid.velocity[:, 0].max()))
    print(bedload.open_run("results/dam").diagnostics.to_pandas())

Numbers are in SI units. Reading results needs only NumPy and h5py, not the compiled module: `bedload.results` and
`bedload.measures` can be used from a source tree.
"""

import importlib

from .errors import CaseError, DeviceError, FileError, SimulationFault

# Loaded on demand, so that results can be read without the compiled module.
_HOMES = {
    "Case": "case", "Section": "case", "Items": "case", "Report": "case", "drag_table": "case", "keys": "case",
    "Simulation": "simulation", "Particles": "simulation", "DeviceArray": "simulation",
    "Run": "results", "Frames": "results", "Table": "results", "open_run": "results",
    "Sweep": "sweeps", "sweep": "sweeps",
    "measures": None, "results": None,
}

__all__ = ["CaseError", "DeviceError", "FileError", "SimulationFault", "__version__", *_HOMES]


def __getattr__(name):
    if name == "__version__":
        from ._module import module

        return module().version()
    if name not in _HOMES:
        raise AttributeError(f"module 'bedload' has no attribute '{name}'")
    home = _HOMES[name]
    found = importlib.import_module(f".{home or name}", __name__)
    value = getattr(found, name) if home else found
    globals()[name] = value
    return value


def __dir__():
    return sorted(__all__)
