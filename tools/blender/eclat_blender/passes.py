"""Turns eclat's channels into Blender's passes. Pure functions of planes."""
import numpy

FAR = 1e10  # Blender's depth where there is no surface


def combined(planes):
    """Returns linear radiance; opaque, since the environment is in it. Rows from the bottom, as in Blender."""
    shape = planes["R"].shape
    return numpy.stack([planes["R"], planes["G"], planes["B"], numpy.ones(shape, numpy.float32)], -1)[::-1]


def layer(planes, name, channels="RGB"):
    return numpy.stack([planes[f"{name}.{channel}"] for channel in channels], -1)[::-1]


def depth(planes, along):
    """Returns the depth along the camera's axis, as other engines do. along: camera.along_axis."""
    distance = planes["depth.Z"]
    seen = (planes["A"] > 0) & (distance > 0) & numpy.isfinite(distance)
    return numpy.where(seen, distance * along, FAR)[::-1, :, None]


def normal(planes):
    """Returns the normal in Blender's axes, z up."""
    x, y, z = (planes[f"normal.{axis}"] for axis in "XYZ")
    return numpy.stack([x, -z, y], -1)[::-1]


# Name of the pass, channels, their names, Blender's kind, layers of the EXR that it needs, function that makes it.
TABLE = {
    "Depth": (1, "Z", "VALUE", ("depth", "A"), depth),
    "Normal": (3, "XYZ", "VECTOR", ("normal",), lambda planes, along: normal(planes)),
    "DiffCol": (3, "RGB", "COLOR", ("albedo",), lambda planes, along: layer(planes, "albedo")),
    "Albedo": (3, "RGB", "COLOR", ("albedo",), lambda planes, along: layer(planes, "albedo")),
    "Standard Error": (3, "RGB", "COLOR", ("stderr",), lambda planes, along: layer(planes, "stderr")),
    "Low 95": (3, "RGB", "COLOR", ("low95",), lambda planes, along: layer(planes, "low95")),
    "High 95": (3, "RGB", "COLOR", ("high95",), lambda planes, along: layer(planes, "high95")),
    "Samples": (1, "X", "VALUE", ("samples",), lambda planes, along: planes["samples"][::-1, :, None]),
}


def channels(names):
    """Returns the option --channels for these passes."""
    return "--channels=" + ",".join(["default", *sorted({layer for name in names for layer in TABLE[name][3]} - {"A", "stderr", "samples"})])


def make(name, planes, along):
    """Returns the pass, or None if the picture lacks it: a single sample has no standard error."""
    try:
        return numpy.ascontiguousarray(TABLE[name][4](planes, along), numpy.float32)
    except KeyError:
        return None
