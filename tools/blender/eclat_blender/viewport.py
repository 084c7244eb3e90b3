"""The rendered view of a 3D viewport. Drawing never waits: scenes are exported between events, and another process renders them."""
import atexit
import hashlib
import os
import time

import bpy

from . import export, losses, options, preferences, program, properties, session, view, world
from .trouble import Trouble

PAUSE = 0.3 # seconds without a change after which a scene is exported again
teller = losses.Teller()
shown = {} # viewports by the space that draws them, since an export makes Blender replace the engine


def of(space, engine):
    """Returns the viewport of a space, which lasts as long as the space shows rendered views."""
    key = space.as_pointer()
    viewport = shown[key] = shown.get(key) or Viewport(key)
    if not engine.has_begun:
        engine.has_begun = True
        viewport.engines += 1
    return viewport


class Viewport:
    def __init__(self, key):
        self.key = key
        self.engines = self.looked_at = 0 # how many engines have drawn it; how many of them have had a first look at the scene
        self.session = self.scene_words = self.texture = self.place = None
        self.changed_at, self.exported_at = time.monotonic(), None
        self.trouble = ""
        bpy.app.timers.register(self.tick, first_interval=0.01)

    def update(self, depsgraph):
        """Notes that the scene has changed, unless this is a new engine's first look, or the change comes from an export."""
        self.place = depsgraph.scene.original, depsgraph.view_layer.name
        is_first, self.looked_at = self.looked_at < self.engines, self.engines
        if not is_first and (self.exported_at is None or time.monotonic() - self.exported_at > PAUSE):
            self.changed_at = time.monotonic()

    def tick(self):
        """Called between events. Returns the seconds until the next call; None once the space shows something else."""
        if not any(space.as_pointer() == self.key and space.shading.type == "RENDERED" for space in views()):
            self.close()
        if shown.get(self.key) is not self:
            return None
        try:
            if self.changed_at is not None and self.place and time.monotonic() - self.changed_at > PAUSE and bpy.context.mode == "OBJECT":
                self.export()
            if self.session:
                self.take(self.session.poll())
        except Trouble as why:
            self.trouble = str(why)
        if self.session and (self.session.is_busy or self.trouble):
            redraw()
        return 0.1

    def export(self):
        scene, layer = self.place
        self.changed_at, self.trouble = None, ""
        self.session = self.session or session.Session(program.find(preferences.program()))
        folder = os.path.join(self.session.folder, "scene")
        os.makedirs(folder, exist_ok=True)
        try:
            path, _, _, _, lost = export.scene_to_file(scene, layer, folder, for_render=False)
        finally:
            self.exported_at = time.monotonic()
        kept = kept_as(path)
        environment, of_world = world.words(scene.world, folder)
        settings = {**properties.of_scene(scene.eclat), "error": 0, "time": 0, "spp": 0, "adaptive": "auto"}
        self.scene_words = [kept, *environment, *options.words(settings)]
        for line in teller.news([*losses.of_scene(scene, for_render=False), *lost, *of_world]):
            print(f"eclat renders without: {line}")
        redraw()

    def take(self, shot):
        if shot is None:
            return
        import gpu
        import numpy
        from . import passes
        pixels = numpy.ascontiguousarray(passes.combined(shot.planes), numpy.float32)
        height, width, _ = pixels.shape
        self.texture = gpu.types.GPUTexture((width, height), format="RGBA16F", data=gpu.types.Buffer("FLOAT", width * height * 4, pixels.reshape(-1)))

    def draw(self, engine, context, depsgraph):
        import gpu
        from gpu_extras.presets import draw_texture_2d
        region, data, scene = context.region, context.region_data, depsgraph.scene
        self.place = scene.original, depsgraph.view_layer.name
        size = (region.width, region.height)
        if self.session and self.scene_words:
            words = view.words(data.view_matrix.inverted(), data.window_matrix, size)
            self.session.show(self.scene_words, words[1:], size, scene.eclat.viewport_spp)
        if self.texture:
            gpu.state.blend_set("NONE")
            engine.bind_display_space_shader(scene)
            draw_texture_2d(self.texture, (0, 0), *size)
            engine.unbind_display_space_shader()
        engine.update_stats("", self.status())

    def status(self):
        return self.trouble or (self.session.status if self.session else "exporting")

    def close(self):
        shown.pop(self.key, None)
        if self.session:
            self.session.close()


@atexit.register
def close_all():
    for viewport in list(shown.values()):
        viewport.close()


def kept_as(path):
    """Gives the same scene the same name, so that nothing starts again if an export brings nothing new."""
    with open(path, "rb") as file:
        name = f"{hashlib.sha256(file.read()).hexdigest()[:16]}.glb"
    kept = os.path.join(os.path.dirname(path), name)
    os.replace(path, kept)
    return kept


def views():
    """Returns the spaces of all 3D views on the screen."""
    return [area.spaces.active for area in areas()]


def areas():
    return [area for window in bpy.context.window_manager.windows for area in window.screen.areas if area.type == "VIEW_3D"]


def redraw():
    for area in areas():
        area.tag_redraw()
