#!/usr/bin/env python3
"""A picture of millions of particles, drawn as spheres by NumPy alone: no display, no graphics card, no VTK.

    python3 tools/splat.py RESULTS [--out x.png]        the last frame; --frame N or --time T another

Ten million take some 10 s of one core and 3 GB. Fluid is coloured by speed and smoothed to a surface, grains are
spheres in shades of sand (--grain-colour speed: by speed), walls are the wall particles of the bodies named in --walls.
Needs h5py, numpy, Pillow and matplotlib. For fewer particles, glass walls and films: tools/render.
"""

import argparse
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib import font_manager
from matplotlib.colors import LinearSegmentedColormap
from PIL import Image, ImageDraw, ImageFont

from frames import Frames, resolved_case
from runs import finish

DEEP = LinearSegmentedColormap.from_list("deep", ["#17518f", "#2a83c9", "#62b5e6", "#aee0f4", "#f4fbfc"])
SAND, WALL = np.array([0.85, 0.66, 0.42]), np.array([0.70, 0.68, 0.65])
ANGLE = 25  # of view, degrees
FINE = 2  # pixels drawn for each pixel of the picture, along an edge
CHUNK = 2_000_000  # particles projected at once
LIGHT = np.array([-0.42, 0.55, 0.72])  # to the right, up, to the camera
FLUID, GRAIN, BODY = range(3)


class Camera:
    """Perspective from azimuth (degrees to the right of the front, -y) and elevation; takes in all of the bounds."""

    def __init__(self, low, high, turn, size):
        azimuth, elevation = np.radians(turn[:2])
        self.back = np.array([np.sin(azimuth) * np.cos(elevation), -np.cos(azimuth) * np.cos(elevation),
                              np.sin(elevation)])
        self.right = np.array([np.cos(azimuth), np.sin(azimuth), 0])
        self.up = np.cross(self.back, self.right)
        corners = np.array(np.meshgrid(*np.transpose([low, high]))).reshape(3, -1).T - (low + high) / 2
        half, ratio = np.tan(np.radians(ANGLE / 2)), size[0] / size[1]
        wide = np.maximum(np.abs(corners @ self.right) / (0.96 * ratio), np.abs(corners @ self.up) / 0.84)
        away = np.max(wide / half + corners @ self.back) / (turn[2] if len(turn) > 2 else 1)
        self.place, self.away = (low + high) / 2 + away * self.back, away + float(np.linalg.norm(high - low))
        self.size, self.focus = size, size[1] / 2 / half  # pixels

    def project(self, x):
        """Columns, rows (pixels) and depth (m) of places [n, 3]."""
        x = x - self.place
        depth = -(x @ self.back)
        with np.errstate(divide="ignore", invalid="ignore"):
            return (self.size[0] / 2 + self.focus * (x @ self.right) / depth,
                    self.size[1] / 2 - self.focus * (x @ self.up) / depth, depth)


