"""The window in a headless Chromium: a drum of slurry from an empty file to a film, with its run stopped and restarted;
a broken case mended. BEDLOAD_SCREENSHOTS names a folder for pictures of the steps."""

import importlib.util
import os
import shutil
import signal
import subprocess
import sys
import time
import unittest
import urllib.request
from pathlib import Path

import bedload
from bedload import gui
from support import folder

BROWSER = next((path for path in map(shutil.which, ("chromium", "chromium-browser", "google-chrome")) if path), None)
LACKING = gui.missing() + (["playwright"] if importlib.util.find_spec("playwright") is None else [])
WHY_NOT = f"needs {', '.join(LACKING)}" if LACKING else "" if BROWSER else "there is no Chromium"
SECONDS = 60  # for anything to happen

DRUM = """title = "Slurry drum"

[domain]
min = [-0.045, -0.03, -0.045]
max = [0.045, 0.03, 0.045]

[[shape]]
name = "inside"
kind = "cylinder"
a = [0, -0.0125, 0]
b = [0, 0.0125, 0]
radius = "30 mm"

[[shape]]
name = "drum"
kind = "hollow"
of = ["inside"]

[fluid]
dx = "4 mm"
rho0 = 1100

[[fluid.fill]]
shape = "inside"
level = 0

[wall]

[[wall.body]]
name = "drum"
shape = "drum"

[wall.body.motion]
kind = "rotation"
axis = [0, 1, 0]
centre = [0, 0, 0]
rate = "60 rpm"

[grain]
d = "3 mm"
E = 1e6

[[grain.fill]]
shape = "inside"
count = 150

[time]
end = 0.15

[out]
every = 0.01

[[probe]]
name = "shaft"
type = "force"
body = "drum"
"""
BROKEN = """title = "Tank"
[domain]
min = [0, 0, 0]
max = [0.1, 0.1, 0.2]
[fluid]
dx = 0.01     # of water
[[fluid.fill]]
min = [0, 0, 0]
max = [0.05, 0.1, 0.08]
[[wall.body]]
name = "tank"
shape = "tnak"  # a slip of the finger
min = [0, 0, 0]
max = [0.1, 0.1, 0.12]
[time]
end = "20 kg"
[out]
every = 0.005
"""


CORNERS = ((0.02, 0.02, 0.12), (0.08, 0.02, 0.12), (0.05, 0.08, 0.12), (0.05, 0.05, 0.18))
STONE = "solid stone\n" + "".join(
    "facet normal 0 0 0\nouter loop\n" + "".join("vertex %g %g %g\n" % CORNERS[k] for k in side) +
    "endloop\nendfacet\n" for side in ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3))) + "endsolid stone\n"


class Page:
    """The page of a window, by what a person does."""

    def __init__(self, page, place):
        self.page, self.place = page, Path(place)
        self.pictures = os.environ.get("BEDLOAD_SCREENSHOTS")

    def shot(self, name):
        if self.pictures:
            Path(self.pictures).mkdir(parents=True, exist_ok=True)
            time.sleep(1.5)  # until what opens and the picture have settled
            self.page.screenshot(path=f"{self.pictures}/{name}.png")

    def select(self, path):
        self.page.click(f'[id="node {path}"]')
        self.page.wait_for_selector(f'[id="node {path}"].on')

    def add(self, path):
        inside = self.page.locator(f'#form [id="add {path}"]')
        if not inside.count():
            self.page.click("#add")
            self.page.locator(f'.v-list [id="add {path}"]').click()
        else:
            inside.click()
        is_item = path in ("shape", "probe", "fluid.fill", "wall.body", "grain.fill")
        self.page.wait_for_selector(f'.bl-node.on[id^="node {path}{"." if is_item else ""}"]')

    def type(self, path, text):
        self._fill(f'[id="{path}"]', text)

    def vector(self, path, values):
        for axis, value in zip("xyz", values):
            self._fill(f'[id="{path} {axis}"]', str(value))

    def choose(self, path, option):
        self.page.locator(f'[id="field {path}"] .v-field').click()
        self.page.locator(".v-overlay--active .v-list-item-title", has_text=option).first.click()
        self.page.wait_for_selector(".v-overlay--active", state="detached")

    def text(self, selector):
        return self.page.inner_text(selector)

    def until(self, true, what):
        end = time.monotonic() + SECONDS
        while not true():
            if time.monotonic() > end:
                raise AssertionError(f"waited in vain for {what}")
            time.sleep(0.05)

    def _fill(self, selector, text):
        self.page.fill(selector, text)
        self.page.press(selector, "Tab")


