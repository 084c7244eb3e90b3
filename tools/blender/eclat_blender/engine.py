"""The render engine."""
import bpy

from . import final, passes, properties, viewport
from .trouble import Trouble


class Engine(bpy.types.RenderEngine):
    bl_idname, bl_label = "ECLAT", "eclat"
    bl_use_preview = False
    bl_use_eevee_viewport = True           # for material previews
    bl_use_shading_nodes_custom = False
    bl_use_postprocess = True
    has_begun = False                      # has begun to draw a viewport

    def update_render_passes(self, scene=None, renderlayer=None):
        self.register_pass(scene, renderlayer, "Combined", 4, "RGBA", "COLOR")
        for name in properties.passes_of(renderlayer):
            count, channels, kind, _, _ = passes.TABLE[name]
            self.register_pass(scene, renderlayer, name, count, channels, kind)

    def render(self, depsgraph):
        layer = depsgraph.view_layer
        for name in properties.passes_of(layer):
            self.add_pass(name, *passes.TABLE[name][:2], layer=layer.name)
        try:
            final.render(self, depsgraph)
        except Trouble as why:
            self.fail(str(why))
        except OSError as why:
            self.fail(f"{why.filename}: {why.strerror}" if why.filename else str(why))
        except Exception as why:  # whatever it is, the user gets a line, not a traceback
            self.fail(f"internal error: {type(why).__name__}: {why}")

    def fail(self, line):
        """Reports a failure to Blender, which then writes no picture and renders no more frames."""
        self.report({"ERROR"}, line)

    def view_update(self, context, depsgraph):
        viewport.of(context.space_data, self).update(depsgraph)

    def view_draw(self, context, depsgraph):
        viewport.of(context.space_data, self).draw(self, context, depsgraph)


CLASSES = (Engine,)
