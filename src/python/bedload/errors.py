"""The four kinds of errors; each has the message that the program prints."""


class CaseError(ValueError):
    """An invalid case or argument: names file, line, key, value and allowed range."""


class FileError(OSError):
    """A file that cannot be read or written."""


class DeviceError(RuntimeError):
    """No such device, or it is out of memory."""


class SimulationFault(ArithmeticError):
    """The simulation failed; names particle, position and time."""