@unittest.skipIf(WHY_NOT, f"the window is not tried in a browser: {WHY_NOT}")
class InABrowser(unittest.TestCase):
    def setUp(self):
        from playwright.sync_api import sync_playwright

        self.place = Path(self.enterContext(folder()))
        chromium = self.enterContext(sync_playwright()).chromium
        self.browser = chromium.launch(executable_path=BROWSER, args=["--no-sandbox", "--disable-gpu"])
        self.addCleanup(self.browser.close)

    def window(self, *arguments):
        """The page of a new window in the test's folder."""
        command = [sys.executable, "-m", "bedload", "gui", *arguments, "--port", "0", "--no-browser"]
        shown = subprocess.Popen(command, cwd=self.place, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.shown = shown
        self.addCleanup(self.close, shown)
        line = next((line for line in shown.stdout if line.startswith("window")), "")
        self.assertRegex(line, r"^window +http://127\.0\.0\.1:\d+/index\.html\?secret=\S{20,}$")
        self.address = line.split()[1]
        page = self.browser.new_page(viewport={"width": 1500, "height": 900})
        page.set_default_timeout(1000 * SECONDS)
        self.faults, self.asked = [], set()
        page.on("request", lambda request: self.asked.add(request.url.partition("//")[2].partition("/")[0]))
        page.on("pageerror", lambda error: self.faults.append(str(error)))
        page.goto(self.address)
        page.wait_for_selector(".bl-node")
        return Page(page, self.place)

    def close(self, shown):
        shown.send_signal(signal.SIGINT)
        try:
            shown.wait(30)
        except subprocess.TimeoutExpired:
            shown.kill()
        shown.stdout.close()
        self.assertEqual(self.faults, [])

    def test_a_drum_from_an_empty_file_to_a_film(self):
        page = self.window()
        self.assertIn("domain.min must be given", page.text("#problem"))
        page.shot("1_empty")
        self.all_keys(page, "title", "Slurry drum")
        page.add("domain")
        page.vector("domain.min", (-0.045, -0.03, -0.045))
        page.vector("domain.max", (0.045, 0.03, 0.045))
        page.add("shape")
        page.type("shape.0.name", "inside")
        page.choose("shape.0.kind", "cylinder")
        page.vector("shape.0.a", (0, -0.0125, 0))
        page.vector("shape.0.b", (0, 0.0125, 0))
        page.type("shape.0.radius", "30 mm")
        page.shot("2_shape")
        page.add("shape")
        page.type("shape.1.name", "drum")
        page.choose("shape.1.kind", "hollow")
        page.type("shape.1.of", "inside")
        page.add("fluid")
        page.type("fluid.dx", "4 mm")
        self.all_keys(page, "fluid.rho0", "1100")
        page.add("fluid.fill")
        page.choose("fluid.fill.0.shape", "inside")
        page.type("fluid.fill.0.level", "0")
        page.add("wall")
        page.add("wall.body")
        page.type("wall.body.0.name", "drum")
        page.choose("wall.body.0.shape", "drum")
        page.add("wall.body.0.motion")
        page.choose("wall.body.0.motion.kind", "rotation")
        page.vector("wall.body.0.motion.axis", (0, 1, 0))
        page.vector("wall.body.0.motion.centre", (0, 0, 0))
        page.type("wall.body.0.motion.rate", "60 rpm")
        page.shot("3_motion")
        page.add("grain")
        page.type("grain.d", "3 mm")
        page.type("grain.E", "1e6")
        page.add("grain.fill")
        page.choose("grain.fill.0.shape", "inside")
        page.type("grain.fill.0.count", "150")
        page.add("time")
        page.type("time.end", "0.15")
        page.add("out")
        page.type("out.every", "0.01")
        page.add("probe")
        page.type("probe.0.name", "shaft")
        page.choose("probe.0.type", "force")
        page.choose("probe.0.body", "drum")
        page.page.click("#check")
        page.page.wait_for_selector("#check_panel .bl-rows")
        self.assertRegex(page.text("#check_panel"), r"particles\s+fluid [\d ]+, walls [\d ]+, grains 150")
        page.shot("4_check")

        page.page.click("#run")
        page.page.fill("#file_name", "drum.toml")
        page.page.click("#save_here")
        page.until(lambda: (self.place / "drum.toml").exists(), "the file")
        self.assertEqual((self.place / "drum.toml").read_text(), DRUM)
        page.until(lambda: page.text("#run_words").startswith("t = "), "the run")
        page.page.click("#pause")
        page.until(lambda: page.text("#run_words").startswith("paused"), "the pause")
        page.shot("5_paused")
        page.page.click("#stop")
        page.page.wait_for_selector("#next_frame")
        self.assertEqual(bedload.open_run(self.place / "results/drum").status, "stopped")
        page.page.click("#run")
        page.page.click("#restart")
        page.until(lambda: bedload.open_run(self.place / "results/drum").status == "completed", "the end")
        page.until(lambda: "frame 16 of 16" in page.page.inner_text(".bl-right"), "the results")
        page.page.locator(".v-select:has(#colour_fluid) .v-field").click()
        page.page.locator(".v-overlay--active .v-list-item-title", has_text="velocity").first.click()
        page.page.locator(".v-select:has(#cut) .v-field").click()
        page.page.locator(".v-overlay--active .v-list-item-title", has_text="y").first.click()
        page.page.click("#picture")
        page.until(lambda: list(self.place.glob("results/drum/picture_001.png")), "the picture")
        page.shot("6_results")
        page.page.click("#film")
        film = self.place / "results/drum/film.mp4"
        page.until(lambda: "film.mp4" in page.text(".v-snackbar"), "the film")
        self.assertGreater(film.stat().st_size, 5000)
        if page.pictures:
            shutil.copy(film, page.pictures)

    def all_keys(self, page, path, text):
        if not page.page.is_visible(f'[id="{path}"]'):
            page.page.click("#all_keys")
        page.type(path, text)

    def test_a_broken_case_is_mended(self):
        (self.place / "tank.toml").write_text(BROKEN)
        page = self.window("tank.toml")
        page.page.click("#problem")
        page.page.wait_for_selector('[id="field time.end"] .bl-error')
        self.assertIn("kg is no unit of that kind", page.text('[id="field time.end"] .bl-error'))
        self.assertEqual(page.page.locator(".bl-node.wrong").all_inner_texts(), ["Time"])
        page.shot("7_broken")
        page.type("time.end", "20 ms")
        page.until(lambda: "tnak" in page.text("#check_panel"), "the next error")
        page.page.click("#problem")
        page.page.wait_for_selector('[id="field wall.body.0.shape"] .bl-error')
        page.choose("wall.body.0.shape", "tank")
        page.until(lambda: not page.page.locator(".bl-node.wrong").count(), "the case without errors")
        page.page.click("#undo")
        page.until(lambda: page.page.locator(".bl-node.wrong").count(), "the error again")
        page.page.click("#redo")
        page.until(lambda: not page.page.locator(".bl-node.wrong").count(), "the case without errors again")
        page.page.click("#save")
        mended = BROKEN.replace('"tnak"', '"tank"').replace('"20 kg"', '"20 ms"')
        page.until(lambda: (self.place / "tank.toml").read_text() == mended, "the file")
        page.page.click("#tab_text")
        page.page.fill("#text", "[domain\n")
        page.page.click("#tab_check")
        page.until(lambda: "is not TOML" in page.text("#problem"), "the error of the text")

    def test_things_are_moved_by_hand_and_a_run_ends_with_the_window(self):
        (self.place / "tank.toml").write_text(BROKEN.replace('"tnak"', '"tank"').replace('"20 kg"', '"20 s"'))
        page = self.window("tank.toml")
        page.page.click("#look_y")
        time.sleep(1)
        box = page.page.locator(".bl-view").bounding_box()
        x, y = box["x"] + 0.42 * box["width"], box["y"] + 0.62 * box["height"]
        page.page.mouse.click(x, y)
        page.page.wait_for_selector('[id="node fluid.fill.0"].on')
        page.page.keyboard.down("Shift")
        page.page.mouse.move(x, y)
        page.page.mouse.down()
        page.page.mouse.move(x + 20, y, steps=4)
        page.page.mouse.move(x + 40, y, steps=4)
        page.page.mouse.up()
        page.page.keyboard.up("Shift")
        page.until(lambda: "*" in page.text("#file"), "the move")
        page.page.click("#save")
        fill = lambda: bedload.Case(self.place / "tank.toml").fluid.fill[0]
        page.until(lambda: fill().min[0] > 0, "the file")
        self.assertAlmostEqual(fill().max[0] - fill().min[0], 0.05)
        self.assertEqual((fill().min[1:], fill().max[1:]), ([0, 0], [0.1, 0.08]))
        page.select("")
        stone = self.place / "elsewhere" / "stone.stl"
        stone.parent.mkdir()
        stone.write_text(STONE)
        page.page.set_input_files("#mesh", stone)
        page.page.wait_for_selector('[id="node shape.0"].on')
        self.assertEqual((self.place / "stone.stl").read_text(), STONE)
        self.assertEqual(page.page.input_value('[id="shape.0.file"]'), "stone.stl")
        page.shot("8_mesh")
        page.page.click("#run")
        page.until(lambda: page.text("#run_words").startswith("t = "), "the run")
        self.shown.send_signal(signal.SIGINT)
        self.shown.wait(SECONDS)
        self.assertEqual(bedload.open_run(self.place / "results/tank").status, "stopped")
        self.assertTrue(list((self.place / "results/tank/checkpoints").glob("*.h5")))
        self.assertEqual(list(self.place.glob(".*")), [])

    def test_asks_no_other_server_and_lets_nobody_in_without_the_token(self):
        page = self.window()
        self.assertIn("Case", page.text(".bl-page"))
        self.assertEqual({place.partition(":")[0] for place in self.asked}, {"127.0.0.1"})  # nothing from elsewhere
        other = self.browser.new_page()
        other.goto(self.address.partition("?")[0] + "?secret=guessed")
        time.sleep(3)
        self.assertEqual(other.locator(".bl-node").count(), 0)
        with urllib.request.urlopen(self.address.partition("?")[0]) as answer:
            self.assertNotIn("bl-node", answer.read().decode())


if __name__ == "__main__":
    unittest.main()
