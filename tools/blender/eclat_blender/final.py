"""A final render: exports the scene, runs the program, shows the picture so far, hands over the passes and the error."""
import contextlib
import os
import shlex
import shutil
import tempfile

import bpy

from . import camera, export, losses, main_thread, options, passes, preferences, program, properties, world
from .process import Process, is_known

teller = losses.Teller()


# All questions and messages to Blender, in one place.

def is_cancelled(engine):
    return engine.test_break()


def say(engine, line):
    engine.update_stats("", line)


def report(engine, kind, line):
    engine.report({kind}, line)


def prepare(scene, layer, is_animation, folder):
    """Runs in the main thread. Returns the arguments of `eclat render`, the scene's path first; lens, frame, passes, and what was lost."""
    path, shutter, lens, frame, lost = export.scene_to_file(scene, layer, folder)
    environment, of_world = world.words(scene.world, folder)
    view_layer = scene.view_layers[layer]
    wanted = properties.passes_of(view_layer)
    words = [path, *camera.words(lens, frame), *shutter, *environment, passes.channels(wanted),
             *options.words(properties.of_scene(scene.eclat, scene.frame_current if is_animation else None))]
    return words, lens, frame, wanted, [*losses.of_scene(scene), *lost, *of_world]


def render(engine, depsgraph):
    scene, layer = depsgraph.scene.original, depsgraph.view_layer.name
    found = program.find(preferences.program())
    with place(scene, layer) as folder:
        say(engine, "exporting")
        prepared = main_thread.call(lambda: prepare(scene, layer, engine.is_animation, folder), lambda: is_cancelled(engine))
        if prepared is None:
            return
        words, lens, frame, wanted, lost = prepared
        new = teller.news(lost)
        if new:
            report(engine, "WARNING", "eclat renders without: " + "; ".join(new))
        command = [found, "render", *words]
        if scene.eclat.keep:
            with open(os.path.join(folder, "command.txt"), "w", encoding="utf-8") as file:
                file.write(shlex.join(command) + "\n")
        process = Process(command, folder, scene.eclat.update)
        try:
            follow(engine, process, layer, frame, scene.eclat.spp)
            deliver(engine, process, layer, lens, frame, wanted)
        finally:
            process.kill()


@contextlib.contextmanager
def place(scene, layer):
    """Yields a folder for the files of this frame: a temporary one, or one inside the folder that the user has named."""
    if scene.eclat.keep:
        kept = os.path.join(bpy.path.abspath(scene.eclat.keep), f"{bpy.path.clean_name(layer)}.{scene.frame_current:04d}")
        os.makedirs(kept, exist_ok=True)
        for name in ("picture.exr", "snapshot.exr"):
            with contextlib.suppress(FileNotFoundError):
                os.remove(os.path.join(kept, name))
        yield kept
        return
    folder = tempfile.mkdtemp(prefix="eclat-blender-")
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def follow(engine, process, layer, frame, samples):
    """Follows the program until it ends. samples: the number at which it ends; 0: another limit ends it."""
    while process.is_running():
        process.wait(0.05)
        if is_cancelled(engine):
            process.stop()
        for line in process.news():
            if not line.startswith("warning: "):
                say(engine, line)
        shot = process.look()
        if shot:
            say(engine, shot.figures())
            if samples:
                engine.update_progress(min(1.0, shot.samples / samples))
            show(engine, layer, frame, {"Combined": passes.combined(shot.planes)})


def deliver(engine, process, layer, lens, frame, wanted):
    shot = process.result()
    for line in process.warnings():
        report(engine, "WARNING", line)
    if shot is None:
        return
    along = camera.along_axis(lens, frame)
    made = {name: passes.make(name, shot.planes, along) for name in wanted}
    show(engine, layer, frame, {"Combined": passes.combined(shot.planes), **made}, stamp=stamp(shot.attributes))
    say(engine, shot.figures())
    report(engine, "INFO", f"eclat: {shot.figures()}" + (f" ({shot.attributes['eclat.errorBoundWhy']})" if "eclat.errorBoundWhy" in shot.attributes else ""))


def stamp(attributes):
    """Returns metadata of the picture for EXR and PNG files: all that eclat's own file says about itself."""
    found = {name: value for name, value in attributes.items() if name.startswith("eclat.")}
    return {name: value if isinstance(value, str) else f"{value:.9g}" for name, value in found.items() if isinstance(value, str) or is_known(value)}


def show(engine, layer, frame, planes, stamp=None):
    """Puts these passes into Blender's picture."""
    width, height = camera.size(frame)
    result = engine.begin_result(0, 0, width, height, layer=layer)
    if not result.layers:
        engine.end_result(result, cancel=True)
        return
    for one in result.layers[0].passes:
        plane = planes.get(one.name)
        if plane is not None and plane.shape[:2] == (height, width):
            one.rect.foreach_set(plane.astype("f").reshape(-1))
    engine.end_result(result)
    for name, value in (stamp or {}).items():
        engine.get_result().stamp_data_add_field(name, value)
