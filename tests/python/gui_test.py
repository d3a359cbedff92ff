"""The window without a browser: the document, forms, what is drawn, checks and runs."""

import contextlib
import io
import tomllib
import unittest
import xml.etree.ElementTree as xml
from pathlib import Path
from unittest import mock

import numpy as np
from bedload import gui
from support import ROOT, TANK, folder, program, write_case

LACKING = gui.missing()
needs_gui = unittest.skipIf(LACKING, f'the window needs {", ".join(LACKING)}: pip install "bedload[gui]"')
CASES = sorted(path for path in [*ROOT.glob("cases/*/*.toml"), *ROOT.glob("docs/tutorial/*.toml")]
               if not path.name.startswith("expect"))
DRUM = ROOT / "docs/tutorial/5_slurry.toml"


class Program(unittest.TestCase):
    def test_says_what_to_install(self):
        said = io.StringIO()
        with mock.patch.object(gui, "missing", lambda: ["trame", "tomlkit"]), contextlib.redirect_stderr(said):
            self.assertEqual(gui.main([]), 2)
        self.assertIn("needs trame, tomlkit, which", said.getvalue())
        self.assertIn('pip install "bedload[gui]"', said.getvalue())

    @needs_gui
    def test_refuses_wrong_command_lines_with_one_sentence(self):
        for arguments, why in ((["no.stl"], "no.stl: cannot read this case file"),
                               (["--port", "80"], "--port 80 must be within 1024..65535, or 0 for any free one")):
            code, out, error = program("gui", *arguments)
            self.assertEqual((code, out), (2, ""))
            self.assertIn(why, error)
            self.assertEqual(error.count("\n"), 1)


