"""Translates Blender's camera into a glTF camera and options of eclat. Pure functions of numbers."""
import math
from typing import NamedTuple, Optional, Tuple

from .options import number
from .trouble import Trouble

SENSOR_HEIGHT = 0.024  # that the option --fstop assumes, in metres


class Frame(NamedTuple):
    """The pixels of the whole frame, without a border."""
    width: int
    height: int
    pixel_aspect: float = 1.0                               # height of a pixel over its width
    border: Optional[Tuple[float, float, float, float]] = None # left, right, bottom, top, each from 0 to 1


class Lens(NamedTuple):
    kind: str             # "PERSP" or "ORTHO"
    focal_length: float   # millimetres
    sensor_width: float
    sensor_height: float
    sensor_fit: str       # "AUTO", "HORIZONTAL" or "VERTICAL"
    ortho_scale: float
    shift: Tuple[float, float]
    fstop: float = 0.0    # 0: a pinhole
    focus: float = 0.0    # metres along the axis


class Window(NamedTuple):
    """The visible part of the image plane: for a perspective camera at distance 1, otherwise in metres."""
    left: float
    right: float
    bottom: float
    top: float


def plane(lens, frame):
    """Returns the half width and half height of the frame about the axis, and the shift of its centre."""
    tall = frame.height * frame.pixel_aspect
    across = lens.sensor_fit == "HORIZONTAL" or (lens.sensor_fit == "AUTO" and frame.width >= tall)
    fitted = frame.width if across else tall
    if lens.kind == "ORTHO":
        pixel = lens.ortho_scale / fitted
    else:
        pixel = (lens.sensor_height if lens.sensor_fit == "VERTICAL" else lens.sensor_width) / lens.focal_length / fitted
    return 0.5 * frame.width * pixel, 0.5 * tall * pixel, lens.shift[0] * fitted * pixel, lens.shift[1] * fitted * pixel


def window(lens, frame):
    half_width, half_height, x, y = plane(lens, frame)
    left, right, bottom, top = frame.border or (0, 1, 0, 1)
    return Window(x + half_width * (2 * left - 1), x + half_width * (2 * right - 1), y + half_height * (2 * bottom - 1),
                  y + half_height * (2 * top - 1))


def size(frame):
    """Returns the size in pixels of what is rendered: the border, rounded as Blender rounds it."""
    if not frame.border:
        return frame.width, frame.height
    left, right, bottom, top = frame.border
    return (max(1, int(right * frame.width) - int(left * frame.width)), max(1, int(top * frame.height) - int(bottom * frame.height)))


def gltf_camera(lens, frame):
    """Returns the entry for glTF's "cameras"."""
    half_width, half_height, _, _ = plane(lens, frame)
    if lens.kind == "ORTHO":
        return {"type": "orthographic", "orthographic": {"xmag": half_width, "ymag": half_height, "znear": 0.01, "zfar": 1000.0}}
    if lens.kind != "PERSP":
        raise Trouble("the camera is panoramic; eclat renders perspective and orthographic ones; choose another lens type")
    return {"type": "perspective", "perspective": {"yfov": 2 * math.atan(half_height), "znear": 0.01}}


def words(lens, frame):
    """Returns the options for what glTF cannot express: the shift, the border, the shape of pixels, the lens."""
    width, height = size(frame)
    found = [f"--size={width}x{height}"]
    if any(lens.shift) or frame.border or frame.pixel_aspect != 1:
        _, half_height, _, _ = plane(lens, frame)
        found.append("--screen-window=" + ",".join(number(edge / half_height) for edge in window(lens, frame)))
    if lens.fstop > 0 and lens.kind == "PERSP":
        found += [f"--fstop={number(fstop(lens, frame))}", f"--focus={number(lens.focus)}"]
    return found


def fstop(lens, frame):
    """Returns the f-number that makes the aperture as wide as Blender's: eclat computes the focal length from the field of view, for a sensor 24 mm high."""
    _, half_height, _, _ = plane(lens, frame)
    aperture = lens.focal_length * 1e-3 / lens.fstop
    return SENSOR_HEIGHT / (2 * half_height) / aperture


def along_axis(lens, frame):
    """Returns the cosine between each pixel's ray and the axis, rows from the top: it turns a distance into a depth."""
    import numpy
    width, height = size(frame)
    if lens.kind == "ORTHO":
        return numpy.ones((height, width))
    view = window(lens, frame)
    x = view.left + (numpy.arange(width) + 0.5) * (view.right - view.left) / width
    y = view.top - (numpy.arange(height) + 0.5) * (view.top - view.bottom) / height
    return 1 / numpy.sqrt(1 + x[None, :] ** 2 + y[:, None] ** 2)
