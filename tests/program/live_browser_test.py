#!/usr/bin/env python3
"""The page of a live view in a headless Chromium: progress, curves and a picture while a run goes on, and how it ended.

Usage: live_browser_test.py PROGRAM [--screenshot FILE [CASE]]. Ends with 77 where there is no Chromium."""

import contextlib
import http.server
import itertools
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import urllib.request
from html.parser import HTMLParser
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CASE = """title = "Wave in a tank"
[domain]
min = [0, 0, 0]
max = [0.1, 0.06, 0.2]
[fluid]
dx = 0.01
[[fluid.fill]]
min = [0, 0, 0]
max = [0.05, 0.06, 0.05]
[[wall.body]]
name = "tank"
shape = "tank"
min = [0, 0, 0]
max = [0.1, 0.06, 0.2]
faces = ["x-", "x+", "y-", "y+", "z-"]
[[probe]]
name = "front"
type = "front"
[[probe]]
name = "wall"
type = "force"
body = "tank"
[time]
end = 1000
[out]
every = 0.01
"""
BROWSER = next((path for path in map(shutil.which, ("chromium", "chromium-browser", "google-chrome")) if path), None)


class Run:
    """A case that runs with a live view, in a folder of its own."""

    def __init__(self, folder, case=None):
        self.folder = Path(folder)
        if not case:
            case = self.folder / "case.toml"
            case.write_text(CASE)
        environment = {**os.environ, "OMP_NUM_THREADS": "1", "XDG_CACHE_HOME": str(self.folder / "cache")}
        self.process = subprocess.Popen(
            [PROGRAM, "run", case, "--backend", "cpu", "--live", "0", "--out", self.folder / "out"],
            stdout=subprocess.PIPE, text=True, env=environment)
        self.address = re.fullmatch(r"live +(http://127\.0\.0\.1:\d+)\n", self.process.stdout.readline())[1]

    def wait_for(self, good, seconds=120):
        """Asks for the status until it is as it should be."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            with urllib.request.urlopen(f"{self.address}/status") as answer:
                status = json.load(answer)
            if good(status):
                return status
            time.sleep(0.1)
        raise AssertionError(f"did not come about: {status}")

    def stop(self):
        self.process.send_signal(signal.SIGINT)

    def close(self):
        self.process.kill()
        self.process.communicate()


@contextlib.contextmanager
def tunnel_that_stops(run, after):
    """The address of another port that leads to the run, as a tunnel of ssh does. It stops the run when it is asked for
    the status the nth time."""
    asked = itertools.count(1)

    class Handler(http.server.BaseHTTPRequestHandler):
        def do_GET(self):
            if self.path == "/status" and next(asked) == after:
                run.stop()
                run.wait_for(lambda s: s["state"] == "stopped")
            try:
                request = urllib.request.Request(run.address + self.path, headers={"Host": self.headers["Host"]})
                with urllib.request.urlopen(request) as answer:
                    self.send_response(answer.status)
                    self.send_header("Content-Type", answer.headers["Content-Type"])
                    self.end_headers()
                    self.wfile.write(answer.read())
            except OSError:  # none answers there, or the browser has gone
                self.close_connection = True

        def log_message(self, *_):
            pass

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    try:
        yield f"http://localhost:{server.server_port}"
    finally:
        server.shutdown()
        server.server_close()


def browse(address, folder, *options, seconds):
    """Chromium's output for a page that was looked at for so long, in the page's own time."""
    command = [BROWSER, "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
               f"--user-data-dir={folder}/browser", f"--virtual-time-budget={1000 * seconds}", *options, address]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
                            env={**os.environ, "HOME": str(folder)})


class Page(HTMLParser):
    """What a page shows: texts by the id of their element, pictures, points of curves."""

    def __init__(self, dom):
        super().__init__()
        self.texts, self.attributes, self.points, self.labels = {}, {}, {}, {}
        self.open, self.figure = [], ""
        self.feed(dom)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        if tag not in ("meta", "link", "img", "input", "br"):
            self.open.append(attributes.get("id"))
        if "id" in attributes:
            self.attributes[attributes["id"]] = attributes
        if "data-points" in attributes:
            self.points[attributes["aria-label"].split(":")[0]] = int(attributes["data-points"])

    def handle_endtag(self, tag):
        if self.open:
            self.open.pop()

    def handle_data(self, data):
        for name in filter(None, self.open):
            self.texts[name] = self.texts.get(name, "") + data


class LiveView(unittest.TestCase):
    def setUp(self):
        self.folder = self.enterContext(tempfile.TemporaryDirectory(prefix="bedload_live_"))
        self.run_ = Run(self.folder)
        self.addCleanup(self.run_.close)
        self.run_.wait_for(lambda s: s["time"]["value"] > 0.1 and s["picture"]["serial"] > 0)

    def test_shows_a_run_that_goes_on(self):
        before = self.run_.wait_for(lambda s: True)
        dom = browse(self.run_.address, self.folder, "--dump-dom", seconds=20).communicate(timeout=120)[0]
        after = self.run_.wait_for(lambda s: True)
        page = Page(dom)
        self.assertEqual(page.texts["title"], "Wave in a tank")
        self.assertEqual(page.texts["state"], "running")
        self.assertEqual(page.texts.get("note", ""), "")
        numbers = page.texts["numbers"]
        shown = float(re.search(r"Time([0-9.e-]+) of 1000 s", numbers)[1])
        self.assertLessEqual(0.999 * before["time"]["value"], shown)
        self.assertLessEqual(shown, 1.001 * after["time"]["value"])
        for what in (r"Remaining\d+ (s|min|h)", r"Step rate[\d.]+ steps/s", r"Time step[\d.e-]+ s",
                     r"\d fluid, [\d\u202f]+ walls"):
            self.assertRegex(numbers, what)
        self.assertEqual(float(page.attributes["bar"]["aria-valuenow"]), round(0.1 * shown, 1))
        self.assertGreater(len(page.points), 8, "columns of both probes")
        for name, points in page.points.items():
            self.assertGreater(points, 1, name)
        self.assertIn("Probe wall", page.texts["tables"])
        picture = page.attributes["picture"]
        self.assertNotIn("hidden", picture)
        self.assertGreater(int(picture["width"]), 100, "its natural size, set once it is decoded")
        self.assertGreater(int(picture["height"]), 100)
        self.assertRegex(page.texts["moment"], r"at t = [\d.e-]+ s")
        self.assertRegex(page.texts["scales"], r"Fluid: speed 0[\d.e-]+ m/s or more")

    def test_tells_how_a_run_ended(self):
        with tunnel_that_stops(self.run_, after=3) as address:
            dom = browse(address, self.folder, "--dump-dom", seconds=30).communicate(timeout=120)[0]
        self.assertEqual(self.run_.process.wait(timeout=60), 130)
        page = Page(dom)
        self.assertEqual(page.texts["state"], "stopped")
        note = r"The run was stopped at t = ([\d.e-]+) s, after \d+ s\. +This page shows"
        self.assertRegex(page.texts["note"], note)
        told = float(re.search(r"stopped at t = (\S+) s", self.run_.process.stdout.read())[1])
        self.assertAlmostEqual(float(re.match(note, page.texts["note"])[1]), told, delta=1e-4 * told)
        self.assertGreater(int(page.attributes["picture"]["width"]), 100, "the last state stays")
        self.assertGreater(max(page.points.values()), 1)


def screenshot(file, case=None):
    with tempfile.TemporaryDirectory() as folder:
        run = Run(folder, case)
        try:
            run.wait_for(lambda s: s["fraction"] > 0.22 and s["picture"]["serial"] > 0, seconds=3600)
            browse(run.address, folder, f"--screenshot={file}", "--window-size=1280,860", "--hide-scrollbars",
                   seconds=3).wait(timeout=120)
        finally:
            run.close()


if __name__ == "__main__":
    PROGRAM = Path(sys.argv.pop(1)).resolve()
    if not BROWSER:
        print("there is no Chromium; tools/install_dependencies --browser installs it")
        sys.exit(77)
    if sys.argv[1:2] == ["--screenshot"]:
        screenshot(*sys.argv[2:])
    else:
        unittest.main()
