"""Scenes, and functions that render, merge and describe them."""
from __future__ import annotations

import json
import os
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Union

from ._error import Error
from ._job import PictureHandle, Shown, run
from ._options import texts
from ._picture import Picture

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._option_types import CostOptions, FrameOptions, InfoOptions, RenderOptions

SERIES = ("frames", "fps", "orbit", "out", "output", "overwrite", "scenarios", "shard", "sheet")
Path = Union[str, "os.PathLike[str]"]
Seconds = Union[float, str]


def some(made: PictureHandle | None) -> PictureHandle:
    if made is None:
        raise Error("the picture does not fit into memory as a whole; the command `eclat render` writes such pictures in strips", "host memory")
    return made


def series(inputs: Iterable[Path], named: dict[str, Any], progress: Shown) -> list[dict[str, Any]]:
    """Renders pictures to files. Returns what `eclat render --json` reports for each, and at the end."""
    reports = run("render", [os.fspath(path) for path in inputs], [("json", None), *texts("render", named, SERIES)], progress).reports
    return [json.loads(line) for report in reports for line in report.splitlines()]


def info(path: Path, **options: Unpack[InfoOptions]) -> dict[str, Any]:
    """Returns what a scene contains and what rendering it needs: the figures of `eclat info --json`."""
    found: dict[str, Any] = json.loads(run("info", [os.fspath(path)], [("json", None), *texts("info", dict(options))]).reports[-1])
    return found


class Scene:
    """A glTF file. It was read once to check that it can be rendered; each render reads it again. `info` is the result of eclat.info."""

    def __init__(self, path: Path) -> None:
        self.path = os.fspath(path)
        self.info = info(path)

    def __repr__(self) -> str:
        return f"<eclat.Scene {self.path}, {self.info['triangles']} triangles, {len(self.info['cameras'])} cameras>"

    def render(self, *, error: float | str | None = None, spp: int | None = None, size: tuple[int, int] | str | None = None,
               time: Seconds | None = None, progress: Shown = None, **options: Unpack[RenderOptions]) -> Picture:
        """Renders until the first limit is met; without one, 256 samples a pixel.

        error: the bound of the picture's error, 0.02 for 2 %. spp: samples per pixel. time: seconds, or "10m". size: (width, height).
        progress: True for a bar, or a function of a Progress, which this thread calls during the render; if it returns False, the render ends
        with the picture so far.
        Other options are those of `eclat render`. Ctrl-C ends the render, and KeyboardInterrupt is raised.
        """
        named = {"error": error, "spp": spp, "size": size, "time": time, **options}
        made = run("render", [self.path], texts("render", named), progress, wants_picture=True).picture
        return Picture(some(made))

    def render_frames(self, frames: tuple[int, ...] | str, output: Path, *, sheet: Path | None = None, progress: Shown = None,
                      **options: Unpack[FrameOptions]) -> list[dict[str, Any]]:
        """Renders an animation to files, one per frame. frames: (first, last), (first, last, step), or as the command line has it.
        output: a name with %d or %04d that ends in .exr or .png. sheet: a .png to write, with small pictures of all frames.
        Returns what `eclat render --json` reports, frame by frame and at the end."""
        return series([self.path], {"frames": frames, "output": output, "sheet": sheet, **options}, progress)

    def render_orbit(self, orbit: int, output: Path, *, sheet: Path | None = None, progress: Shown = None,
                     **options: Unpack[FrameOptions]) -> list[dict[str, Any]]:
        """Renders a turntable to files, as render_frames does: the camera goes round the scene once in so many frames. With fps, animations play."""
        return series([self.path], {"orbit": orbit, "output": output, "sheet": sheet, **options}, progress)

    def cost(self, *, budget: Seconds | None = None, html: Path | None = None, progress: Shown = None,
             **options: Unpack[CostOptions]) -> dict[str, Any]:
        """Returns which technique reaches an accuracy most cheaply: the figures of `eclat cost --json`. budget: of time, 120 seconds by default. html: a
        page to write, with charts and pictures."""
        named = texts("cost", {"budget": budget, "output": html, **options}, ("output",))
        found: dict[str, Any] = json.loads(run("cost", [self.path], [("json", "-"), *named], progress).reports[-1])
        return found


def load(path: Path) -> Scene:
    """Loads a glTF 2.0 scene, .gltf or .glb."""
    return Scene(path)


def render_all(scenes: Iterable[Scene | Path], output: Path, *, sheet: Path | None = None, shard: tuple[int, int] | str | None = None,
               progress: Shown = None, **options: Unpack[RenderOptions]) -> list[dict[str, Any]]:
    """Renders many scenes to files, with one device and its kernels; existing files are kept. output: a name that contains {name} or {folder}, which
    stand for the scene's. sheet: a .png to write, with small pictures of all. shard: (i, n), every n-th scene from the i-th on, counted from 1.
    Returns what `eclat render --json` reports, scene by scene and at the end. If a scene fails, the others are still rendered; Error is raised at
    the end."""
    paths = [scene.path if isinstance(scene, Scene) else scene for scene in scenes]
    return series(paths, {"output": output, "sheet": sheet, "shard": share(shard), **options}, progress)


def render_scenarios(file: Path, out: Path, *, shard: tuple[int, int] | str | None = None, progress: Shown = None,
                     **options: Unpack[RenderOptions]) -> list[dict[str, Any]]:
    """Renders the scenarios of a config.json into a folder, with a page and a contact sheet, as `eclat render --scenarios` does. Otherwise like
    render_all."""
    return series([], {"scenarios": file, "out": out, "shard": share(shard), **options}, progress)


def share(shard: tuple[int, int] | str | None) -> str | None:
    return shard if shard is None or isinstance(shard, str) else f"{shard[0]}/{shard[1]}"


def cost(scene: Scene | Path, /, *, budget: Seconds | None = None, html: Path | None = None,
         progress: Shown = None, **options: Unpack[CostOptions]) -> dict[str, Any]:
    """Like Scene.cost, but also takes a path."""
    return (scene if isinstance(scene, Scene) else Scene(scene)).cost(budget=budget, html=html, progress=progress, **options)


def merge(files: Iterable[Path], *, partial: bool = False, denoise: bool | str | None = None, exposure: float | str | None = None,
          tonemap: str | None = None) -> Picture:
    """Merges slices or checkpoints into one picture. Slices are pictures of Scene.render(samples=(a, b)), written by
    Picture.save. partial: even if samples are missing."""
    named = texts("merge", {"partial": partial, "denoise": denoise, "exposure": exposure, "tonemap": tonemap})
    made = run("merge", [os.fspath(file) for file in files], named, wants_picture=True).picture
    return Picture(some(made))


@dataclass(frozen=True)
class Device:
    """An OpenCL device. The option `device` takes its index or a part of its name."""
    index: int
    name: str
    type: str            # "CPU", "GPU", ...
    vendor: str
    driver: str
    platform: str
    compute_units: int
    memory_bytes: int
    is_usable: bool      # available, and with a compiler
    is_default: bool


def devices() -> list[Device]:
    """Returns every OpenCL device that eclat finds."""
    report = json.loads(run("devices", [], [("json", None)]).reports[-1])
    return [Device(**{name: device[name] for name in Device.__annotations__.keys() & device.keys()}, is_default=device["index"] == report["default"],
                   is_usable=device["available"] and device["compiler_available"]) for device in report["devices"]]
