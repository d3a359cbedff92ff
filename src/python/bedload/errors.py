"""The four ways in which Bedload stops; each carries the sentence that the program prints."""


class CaseError(ValueError):
    """A case, or what it is asked for, that cannot be computed: names file, line, key, value and allowed range."""


class FileError(OSError):
    """A file that cannot be read or written."""


class DeviceError(RuntimeError):
    """No such device, or too little of its memory."""


class SimulationFault(ArithmeticError):
    """The computation broke down; names particle, place and time."""
