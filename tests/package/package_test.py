#!/usr/bin/env python3
"""What is installed and packed: the example of docs/examples builds against it and runs, the tarball runs anywhere, the
.deb names what it needs. Usage: package_test.py BUILD_DIR"""

import os
import subprocess
import sys
import tarfile
import tempfile
import unittest
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(sys.argv.pop(1)).resolve() if len(sys.argv) > 1 else ROOT / "build/cpu"
sys.path[:0] = [str(ROOT / "src/python"), str(ROOT / "tests/python")]
from bedload import _toml  # noqa: E402
from bedload.results import Frames  # noqa: E402
from support import TANK  # noqa: E402


def call(*words, **options):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, **options)
    if done.returncode:
        raise AssertionError(f"{words[0]} ended with {done.returncode}: {done.stdout}{done.stderr}")
    return done.stdout


def beetstra(eps, reynolds):
    """As in docs/examples/drag_law/main.cpp."""
    phi = 1 - eps
    slow = 10 * phi / eps**2 + eps**2 * (1 + 1.5 * phi**0.5)
    if reynolds == 0:
        return eps * slow
    above = 1 / eps + 3 * eps * phi + 8.4 * reynolds**-0.343
    below = 1 + 10 ** (3 * phi) * reynolds ** (-0.5 - 2 * phi)
    return eps * (slow + 0.413 * reynolds / (24 * eps**2) * above / below)


class Packages(unittest.TestCase):
    def setUp(self):
        self.place = Path(self.enterContext(tempfile.TemporaryDirectory(prefix="bedload_package_")))
        self.case = self.place / "tank.toml"
        self.case.write_text(TANK.replace("end = 0.02", "end = 0.01"))

    def test_a_program_from_outside_adds_its_drag_law(self):
        for component in ("program", "development"):
            call("cmake", "--install", BUILD, "--prefix", self.place / "usr", "--component", component)
        call("cmake", "-S", ROOT / "docs/examples/drag_law", "-B", self.place / "build", "-G", "Ninja",
             f"-DCMAKE_PREFIX_PATH={self.place / 'usr'}")
        call("cmake", "--build", self.place / "build")
        found = float(call(self.place / "build/drag_law", self.case).split()[0])

        porosity = [k / 20 for k in range(6, 21)]
        reynolds = [0.0, *(10 ** (k / 8) for k in range(-24, 41))]
        table = {"law": "table", "porosity": porosity, "reynolds": reynolds,
                 "factor": [beetstra(eps, re) for eps in porosity for re in reynolds]}
        self.case.write_text(f"drag = {_toml.value(table)}\n" + self.case.read_text())
        program = self.place / "usr/bin/bedload"
        call(program, "run", self.case, "--out", self.place / "table", "--quiet")
        speed = -Frames(self.place / "table/grains.vtkhdf").get(-1, "velocity")[:, 2].mean()
        self.assertAlmostEqual(found, speed, delta=1e-5 * speed)
        man = (self.place / "usr/share/man/man1/bedload.1").read_text()
        self.assertIn("bedload", man)

    def test_the_tarball_brings_its_libraries(self):
        call("cpack", "-G", "TGZ", "-B", self.place, cwd=BUILD)
        with tarfile.open(next(self.place.glob("*.tar.gz"))) as tarball:
            tarball.extractall(self.place, filter="data")
        program = next(self.place.glob("*/bin/bedload"))
        own = program.parents[1] / "lib"
        environment = {key: value for key, value in os.environ.items() if key != "LD_LIBRARY_PATH"}
        call(program, "run", self.case, "--out", self.place / "run", "--quiet", "--until", 0.001, env=environment)
        libraries = [line.split()[2] for line in call("ldd", program).splitlines() if "=>" in line]
        outside = [Path(path).name for path in libraries if not Path(path).resolve().is_relative_to(own.resolve())]
        self.assertTrue(any("hdf5" in path for path in libraries))
        c_library = ("libc.", "libm.", "libdl.", "libpthread.", "libresolv.", "librt.")
        self.assertEqual([name for name in outside if not name.startswith(c_library)], [])

    def test_the_debian_package_names_what_it_needs(self):
        call("cpack", "-G", "DEB", "-B", self.place, cwd=BUILD)
        package = next(self.place.glob("bedload_*.deb"))
        self.assertRegex(call("dpkg-deb", "-f", package, "Depends"), "libhdf5.*")
        files = call("dpkg-deb", "-c", package)
        for path in ("./usr/bin/bedload", "./usr/share/man/man1/bedload.1", "./usr/include/bedload/simulation.hpp",
                     "bedload-config.cmake", "libbedload_device.a"):
            self.assertIn(path, files)
        self.assertNotIn("libhdf5", files)

    def test_an_option_replaces_that_of_the_tool(self):
        """tools/package with programs that take the place of Python, pip and auditwheel."""
        for path, text in {
            "tools/package": (ROOT / "tools/package").read_text(),
            "tools/install_dependencies": "#!/bin/sh\n",
            "build/package_tools/hdf5/lib/libhdf5.a": "",
            "build/package_tools/hdf5_source/COPYING": "",
            "build/package_tools/venv_311/lib/python3.11/site-packages/nanobind-3.dist-info/licenses/LICENSE": "",
            "build/package_tools/venv_311/bin/python": '#!/bin/sh\n[ "$2" != pip ] || printf "%s\\n" "$@" >given\n',
            "build/package_tools/venv_311/bin/auditwheel": "#!/bin/sh\ntouch build/packages/bedload.whl\n",
            "python": "#!/bin/sh\necho 311\n",
        }.items():
            file = self.place / path
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text)
            file.chmod(0o755)
        out = call(self.place / "tools/package", "-DBEDLOAD_PRECISIONS=single", "wheel",
                   env=os.environ | {"PYTHON": str(self.place / "python")})
        self.assertEqual(len(out.splitlines()), 1)  # its size
        given = [word for word in (self.place / "given").read_text().split() if "cmake.define" in word]
        keys = [word.split("=")[1] for word in given]
        self.assertEqual(len(keys), len(set(keys)))
        self.assertIn("--config-settings=cmake.define.BEDLOAD_PRECISIONS=single", given)
        self.assertTrue((self.place / "build/package_tools/licences/hdf5").exists())


if __name__ == "__main__":
    unittest.main()