class Canvas:
    """What is nearest in each pixel: depth, and the number of the particle among all that were drawn."""

    def __init__(self, camera):
        self.camera = camera
        self.nearest = np.zeros(camera.size[0] * camera.size[1], np.uint64)  # (2^32 - depth) 2^32 + number
        self.parts = []  # (kind, columns, rows, depths, radii, values, own numbers) of what was drawn
        self.count = 0
        self.far = 3 * camera.away  # m: nothing beyond is drawn

    def draw(self, kind, places, radii, values):
        parts = [self.camera.project(places[begin:begin + CHUNK]) for begin in range(0, len(places), CHUNK)]
        column, row, depth = (np.concatenate(part).astype(np.float32) for part in zip(*parts))
        radius = np.broadcast_to(np.asarray(radii, np.float32), depth.shape)
        pixels = np.where(depth > 0, self.camera.focus * radius / depth, 0)
        seen = self.seen(column, row, depth, radius, pixels)
        column, row, depth, radius, pixels = (a[seen] for a in (column, row, depth, radius, pixels))
        number = self.count + np.arange(len(seen), dtype=np.uint64)
        octave = np.ceil(np.log2(np.maximum(pixels, 0.5))).astype(int)
        for power in np.unique(octave):
            some = np.flatnonzero(octave == power)
            self.splat(column[some], row[some], depth[some], radius[some], pixels[some], number[some],
                       int(np.ceil(2.0**power)))
        self.parts.append([np.full(len(seen), kind, np.int8), column, row, depth, radius, values[seen], seen])
        self.count += len(seen)

    def seen(self, column, row, depth, radius, pixels):
        """Which of the spheres may be seen: those in the picture but for what lies more than two diameters behind the
        nearest in each of the nine tiles, as wide as a sphere, about its own."""
        width, height = self.camera.size
        inside = np.flatnonzero((depth > 0) & (column > -pixels) & (column < width + pixels) & (row > -pixels) &
                                (row < height + pixels))
        if not len(inside):
            return inside
        tile = max(4.0, 2 * float(np.median(pixels[inside])))
        tiles = int(height / tile) + 3, int(width / tile) + 3
        i = np.clip(column[inside] / tile + 1, 0, tiles[1] - 1).astype(int)
        j = np.clip(row[inside] / tile + 1, 0, tiles[0] - 1).astype(int)
        nearest = np.full(tiles, np.inf, np.float32)
        np.minimum.at(nearest, (j, i), depth[inside])
        near = [shifted(nearest, down, across, np.inf) for down in (-1, 0, 1) for across in (-1, 0, 1)]
        behind = np.max(near, axis=0)
        return inside[depth[inside] < behind[j, i] + 4 * radius[inside]]

    def splat(self, column, row, depth, radius, pixels, number, reach):
        width, height = self.camera.size
        left, top = np.floor(column).astype(int), np.floor(row).astype(int)
        for down in range(-reach, reach + 1):
            for across in range(-reach, reach + 1):
                i, j = left + across, top + down
                off = ((i + 0.5 - column) ** 2 + (j + 0.5 - row) ** 2) / np.maximum(pixels, 0.75) ** 2
                hit = np.flatnonzero((off < 1) & (i >= 0) & (i < width) & (j >= 0) & (j < height))
                if not len(hit):
                    continue
                front = depth[hit] - radius[hit] * np.sqrt(1 - off[hit])
                near = np.clip(front * (2**32 / self.far), 0, 2**32 - 2).astype(np.uint64)
                np.maximum.at(self.nearest, j[hit] * width + i[hit],
                              ((np.uint64(2**32 - 1) - near) << np.uint64(32)) | number[hit])

    def resolve(self):
        """Of pixels, each [height, width]: depth (m; inf: nothing), and kind, column, row, depth of the centre, radius
        (m), value and number of the particle."""
        shape = self.camera.size[::-1]
        drawn = self.nearest > 0
        depth = (2**32 - 1 - (self.nearest >> np.uint64(32)).astype(float)) * (self.far / 2**32)
        number = (self.nearest & np.uint64(2**32 - 1)).astype(np.int64)[drawn]
        found = [np.where(drawn, depth, np.inf).reshape(shape)]
        for k, nothing in enumerate((-1, 0, 0, 0, 0, 0, 0)):
            values = np.full(drawn.shape, nothing, float)
            values[drawn] = np.concatenate([part[k] for part in self.parts])[number]
            found.append(values.reshape(shape))
        return found


def shifted(a, down, across, beyond):
    """The array moved so that each element stands where its neighbour did; `beyond` comes in from outside."""
    out = np.full_like(a, beyond)
    h, w = a.shape
    out[max(0, -down):h - max(0, down), max(0, -across):w - max(0, across)] = \
        a[max(0, down):h + min(0, down), max(0, across):w + min(0, across)]
    return out


def smoothed(depth, mask, reach, step):
    """Depth within the mask, averaged over what lies within `reach` pixels and is no farther than `step` (m) off."""
    for axis in (0, 1, 0, 1):
        total, weight = np.zeros_like(depth), np.zeros_like(depth)
        base = np.where(mask, depth, 0)
        for k in range(-reach, reach + 1):
            move = (k, 0) if axis == 0 else (0, k)
            other, there = shifted(base, *move, 0), shifted(mask, *move, False)
            w = there * np.exp(-2 * (k / (reach + 0.5)) ** 2) * (np.abs(other - base) < step)
            total += w * other
            weight += w
        depth = np.where(mask & (weight > 0), total / np.maximum(weight, 1e-30), depth)
    return depth


def normals(depth, camera, step):
    """Of the surface that the depths are, towards the camera: [height, width, 3], right, up, back. Where depth jumps
    by more than `step` the side that goes on is taken."""
    found = []
    for move in ((0, 1), (1, 0)):
        with np.errstate(invalid="ignore"):
            ahead = shifted(depth, *move, np.inf) - depth
            behind = depth - shifted(depth, -move[0], -move[1], np.inf)
            slope = np.where(np.abs(ahead) < np.abs(behind), ahead, behind)
            both = (np.abs(ahead) < step) & (np.abs(behind) < step)
            slope = np.where(both, (ahead + behind) / 2, slope)
        found.append(np.where(np.abs(slope) < 4 * step, slope, 0))
    with np.errstate(invalid="ignore"):
        n = np.stack([found[0], -found[1], np.where(np.isfinite(depth), depth, 1) / camera.focus], axis=-1)
    return n / np.linalg.norm(n, axis=-1, keepdims=True)


