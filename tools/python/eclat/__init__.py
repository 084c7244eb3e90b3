"""Renders glTF 2.0 scenes to physically based images with a stated error, on any OpenCL device.

    picture = eclat.load("scene.glb").render(error=0.02)     # until the error is under 2 %
    picture.error, picture.bound                             # its distance from the converged picture: estimate and upper bound
    picture.radiance                                         # NumPy: height x width x 3, linear Rec. 709
    picture.save("scene.exr")

Options have the names of the command line with _ for -, as in render(max_depth=4, light_choice="tree"); the manual's page "Command line" has
them all. Failures raise eclat.Error with one line that says what failed, where, and how to fix it. Warnings are Python warnings of the category
eclat.Warning; other messages go to the logger "eclat".
"""
from importlib import metadata

from ._compare import Comparison, compare
from ._error import Error, Warning
from ._job import Progress
from ._mix import mix
from ._picture import Clean, Intervals, Picture
from ._scene import Device, Scene, cost, devices, info, load, merge, render_all, render_scenarios

for _public in (Clean, Comparison, Device, Error, Intervals, Picture, Progress, Scene, Warning):
    _public.__module__ = "eclat"  # the name that messages and help show
__version__ = metadata.version("eclat")
__all__ = ["Clean", "Comparison", "Device", "Error", "Intervals", "Picture", "Progress", "Scene", "Warning",
           "compare", "cost", "devices", "info", "load", "merge", "mix", "render_all", "render_scenarios"]
