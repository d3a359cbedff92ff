#!/usr/bin/env python3
"""Pictures and films of a run in perspective: fluid as a surface or as points, grains as spheres, vessels of glass.

    render RESULTS [--out x.png]                     the last frame; --frame N or --time T another
    render RESULTS --film out.mp4 [--fps 25]         all frames; a name that ends in .gif makes a GIF
    render RESULTS --like cases/hopper/expect.toml   as the table [picture] of that file says

RESULTS is a folder of `bedload run`. The camera takes in where fluid and grains are in any frame that is drawn, and the
walls about them. [picture] may hold time (s), fluid, colour, range, grain_colour, grain_range, camera, clip and walls,
which mean what the options of these names do and give way to them.
"""

import argparse
import tomllib
from pathlib import Path

import imageio_ffmpeg
import numpy as np
import pyvista
import vtk
from matplotlib.colors import LinearSegmentedColormap
from PIL import Image

import shapes
from runs import finish
from scene import Scene, moves

DEEP = LinearSegmentedColormap.from_list("deep", ["#0d3b73", "#1e74bf", "#55aee3", "#a5dcf3", "#d5f1f7"])
FIELDS = {  # of fluid: array, words, colours
    "speed": ("velocity", "speed (m/s)", DEEP),
    "pressure": ("pressure", "pressure (Pa)", "cividis"),
    "porosity": ("porosity", "porosity (-)", "Blues"),
}
GRAIN_FIELDS = {  # of grains, likewise, times a factor
    "speed": ("velocity", "grain speed (m/s)", "plasma", 1),
    "diameter": ("radius", "grain diameter (m)", "viridis", 2),
    "spin": ("angular_velocity", "grain spin (rad/s)", "inferno", 1),
    "contact_force": ("contact_force", "contact force (N)", "magma", 1),
    "fluid_force": ("fluid_force", "force by fluid (N)", "magma", 1),
    "porosity": ("porosity", "porosity at grains (-)", "Greens", 1),
    "material": ("material", "grain material (-)", "cool", 1),
}
VIEWS = {"front": (0, 0), "above": (0, 90), "side": (90, 0), "corner": (25, 22)}  # azimuth, elevation, degrees
GRAIN, GLASS, MACHINE, CUT, WATER = "#d9964f", "#8fa3b3", "#7d8790", "#59646e", "#4f93c8"
FACES = ["x-", "x+", "y-", "y+", "z-", "z+"]
SMOOTH = 0.6  # spacings: width of the Gaussian by which particles are spread
LEVEL = 0.4  # of whole fluid: where its surface is drawn
NEAR = 0.25  # diagonals of the flow: walls within that of it are taken in
ANGLE = 25  # of view, degrees
CELLS = 8_000_000  # of the grid on which it is looked for, at most