def shadow(depth, unit):
    """Less light where what is about a pixel lies before it: a factor, 1 in the open."""
    dark = np.zeros_like(depth)
    for reach in (2, 5, 12, 28):
        for turn in np.arange(8) * np.pi / 4:
            other = shifted(depth, round(reach * np.sin(turn)), round(reach * np.cos(turn)), np.inf)
            with np.errstate(invalid="ignore"):
                ahead = np.nan_to_num(depth - other, nan=0, posinf=0, neginf=0)
            dark += np.clip(ahead / (unit * reach) - 0.3, 0, 1) / 32
    return np.exp(-2.2 * dark)


def draw(canvas, limits, grain_colour):
    """The picture, [height, width, 3] of 0 to 1."""
    camera = canvas.camera
    depth, kind, column, row, centre, radius, value, number = canvas.resolve()
    out = np.ones((*depth.shape, 3))
    drawn = kind >= 0
    if not drawn.any():
        raise SystemExit("nothing to draw")
    pixel = np.median(depth[drawn]) / camera.focus  # m
    light = LIGHT / np.linalg.norm(LIGHT)
    low, high = limits
    shade = shadow(depth, pixel)
    for this in (FLUID, GRAIN, BODY):
        mask = kind == this
        if not mask.any():
            continue
        size = float(np.median(radius[mask]))
        if this == GRAIN:
            across = (np.arange(depth.shape[1]) + 0.5 - column)[mask]
            up = (row - np.arange(depth.shape[0])[:, None] - 0.5)[mask]
            pixels = np.maximum(camera.focus * radius[mask] / centre[mask], 0.75)
            n = np.stack([across / pixels, up / pixels], axis=-1)
            n = np.concatenate([n, np.sqrt(np.maximum(0.05, 1 - (n**2).sum(-1)))[:, None]], axis=1)
        else:
            reach = max(2, round(3 * size / pixel))
            smooth = smoothed(depth, mask, min(reach, 16), 6 * size)
            n = normals(np.where(mask, smooth, np.inf), camera, 4 * size)[mask]
        share = np.clip((value[mask] - low) / (high - low), 0, 1)
        if this == FLUID:
            colour = DEEP(share)[:, :3]
        elif this == GRAIN and grain_colour == "speed":
            colour = matplotlib.colormaps["plasma"](share)[:, :3]
        elif this == GRAIN:
            own = (number[mask] * 2654435 % 1000) / 1000  # each its own shade
            colour = SAND * (0.78 + 0.4 * own)[:, None]
        else:
            colour = np.broadcast_to(WALL, (mask.sum(), 3))
        direct = np.clip(n @ light, 0, 1)
        gleam = np.clip(n @ ((light + [0, 0, 1]) / np.linalg.norm(light + [0, 0, 1])), 0, 1) ** 40
        bright = (0.55 + 0.65 * direct) * shade[mask]
        out[mask] = np.clip(colour * bright[:, None] + (0.25 * gleam if this == FLUID else 0.05 * gleam)[:, None], 0, 1)
    h, w = out.shape[0] // FINE, out.shape[1] // FINE
    return out[:h * FINE, :w * FINE].reshape(h, FINE, w, FINE, 3).mean(axis=(1, 3))


def label(picture, text, limits, coloured):
    """The picture as an image, with words and a bar of colours."""
    image = Image.fromarray((255 * picture + 0.5).astype(np.uint8))
    pen = ImageDraw.Draw(image)
    scale = image.height / 900
    font = ImageFont.truetype(font_manager.findfont("DejaVu Sans"), round(20 * scale))
    pen.text((20 * scale, 14 * scale), text, font=font, fill=(40, 45, 50))
    if coloured:
        left, top, wide, high = (round(v * scale) for v in (image.width / scale - 400, 20, 260, 14))
        for k in range(wide):
            pen.line([left + k, top, left + k, top + high], fill=tuple(int(255 * c) for c in DEEP(k / wide)[:3]))
        pen.text((left - 24 * scale, top - 5 * scale), f"{limits[0]:g}", font=font, fill=(40, 45, 50))
        pen.text((left + wide + 8 * scale, top - 5 * scale), f"{limits[1]:.3g} m/s", font=font, fill=(40, 45, 50))
    return image


