"""Turns the view of a 3D viewport into options of eclat. Pure functions of matrices, given as rows of numbers."""
import math

from .options import number

BACK = 20  # parallel rays start so many view heights behind the viewpoint


def window(projection):
    """Returns left, right, bottom, top of the image plane: at distance 1 or, for parallel rays, in metres."""
    p = projection
    if p[3][3] == 1:  # parallel
        return tuple((sign - p[axis][3]) / p[axis][axis] for axis in (0, 1) for sign in (-1, 1))
    return tuple((sign + p[axis][2]) / p[axis][axis] for axis in (0, 1) for sign in (-1, 1))


def gltf(v):
    return v[0], v[2], -v[1]


def words(camera, projection, size):
    """camera: matrix from the camera's axes to the world's; the camera looks along its -z. size: of the picture in pixels."""
    left, right, bottom, top = window(projection)
    half = (top - bottom) / 2
    is_parallel = projection[3][3] == 1
    column = [[camera[row][k] for row in range(3)] for k in range(4)]
    back = BACK * 2 * half if is_parallel else 0.0
    eye = [p + back * z for p, z in zip(column[3], column[2])]
    target = [p - z for p, z in zip(eye, column[2])]
    found = [f"--size={size[0]}x{size[1]}", *(f"--{name}={','.join(map(number, gltf(v)))}" for name, v in (("eye", eye), ("look-at", target), ("up", column[1])))]
    found.append(f"--parallel={number(2 * half)}" if is_parallel else f"--fov={number(2 * math.degrees(math.atan(half)))}")
    found.append("--screen-window=" + ",".join(number(edge / half) for edge in (left, right, bottom, top)))
    return found