@needs_gui
class Documents(unittest.TestCase):
    def setUp(self):
        from bedload.gui.document import Document

        self.document = Document.open(DRUM)

    def lines_changed(self, before):
        old, new = before.splitlines(), self.document.text.splitlines()
        self.assertEqual(len(old), len(new))
        return [(a, b) for a, b in zip(old, new) if a != b]

    def test_an_edit_changes_one_line_and_keeps_its_comment(self):
        before = self.document.text
        self.document.set("grain.E", "2e7")
        line = "E = 1e7                            # Pa; soft, for larger steps"
        self.assertEqual(self.lines_changed(before), [(line, line.replace("1e7", "2e7"))])
        self.document.set("grain.fill.0.sizes.0.d", '"2.2 mm"')
        self.assertIn(('  { d = 0.002 },', '  { d = "2.2 mm" },'), self.lines_changed(before))

    def test_adds_no_empty_lines_where_only_a_value_changes(self):
        from bedload.gui.document import Document

        made = Document("[time]\nend = 1\n[out]\nevery = 1\n")
        made.set("time.end", "2")
        made.set("time.dt", "1e-5")
        self.assertEqual(made.text, "[time]\nend = 2\ndt = 1e-5\n[out]\nevery = 1\n")
        made.add("run")
        self.assertEqual(made.text, "[time]\nend = 2\ndt = 1e-5\n[out]\nevery = 1\n\n[run]\n")

    def test_undo_and_redo(self):
        texts = [self.document.text]
        for path, value in (("time.end", "2.0"), ("fluid.rho0", "1200"), ("probe.0.name", '"torque"')):
            self.document.set(path, value)
            texts.append(self.document.text)
        self.assertTrue(self.document.changed)
        for text in texts[-2::-1]:
            self.document.undo()
            self.assertEqual(self.document.text, text)
        self.assertFalse(self.document.can_undo or self.document.changed)
        self.document.redo()
        self.assertEqual(self.document.text, texts[1])
        self.document.set("time.end", "3.0")
        self.assertFalse(self.document.can_redo)

    def test_a_case_from_nothing_is_what_a_person_would_write(self):
        from bedload.gui.document import Document

        self.document = made = Document()
        made.set("title", '"Tank"')
        made.add("domain")
        made.set("domain.min", "[0, 0, 0]")
        self.assertEqual(made.add("fluid.fill", {}, item=True), "fluid.fill.0")
        made.set("fluid.fill.0.min", "[0, 0, 0]")
        made.set("fluid.dx", '"2 mm"')
        made.add("wall.body", {"name": "tank"}, item=True)
        made.add("wall.body", {"name": "gate"}, item=True)
        made.add("wall.body.1.motion")
        made.set("wall.body.1.motion.kind", '"velocity"')
        self.assertEqual(made.text, 'title = "Tank"\n\n[domain]\nmin = [0, 0, 0]\n\n[fluid]\ndx = "2 mm"\n\n'
                                    '[[fluid.fill]]\nmin = [0, 0, 0]\n\n[[wall.body]]\nname = "tank"\n\n'
                                    '[[wall.body]]\nname = "gate"\n\n[wall.body.motion]\nkind = "velocity"\n')
        made.remove("wall.body.1")
        made.remove("wall.body.0")
        made.remove("fluid.fill.0")
        self.assertEqual(made.tree(), {"title": "Tank", "domain": {"min": [0, 0, 0]}, "fluid": {"dx": "2 mm"}})

    def test_keeps_the_order_of_tables_that_stand_apart(self):
        from bedload.gui.document import Document

        text = ('[[wall.body]]\nname = "a"\n\n[[shape]]\nname = "s"\n\n[[wall.body]]\nname = "b"\n[wall.body.free]\n'
                'density = 1\n\n[time]\nend = 1  # s\n')
        made = Document(text)
        made.set("wall.body.1.free.density", "2")
        made.set("wall.body.0.name", '"c"')
        made.set("time.end", "3")
        self.assertEqual(made.text, text.replace("density = 1", "density = 2").replace('"a"', '"c"')
                         .replace("end = 1", "end = 3"))
        made.remove("wall.body.0")
        made.add("wall.body", {"name": "d"}, item=True)
        self.assertEqual(made.text, '[[shape]]\nname = "s"\n\n[[wall.body]]\nname = "b"\n[wall.body.free]\n'
                                    'density = 2\n\n[[wall.body]]\nname = "d"\n\n[time]\nend = 3  # s\n')

    def test_every_value_of_every_case_can_be_written_again(self):
        from bedload.gui.document import Document

        for path in CASES:
            with self.subTest(case=str(path.relative_to(ROOT))):
                document = Document.open(path)
                for key in leaves(document.tree()):
                    document.set(key, document.source(key))
                self.assertEqual(document.text, path.read_text())
                self.assertFalse(document.can_undo)

    def test_every_table_of_every_case_can_be_removed(self):
        from bedload.gui import forms
        from bedload.gui.document import Document

        for path in CASES:
            document = Document.open(path)
            for node in forms.tree(document)[1:]:
                with self.subTest(case=str(path.relative_to(ROOT)), table=node.path):
                    document.remove(node.path)
                    document.undo()
                    self.assertEqual(document.text, path.read_text())

    def test_text_that_is_not_toml_can_only_be_edited_as_text(self):
        from bedload import CaseError

        self.document.set_text("[fluid\ndx = 1\n")
        self.assertIn("line 1", self.document.error)
        with self.assertRaisesRegex(CaseError, "the text is not TOML"):
            self.document.set("fluid.dx", "2")
        self.document.set_text("[fluid]\ndx = 1\n")
        self.document.set("fluid.dx", "2")
        self.assertEqual(self.document.text, "[fluid]\ndx = 2\n")

    def test_saves(self):
        from bedload import FileError

        with folder() as place:
            self.document.set("time.end", "2.0")
            file = self.document.save(Path(place) / "new" / "drum.toml")
            self.assertEqual(file.read_text(), self.document.text)
            self.assertFalse(self.document.changed)
            with self.assertRaisesRegex(FileError, "cannot be written"):
                self.document.save(Path(place))


