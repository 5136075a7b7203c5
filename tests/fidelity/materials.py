"""What the materials of a glTF file are: glass, cloth, coat, metal."""

import base64
import io
import json
import struct
import urllib.parse

import numpy
from PIL import Image, UnidentifiedImageError

KINDS = ("glass", "cloth", "coat", "metal")
LEAST_METALNESS = 0.5
JSON_CHUNK, BINARY_CHUNK = 0x4E4F534A, 0x004E4942


def read(path):
    """The document and the binary chunk of a .gltf or .glb file."""
    data = path.read_bytes()
    if data[:4] != b"glTF":
        return json.loads(data), b""
    chunks, at = {}, 12
    while at + 8 <= len(data):
        length, kind = struct.unpack_from("<II", data, at)
        chunks[kind] = data[at + 8:at + 8 + length]
        at += 8 + length
    return json.loads(chunks[JSON_CHUNK]), chunks.get(BINARY_CHUNK, b"")


def resource(uri, folder):
    if uri.startswith("data:"):
        return base64.b64decode(uri.partition(",")[2])
    return (folder / urllib.parse.unquote(uri)).read_bytes()


def image_of(document, binary, folder, texture):
    """The decoded image of a texture, or None where Pillow cannot read it (KTX2)."""
    image = document["images"][document["textures"][texture].get("source", 0)]
    if "uri" in image:
        data = resource(image["uri"], folder)
    else:
        view = document["bufferViews"][image["bufferView"]]
        uri = document["buffers"][view["buffer"]].get("uri")
        buffer = resource(uri, folder) if uri else binary
        data = buffer[view.get("byteOffset", 0):][:view["byteLength"]]
    try:
        return numpy.asarray(Image.open(io.BytesIO(data)).convert("RGB"))
    except UnidentifiedImageError:
        return None


def metalness(material, texture_image):
    """The mean of a material: its factor times the texture's blue channel (glTF 2.0, 3.9.2)."""
    surface = material.get("pbrMetallicRoughness", {})
    factor = surface.get("metallicFactor", 1.0)
    if factor < LEAST_METALNESS or "metallicRoughnessTexture" not in surface:
        return factor
    image = texture_image(surface["metallicRoughnessTexture"]["index"])
    return factor if image is None else factor * float(image[..., 2].mean()) / 255.0


def is_metal(material, texture_image):
    others = ("KHR_materials_unlit", "KHR_materials_pbrSpecularGlossiness")
    if any(name in material.get("extensions", {}) for name in others):
        return False
    return metalness(material, texture_image) >= LEAST_METALNESS


def kinds_of(path):
    """The kinds among a file's materials, in the order of KINDS."""
    document, binary = read(path)
    found = set()
    for material in document.get("materials", []):
        extensions = material.get("extensions", {})
        if extensions.get("KHR_materials_transmission", {}).get("transmissionFactor", 0.0) > 0.0:
            found.add("glass")
        if any(extensions.get("KHR_materials_sheen", {}).get("sheenColorFactor", ())):
            found.add("cloth")
        if extensions.get("KHR_materials_clearcoat", {}).get("clearcoatFactor", 0.0) > 0.0:
            found.add("coat")
        if "metal" not in found and is_metal(
                material, lambda index: image_of(document, binary, path.parent, index)):
            found.add("metal")
    return [kind for kind in KINDS if kind in found]