def bodies(folder, case, names, time):
    """Places of the wall particles of the bodies named, or of all."""
    path = Path(folder) / "walls.vtkhdf"
    if names == ["none"] or not path.exists():
        return np.zeros((0, 3))
    walls = Frames(path)
    frame = walls.nearest(time)
    known = [body["name"] for body in case["wall"]["body"]]
    if unknown := set(names) - set(known) - {"all"}:
        raise SystemExit(f"--walls: no wall.body '{min(unknown)}', only {', '.join(known)}")
    wanted = [k for k, name in enumerate(known) if name in names or names == ["all"]]
    return walls.position(frame)[np.isin(walls.read(frame, "body"), wanted)]


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="splat", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results")
    parser.add_argument("--out", type=Path, help=".png or .jpg; default RESULTS/splat.png")
    which = parser.add_mutually_exclusive_group()
    which.add_argument("--frame", type=int, default=-1)
    which.add_argument("--time", type=float, help="s; the nearest frame")
    parser.add_argument("--camera", default="-28,20", help="azimuth,elevation[,zoom], degrees; default -28,20")
    parser.add_argument("--bounds", help="x0,x1,y0,y1,z0,z1 (m), what the camera takes in; default: the flow")
    parser.add_argument("--range", help="LOW,HIGH of the colours, m/s; default: fits")
    parser.add_argument("--grain-colour", choices=["none", "speed"], default="none")
    parser.add_argument("--walls", default="all", help="names of wall bodies with commas, all or none; default all")
    parser.add_argument("--size", default="1600,900", help="pixels, default 1600,900")
    options = parser.parse_args(arguments)

    def numbers(text, *counts):
        try:
            found = [float(word) for word in text.split(",")]
        except ValueError:
            found = []
        if len(found) not in counts:
            parser.error(f"'{text}' must be {' or '.join(map(str, counts))} numbers with commas between them")
        return found

    folder, case = Path(options.results), resolved_case(options.results)
    stores = {name: Frames(folder / f"{name}.vtkhdf") for name in ("fluid", "grains")
              if (folder / f"{name}.vtkhdf").exists()}
    if not stores:
        raise SystemExit(f"{folder}: has neither fluid.vtkhdf nor grains.vtkhdf")
    times = next(iter(stores.values())).times
    frame = int(np.argmin(np.abs(times - options.time))) if options.time is not None else \
        range(len(times))[options.frame]
    places = {name: store.read(frame, "position") for name, store in stores.items()}
    by_speed = [name for name in stores if name == "fluid" or options.grain_colour == "speed"]
    speeds = {name: np.linalg.norm(stores[name].read(frame, "velocity"), axis=1) for name in by_speed}
    wall = bodies(folder, case, options.walls.split(","), times[frame])

    flow = np.concatenate(list(places.values()))
    low, high = (np.percentile(flow, q, axis=0) for q in (0.01, 99.99))
    if options.bounds:
        box = np.reshape(numbers(options.bounds, 6), (3, 2))
        low, high = box[:, 0], box[:, 1]
    size = [int(n) * FINE for n in numbers(options.size, 2)]
    limits = numbers(options.range, 2) if options.range else \
        [0, float(f"{max([np.percentile(v, 99.5) for v in speeds.values()], default=0):.2g}") or 1.0]
    camera = Camera(low, high, numbers(options.camera, 2, 3), size)
    canvas = Canvas(camera)
    dx = case.get("fluid", {}).get("dx", 0)
    if "fluid" in places:
        canvas.draw(FLUID, places["fluid"], 0.65 * dx, speeds["fluid"])
    if "grains" in places:
        radius = stores["grains"].get(frame, "radius")
        canvas.draw(GRAIN, places["grains"], case["grain"]["d"] / 2 if radius is None else radius,
                    speeds.get("grains", np.zeros(len(places["grains"]))))
    if len(wall):
        canvas.draw(BODY, wall, 0.65 * case["wall"].get("dx", dx), np.zeros(len(wall)))
    picture = draw(canvas, limits, options.grain_colour)
    words = [f"t = {times[frame]:.2f} s"]
    words += [f"{len(places[name]):,} {what}".replace(",", " ") for name, what in
              (("fluid", "particles of fluid"), ("grains", "grains")) if name in places]
    image = label(picture, ",  ".join(words), limits, "fluid" in places)
    out = options.out or folder / "splat.png"
    out.parent.mkdir(parents=True, exist_ok=True)
    if out.suffix.lower() in (".jpg", ".jpeg"):
        image.save(out, quality=88, optimize=True)
    else:
        image.quantize(256, Image.Quantize.MAXCOVERAGE).save(out, optimize=True)
    print(f"{out}: {out.stat().st_size / 1e6:.2f} MB")


if __name__ == "__main__":
    finish(main)
