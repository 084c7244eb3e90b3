"""Panels: eclat's options and passes, and those of Blender's own panels that affect eclat."""
import bpy

from . import options

ENGINE = "ECLAT"


class Panel(bpy.types.Panel):
    bl_space_type, bl_region_type, bl_context = "PROPERTIES", "WINDOW", "render"
    COMPAT_ENGINES = {ENGINE}

    @classmethod
    def poll(cls, context):
        return context.engine == ENGINE


EXTRA = {"limits": ("update", "viewport_spp"), "transport": ("seed_is_frame",), "device": ("keep",)}


def draw_options(self, context):
    layout = self.layout
    layout.use_property_split, layout.use_property_decorate = True, False
    for row in options.ROWS:
        if row.panel == self.eclat_panel:
            layout.prop(context.scene.eclat, options.identifier(row.option))
    for name in EXTRA.get(self.eclat_panel, ()):
        layout.prop(context.scene.eclat, name)


OPTIONS = tuple(type(f"ECLAT_PT_{name}", (Panel,), {"bl_label": title, "bl_idname": f"ECLAT_PT_{name}", "eclat_panel": name, "draw": draw_options})
                for name, title in options.PANELS)


class ECLAT_PT_motion(Panel):
    bl_label, bl_idname = "Motion Blur", "ECLAT_PT_motion"

    def draw_header(self, context):
        self.layout.prop(context.scene.render, "use_motion_blur", text="")

    def draw(self, context):
        layout, render = self.layout, context.scene.render
        layout.use_property_split, layout.use_property_decorate = True, False
        for owner, name in ((render, "motion_blur_position"), (render, "motion_blur_shutter"), (context.scene.eclat, "motion_steps")):
            if hasattr(owner, name):
                layout.prop(owner, name)


class ECLAT_PT_passes(Panel):
    bl_label, bl_idname, bl_context = "Passes", "ECLAT_PT_passes", "view_layer"

    def draw(self, context):
        layout, layer = self.layout, context.view_layer
        layout.use_property_split, layout.use_property_decorate = True, False
        for name in ("use_pass_z", "use_pass_normal", "use_pass_diffuse_color"):
            layout.prop(layer, name)
        for name in ("use_standard_error", "use_interval", "use_samples", "use_albedo"):
            layout.prop(layer.eclat, name)


CLASSES = (*OPTIONS, ECLAT_PT_motion, ECLAT_PT_passes)
# Settings of EEVEE that the exporter or this add-on reads.
EEVEES = {"EEVEE_MATERIAL_PT_context_material", "EEVEE_MATERIAL_PT_surface", "EEVEE_WORLD_PT_surface", "DATA_PT_EEVEE_light", "DATA_PT_camera_dof",
          "DATA_PT_camera_dof_aperture", "DATA_PT_EEVEE_light_distance", "EEVEE_NEXT_MATERIAL_PT_surface"}
shared = []


def share_blenders_own():
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", None)
        if engines is not None and ENGINE not in engines and ("BLENDER_RENDER" in engines or panel.__name__ in EEVEES):
            engines.add(ENGINE)
            shared.append(engines)


def unshare_blenders_own():
    while shared:
        shared.pop().discard(ENGINE)
