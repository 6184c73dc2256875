#include "scene/gltf_material.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "export/atomic_file.h"
#include "scene/texel_image.h"

namespace ltcfit {
namespace {

using Rgb = std::array<double, 3>;
using tinygltf::Value;

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

// Fields of an object, with messages that name them.
class Fields {
 public:
  Fields(const Value& object, std::string where, std::vector<std::string>& notes)
      : object_(object), where_(std::move(where)), notes_(notes) {}

  double number(const char* key, double otherwise, double high = 1.0) {
    if (!object_.Has(key)) return otherwise;
    const Value& value = object_.Get(key);
    if (!value.IsNumber()) throw InputError(fmt::format("{}: {} is not a number", where_, key));
    return clamped(value.GetNumberAsDouble(), key, high);
  }

  Rgb color(const char* key, double high = 1.0) {
    if (!object_.Has(key)) return {1.0, 1.0, 1.0};
    const Value& value = object_.Get(key);
    if (!value.IsArray() || value.ArrayLen() < 3)
      throw InputError(fmt::format("{}: {} is not a colour", where_, key));
    Rgb out{};
    for (int i = 0; i < 3; ++i) {
      if (!value.Get(i).IsNumber()) throw InputError(fmt::format("{}: {} is not a colour", where_, key));
      out[static_cast<std::size_t>(i)] = clamped(value.Get(i).GetNumberAsDouble(), key, high);
    }
    return out;
  }

  double clamped(double value, const char* key, double high) {
    const double to = std::clamp(value, 0.0, high);
    if (to != value)
      notes_.push_back(
          fmt::format("{}: {} is {}, out of its range, and was taken as {}.", where_, key, value, to));
    return to;
  }

  TextureUse texture(const char* key) {
    TextureUse use;
    if (!object_.Has(key)) return use;
    const Value& info = object_.Get(key);
    if (!info.IsObject() || !info.Get("index").IsInt())
      throw InputError(fmt::format("{}: {} has no index", where_, key));
    use.texture = info.Get("index").GetNumberAsInt();
    if (use.texture < 0) throw InputError(fmt::format("{}: {} has index {}", where_, key, use.texture));
    readSet(info, key, use);
    if (info.Get("extensions").IsObject() && info.Get("extensions").Has("KHR_texture_transform"))
      readTransform(info.Get("extensions").Get("KHR_texture_transform"), use);
    return use;
  }

  TextureUse texture(const char* key, const tinygltf::TextureInfo& info) {
    TextureUse use;
    use.texture = info.index;
    use.texCoord = info.texCoord;
    if (info.index < -1) throw InputError(fmt::format("{}: {} has index {}", where_, key, info.index));
    const auto transform = info.extensions.find("KHR_texture_transform");
    if (transform != info.extensions.end()) readTransform(transform->second, use);
    return use;
  }

 private:
  void readTransform(const Value& transform, TextureUse& use) const {
    if (!transform.IsObject()) return;
    const auto pair = [&](const char* key, std::array<double, 2>& out) {
      if (!transform.Has(key)) return;
      const Value& value = transform.Get(key);
      if (!value.IsArray() || value.ArrayLen() != 2 || !value.Get(0).IsNumber() || !value.Get(1).IsNumber())
        throw InputError(fmt::format("{}: KHR_texture_transform: {} is not two numbers", where_, key));
      out = {value.Get(0).GetNumberAsDouble(), value.Get(1).GetNumberAsDouble()};
    };
    pair("offset", use.offset);
    pair("scale", use.scale);
    if (transform.Has("rotation")) {
      if (!transform.Get("rotation").IsNumber())
        throw InputError(fmt::format("{}: KHR_texture_transform: rotation is not a number", where_));
      use.rotation = transform.Get("rotation").GetNumberAsDouble();
    }
    readSet(transform, "KHR_texture_transform", use);
  }

  void readSet(const Value& object, const char* of, TextureUse& use) const {
    if (!object.Has("texCoord")) return;
    if (!object.Get("texCoord").IsInt())
      throw InputError(fmt::format("{}: texCoord of {} is not an integer", where_, of));
    use.texCoord = object.Get("texCoord").GetNumberAsInt();
  }