@needs_gui
class Forms(unittest.TestCase):
    def setUp(self):
        from bedload.gui.document import Document

        self.document = Document.open(DRUM)

    def fields(self, path):
        from bedload.gui import forms, reading

        return {f.name: f for f in forms.fields(self.document, path, reading.read(self.document).problem)}

    def test_the_tree_has_every_table(self):
        from bedload.gui import forms

        nodes = forms.tree(self.document)
        self.assertEqual([(n.depth, n.title) for n in nodes][:8],
                         [(0, "Case"), (0, "Domain"), (0, "Shapes"), (1, "inside"), (1, "drum"), (0, "Fluid"),
                          (1, "Fills"), (2, "inside")])
        self.assertIn("wall.body.0.motion", [n.path for n in nodes])
        self.assertFalse([n.path for n in nodes if n.wrong])

    def test_fields_have_units_bounds_defaults_and_choices(self):
        motion = self.fields("wall.body.0.motion")
        self.assertEqual(motion["rate"].texts, ["60 rpm"])
        self.assertEqual(motion["rate"].unit, "rad/s")
        self.assertEqual(motion["axis"].texts, ["0", "1", "0"])
        self.assertEqual(motion["start"].allowed, ">= 0")
        self.assertEqual(motion["start"].default, "0")
        self.assertIn("oscillation", [c["value"] for c in motion["kind"].choices])
        self.assertNotIn("amplitude", motion)  # of another kind
        self.document.set("wall.body.0.motion.kind", '"oscillation"')
        self.assertTrue(self.fields("wall.body.0.motion")["amplitude"].required)
        shape = [c["value"] for c in self.fields("wall.body.0")["shape"].choices]
        self.assertEqual(shape, ["tank", "box", "plane", "inside", "drum"])
        self.assertEqual([c["value"] for c in self.fields("probe.0")["body"].choices], ["drum"])

    def test_every_given_key_of_every_case_has_a_field_that_gives_its_value(self):
        from bedload.gui import forms
        from bedload.gui.document import Document

        for path in CASES:
            document = Document.open(path)
            for node in forms.tree(document):
                values = document.get(node.path, {})
                if isinstance(values, list):
                    continue
                fields = {f.name: f for f in forms.fields(document, node.path)}
                for name, value in values.items():
                    if isinstance(value, dict) or isinstance(value, list) and value and isinstance(value[0], dict):
                        continue
                    with self.subTest(case=str(path.relative_to(ROOT)), key=f"{node.path}.{name}"):
                        source = forms.source(fields[name].path, fields[name].texts)
                        self.assertEqual(tomllib.loads(f"v = {source}")["v"], value)

    def test_the_programs_sentence_stands_beside_the_field(self):
        for path, value, sentence in (
                ("fluid.dx", "-1", "fluid.dx = -1 must be > 0"),
                ("grain.e", '"much"', "must be a number"),
                ("probe.1.direction", '"up"', "must be one of x-, x+, y-, y+, z-, z+"),
                ("wall.body.0.motion.rate", '"60 kg"', "kg is no unit of that kind"),
                ("fluid.colour", '"blue"', "is not a parameter")):
            with self.subTest(key=path):
                self.document.set(path, value)
                table, _, name = path.rpartition(".")
                self.assertIn(sentence, self.fields(table)[name].error)
                self.document.undo()
        self.document.remove("shape.0.radius")
        self.assertIn("must be given", self.fields("shape.0")["radius"].error)
        self.assertEqual([f.name for f in self.fields("shape.1").values() if f.error], [])

    def test_the_tree_shows_where_the_error_is(self):
        from bedload.gui import forms, reading
        from bedload.gui.document import Document

        self.document.set("wall.body.0.motion.rate", '"60 kg"')
        nodes = forms.tree(self.document, reading.read(self.document).problem)
        self.assertEqual([n.path for n in nodes if n.wrong],
                         ["wall", "wall.body", "wall.body.0", "wall.body.0.motion"])
        empty = Document()
        self.assertEqual([n.path for n in forms.tree(empty, reading.read(empty).problem) if n.wrong], [""])

    def test_what_is_typed_becomes_toml(self):
        from bedload.gui import forms

        for path, typed, source in (("fluid.dx", ["1e-3"], "1e-3"), ("fluid.dx", [".5"], "0.5"),
                                    ("fluid.dx", ["2 mm"], '"2 mm"'),
                                    ("domain.min", ["0", "-1 cm", "2."], '[0, "-1 cm", 2.0]'),
                                    ("title", ["1"], '"1"'), ("shape.0.of", ["inside, other"], '["inside", "other"]'),
                                    ("shape.0.of", ['["inside"]'], '["inside"]'), ("grain.settle", ["true"], "true"),
                                    ("domain.periodic", ["true, false, false"], "[true, false, false]"),
                                    ("probe.0.size", ["0.1, 0.2"], "[0.1, 0.2]")):
            self.assertEqual(forms.source(path, typed), source, (path, typed))

    def test_everything_can_be_added(self):
        from bedload import keys
        from bedload.gui import forms
        from bedload.gui.document import Document, bare

        document, waiting, added = Document(), [""], set()
        while waiting:
            path = waiting.pop()
            for one in forms.additions(document, path):
                if bare(one.path) in added:
                    continue
                added.add(bare(one.path))
                values = forms.suggested_name(document, one.path) if one.is_list else {}
                waiting.append(document.add(one.path, values, item=one.is_list))
        tables = {bare(path.replace("[]", "")).rpartition(".")[0] for path in keys()} - {""}
        self.assertLessEqual(tables, added)


