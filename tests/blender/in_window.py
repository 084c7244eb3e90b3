"""Steps for Blender's window (test_window.py), one after the other. Each begins when the condition of the one before has come true."""
import os
import sys
import traceback

import bpy

viewport = sys.modules["bl_ext.user_default.eclat_blender.viewport"]
exports = []
whole_export = viewport.Viewport.export


def counted_export(self):
    exports.append(self.key)
    return whole_export(self)


viewport.Viewport.export = counted_export


def space():
    return viewport.views()[0]


def only():
    """The only viewport, or None."""
    return next(iter(viewport.shown.values()), None)


def is_rendered(exported):
    """Tells whether the complete picture is there, after so many exports."""
    one = only()
    return one and one.texture and not one.session.is_busy and len(exports) == exported and one.status().startswith("64 samples, error ")


def steps():
    """Yields the conditions to wait for."""
    scene = bpy.context.scene
    scene.render.engine = "ECLAT"
    scene.render.resolution_x, scene.render.resolution_y, scene.eclat.viewport_spp = 64, 48, 64
    bpy.ops.mesh.primitive_plane_add(size=30, location=(0, 0, -1))
    space().region_3d.view_perspective = "CAMERA"
    space().shading.type = "RENDERED"
    yield lambda: is_rendered(1)
    first = only().texture
    space().region_3d.view_perspective = "PERSP"  # the scene is the same: nothing is exported
    yield lambda: is_rendered(1) and only().texture is not first
    second = only().texture
    bpy.data.objects["Cube"].location.z += 2
    yield lambda: is_rendered(2) and only().texture is not second
    space().shading.type = "SOLID"
    yield lambda: not viewport.shown
    space().shading.type = "RENDERED"  # changes made meanwhile show
    yield lambda: is_rendered(3)
    space().shading.type = "SOLID"
    yield lambda: not viewport.shown
    ended = []
    bpy.app.handlers.render_complete.append(lambda *_: ended.append(True))
    window = bpy.context.window_manager.windows[0]
    with bpy.context.temp_override(window=window):
        bpy.ops.render.render("INVOKE_DEFAULT", use_viewport=False)
    yield lambda: ended and not bpy.app.is_job_running("RENDER")
    assert tuple(bpy.data.images["Render Result"].size) in ((64, 48), (0, 0))


under_way = steps()
waited_for = [lambda: True]


def tick():
    try:
        if waited_for[0]():
            waited_for[0] = next(under_way, None)
            if waited_for[0] is None:
                print("\nall steps passed", flush=True)
                os._exit(0)
        return 0.1
    except BaseException:
        traceback.print_exc()
        sys.stdout.flush()
        os._exit(1)


bpy.context.preferences.view.show_splash = False
bpy.app.timers.register(tick, first_interval=1)
