"""Node trees that count."""
import bpy


def tree(owner, since=(5, 0)):
    """Of a material, world or light; None: it has none, or does not use it. since: the version from which on what is there is used."""
    if bpy.app.version < since and not owner.use_nodes:
        return None
    return owner.node_tree