@needs_gui
class Moving(unittest.TestCase):
    def move(self, text, path, shift):
        from bedload.gui import moving
        from bedload.gui.document import Document

        document = Document(text)
        moving.move(document, path, np.array(shift), 0.001)
        if document.can_undo:
            document.undo()
            self.assertEqual(document.text, text)
            document.redo()
        return document

    def test_moves_what_says_where_a_thing_is(self):
        drum = DRUM.read_text()
        for path in ("shape.0", "wall.body.0", "fluid.fill.0", "grain.fill.0"):  # the drum is around the shape "inside"
            moved = self.move(drum, path, [0.01, 0, -0.0023])
            self.assertEqual(moved.get("shape.0.a"), [0.01, -0.0125, -0.002])
            self.assertEqual(moved.get("shape.0.b"), [0.01, 0.0125, -0.002])
        centre = self.move(drum, "wall.body.0.motion", [0, 0.005, 0]).get("wall.body.0.motion.centre")
        self.assertEqual(centre, [0, 0.005, 0])
        self.assertFalse(self.move(drum, "time", [1, 1, 1]).can_undo)
        self.assertFalse(self.move(drum, "probe.1", [1, 1, 1]).can_undo)
        tank = TANK.replace("max = [0.05, 0.1, 0.08]", 'max = ["5 cm", 0.1, 0.08]')
        tank = self.move(tank, "fluid.fill.0", [0.01, 0, 0])
        self.assertEqual(tank.get("fluid.fill.0"), {"min": [0.01, 0, 0], "max": [0.06, 0.1, 0.08]})
        turned = self.move(drum.replace("radius = 0.03", "radius = 0.03\nturn_angle = 30"), "shape.0", [0, 0, 0.01])
        self.assertEqual(turned.get("shape.0.translate"), [0, 0, 0.01])
        self.assertEqual(turned.get("shape.0.a"), [0, -0.0125, 0])


