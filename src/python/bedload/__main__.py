"""The program: `python -m bedload run case.toml`, as `bedload run case.toml`."""

import sys

from ._module import module


def main():
    return module().main(["bedload", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
