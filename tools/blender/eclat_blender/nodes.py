"""Finds the node trees that are in use."""
import bpy


def tree(owner, since=(5, 0)):
    """Returns the node tree of a material, world or light; None: it has none, or does not use it. since: the version from which on a tree is always used."""
    if bpy.app.version < since and not owner.use_nodes:
        return None
    return owner.node_tree
