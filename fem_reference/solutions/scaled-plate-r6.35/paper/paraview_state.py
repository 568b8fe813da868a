"""The impact in ParaView: *File > Load State*, or ``pvpython paraview_state.py picture.png``.

Lies beside a solution's `stress.pvd`: bodies deformed (largest displacement drawn as a twentieth of
the picture) and coloured by the von Mises stress, over all instants that are stored; first shown is
the one of the highest stress.
"""

import sys
from pathlib import Path

from paraview import simple

DRAWN = 0.05
"""Largest displacement over the size of the bodies, as drawn."""
COLOURED = 0.1
"""Share of the highest stress, that under the contacts, at which the colours end: waves show."""

# ParaView runs a state without __file__
here = Path((lambda: 0).__code__.co_filename).resolve().parent
series = simple.PVDReader(FileName=str(here / "stress.pvd"))
view = simple.GetActiveViewOrCreate("RenderView")

largest, stress, stressed = 0.0, 0.0, 0.0
for instant in series.TimestepValues:
    series.UpdatePipeline(instant)
    largest = max(largest, series.PointData["displacement"].GetRange(-1)[1])
    highest = series.CellData["von_mises"].GetRange()[1]
    if highest > stress:
        stress, stressed = highest, instant
low_x, high_x, low_y, high_y, low_z, high_z = series.GetDataInformation().GetBounds()
size = max(high_x - low_x, high_y - low_y, high_z - low_z)

warped = simple.WarpByVector(Input=series)
warped.Vectors = ["POINTS", "displacement"]
warped.ScaleFactor = DRAWN * size / largest if largest > 0.0 else 1.0
display = simple.Show(warped, view)
simple.ColorBy(display, ("CELLS", "von_mises"))
display.SetScalarBarVisibility(view, True)
colours = simple.GetColorTransferFunction("von_mises")
colours.ApplyPreset("Viridis (matplotlib)", True)
colours.RescaleTransferFunction(0.0, COLOURED * stress)
legend = simple.GetScalarBar(colours, view)
legend.Title, legend.ComponentTitle = "von Mises stress in Pa", ""
simple.GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
simple.GetAnimationScene().AnimationTime = stressed
simple.ResetCamera(view)
simple.Render(view)
if len(sys.argv) > 1:
    simple.SaveScreenshot(sys.argv[1], view, ImageResolution=[1200, 900])
