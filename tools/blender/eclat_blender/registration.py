"""Registers this add-on with Blender."""
import bpy

from . import engine, panels, preferences, properties, viewport

CLASSES = (*preferences.CLASSES, *properties.CLASSES, *panels.CLASSES, *engine.CLASSES)


def register():
    for one in CLASSES:
        bpy.utils.register_class(one)
    bpy.types.Scene.eclat = bpy.props.PointerProperty(type=properties.Settings)
    bpy.types.ViewLayer.eclat = bpy.props.PointerProperty(type=properties.Passes)
    panels.share_blenders_own()


def unregister():
    viewport.close_all()
    panels.unshare_blenders_own()
    del bpy.types.ViewLayer.eclat
    del bpy.types.Scene.eclat
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