  const Value& object_;
  std::string where_;
  std::vector<std::string>& notes_;
};

Rgb linearOf(const std::array<std::uint8_t, 4>& texel) {
  return {linearFromSrgb8(texel[0]), linearFromSrgb8(texel[1]), linearFromSrgb8(texel[2])};
}

double unit(std::uint8_t value) {
  return static_cast<double>(value) / 255.0;
}

bool isBlack(const Rgb& color) {
  return color[0] <= 0.0 && color[1] <= 0.0 && color[2] <= 0.0;
}

// What light the GGX lobes leave out, by extension.
constexpr std::array<std::pair<const char*, const char*>, 8> kNotCovered{{
    {"KHR_materials_sheen", "the sheen"},
    {"KHR_materials_transmission", "the light it transmits"},
    {"KHR_materials_volume", "the light within it"},
    {"KHR_materials_diffuse_transmission", "the light it transmits diffusely"},
    {"KHR_materials_iridescence", "the colours of its iridescence"},
    {"KHR_materials_dispersion", "its dispersion"},
    {"KHR_materials_subsurface", "the light scattered below its surface"},
    {"KHR_materials_fuzz", "the fuzz"},
}};

}  // namespace

std::array<double, 2> TextureUse::transformed(const std::array<double, 2>& uv) const {
  const double u = uv[0] * scale[0];
  const double v = uv[1] * scale[1];
  const double c = std::cos(rotation);
  const double s = std::sin(rotation);
  // the extension turns counter-clockwise as seen with v upwards, and v points down
  return {offset[0] + c * u + s * v, offset[1] - s * u + c * v};
}

GltfMaterial materialFrom(const tinygltf::Material& source, const std::string& name,
                          std::vector<std::string>& notes) {
  GltfMaterial out;
  out.name = name;
  const std::string where = fmt::format("Material '{}'", name);
  const auto extension = [&](const char* key) -> const Value* {
    const auto found = source.extensions.find(key);
    return found == source.extensions.end() || !found->second.IsObject() ? nullptr : &found->second;
  };
  const Value none;
  Fields core(none, where, notes);
  const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
  out.roughness = core.clamped(pbr.roughnessFactor, "roughnessFactor", 1.0);
  out.metallic = core.clamped(pbr.metallicFactor, "metallicFactor", 1.0);
  for (std::size_t i = 0; i < 3; ++i)
    out.baseColor[i] = core.clamped(pbr.baseColorFactor.at(i), "baseColorFactor", 1.0);
  out.textures[kMetallicRoughness] = core.texture("metallicRoughnessTexture", pbr.metallicRoughnessTexture);
  out.textures[kBaseColor] = core.texture("baseColorTexture", pbr.baseColorTexture);
  if (const Value* object = extension("KHR_materials_anisotropy")) {
    Fields fields(*object, where, notes);
    out.anisotropy = fields.number("anisotropyStrength", 0.0);
    out.textures[kAnisotropy] = fields.texture("anisotropyTexture");
  }
  if (const Value* object = extension("KHR_materials_ior"))
    out.ior = Fields(*object, where, notes).number("ior", 1.5, kNoLimit);
  if (const Value* object = extension("KHR_materials_specular")) {
    Fields fields(*object, where, notes);
    out.specular = fields.number("specularFactor", 1.0);
    out.specularColor = fields.color("specularColorFactor", kNoLimit);
    out.textures[kSpecular] = fields.texture("specularTexture");
    out.textures[kSpecularColor] = fields.texture("specularColorTexture");
  }
  if (const Value* object = extension("KHR_materials_clearcoat")) {
    Fields fields(*object, where, notes);
    out.clearcoat = fields.number("clearcoatFactor", 0.0);
    out.clearcoatRoughness = fields.number("clearcoatRoughnessFactor", 0.0);
    out.textures[kClearcoat] = fields.texture("clearcoatTexture");
    out.textures[kClearcoatRoughness] = fields.texture("clearcoatRoughnessTexture");
  }
  if (const Value* object = extension("KHR_materials_pbrSpecularGlossiness")) {
    Fields fields(*object, where, notes);
    out.specularGlossiness = true;
    out.reflectance = fields.color("specularFactor");
    out.glossiness = fields.number("glossinessFactor", 1.0);
    out.textures[kSpecularGlossiness] = fields.texture("specularGlossinessTexture");
  }
  // an empty extension is an object to tinygltf only if it says so
  out.unlit = source.extensions.contains("KHR_materials_unlit");
  double strength = 1.0;
  if (const Value* object = extension("KHR_materials_emissive_strength"))
    strength = Fields(*object, where, notes).number("emissiveStrength", 1.0, kNoLimit);
  const std::vector<double>& emissive = source.emissiveFactor;
  out.emits =
      strength > 0.0 && std::any_of(emissive.begin(), emissive.end(), [](double c) { return c > 0.0; });
  out.emissiveTexture = source.emissiveTexture.index >= 0;
  out.doubleSided = source.doubleSided;
  for (const auto& [key, what] : kNotCovered)
    if (source.extensions.contains(key))
      notes.push_back(
          fmt::format("{}: tables of GGX do not hold {} ({}); its GGX lobe is counted.", where, what, key));
  return out;
}

std::vector<TextureSlot> slotsOfBase(const GltfMaterial& m) {
  std::vector<TextureSlot> slots;
  const auto add = [&](TextureSlot slot, bool matters) {
    if (matters && m.textures[slot].texture >= 0) slots.push_back(slot);
  };
  if (m.specularGlossiness) {
    add(kSpecularGlossiness, m.glossiness > 0.0 || !isBlack(m.reflectance));
    return slots;
  }
  add(kMetallicRoughness, m.roughness > 0.0 || m.metallic > 0.0);
  add(kBaseColor, m.metallic > 0.0 && !isBlack(m.baseColor));
  add(kAnisotropy, m.anisotropy > 0.0);
  // a metal has neither, unless the texture makes it none
  const bool dielectric = m.metallic < 1.0 || m.textures[kMetallicRoughness].texture >= 0;
  add(kSpecular, dielectric && m.specular > 0.0);
  add(kSpecularColor, dielectric && m.specular > 0.0 && !isBlack(m.specularColor));
  return slots;
}

std::vector<TextureSlot> slotsOfCoat(const GltfMaterial& m) {
  std::vector<TextureSlot> slots;
  if (m.textures[kClearcoat].texture >= 0) slots.push_back(kClearcoat);
  if (m.clearcoatRoughness > 0.0 && m.textures[kClearcoatRoughness].texture >= 0)
    slots.push_back(kClearcoatRoughness);
  return slots;
}

std::span<const std::size_t> channelsOf(TextureSlot slot) {
  static constexpr std::array<std::size_t, 4> kAll{0, 1, 2, 3};
  constexpr std::span<const std::size_t> kRgba(kAll);
  switch (slot) {
    case kMetallicRoughness:
      return kRgba.subspan(1, 2);
    case kBaseColor:
    case kSpecularColor:
      return kRgba.first(3);
    case kAnisotropy:
      return kRgba.subspan(2, 1);
    case kSpecular:
      return kRgba.subspan(3, 1);
    case kClearcoat:
      return kRgba.first(1);
    case kClearcoatRoughness:
      return kRgba.subspan(1, 1);
    default:  // kSpecularGlossiness has a colour and, in alpha, a number
      return kRgba;
  }
}

LobeUse baseLobe(const GltfMaterial& m, const SlotTexels& texels) {
  LobeUse lobe;
  if (m.specularGlossiness) {
    const Rgb color = linearOf(texels[kSpecularGlossiness]);
    const double roughness = 1.0 - m.glossiness * unit(texels[kSpecularGlossiness][3]);
    lobe.alphaX = lobe.alphaY = roughness * roughness;
    lobe.f0 =
        luminance({m.reflectance[0] * color[0], m.reflectance[1] * color[1], m.reflectance[2] * color[2]});
    lobe.f90 = 1.0;
    return lobe;
  }
  const double roughness = m.roughness * unit(texels[kMetallicRoughness][1]);
  const double metallic = m.metallic * unit(texels[kMetallicRoughness][2]);
  const double strength = m.anisotropy * unit(texels[kAnisotropy][2]);
  lobe.alphaY = roughness * roughness;
  lobe.alphaX = lobe.alphaY + (1.0 - lobe.alphaY) * strength * strength;
  const double specular = m.specular * unit(texels[kSpecular][3]);
  const Rgb specularColor = linearOf(texels[kSpecularColor]);
  const Rgb baseColor = linearOf(texels[kBaseColor]);
  const double root = std::isinf(m.ior) ? 1.0 : (m.ior - 1.0) / (m.ior + 1.0);
  Rgb f0{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double dielectric = std::min(root * root * m.specularColor[i] * specularColor[i], 1.0) * specular;
    f0[i] = dielectric + metallic * (m.baseColor[i] * baseColor[i] - dielectric);
  }
  lobe.f0 = std::clamp(luminance(f0), 0.0, 1.0);
  lobe.f90 = specular + metallic * (1.0 - specular);
  return lobe;
}

double clearcoatAt(const GltfMaterial& m, const SlotTexels& texels) {
  return m.clearcoat * unit(texels[kClearcoat][0]);
}

LobeUse coatLobe(const GltfMaterial& m, const SlotTexels& texels) {
  const double roughness = m.clearcoatRoughness * unit(texels[kClearcoatRoughness][1]);
  return {roughness * roughness, roughness * roughness, 0.04, 1.0, 0.0};
}

}  // namespace ltcfit
