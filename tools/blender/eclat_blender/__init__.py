"""eclat as a render engine for Blender. register() loads the modules that import bpy, so that the others can be used and tested without Blender."""


def register():
    from . import registration
    registration.register()


def unregister():
    from . import registration
    registration.unregister()
