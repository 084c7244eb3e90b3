"""eclat as a render engine. Modules that import bpy are loaded by register(), so that the others can be used and tested without Blender."""


def register():
    from . import registration
    registration.register()


def unregister():
    from . import registration
    registration.unregister()