@needs_gui
class Scenes(unittest.TestCase):
    def parts(self, text, place="."):
        from bedload.gui import reading, scene
        from bedload.gui.document import Document

        return {p.path: p for p in scene.parts_of(reading.read(Document(text)).case, place)}

    def test_the_drum(self):
        parts = self.parts(DRUM.read_text())
        self.assertEqual(set(parts), {"domain", "wall.body.0", "wall.body.0.motion", "fluid.fill.0", "grain.fill.0",
                                      "probe.1"})
        self.assertAlmostEqual(parts["grain.fill.0"].mesh.volume, np.pi * 0.03**2 * 0.025, delta=1e-7)
        self.assertAlmostEqual(parts["fluid.fill.0"].mesh.volume, np.pi * 0.03**2 * 0.025 / 2, delta=1e-7)
        np.testing.assert_allclose(parts["domain"].mesh.bounds, [-0.045, 0.045, -0.03, 0.03, -0.045, 0.045])

    def test_every_case_can_be_drawn(self):
        for path in CASES:
            with self.subTest(case=str(path.relative_to(ROOT))):
                parts = self.parts(path.read_text(), path.parent)
                self.assertIn("domain", parts)
                bodies = tomllib.loads(path.read_text()).get("wall", {}).get("body", [])
                for k in range(len(bodies)):
                    self.assertGreater(parts[f"wall.body.{k}"].mesh.n_cells, 0)

    def test_shapes(self):
        from bedload.gui import shapes

        third, half = np.pi / 3, np.pi / 2
        for shape, volume in (({"kind": "box", "min": [0, 0, 0], "max": ["1 m", 2, "50 cm"]}, 1.0),
                              ({"kind": "cylinder", "a": [0, 0, 0], "b": [2, 0, 0], "radius": 0.5}, half),
                              ({"kind": "cone", "a": [0, 0, 0], "b": [0, 0, 1], "radius_a": 1, "radius_b": 0}, third),
                              ({"kind": "capsule", "a": [0, 0, 0], "b": [0, 0, 1], "radius": 1}, 7 * third),
                              ({"kind": "sphere", "centre": [1, 1, 1], "radius": 1, "scale": 0.5}, third / 2),
                              ({"kind": "pipe", "a": [0, 0, 0], "b": [0, 1, 0], "radius": 1, "thickness": 1},
                               3 * np.pi),
                              ({"kind": "box", "min": [0, 0, 0], "max": [1, 1, 1], "copies": {
                                  "count": 3, "along": [2, 0, 0], "angle": 0}}, 3.0)):
            with self.subTest(kind=shape["kind"]):
                mesh = shapes.surface("it", {"it": shape}, Path())
                self.assertAlmostEqual(mesh.triangulate().volume / volume, 1, delta=0.01)
        turned = {"kind": "box", "min": [0, 0, 0], "max": [1, 0.1, 0.1], "turn_angle": 90, "translate": [0, 0, 5]}
        bounds = shapes.surface("it", {"it": turned}, Path()).bounds
        np.testing.assert_allclose(bounds, [-0.1, 0, 0, 1, 5, 5.1], atol=1e-9)

    def test_what_is_not_complete_is_left_out(self):
        self.assertEqual(set(self.parts('[domain]\nmin = [0, 0, 0]\nmax = ["1 m", 1, "x"]\n')), set())
        parts = self.parts('[domain]\nmin = [0, 0, 0]\nmax = ["1 m", 1, 1]\n[[wall.body]]\nname = "a"\n'
                           '[[wall.body]]\nname = "b"\nshape = "box"\nmin = [0, 0, 0]\nmax = ["1 cm", 0.1, 0.1]\n')
        self.assertEqual(set(parts), {"domain", "wall.body.1"})

    def test_motion_between_two_places_of_the_same_points(self):
        from bedload._surfaces import motion_between, rotation
        from bedload.gui.shapes import matrix

        before = np.random.default_rng(1).random((9, 3))
        turn = rotation([1, 2, 3], 0.7)
        motion = matrix(*motion_between(before, before @ turn.T + [1, 2, 3]))
        np.testing.assert_allclose(motion[:3, :3], turn, atol=1e-12)
        np.testing.assert_allclose(motion[:3, 3], [1, 2, 3], atol=1e-12)

    def test_bodies_are_where_their_particles_are(self):
        from bedload.gui.run import Cloud
        from bedload.gui.view import moved_bodies

        case = {"wall": {"body": [{"name": "gate"}, {"name": "tank"}, {"name": "lid"}]}}
        places = np.random.default_rng(2).random((9, 3))
        before = Cloud(places, {"body": np.repeat([0, 1, 2], 3), "id": np.arange(9)})
        there = places + np.repeat([[0, 0, 0.5], [0, 0, 0], [0, 0, 0]], 3, axis=0)
        order = [5, 4, 3, 2, 1, 0]  # sorted anew; the lid has been removed
        now = Cloud(there[order], {name: field[order] for name, field in before.fields.items()})
        moved = moved_bodies(case, before, now)
        self.assertIsNone(moved["wall.body.2"])
        np.testing.assert_allclose(moved["wall.body.0"][:3, 3], [0, 0, 0.5], atol=1e-12)
        np.testing.assert_allclose(moved["wall.body.1"], np.eye(4), atol=1e-12)

    def test_picture_pick_and_film(self):
        from bedload.gui import scene
        from bedload.gui.run import Cloud
        from bedload.gui.view import Look, View, write_film

        parts = list(self.parts(TANK).values())
        view = View((320, 240))
        view.look_from("y", parts)
        view.show(parts)
        empty = view.picture()
        self.assertEqual(empty.shape, (240, 320, 3))
        self.assertEqual(view.pick(2, 2), "")
        self.assertIn(view.pick(160, 110), {"wall.body.0", "fluid.fill.0", "grain.fill.0", "domain"})
        places = np.random.default_rng(1).random((400, 3)) * 0.1
        cloud = Cloud(places, {"pressure": np.arange(400.0)}, {"pressure": "Pa"})
        shown = []
        for look in (Look({"fluid": "plain"}), Look({"fluid": "pressure"}), Look({"fluid": "pressure"}, "x", 0.5)):
            view.show([p for p in parts if "fill" not in p.path], "", {"fluid": cloud}, look, 0.01, 0.5)
            shown.append(view.picture().astype(int))
        for one, other in ((empty, shown[0]), (shown[0], shown[1]), (shown[1], shown[2])):
            self.assertGreater(np.mean(np.abs(one - other).max(axis=2) > 30), 0.005)
        with folder() as place:
            film = Path(place) / "film.mp4"
            self.assertEqual(list(write_film(film, [empty, empty])), [1, 2])
            self.assertGreater(film.stat().st_size, 500)
        self.assertEqual(len(scene.parts_of({})), 0)


