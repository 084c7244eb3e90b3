"""The preference that says where the program is."""
import bpy


class Preferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: bpy.props.StringProperty(
        name="Program", subtype="FILE_PATH",
        description="The program eclat. If empty, it comes from the environment variable ECLAT, an installed Python package eclat, or PATH")

    def draw(self, context):
        self.layout.prop(self, "program")


def program():
    """Returns the preference; nothing if a script registered the add-on."""
    addon = bpy.context.preferences.addons.get(__package__)
    return addon.preferences.program if addon and addon.preferences else ""


CLASSES = (Preferences,)
