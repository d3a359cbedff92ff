"""Loads the compiled module."""

import functools
import os


@functools.cache
def module():
    """bedload._bedload. OpenMP reads its settings when it is loaded: idle threads sleep, as in the program."""
    if "GOMP_SPINCOUNT" not in os.environ:
        os.environ.setdefault("OMP_WAIT_POLICY", "passive")
    from . import _bedload

    return _bedload
