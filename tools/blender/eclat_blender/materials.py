"""Changes the materials of a glTF document to what Blender means. Pure functions."""
import math

from . import glb


def make_solid(document):
    """Adds a volume to transmission: in Blender it means a body, which refracts; in glTF it means a thin wall unless there is a volume too."""
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
    """Takes the root of the base colour. A path through a body meets two faces: Blender tints it by the base colour once for both, glTF at each."""
    if "baseColorTexture" not in base and "baseColorFactor" in base:
        base["baseColorFactor"] = [*map(math.sqrt, base["baseColorFactor"][:3]), base["baseColorFactor"][3]]
