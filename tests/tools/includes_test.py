"""What may include what (docs/architecture.md): layers point one way, and solvers do not see the whole Config."""

import re
import unittest
from functools import cache
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
ROOTS = TOP / "include", TOP

CORE, PARALLEL, CASE = "bedload/core/", "bedload/parallel/", ("bedload/case/", "bedload/geometry/")
DATA = "bedload/particles/", "bedload/neighbours/", "bedload/lattice/"
SOLVERS = tuple(f"src/{row}/" for row in ("domain", "fluid", "solids", "coupling", "walls", "boundaries", "lattice"))

#: folder -> beginnings of what its files may include
LAYERS = {
    "include/bedload/core": (CORE,),
    "include/bedload/parallel": (CORE, PARALLEL),
    "include/bedload/particles": (CORE, PARALLEL, "bedload/particles/", "bedload/host_data.hpp"),
    "include/bedload/neighbours": (CORE, PARALLEL, "bedload/neighbours/"),
    "include/bedload/lattice": (CORE, "bedload/lattice/"),
    "kernels": (CORE, PARALLEL, *DATA, *CASE, "kernels/"),
    **{row.rstrip("/"): ("bedload/", "kernels/", *SOLVERS, "src/motion/")
       for row in SOLVERS},
}
WHOLE = "bedload/case/config.hpp"
#: what the rest of the code must not need, and the folders that may include it
TOOLS = {"src/viewer/": ("src/viewer", "src/viscometer", "src/cli", "src/python"),
         "src/cli/": ("src/cli", "src/python"), "cli/": ("src/cli", "src/python", "src/main.cpp")}


def sources(folder):
    return sorted(path for path in (TOP / folder).rglob("*") if path.suffix in (".hpp", ".cpp"))


@cache
def includes(path):
    return re.findall(r'^\s*#\s*include "([^"]+)"', path.read_text(), re.M)


@cache
def file_of(name):
    return next((root / name for root in ROOTS if (root / name).exists()), None)


def way_to(name, path):
    """The includes by which a file comes to another, None if it does not."""
    ways, seen = [[path]], {path}
    while ways:
        way = ways.pop(0)
        for include in includes(way[-1]):
            if include == name:
                return [str(step.relative_to(TOP)) for step in way] + [name]
            step = file_of(include)
            if step and step not in seen:
                seen.add(step)
                ways.append([*way, step])
    return None


class Includes(unittest.TestCase):
    def test_layers_point_one_way(self):
        for folder, allowed in LAYERS.items():
            for path in sources(folder):
                wrong = [name for name in includes(path) if not name.startswith(allowed)]
                self.assertEqual(wrong, [], path.relative_to(TOP))

    def test_viewer_and_command_line_stand_on_top(self):
        found = dict.fromkeys(TOOLS, 0)
        for folder in ("include", "kernels", "src"):
            for path in sources(folder):
                for tool, users in TOOLS.items():
                    if any(name.startswith(tool) for name in includes(path)):
                        found[tool] += 1
                        self.assertTrue(str(path.relative_to(TOP)).startswith(users), f"{path.relative_to(TOP)}: {tool}")
        self.assertGreater(found["src/viewer/"], 5)
        self.assertGreater(found["cli/"], 1)

    def test_steps_do_not_measure(self):
        """`coupled_simulation` joins both; what it steps knows nothing of measuring."""
        for path in sources("src/time"):
            if path.stem != "coupled_simulation":
                wrong = [name for name in includes(path) if name.startswith("src/measure/")]
                self.assertEqual(wrong, [], path.relative_to(TOP))

    def test_solvers_see_their_parameters_alone(self):
        """Of the rows of the solver, `parameters.cpp` makes them of a Config; `src/time`, the top, has one."""
        looked = 0
        for folder in LAYERS:
            for path in sources(folder):
                if path.name == "parameters.cpp":
                    continue
                looked += 1
                self.assertIsNone(way_to(WHOLE, path), "reaches the whole Config")
        self.assertGreater(looked, 150)
        self.assertTrue(way_to(WHOLE, TOP / "src/time/stepper.hpp"), "the test finds ways")


if __name__ == "__main__":
    unittest.main()
