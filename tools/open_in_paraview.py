"""Opens a run in ParaView, ready to look at: fluid coloured by speed, grains as spheres, walls of glass.

    BEDLOAD_RESULTS=RESULTS paraview --script=tools/open_in_paraview.py
    pvpython tools/open_in_paraview.py RESULTS [picture.png]     draws the last frame without a window

ParaView before 5.12, which reads no points over time from VTKHDF, takes the XDMF files beside them.
"""

import os
import sys
from pathlib import Path

from paraview import simple

VERSION = simple.GetParaViewVersion()
ENDING = "vtkhdf" if (VERSION.major, VERSION.minor) >= (5, 12) else "xdmf"
COLOURS = {"fluid": None, "grains": [0.85, 0.59, 0.31], "walls": [0.56, 0.64, 0.70]}


def open_run(folder):
    """Shows what the folder holds; returns the view, at its last time."""
    view = simple.GetActiveViewOrCreate("RenderView")
    fluid = None
    found = {name: path for name in COLOURS if (path := folder / f"{name}.{ENDING}").exists()}
    if not found:
        raise SystemExit(f"{folder}: has no fluid.{ENDING}, grains.{ENDING} or walls.{ENDING}")
    for name, path in found.items():
        source = opened(name, str(path))
        source.UpdatePipeline()
        shown = simple.Show(source, view)
        if name == "grains":
            ball = simple.Glyph(registrationName="spheres", Input=source, GlyphType="Sphere")
            ball.ScaleArray, ball.ScaleFactor, ball.GlyphMode = ["POINTS", "radius"], 2.0, "All Points"
            ball.GlyphType.Radius = 0.5
            simple.Hide(source, view)
            shown = simple.Show(ball, view)
        elif name == "fluid":
            shown.SetRepresentationType("Point Gaussian")
            shown.GaussianRadius = spacing(source) / 2
            fluid = shown
            shown.Opacity = 0.4 if "grains" in found else 1
            simple.ColorBy(shown, ("POINTS", "velocity", "Magnitude"))
        else:
            shown.SetRepresentationType("Points")
            shown.Opacity = 0.15
        if COLOURS[name]:
            simple.ColorBy(shown, None)
            shown.AmbientColor = shown.DiffuseColor = COLOURS[name]
    scene = simple.GetAnimationScene()
    scene.UpdateAnimationUsingDataTimeSteps()
    scene.GoToLast()
    if fluid:
        fluid.RescaleTransferFunctionToDataRange()
        bar = simple.GetScalarBar(simple.GetColorTransferFunction("velocity"), view)
        bar.Title, bar.ComponentTitle, bar.TitleFontSize, bar.LabelFontSize = "speed (m/s)", "", 10, 10
        fluid.SetScalarBarVisibility(view, True)
    view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [1, -2.5, 1], [0, 0, 0], [0, 0, 1]
    simple.ResetCamera(view)
    simple.Render(view)
    return view


def opened(name, path):
    """All frames of a file."""
    if ENDING == "xdmf":
        return simple.XDMFReader(registrationName=name, FileNames=[path])
    return simple.VTKHDFReader(registrationName=name, FileName=[path])


def spacing(source):
    """About the spacing of the particles, m: the side of the cube that each has of the box about them."""
    data = source.GetDataInformation()
    bounds, count = data.GetBounds(), max(data.GetNumberOfPoints(), 1)
    sides = [b - a for a, b in zip(bounds[::2], bounds[1::2]) if b > a]
    volume = 1.0
    for side in sides:
        volume *= side
    return (volume / count) ** (1 / max(len(sides), 1)) if sides else 1.0


if __name__ == "__main__":
    results = Path(sys.argv[1] if len(sys.argv) > 1 else os.environ.get("BEDLOAD_RESULTS", "."))
    shown_in = open_run(results.resolve())
    if len(sys.argv) > 2:
        simple.SaveScreenshot(sys.argv[2], shown_in, ImageResolution=[1280, 800])
