#!/usr/bin/env python3
"""Writes the scenes of data/scenes into a folder: python3 scripts/make_scenes.py data/scenes

Quads with the materials of Khronos sample models (see data/scenes/README.md); the same bytes every time.
"""
import base64
import json
import math
import pathlib
import struct
import sys
import zlib


def png(width, height, texel):
    """RGBA, 8 bits; not compressed, so that the bytes do not depend on zlib."""
    rows = b"".join(b"\0" + b"".join(bytes(texel(x, y)) for x in range(width)) for y in range(height))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    stored = zlib.compressobj(0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", stored.compress(rows) + stored.flush())
            + chunk(b"IEND", b""))


def grey_jpeg(blocks):
    """A baseline JPEG of flat 8 x 8 blocks with the grey values given row by row."""
    def segment(marker, data):
        return b"\xff" + bytes([marker]) + struct.pack(">H", len(data) + 2) + data

    height, width = len(blocks), len(blocks[0])
    # one code length for each of the 12 size categories of differences: 4 bits
    dc_codes = bytes([0, 0, 0, 12] + [0] * 12) + bytes(range(12))
    end_of_block = bytes([1] + [0] * 15) + b"\0"
    bits = ""
    last = 0
    for row in blocks:
        for grey in row:
            # the mean of a block is 128 + dc * 8 / 8
            difference = (grey - 128) - last
            last = grey - 128
            size = abs(difference).bit_length()
            value = difference if difference >= 0 else difference + (1 << size) - 1
            bits += f"{size:04b}" + (f"{value:0{size}b}" if size else "") + "0"
    bits += "1" * (-len(bits) % 8)
    scan = int(bits, 2).to_bytes(len(bits) // 8, "big").replace(b"\xff", b"\xff\0")
    return (b"\xff\xd8" + segment(0xDB, b"\0" + bytes([8] * 64))
            + segment(0xC0, struct.pack(">BHHBBBB", 8, 8 * height, 8 * width, 1, 1, 0x11, 0))
            + segment(0xC4, b"\0" + dc_codes) + segment(0xC4, b"\x10" + end_of_block)
            + segment(0xDA, bytes([1, 1, 0, 0, 63, 0])) + scan + b"\xff\xd9")


class Scene:
    """A glTF file of unit quads in the plane z = 0, side by side."""

    def __init__(self):
        self.json = {"asset": {"version": "2.0", "generator": "ltcfit scripts/make_scenes.py"}, "scene": 0,
                     "scenes": [{"nodes": []}], "nodes": [], "meshes": [], "materials": [], "accessors": [],
                     "bufferViews": [], "buffers": []}
        self.data = b""
        self.shared = {}

    def view(self, data, target=None):
        self.data += b"\0" * (-len(self.data) % 4)
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)}
        if target:
            view["target"] = target
        self.data += data
        self.json["bufferViews"].append(view)
        return len(self.json["bufferViews"]) - 1

    def accessor(self, kind, component, numbers, width, **more):
        key = (kind, component, tuple(numbers))
        if key not in self.shared:
            code = {5126: "f", 5123: "H"}[component]
            accessor = {"bufferView": self.view(struct.pack(f"<{len(numbers)}{code}", *numbers),
                                                34963 if kind == "SCALAR" else 34962),
                        "componentType": component, "count": len(numbers) // width, "type": kind, **more}
            self.json["accessors"].append(accessor)
            self.shared[key] = len(self.json["accessors"]) - 1
        return self.shared[key]

    def quad(self, material, uv=(0.0, 0.0, 1.0, 1.0), scale=1.0):
        """Puts the part of the texture from (u0, v0) to (u1, v1) onto a quad of side `scale`."""
        u0, v0, u1, v1 = uv
        attributes = {
            "POSITION": self.accessor("VEC3", 5126, [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0], 3, min=[0, 0, 0],
                                      max=[1, 1, 0]),
            "NORMAL": self.accessor("VEC3", 5126, [0, 0, 1] * 4, 3),
            "TANGENT": self.accessor("VEC4", 5126, [1, 0, 0, 1] * 4, 4),
            "TEXCOORD_0": self.accessor("VEC2", 5126, [u0, v1, u1, v1, u1, v0, u0, v0], 2)}
        indices = self.accessor("SCALAR", 5123, [0, 1, 2, 0, 2, 3], 1)
        self.json["materials"].append(material)
        self.json["meshes"].append({"primitives": [
            {"attributes": attributes, "indices": indices, "material": len(self.json["materials"]) - 1}]})
        node = {"mesh": len(self.json["meshes"]) - 1, "translation": [1.25 * len(self.json["nodes"]), 0, 0]}
        if scale != 1.0:
            node["scale"] = [scale, scale, scale]
        self.json["nodes"].append(node)
        self.json["scenes"][0]["nodes"].append(len(self.json["nodes"]) - 1)

    def image(self, image, **sampler):
        for key in ("images", "textures"):
            self.json.setdefault(key, [])
        self.json["images"].append(image)
        texture = {"source": len(self.json["images"]) - 1}
        if sampler:
            self.json.setdefault("samplers", []).append(sampler)
            texture["sampler"] = len(self.json["samplers"]) - 1
        self.json["textures"].append(texture)
        return {"index": len(self.json["textures"]) - 1}

    def embedded(self, data):
        return {"bufferView": self.view(data), "mimeType": "image/png"}

    def text(self):
        used = sorted({name for material in self.json["materials"] for name in material.get("extensions", {})})
        if used:
            self.json["extensionsUsed"] = used
        return json.dumps(self.json, separators=(",", ":"))

    def gltf(self):
        self.json["buffers"] = [{"byteLength": len(self.data), "uri": "data:application/octet-stream;base64,"
                                 + base64.b64encode(self.data).decode()}]
        return self.text().encode() + b"\n"

    def glb(self):
        self.data += b"\0" * (-len(self.data) % 4)
        self.json["buffers"] = [{"byteLength": len(self.data)}]
        text = self.text().encode()
        text += b" " * (-len(text) % 4)
        body = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(self.data), 0x004E4942)
        return struct.pack("<4sII", b"glTF", 2, 12 + len(body) + len(self.data)) + body + self.data


