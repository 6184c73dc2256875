"""What independent readers find in ltcfit's exports, against the table file: readers.py LTCFIT SOURCE_DIR BUILD_WEB.

Channels must come back as the very float32 of the table file, halves as halves of the same values in every
container. Packed textures are compared with matrices inverted by NumPy, which rounds otherwise: to the condition
of the matrix times a few ulps.
"""
import json
import subprocess
import sys

import numpy as np
import OpenImageIO as oiio

LTCFIT, SOURCE, WEB = sys.argv[1:4]
failures = []


def run(*command):
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        failures.append(f"{' '.join(command)}: exit {done.returncode}: {done.stdout[-500:]}{done.stderr[-500:]}")
    return done.stdout


def check(what, good):
    print(("ok      " if good else "FAILED: ") + what)
    if not good:
        failures.append(what)


def export(table, output, *options):
    run(LTCFIT, "export", "-q", table, "-o", output, *options)


def same(a, b):
    a, b = np.asarray(a, np.float32), np.asarray(b, np.float32)
    return a.shape == b.shape and a.tobytes() == b.tobytes()


class Expected:
    """The table file, and the textures that follow from it."""

    def __init__(self, path):
        table = json.load(open(path))
        self.path = path
        self.channels = table["channels"]
        self.shape = [len(axis["values"]) for axis in table["axes"]]
        self.data = np.array(table["data"], np.float64).astype(np.float32).reshape(*self.shape, -1)
        m = np.zeros((*self.shape, 3, 3))
        for c, name in enumerate(self.channels):
            if name[0] == "m":
                m[..., int(name[1]), int(name[2])] = self.data[..., c]
        norm = self.data[..., self.channels.index("norm")]
        fresnel = self.data[..., self.channels.index("fresnel")]
        zero = np.zeros_like(norm)
        self.condition = np.linalg.cond(m)[..., None]
        if len(self.shape) == 2:
            inverse = np.linalg.inv(m)
            inverse /= inverse[..., 1:2, 1:2]
            self.matrix = [np.stack([inverse[..., r, c] for r, c in ((0, 0), (2, 0), (0, 2), (2, 2))], -1)]
            self.norm_fresnel = np.stack([norm, fresnel], -1)
        else:
            extra = [norm, fresnel, zero]
            self.matrix = [np.concatenate([m[..., r, :], extra[r][..., None]], -1) for r in range(3)]

    def packed_is(self, what, textures):
        """textures: (n, ..., 4) in the order of the axes."""
        textures = np.asarray(textures, np.float64)
        for t, matrix in enumerate(self.matrix):
            error = np.abs(textures[t].reshape(matrix.shape) - matrix)
            scale = np.abs(matrix).max(-1, keepdims=True)
            check(f"{what}: texture {t}", bool(np.all(error <= 4e-7 * np.minimum(self.condition, 1e4) * scale + 1e-7)))
        if len(self.shape) == 2:
            check(f"{what}: norm and Fresnel", same(textures[1].reshape(*self.shape, 4)[..., :2], self.norm_fresnel))


def check_npy(e, name):
    export(e.path, "a.npy")
    array = np.load("a.npy")
    check(f"{name} npy: shape and float32 values", array.shape == e.data.shape and same(array, e.data))
    export(e.path, "p.npy", "--layout", "packed")
    e.packed_is(f"{name} npy packed", np.load("p.npy"))
    export(e.path, "h.npy", "--layout", "packed", "--precision", "half")
    half = np.load("h.npy")
    check(f"{name} npy half: float16", half.dtype == np.float16 and bool(np.isfinite(half).all()))
    for layout, dtype in (("float", np.float32), ("half", np.float16)):
        export(e.path, "r.bin", "--precision", layout)
        raw = np.fromfile("r.bin", dtype)
        check(f"{name} bin {layout}", raw.tobytes() == np.load("p.npy" if layout == "float" else "h.npy").tobytes())
    return np.load("p.npy"), half


def read_exr(path):
    image = oiio.ImageBuf(path)
    spec = image.spec()
    pixels = image.get_pixels(oiio.FLOAT)
    return spec, {c: pixels[..., i] for i, c in enumerate(spec.channelnames)}


