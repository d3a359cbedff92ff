"""The window: `bedload gui [case.toml]`, in the browser of this machine.

`document`, `reading` and `forms` edit a case, `shapes` and `scene` draw it, `run` checks and runs it, `curves` and
`view` show what a run does, `page` is the page. `app` is the window, with its actions in `editing`, `files`, `drawing`
and `pointer`.
"""

from __future__ import annotations

import argparse
import ctypes.util
import importlib.util
import os
import secrets
import socket
import sys
from pathlib import Path

NEEDS = {"trame": "trame", "trame_vuetify": "trame-vuetify", "trame_vtk": "trame-vtk", "pyvista": "pyvista",
         "tomlkit": "tomlkit", "imageio_ffmpeg": "imageio-ffmpeg"}  # module -> package
PORT = 8030


def missing() -> list[str]:
    """Packages that the window needs and this Python lacks."""
    return [package for name, package in NEEDS.items() if importlib.util.find_spec(name) is None]


def main(arguments: list[str]) -> int:
    """`bedload gui ARGUMENTS`; returns the exit code."""
    if lacking := missing():
        print(f"bedload gui needs {', '.join(lacking)}, which {sys.executable} does not have; install with: "
              'pip install "bedload[gui]"', file=sys.stderr)
        return 2
    parser = argparse.ArgumentParser(prog="bedload gui", description="Build, run and watch a case in the browser.")
    parser.add_argument("case", nargs="?", metavar="CASE.toml", help="case file; it is made if it does not exist")
    parser.add_argument("--port", type=int, default=PORT,
                        help=f"port at 127.0.0.1; 0: any that is free; default {PORT}")
    parser.add_argument("--no-browser", action="store_true", help="print the address, open no browser")
    options = parser.parse_args(arguments)
    if not (options.port == 0 or 1024 <= options.port <= 65535):
        print(f"command line: --port {options.port} must be within 1024..65535, or 0 for any free one", file=sys.stderr)
        return 2
    from ..errors import CaseError, FileError

    try:
        document = opened(options.case)
    except (CaseError, FileError) as error:
        print(error, file=sys.stderr)
        return 2
    port = options.port or _free_port()
    if not _is_free(port):
        print(f"command line: --port {port} is in use; take another, or 0 for any free one", file=sys.stderr)
        return 2
    serve(document, port, browser=not options.no_browser)
    return 0


def opened(name: str | None):
    """The document of a file; a new one where there is no such file yet."""
    from .document import Document

    if name is None:
        return Document()
    if not Path(name).exists() and Path(name).suffix == ".toml":
        document = Document()
        document.path = Path(name)
        return document
    return Document.open(name)


def serve(document, port: int, browser: bool = True) -> None:
    """Shows a document until Ctrl-C. Only who has the token of the address can use the page."""
    import webbrowser

    token = secrets.token_urlsafe(16)
    sys.argv[1:] = []  # trame reads it
    if sys.platform == "linux" and not os.environ.get("DISPLAY") and ctypes.util.find_library("EGL"):
        os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")  # which VTK finds only after a warning
    from .app import Window

    address = f"http://127.0.0.1:{port}/index.html?secret={token}"
    window = Window(document)
    window.server.cli.set_defaults(authKey=token)

    def ready(**_):
        print(f"window     {address}", flush=True)
        if browser:
            webbrowser.open(address)

    window.server.controller.on_server_ready.add(ready)
    window.server.start(port=port, host="127.0.0.1", open_browser=False, show_connection_info=False, timeout=0,
                        disable_logging=True)
    window.close()


def _free_port() -> int:
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def _is_free(port: int) -> bool:
    with socket.socket() as one:
        one.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            one.bind(("127.0.0.1", port))
        except OSError:
            return False
    return True
