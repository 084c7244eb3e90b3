"""Materials of a glTF document as Blender means them. Pure functions."""
import math

from . import glb


def make_solid(document):
    """Blender's transmission is that of a body, which refracts; glTF's is that of a thin wall unless there is a volume too."""
    for material in document.get("materials", []):
        extensions = material.get("extensions", {})
        share = extensions.get("KHR_materials_transmission", {}).get("transmissionFactor", 0)
        if share <= 0 or "KHR_materials_volume" in extensions:
            continue
        extensions["KHR_materials_volume"] = {"thicknessFactor": 1.0}
        glb.use(document, "KHR_materials_volume")
        if share == 1:
            tint_once(material.get("pbrMetallicRoughness", {}))


def tint_once(base):
    """A path through a body meets two faces: Blender's Principled BSDF tints it by the base colour at both together, glTF at each."""
    if "baseColorTexture" not in base and "baseColorFactor" in base:
        base["baseColorFactor"] = [*map(math.sqrt, base["baseColorFactor"][:3]), base["baseColorFactor"][3]]
