"""The program: `python -m bedload run case.toml`, as `bedload run case.toml`."""

import sys


def main():
    if sys.argv[1:2] == ["gui"] and not {"-h", "--help"} & set(sys.argv[2:]):
        from .gui import main as show

        return show(sys.argv[2:])
    from ._module import module

    return module().main(["bedload", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