def anisotropic(strength, **more):
    return {"KHR_materials_anisotropy": {"anisotropyStrength": strength, **more}}


def lamp():
    """AnisotropyBarnLamp: brushed metal under a coat, a filament that emits, clear glass."""
    scene = Scene()
    # rings of roughness 0.2 to 0.5 on the metal; the outer texels are not used
    rough = scene.image(scene.embedded(png(16, 16, lambda x, y: (255, 51 + 5 * min(x, 15), 255, 255))))
    brushed = scene.image(scene.embedded(png(8, 8, lambda x, y: (255, 128, 255 if y < 4 else 128, 255))))
    scene.quad({"name": "Lamp Metal", "pbrMetallicRoughness": {"metallicRoughnessTexture": rough},
                "extensions": {**anisotropic(1, anisotropyRotation=0, anisotropyTexture=brushed),
                               "KHR_materials_clearcoat": {"clearcoatFactor": 0.25,
                                                           "clearcoatRoughnessFactor": 0.15}}},
               uv=(0.125, 0.125, 0.875, 0.875))
    scene.quad({"name": "Lamp Filament", "emissiveFactor": [1, 0.5, 0.25],
                "pbrMetallicRoughness": {"baseColorFactor": [0.09, 0.09, 0.09, 1], "metallicFactor": 0,
                                         "roughnessFactor": 0.7},
                "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 25}}}, scale=0.25)
    scene.quad({"name": "Lamp Glass", "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0},
                "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}}}, scale=0.5)
    return scene.glb()


def discs():
    """AnisotropyDiscTest: roughness 0 to 1 in steps of 0.1, directions and strength from one texture."""
    scene = Scene()
    texture = scene.image({"uri": "discs.png"})
    for i in range(11):
        scene.quad({"name": f"roughness {i / 10}", "pbrMetallicRoughness": {"roughnessFactor": i / 10},
                    "extensions": anisotropic(1, anisotropyTexture=texture)})

    def turning(x, y):
        angle = math.atan2(y - 3.5, x - 3.5)
        return (round(127.5 + 127.5 * math.cos(angle)), round(127.5 + 127.5 * math.sin(angle)), 255, 255)

    return scene.gltf(), png(8, 8, turning)


def strengths():
    """AnisotropyStrengthTest: 7 x 7 of roughness and strength, factors only."""
    scene = Scene()
    for i in range(7):
        for k in range(7):
            scene.quad({"name": f"roughness {i}/6, strength {k}/6", "pbrMetallicRoughness": {"roughnessFactor": i / 6},
                        "extensions": anisotropic(k / 6)})
    return scene.gltf()


def metal_rough():
    """A plain textured material, on the left half of an atlas whose other half is black."""
    scene = Scene()
    rough = scene.image({"uri": "metal_rough.png"}, wrapS=33071, wrapT=33071)
    color = scene.image({"uri": "metal_rough.jpg"}, wrapS=33071, wrapT=33071)
    scene.quad({"name": "worn steel", "pbrMetallicRoughness": {"metallicRoughnessTexture": rough,
                                                              "baseColorTexture": color}},
               uv=(0.0, 0.0, 0.4375, 1.0))
    atlas = png(16, 16, lambda x, y: (0, 0, 0, 255) if x >= 8 else (255, 64 + 8 * y, 255, 255))
    return scene.gltf(), atlas, grey_jpeg([[160, 0], [200, 0]])


def plain():
    """One dielectric of one roughness."""
    scene = Scene()
    scene.quad({"name": "satin", "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.4}})
    return scene.gltf()


def clearcoat():
    """ClearCoatCarPaint: half metal under a smooth coat; and a coat from textures."""
    scene = Scene()
    coat = scene.image({"uri": "data:image/png;base64," + base64.b64encode(
        png(4, 4, lambda x, y: (255 if x < 2 else 0, 26 * (y + 1), 0, 255))).decode()})
    scene.quad({"name": "Clear Coat Car Paint",
                "pbrMetallicRoughness": {"baseColorFactor": [0.7, 0, 0, 1], "metallicFactor": 0.3,
                                         "roughnessFactor": 0.4},
                "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0}}})
    scene.quad({"name": "half varnished", "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.9},
                "extensions": {"KHR_materials_clearcoat": {
                    "clearcoatFactor": 1, "clearcoatRoughnessFactor": 1, "clearcoatTexture": coat,
                    "clearcoatRoughnessTexture": coat}}})
    return scene.gltf()


def emissive():
    """A floor, a panel that emits, and a screen that emits a picture on both sides."""
    scene = Scene()
    picture = scene.image({"uri": "discs.png"})
    scene.quad({"name": "floor", "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.3}}, scale=4.0)
    scene.quad({"name": "panel", "emissiveFactor": [1, 1, 1],
                "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 1}})
    scene.quad({"name": "screen", "emissiveFactor": [1, 1, 1], "emissiveTexture": picture, "doubleSided": True,
                "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.2}})
    return scene.gltf()


def lobby():
    """The other form: a description by hand."""
    return (json.dumps({
        "format": "ltc-scene", "version": 1, "name": "lobby",
        "materials": [
            {"name": "marble", "roughness": [0.1, 0.3], "area": 40},
            {"name": "lift doors", "roughness": 0.35, "anisotropy": [0.4, 0.8], "f0": 0.6, "area": 8},
            {"name": "carpet", "roughness": {"values": [0.8, 0.9], "weights": [3, 1]}, "area": 25},
            {"name": "plate", "roughness": {"image": "metal_rough.png", "channel": "g", "scale": 0.5}, "f0": [0.5, 0.7],
             "area": 2},
            {"name": "brushed rail", "alpha_x": 0.3, "alpha_y": 0.1, "f0": 0.7, "area": 1}],
        "lights": ["polygon", "disk"], "light_sides": ["one"], "views": [0, 85]}, indent=1) + "\n").encode()


def satin():
    """The middle of the roughness axis, which most painted and worn metal has."""
    return (json.dumps({
        "format": "ltc-scene", "version": 1, "name": "satin",
        "materials": [{"name": "satin metal", "roughness": [0.3, 0.7], "f0": 0.6}],
        "lights": ["polygon"], "light_sides": ["one"]}, indent=1) + "\n").encode()


def brushed():
    """Brushed metals of several grits and strengths."""
    return (json.dumps({
        "format": "ltc-scene", "version": 1, "name": "brushed",
        "materials": [{"name": "brushed metal", "roughness": [0.3, 0.5], "anisotropy": [0.4, 0.7], "f0": 0.6}],
        "lights": ["polygon"], "light_sides": ["one"]}, indent=1) + "\n").encode()


def main():
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    discs_gltf, discs_png = discs()
    steel_gltf, steel_png, steel_jpg = metal_rough()
    for name, data in {"lamp.glb": lamp(), "discs.gltf": discs_gltf, "discs.png": discs_png,
                       "strengths.gltf": strengths(), "metal_rough.gltf": steel_gltf, "metal_rough.png": steel_png,
                       "metal_rough.jpg": steel_jpg, "plain.gltf": plain(), "clearcoat.gltf": clearcoat(),
                       "emissive.gltf": emissive(), "lobby.json": lobby(), "satin.json": satin(),
                       "brushed.json": brushed()}.items():
        (folder / name).write_bytes(data)


if __name__ == "__main__":
    main()