def check_exr(e, name, packed, half):
    rows = int(np.prod(e.shape[: len(e.shape) // 2]))
    export(e.path, f"{name}.exr")
    spec, channels = read_exr(f"{name}.exr")
    check(f"{name} exr: a channel for each coefficient", sorted(channels) == sorted(e.channels))
    for c, channel in enumerate(e.channels):
        if not same(channels[channel], e.data[..., c].reshape(rows, -1)):
            check(f"{name} exr: channel {channel}", False)
    attributes = {a.name: a.value for a in spec.extra_attribs}
    check(f"{name} exr: attributes", json.loads(attributes["ltcfit"])["format"] == "ltc-texture"
          and attributes["ltcCommand"].startswith("ltcfit fit"))
    for precision, expected in (("float", packed), ("half", half)):
        file = f"{name}_{precision}.exr"  # OpenImageIO keeps what it has read under a name
        export(e.path, file, "--layout", "packed", "--precision", precision)
        spec, channels = read_exr(file)
        check(f"{name} exr packed {precision}: type", str(spec.format) == precision)
        names = {"": 0, "amplitude.": 1, "row1.": 1, "row2.": 2}
        for channel, pixels in channels.items():
            prefix, letter = channel[:-1], "RGBA".index(channel[-1])
            if not same(pixels, expected[names[prefix]][..., letter].reshape(rows, -1)):
                check(f"{name} exr packed {precision}: {channel}", False)


def check_dds(e, name, packed, half):
    for header in ("dx10", "legacy"):
        for precision, expected in (("float", packed), ("half", half)):
            export(e.path, "a.dds", "--dds-header", header, "--precision", precision)
            split = header == "legacy" and len(e.shape) == 2
            files = ["a-1.dds", "a-2.dds"] if split else ["a.dds"]
            layers = 1 if split else 2 if len(e.shape) == 2 else 192
            found = []
            for file in files:
                report = run("nvddsinfo", file)
                text = run("node", f"{SOURCE}/tests/web/dds.mjs", file, str(layers), WEB)
                dds = json.loads(text)
                what = f"{name} dds {header} {precision}: {file}"
                check(f"{what}: header", dds["rest"] == 0 and dds["half"] == (precision == "half")
                      and (dds["width"], dds["height"]) == (e.shape[-1], e.shape[-2])
                      and f"Depth: {192 if len(e.shape) == 4 else 1}\n" in report
                      and ("DDSCAPS2_VOLUME" in report) == (len(e.shape) == 4))
                if header == "dx10":
                    check(f"{what}: DX10 header", ("R16G16B16A16_FLOAT" if precision == "half" else "R32G32B32A32_FLOAT")
                          in report and f"Array size: {2 if len(e.shape) == 2 else 1}\n" in report
                          and ("TEXTURE3D" if len(e.shape) == 4 else "TEXTURE2D") in report)
                found += dds["floats"]
            check(f"{name} dds {header} {precision}: numbers", same(np.array(found), expected.ravel()))


def check_ktx2(e, name, packed, half):
    layered = len(e.shape) == 2
    for precision, expected in (("float", packed), ("half", half)):
        for options in ((), ("--uncompressed",)):
            export(e.path, "a.ktx2", "--precision", precision, *options)
            json.dump({"vkFormat": 97 if precision == "half" else 109, "width": e.shape[-1], "height": e.shape[-2],
                       "depth": 0 if layered else 192, "layers": 2 if layered else 0,
                       "supercompression": 0 if options else 2,
                       "floats": [float(v) for v in expected.ravel()]}, open("expected.json", "w"))
            out = run("node", f"{SOURCE}/tests/web/ktx.mjs", "a.ktx2", "expected.json", WEB)
            check(f"{name} ktx2 {precision} {' '.join(options)}", "ltcfit: " in out and "KTXwriter: ltcfit" in out)


def check_sources(iso, packed):
    export(iso.path, "three.js", "--profile", "three")
    json.dump({"LTC_MAT_1": packed[0].ravel().tolist(), "LTC_MAT_2": packed[1].ravel().tolist()}, open("expected.json", "w"))
    run("node", f"{SOURCE}/tests/web/three_module.mjs", "three.js", "expected.json")
    # Blender's and Unreal's arrays, by a compiler
    export(iso.path, "eevee.cc", "--profile", "eevee")
    export(iso.path, "LTC.h", "--profile", "unreal")
    open("eevee_lut.hh", "w").write(
        "namespace blender::eevee::lut {\nextern const float ltc_mat_ggx[64][64][4];\n"
        "extern const float ltc_mag_ggx[64][64][2];\nextern const float ltc_disk_integral[64][64][1];\n}\n")
    open("main.cc", "w").write(
        '#include <cstdio>\n#include "eevee_lut.hh"\n#include "LTC.h"\nusing namespace blender::eevee::lut;\n'
        "int main() {\n  std::fwrite(ltc_mat_ggx, sizeof ltc_mat_ggx, 1, stdout);\n"
        "  std::fwrite(ltc_mag_ggx, sizeof ltc_mag_ggx, 1, stdout);\n"
        "  std::fwrite(ltc_disk_integral, sizeof ltc_disk_integral, 1, stdout);\n"
        "  std::fwrite(LTCMat, sizeof LTCMat, 1, stdout);\n  std::fwrite(LTCAmp, sizeof LTCAmp, 1, stdout);\n}\n")
    run("c++", "-Wall", "-Wextra", "-Werror", "main.cc", "eevee.cc", "-o", "main")
    out = np.frombuffer(subprocess.run(["./main"], capture_output=True).stdout, np.float32)
    expected = [packed[0].ravel(), packed[1][..., :2].ravel(), packed[1][..., 3].ravel(), packed[0].ravel(),
                packed[1][..., :2].ravel()]
    check("eevee and unreal: compiled arrays", same(out, np.concatenate(expected)))


def check_shader_includes(e, name):
    texture = "matrix" if len(e.shape) == 2 else "row0"
    export(e.path, f"{name}.glsl")
    export(e.path, f"{name}.hlsl")
    for version in ("330 core", "300 es"):
        with open("t.frag", "w") as f:
            f.write(f"#version {version}\n#ifdef GL_ES\nprecision highp float;\n#endif\n" + open(f"{name}.glsl").read()
                    + f"uniform int i;\nout vec4 colour;\nvoid main() {{ colour = {name}_{texture}[i % {name}_width]; }}\n")
        run("glslangValidator", "t.frag")
    with open("t.hlsl", "w") as f:
        f.write(open(f"{name}.hlsl").read()
                + f"float4 main(int i : A) : SV_Target {{ return {name}_{texture}[i % {name}_width]; }}\n")
    run("glslangValidator", "-D", "-V", "-S", "frag", "-e", "main", "t.hlsl", "-o", "t.spv")


def read_mips(path):
    """Metadata and levels of an EXR, by OpenImageIO."""
    file = oiio.ImageInput.open(path)
    levels = []
    while file.seek_subimage(0, len(levels)):
        pixels = file.read_image(0, len(levels), 0, 4, oiio.FLOAT)
        levels.append(np.asarray(pixels, np.float32))
    file.seek_subimage(0, 0)
    metadata = json.loads(file.spec().get_string_attribute("ltcfit"))
    kind = str(file.spec().format)
    file.close()
    return metadata, kind, levels


def check_light_texture():
    picture = np.random.default_rng(1).random((24, 32, 3), np.float32)
    spec = oiio.ImageSpec(32, 24, 3, oiio.FLOAT)
    out = oiio.ImageOutput.create("picture.exr")
    out.open("picture.exr", spec)
    out.write_image(picture)
    out.close()
    for precision, vk, dtype, texel in (("half", 97, np.float16, 8), ("float", 109, np.float32, 16)):
        name = f"light texture {precision}"
        for extension in ("exr", "dds", "ktx2"):
            run(LTCFIT, "prefilter", "-q", "picture.exr", f"--{precision}", "-o", f"light_{precision}.{extension}")
        metadata, kind, levels = read_mips(f"light_{precision}.exr")
        check(f"{name} exr: levels, type and metadata", [level.shape for level in levels]
              == [(64 >> l, 64 >> l, 4) for l in range(7)] and kind == precision and metadata["margin"] == 0.5)
        check(f"{name} exr: alpha", all(bool(np.all(level[..., 3] == 1)) for level in levels))
        # a constant would not tell; the broadest Gaussian is close to the picture's mean
        check(f"{name} exr: mean", bool(np.all(np.abs(levels[-1][0, 0, :3] - picture.mean((0, 1))) < 0.03))
              and float(levels[0].std()) > 0.05)
        numbers = np.concatenate([level.ravel() for level in levels])
        dds = open(f"light_{precision}.dds", "rb").read()
        report = run("nvddsinfo", f"light_{precision}.dds")
        check(f"{name} dds: header", "Mipmap count: 7\n" in report and "DDSCAPS_MIPMAP" in report
              and "DDSD_MIPMAPCOUNT" in report and "Width: 64\n" in report)
        check(f"{name} dds: numbers", same(np.frombuffer(dds[148:], dtype).astype(np.float32), numbers))
        for options in ((), ("--uncompressed",)):
            run(LTCFIT, "prefilter", "-q", "picture.exr", f"--{precision}", "-o", "light.ktx2", *options)
            json.dump({"vkFormat": vk, "width": 64, "height": 64, "depth": 0, "layers": 0, "levels": 7,
                       "supercompression": 0 if options else 2, "floats": [float(v) for v in numbers]},
                      open("expected.json", "w"))
            out = run("node", f"{SOURCE}/tests/web/ktx.mjs", "light.ktx2", "expected.json", WEB)
            check(f"{name} ktx2 {' '.join(options)}", "values as expected" in out and "ltc-light-texture" in out)


check_light_texture()
for kind in ("iso", "aniso"):
    table = Expected(f"{SOURCE}/data/ltc_{kind}.json")
    packed, half = check_npy(table, kind)
    check_exr(table, kind, packed, half)
    check_dds(table, kind, packed, half)
    check_ktx2(table, kind, packed, half)
    check_shader_includes(table, kind)
    if kind == "iso":
        check_sources(table, packed)
for failure in failures:
    print("FAILED:", failure)
sys.exit(1 if failures else 0)