class Picture:
    """Draws frames of a scene.

    fluid: "surface" or "points"; colour: one of FIELDS or "none"; limits: (low, high) of the colours or None;
    grain_colour, grain_limits: the same of grains, by GRAIN_FIELDS; clip: (axis, place), what lies nearer along it than
    `place` is left out, or None; walls: whether to draw them.
    """

    def __init__(self, scene, frames, size, fluid, colour, limits, camera, clip, walls, grain_colour="none",
                 grain_limits=None):
        self.scene, self.size, self.style, self.colour, self.clip, self.walls = scene, size, fluid, colour, clip, walls
        self.grain_colour = grain_colour if "grains" in scene.frames else "none"
        domain = scene.case.get("domain", {})
        self.coloured = [colour != "none" and "fluid" in scene.frames, self.grain_colour != "none"]
        self.bar = any(self.coloured)
        self.solids_of = {}
        self.plane = domain.get("two_d", False)
        self.domain = np.array([domain[end] for end in ("min", "max")], float) if "min" in domain else None
        self.turn = camera if camera else VIEWS["front" if self.plane else "corner"]
        fluid_bar, grain_bar = self.coloured
        self.limits = limits or (self.spread(frames, self.values, colour) if fluid_bar else None)
        self.grain_limits = grain_limits or (self.spread(frames, self.grain_values, grain_colour) if grain_bar
                                             else None)
        self.bounds = self.extent(frames)

    def shown(self, x):
        """Which of the places [n, 3] are not cut away."""
        if self.clip is None or not len(x):
            return np.ones(len(x), bool)
        axis, place = self.clip
        return (x[:, axis] - place) * self.ahead(axis) <= 0

    def ahead(self, axis):
        """Side of an axis on which the camera stands."""
        return 1 if self.direction()[axis] > 0 else -1

    def direction(self):
        """Unit vector from what is seen to the camera."""
        azimuth, elevation = np.radians(self.turn[:2])
        return np.array([np.sin(azimuth) * np.cos(elevation), -np.cos(azimuth) * np.cos(elevation), np.sin(elevation)])

    def values(self, frame):
        """The field of the fluid, a number for each particle."""
        return self.field("fluid", frame, FIELDS[self.colour][0])

    def grain_values(self, frame):
        """The field of the grains, a number for each."""
        if self.grain_colour == "diameter":
            return 2 * self.scene.radii(frame)
        name, _, _, factor = GRAIN_FIELDS[self.grain_colour]
        return factor * self.field("grains", frame, name)

    def field(self, store, frame, name):
        frames = self.scene.frames[store]
        values = frames.get(frame, name)
        if values is None:
            raise SystemExit(f"{frames.path}: has no {name}, only {', '.join(frames.names())}")
        return np.linalg.norm(values, axis=1) if values.ndim > 1 else values.astype(float)

    def spread(self, frames, values, colour):
        """Limits of the colours that fit all frames, but for the wildest particles."""
        found = [v for k in frames if len(v := values(k))]
        if not found:
            return 0.0, 1.0
        low, high = np.percentile(np.concatenate(found), [1, 99])
        if colour in ("speed", "spin", "contact_force", "fluid_force"):
            low = 0.0
        return (low, high) if high - low > 1e-3 * abs(high) else (low, low + (0.1 * abs(low) or 1.0))

    def extent(self, frames):
        """Lower and upper corner of what the camera takes in, m: what fluid and grains reach in these frames, and of
        the walls what is not far from that."""
        flow, walls = [], []
        for k in frames:
            for store in self.scene.frames.values():
                x = store.position(k)
                flow.append(x[self.shown(x)])
            if self.walls:
                walls += [mesh.points for mesh, _ in self.solids(self.scene.times()[k])]
        flow, walls = ([x for x in found if len(x)] for found in (flow, walls))
        if not flow and not walls:
            raise SystemExit("nothing to draw: no particles, grains or walls in these frames")
        low, high = bounds(flow or walls)
        if flow and walls:
            around = NEAR * np.linalg.norm(high - low)
            outer = bounds([*flow, *walls])
            low, high = np.maximum(outer[0], low - around), np.minimum(outer[1], high + around)
        return low, high

    # ---- what there is to see, as meshes ----

    def solids(self, time):
        """Walls as they stand at `time`: (surface, how it is drawn: "vessel", which is seen through, "machine" or
        "cut")."""
        for body, turn, shift in self.scene.bodies(time):
            pieces, solid = self.walls_of(body)
            for mesh, vessel in pieces:
                mesh = mesh.copy()
                mesh.points = mesh.points @ turn.T + shift
                if self.clip is not None:
                    axis, place = self.clip
                    normal = self.ahead(axis) * np.eye(3)[axis]
                    mesh = mesh.clip(normal=normal, origin=place * np.eye(3)[axis])
                if mesh.n_points:
                    yield mesh, "vessel" if vessel else "machine"
            if self.clip is not None and solid is not None:
                if (cut := shapes.section(solid, *self.clip, turn, shift)) is not None:
                    yield cut, "cut"

    def walls_of(self, body):
        """A body as it stands at the start: [(surface, whether it holds the fluid)], and the solid it is, None for
        sheets and tanks."""
        name = body["name"]
        if name not in self.solids_of:
            self.solids_of[name] = self.make_walls(body)
        return self.solids_of[name]

    def make_walls(self, body):
        shape = body.get("shape")
        if shape in ("tank", "plane"):
            mesh = self.sheet(body) if shape == "plane" else shapes.box(body["min"], body["max"], self.open_faces(body))
            return ([(mesh, True)] if mesh is not None else []), None
        if shape == "box":
            solid = shapes.Solid(shapes.box(body["min"], body["max"], FACES).triangulate())
            return solid.pieces(), solid
        solid = shapes.solid(shape, self.scene.shapes, self.scene.folder) if shape in self.scene.shapes else None
        if solid is None:
            return [], None
        return [(mesh, vessel or not moves(body)) for mesh, vessel in solid.pieces() if mesh.n_points], solid

    def open_faces(self, body):
        """Faces of a tank that are walls: in plane flows not those across, which are none."""
        periodic = self.scene.case.get("domain", {}).get("periodic", [False] * 3)
        without = [axis for axis, again in zip("xyz", periodic) if again] + ["y"] * self.plane
        return [face for face in body.get("faces", FACES) if face[0] not in without]

    def sheet(self, body):
        """The part of a plane wall within the domain."""
        if self.domain is None:
            return None
        around = pyvista.Box(bounds=np.transpose(self.domain).ravel())
        cut = around.slice(normal=body["normal"], origin=body["point"])
        if cut.n_points < 3:
            return None
        return cut.delaunay_2d() if cut.n_points else None

    def surface(self, frame):
        """(surface of the fluid, places of lone particles, their values); the surface carries the field."""
        x = self.scene.frames["fluid"].position(frame)
        seen = self.shown(x)
        x = x[seen]
        value = self.values(frame)[seen] if self.colour != "none" else np.zeros(len(x))
        porosity = self.scene.frames["fluid"].get(frame, "porosity")
        volume = 1 / np.clip(porosity[seen], 0.3, 1) if porosity is not None else np.ones(len(x))
        if not len(x):
            return None, x, value
        origin, step, counts = self.grid(x)
        particle = (self.scene.dx / step) ** (2 if self.plane else 3)  # cells that it fills
        amount = particle * spread_on_grid(x, volume, origin, step, counts, self.plane)
        field = particle * spread_on_grid(x, volume * value, origin, step, counts, self.plane)
        field /= np.maximum(amount, 1e-6)
        if self.plane:  # beside the slab too, between whose last nodes and these its faces are found
            field[:] = np.take(field, [4], axis=1)
        image = pyvista.ImageData(dimensions=counts, spacing=[step] * 3, origin=origin)
        image["amount"], image["field"] = amount.ravel(order="F"), field.ravel(order="F")
        mesh = image.contour([LEVEL], scalars="amount")
        at = np.rint((x - origin) / step).astype(int)
        alone = amount[tuple(at.T)] < LEVEL
        return (mesh if mesh.n_points else None), x[alone], value[alone]

    def grid(self, x):
        """Origin, spacing and counts of the grid: half a spacing of the fluid, wider where that is too many."""
        low, high = x.min(0), x.max(0)
        step = self.scene.dx / 2
        step *= max(1.0, (np.prod((high - low) / step + 8) / CELLS) ** (1 / 3))
        return low - 4 * step, step, np.ceil((high - low) / step).astype(int) + 9

    # ---- drawing ----

    def draw(self, frame):
        """The picture of a frame as an array [height, width, 3] of bytes."""
        plotter = pyvista.Plotter(off_screen=True, window_size=self.size, lighting="none")
        plotter.set_background("white")
        self.light(plotter)
        time = self.scene.times()[frame]
        opaque = "grains" not in self.scene.frames
        if "fluid" in self.scene.frames:
            self.draw_fluid(plotter, frame, opaque)
        if "grains" in self.scene.frames:
            x, r = self.scene.frames["grains"].position(frame), self.scene.radii(frame)
            seen = self.shown(x)
            if self.grain_colour == "none":
                balls(plotter, x[seen], r[seen], color=GRAIN)
            else:
                _, words, colours, _ = GRAIN_FIELDS[self.grain_colour]
                balls(plotter, x[seen], r[seen], self.grain_values(frame)[seen], cmap=colours, clim=self.grain_limits,
                      scalar_bar_args=self.scale(words, last=True))
        if self.walls:
            for mesh, how in self.solids(time):
                look = {"vessel": {"color": GLASS, "opacity": 0.16}, "machine": {"color": MACHINE},
                        "cut": {"color": CUT, "lighting": False}}[how]
                plotter.add_mesh(mesh, smooth_shading=False, specular=0.3, show_scalar_bar=False, **look)
                edges = mesh.extract_feature_edges(25)
                if edges.n_points and how != "cut":  # a ball has none
                    plotter.add_mesh(edges, color="#5c6770", line_width=1.2)
        plotter.enable_depth_peeling(6)
        plotter.enable_anti_aliasing("ssaa")
        plotter.add_text(f"t = {time:.4g} s", position="upper_left", font_size=9, color="black")
        self.aim(plotter)
        picture = plotter.screenshot(return_img=True)
        plotter.close()
        return np.ascontiguousarray(picture[:, :, :3])

    def scale(self, words, last=False):
        """Where a bar of colours stands: in the middle, or that of the fluid to the left of the grains'."""
        x, width = (0.3, 0.4) if not all(self.coloured) else (0.55, 0.36) if last else (0.09, 0.36)
        return {"title": words, "color": "black", "title_font_size": 15, "label_font_size": 13, "fmt": "%.3g",
                "position_x": x, "position_y": 0.02, "width": width, "height": 0.07, "n_labels": 2}

    def draw_fluid(self, plotter, frame, opaque):
        look = {"color": WATER, "show_scalar_bar": False}
        if self.colour != "none":
            _, words, colours = FIELDS[self.colour]
            look = {"cmap": colours, "clim": self.limits, "scalar_bar_args": self.scale(words)}
        if self.style == "surface":
            mesh, x, values = self.surface(frame)
            if mesh is not None:
                scalars = {"scalars": "field"} if self.colour != "none" else {}
                plotter.add_mesh(mesh, opacity=1.0 if opaque else 0.45, smooth_shading=True, specular=0.4,
                                 specular_power=30, **scalars, **look)
                look = {**look, "show_scalar_bar": False}
            look["opacity"] = 1.0 if opaque else 0.6
        else:
            x = self.scene.frames["fluid"].position(frame)
            values = self.values(frame) if self.colour != "none" else np.zeros(len(x))
            x, values = x[self.shown(x)], values[self.shown(x)]
        look.pop("scalar_bar_args", None) if look.get("show_scalar_bar") is False else None
        radius = self.scene.dx * (0.5 if opaque or self.style == "surface" else 0.25)
        balls(plotter, x, np.full(len(x), radius), values if self.colour != "none" else None, **look)

    def light(self, plotter):
        """A key light above the left shoulder and two weaker ones."""
        for place, strength in (((-0.6, 0.8, 1.2), 0.75), ((1.0, 0.3, 0.6), 0.3), ((0, -0.5, 0.6), 0.15)):
            plotter.add_light(pyvista.Light(position=place, intensity=strength, light_type="camera light"))
        plotter.add_light(pyvista.Light(light_type="headlight", intensity=0.15))

    def aim(self, plotter):
        """Points the camera so that all corners of the bounds are just within the picture."""
        low, high = self.bounds
        corners = np.array(np.meshgrid(*np.transpose([low, high]))).reshape(3, -1).T
        towards = self.direction()
        up = np.array([0.0, 0, 1]) if abs(towards[2]) < 0.99 else np.array([0.0, 1, 0])
        across = np.cross(up, towards)
        across /= np.linalg.norm(across)
        up = np.cross(towards, across)
        middle = (low + high) / 2
        corners = corners - middle
        half = np.tan(np.radians(ANGLE / 2))
        usable = np.array([0.94 * self.size[0] / self.size[1], 0.75 if self.bar else 0.92])
        zoom = self.turn[2] if len(self.turn) > 2 else 1.0
        wide = np.abs(corners @ np.transpose([across, up])) / usable  # half heights of a picture that it needs
        away = np.max(wide.max(axis=1) / half + (0 if self.plane else corners @ towards))
        plotter.camera.focal_point, plotter.camera.up, plotter.camera.view_angle = middle, up, ANGLE
        plotter.camera.position = middle + away / zoom * towards
        if self.plane:
            plotter.camera.parallel_projection, plotter.camera.parallel_scale = True, wide.max() / zoom
        plotter.reset_camera_clipping_range()


