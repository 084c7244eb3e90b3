"""Settings of a scene and passes of a view layer, as Blender properties."""
import bpy

from . import options


def of_row(row, entry):
    text = {"name": row.label, "description": options.description(entry)}
    if row.kind == "choice":
        return bpy.props.EnumProperty(items=[(name, name, "") for name in entry["choices"]], default=row.first, **text)
    if row.kind == "text":
        return bpy.props.StringProperty(default=row.first, **text)
    make = bpy.props.IntProperty if row.kind == "int" else bpy.props.FloatProperty
    if row.first == row.unset and row.least == 0:
        text["description"] += ". 0: not set"
    return make(default=row.first, min=int(row.least) if row.kind == "int" else row.least,
                max=int(min(row.most, 2**31 - 1)) if row.kind == "int" else row.most, **text)


class Settings(bpy.types.PropertyGroup):
    """scene.eclat: a property for each option of `eclat render`, and those of the add-on itself."""
    __annotations__ = {options.identifier(row.option): of_row(row, options.table()[row.option]) for row in options.ROWS}
    __annotations__.update(
        seed_is_frame=bpy.props.BoolProperty(name="Seed by Frame", default=True, description="Add the number of the frame to the seed of an animation's frames"),
        motion_steps=bpy.props.IntProperty(name="Motion Steps", default=3, min=2, max=33,
                                           description="Moments of the exposure at which the scene is exported; motion is linear in between"),
        update=bpy.props.FloatProperty(name="Update (s)", default=1.0, min=0.05, max=3600, description="Seconds between pictures while it renders"),
        keep=bpy.props.StringProperty(name="Keep Files In", default="", subtype="DIR_PATH",
                                      description="Folder for the exported scene, eclat's own picture, and the command that made it; left empty, they are deleted"),
        viewport_spp=bpy.props.IntProperty(name="Viewport Samples", default=64, min=1, max=1048576, description="Samples per pixel in the viewport"),
    )


class Passes(bpy.types.PropertyGroup):
    """view_layer.eclat: passes that only eclat has."""
    use_standard_error: bpy.props.BoolProperty(name="Standard Error", default=True, description="Standard error of each pixel's radiance")
    use_interval: bpy.props.BoolProperty(name="95 % Interval", default=False, description="Lower and upper end of each pixel's 95 % confidence interval")
    use_samples: bpy.props.BoolProperty(name="Samples", default=False, description="Samples that each pixel has")
    use_albedo: bpy.props.BoolProperty(name="Albedo", default=False, description="Base colour at the first surface, for denoisers")


def of_scene(settings, frame=None):
    """Returns the argument of options.words. frame: of an animation."""
    values = {options.identifier(row.option): getattr(settings, options.identifier(row.option)) for row in options.ROWS}
    if frame is not None and settings.seed_is_frame:
        values["seed"] += frame
    if values["filter"] == "box":
        values.pop("filter_width")
    return values


def passes_of(layer):
    """Returns the names in passes.TABLE that the view layer wants, besides Combined."""
    wanted = (("Depth", layer.use_pass_z), ("Normal", layer.use_pass_normal), ("DiffCol", layer.use_pass_diffuse_color), ("Albedo", layer.eclat.use_albedo),
              ("Standard Error", layer.eclat.use_standard_error), ("Low 95", layer.eclat.use_interval), ("High 95", layer.eclat.use_interval),
              ("Samples", layer.eclat.use_samples))
    return [name for name, is_wanted in wanted if is_wanted]


CLASSES = (Settings, Passes)