@needs_gui
class Runs(unittest.TestCase):
    def test_check(self):
        from bedload.gui.run import Check

        with folder() as place:
            check = Check(write_case(place), Path(place) / "look")
            while not check.poll():
                pass
            self.assertTrue(check.passed, check.text)
            rows = dict(row for row in check.rows() if row[0])
            self.assertEqual(rows["particles"], "fluid 400, walls 3 408, grains 3")
            self.assertLessEqual({"memory", "step", "steps", "run time", "device"}, set(rows))
            self.assertEqual(check.rows()[0][0], "particles")
            self.assertTrue((Path(place) / "look/fluid.vtkhdf").exists())
            wrong = Check(write_case(place, TANK.replace("dx = 0.01", "dx = -0.01")), Path(place) / "look")
            while not wrong.poll():
                pass
            self.assertFalse(wrong.passed)
            self.assertIn("fluid.dx = -0.01 must be > 0", wrong.text)

    def test_pause_look_stop_and_restart(self):
        from bedload import open_run
        from bedload.gui import curves
        from bedload.gui.run import LiveRun, clouds_of_frame

        with folder() as place:
            file, out = write_case(place), Path(place) / "out"
            run = LiveRun(file, out, threads=1)
            self.until(run, lambda: run.progress.state == "running")
            run.pause()
            self.until(run, lambda: run.progress.state == "paused")
            paused = run.progress.step
            run.look()
            self.until(run, lambda: run.seen > 1)
            self.assertEqual(len(run.first_walls.position), 3408)
            self.assertEqual(run.poll().step, paused)
            self.assertEqual(len(run.clouds["fluid"].position), 400)
            self.assertEqual(run.clouds["grains"].units["velocity"], "m/s")
            run.stop()
            self.assertEqual(run.wait(60).state, "stopped")
            self.assertLess(run.progress.time, 0.02)
            self.assertEqual(open_run(out).status, "stopped")
            again = LiveRun(file, out, threads=1)
            self.assertEqual(again.wait(60).state, "failed")
            self.assertIn("already holds a run", again.progress.message)
            rest = LiveRun(file, out, threads=1, restart=True)
            self.assertEqual(rest.wait(60).state, "completed")
            self.assertGreater(rest.progress.step, paused)
            whole = LiveRun(file, Path(place) / "whole", threads=1)
            self.assertEqual(whole.wait(60).state, "completed")
            for name in ("diagnostics.csv", "probes/front.csv"):
                self.assertEqual((out / name).read_bytes(), (Path(place) / "whole" / name).read_bytes())

            frame = clouds_of_frame(open_run(out), -1)
            self.assertEqual(len(frame["fluid"].position), 400)
            tables = curves.tables_of(out)
            self.assertEqual(list(tables), ["probe front", "diagnostics"])
            columns = curves.columns_of(tables["diagnostics"])
            drawn = xml.fromstring(curves.chart(tables["diagnostics"], columns[:2]))
            self.assertEqual(len(drawn.findall("{*}polyline")), 2)
            self.assertEqual(curves.chart(tables["diagnostics"], ["none"]), "")

    def test_a_run_that_fails_says_why(self):
        from bedload.gui.run import LiveRun

        with folder() as place:
            run = LiveRun(write_case(place, TANK.replace("dx = 0.01", "dx = -0.01")), Path(place) / "out")
            self.assertEqual(run.wait(60).state, "failed")
            self.assertIn("fluid.dx = -0.01 must be > 0", run.progress.message)

    def until(self, run, true):
        import time

        end = time.monotonic() + 60
        while not true():
            self.assertFalse(run.poll().ended, run.progress)
            self.assertLess(time.monotonic(), end, run.progress)
            time.sleep(0.01)


def leaves(tree, path=""):
    """Paths of all values of a case that are no tables."""
    members = tree.items() if isinstance(tree, dict) else enumerate(tree)
    for key, value in members:
        below = f"{path}.{key}" if path else str(key)
        if isinstance(value, dict) or isinstance(value, list) and value and isinstance(value[0], dict):
            yield from leaves(value, below)
        else:
            yield below


if __name__ == "__main__":
    unittest.main()