def bounds(places):
    """Lower and upper corner of arrays [n, 3]."""
    return np.min([x.min(0) for x in places], axis=0), np.max([x.max(0) for x in places], axis=0)


def spread_on_grid(x, weights, origin, step, counts, plane):
    """Sum of weights [n] of places [n, 3] on the nodes of a grid, each spread by a Gaussian of SMOOTH spacings.

    A weight is split between the eight nodes about it, which is then smoothed along each axis. Of a plane flow it goes to
    the nearest nodes along y and is copied to their neighbours, so that a layer of particles becomes a slab.
    """
    place = (x - origin) / step
    if plane:
        place[:, 1] = np.rint(place[:, 1])
    cell = np.floor(place).astype(int)
    part = place - cell
    grid = np.zeros(np.prod(counts))
    for corner in np.ndindex(2, 2, 2):
        fraction = np.where(corner, part, 1 - part).prod(axis=1)
        grid += np.bincount(np.ravel_multi_index((cell + corner).T, counts), weights * fraction, len(grid))
    grid = grid.reshape(counts)
    reach = np.arange(-4, 5)
    taps = np.exp(-0.5 * (reach / (2 * SMOOTH)) ** 2)  # a step is half a spacing, or more where the grid is coarse
    taps /= taps.sum()
    for axis in range(3):
        if plane and axis == 1:
            grid = sum(np.roll(grid, k, axis) for k in (-1, 0, 1))
        else:
            grid = sum(tap * np.roll(grid, k, axis) for k, tap in zip(reach, taps))
    return grid


def balls(plotter, places, radii, values=None, **look):
    """Lit spheres of given radii, coloured by `values` if there are any."""
    if not len(places):
        return
    cloud = pyvista.PolyData(np.array(places, float))
    cloud["radius"] = radii
    if values is not None:
        cloud["field"] = values
    detail = 24 if len(places) < 3000 else 14 if len(places) < 30000 else 8
    ball = pyvista.Sphere(radius=1.0, theta_resolution=detail, phi_resolution=detail // 2 + 2)
    mesh = cloud.glyph(scale="radius", factor=1.0, geom=ball, orient=False)
    plotter.add_mesh(mesh, scalars="field" if values is not None else None, smooth_shading=True, specular=0.25, **look)


def numbers(text, least, most):
    """A list of numbers with commas, `least` to `most` of them."""
    try:
        found = [float(word) for word in text.split(",")]
    except ValueError:
        found = []
    if not least <= len(found) <= most or not np.all(np.isfinite(found)):
        wanted = f"{least}" if least == most else f"{least} to {most}"
        raise argparse.ArgumentTypeError(f"'{text}' must be {wanted} numbers with commas between them")
    return found


def camera(text):
    """A named view, or azimuth, elevation (degrees) and perhaps zoom."""
    return list(VIEWS[text]) if text in VIEWS else numbers(text, 2, 3)


def clip(text):
    """An axis and a place on it: "y=0.05"."""
    axis, _, place = text.partition("=")
    if axis not in ("x", "y", "z") or not place:
        raise argparse.ArgumentTypeError(f"'{text}' must be x, y or z, = and a place in m")
    return "xyz".index(axis), numbers(place, 1, 1)[0]


READERS = {"fluid": str, "colour": str, "range": lambda t: numbers(t, 2, 2), "grain_colour": str,
           "grain_range": lambda t: numbers(t, 2, 2), "camera": camera, "clip": clip, "time": float, "walls": bool}
CHOICES = {"fluid": ("surface", "points"), "colour": (*FIELDS, "none"), "grain_colour": (*GRAIN_FIELDS, "none")}


def settings(path):
    """The table [picture] of a file, each value read as the option of its name would be; {} if there is none."""
    try:
        with open(path, "rb") as file:
            table = tomllib.load(file).get("picture", {})
    except (OSError, tomllib.TOMLDecodeError) as error:
        raise SystemExit(f"{path}: {error}") from None
    found = {}
    for key, value in table.items():
        if key not in READERS:
            raise SystemExit(f"{path}: [picture] has no '{key}', only {', '.join(READERS)}")
        text = ",".join(map(str, value)) if isinstance(value, list) else value
        try:
            found[key] = READERS[key](text)
        except (argparse.ArgumentTypeError, ValueError, AttributeError) as error:
            raise SystemExit(f"{path}: picture.{key}: {error}") from None
        if key in CHOICES and found[key] not in CHOICES[key]:
            raise SystemExit(f"{path}: picture.{key} = '{value}' must be one of {', '.join(CHOICES[key])}")
    return found


def frame_of(scene, number, time):
    """The frame asked for: by number (negative from the end), nearest to a time, or the last."""
    times = scene.times()
    if not len(times):
        raise SystemExit("the run has no frames")
    if time is not None:
        slack = (times[-1] - times[0]) / max(len(times) - 1, 1)
        if not times[0] - slack <= time <= times[-1] + slack:
            raise SystemExit(f"--time {time:g}: this run has frames from {times[0]:.4g} to {times[-1]:.4g} s")
        return int(np.argmin(np.abs(times - time)))
    number = -1 if number is None else number
    if not -len(times) <= number < len(times):
        raise SystemExit(f"--frame {number}: this run has frames 0 to {len(times) - 1}")
    return number % len(times)


def save_picture(picture, path):
    """PNG of at most 256 colours, which is a quarter of the size, or JPEG, by the name."""
    path.parent.mkdir(parents=True, exist_ok=True)
    image = Image.fromarray(picture)
    if path.suffix.lower() in (".jpg", ".jpeg"):
        image.save(path, quality=85, optimize=True)
    else:
        image.quantize(256, Image.Quantize.MAXCOVERAGE).save(path, optimize=True)


def save_film(pictures, path, fps, size):
    path.parent.mkdir(parents=True, exist_ok=True)
    if path.suffix.lower() == ".gif":
        first, *others = [Image.fromarray(p).quantize(128) for p in pictures]
        first.save(path, save_all=True, append_images=others, duration=1000 / fps, loop=0)
        return
    writer = imageio_ffmpeg.write_frames(str(path), size, fps=fps, quality=7, macro_block_size=2)
    writer.send(None)
    for picture in pictures:
        writer.send(picture)
    writer.close()


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="render", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results")
    which = parser.add_mutually_exclusive_group()
    which.add_argument("--frame", type=int, help="its number from 0, or from the end: -1 is the last")
    which.add_argument("--time", type=float, help="s; the nearest frame is drawn")
    which.add_argument("--film", type=Path, metavar="FILE", help=".mp4 or .gif of all frames")
    parser.add_argument("--out", type=Path, help=".png or .jpg; default RESULTS/picture.png")
    parser.add_argument("--fluid", choices=CHOICES["fluid"], help="default surface")
    parser.add_argument("--colour", choices=CHOICES["colour"], help="of the fluid; default speed")
    parser.add_argument("--range", type=READERS["range"], metavar="LOW,HIGH",
                        help="of the colours, in the field's unit")
    parser.add_argument("--grain-colour", choices=CHOICES["grain_colour"], help="of the grains; default none")
    parser.add_argument("--grain-range", type=READERS["grain_range"], metavar="LOW,HIGH",
                        help="of their colours, in the field's unit")
    parser.add_argument("--camera", type=camera, metavar="VIEW",
                        help=f"{', '.join(VIEWS)}, or azimuth,elevation[,zoom]: degrees to the right of the front (-y) "
                             "and above the level; default corner, of plane flows front")
    parser.add_argument("--clip", type=clip, metavar="y=0.05",
                        help="cut at this plane (m); walls show their section")
    parser.add_argument("--no-walls", dest="walls", action="store_false", default=None)
    parser.add_argument("--like", type=Path, metavar="FILE", help="a TOML file with a table [picture]")
    parser.add_argument("--size", type=lambda t: [int(n) for n in numbers(t, 2, 2)], default=[900, 600],
                        metavar="WIDTH,HEIGHT", help="pixels, default 900,600")
    parser.add_argument("--fps", type=float, default=25, help="frames per second of a film, default 25")
    options = parser.parse_args(arguments)
    if options.film and options.film.suffix.lower() not in (".mp4", ".gif"):
        parser.error(f"--film: '{options.film}' must end in .mp4 or .gif")
    if options.out and options.out.suffix.lower() not in (".png", ".jpg", ".jpeg"):
        parser.error(f"--out: '{options.out}' must end in .png or .jpg")
    if min(options.size) < 64 or max(options.size) > 8192:
        parser.error("--size: sides must be within 64..8192")

    chosen = {"fluid": "surface", "colour": "speed", "grain_colour": "none", "walls": True}
    chosen |= settings(options.like) if options.like else {}
    chosen |= {key: value for key in READERS if (value := getattr(options, key)) is not None}
    render(Path(options.results), options.out, options.film, options.frame, chosen, options.size, options.fps)


def render(results, out, film, frame, chosen, size=(900, 600), fps=25):
    """Draws a picture or a film of a run; `chosen` has the settings of [picture]. Prints what it has written."""
    vtk.vtkLogger.SetStderrVerbosity(vtk.vtkLogger.VERBOSITY_ERROR)  # no warning about a missing display
    scene = Scene(results)
    if chosen.get("colour") == "porosity" and "grains" not in scene.frames:
        raise SystemExit(f"{results}: has no grains and so no porosity")
    frames = range(len(scene.times())) if film else [frame_of(scene, frame, None if frame is not None else
                                                              chosen.get("time"))]
    size = [2 * (side // 2) for side in size]
    picture = Picture(scene, frames, size, chosen["fluid"], chosen["colour"], chosen.get("range"),
                      chosen.get("camera"), chosen.get("clip"), chosen["walls"], chosen.get("grain_colour", "none"),
                      chosen.get("grain_range"))
    if film:
        save_film((picture.draw(k) for k in frames), film, fps, size)
        print(film)
        return
    out = out or results / "picture.png"
    save_picture(picture.draw(frames[0]), out)
    print(out)


if __name__ == "__main__":
    finish(main)
