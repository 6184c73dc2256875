#include "scene/gltf_scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "scene/gltf_material.h"
#include "scene/gltf_surfaces.h"
#include "scene/gltf_textures.h"
#include "scene/lobe_histogram.h"

namespace ltcfit {
namespace {

// A material, or -1 for the one of primitives that name none, with its surfaces.
using MaterialSurfaces = std::map<int, std::vector<const GltfSurface*>>;

std::string materialName(const tinygltf::Model& model, int index) {
  if (index < 0) return "default material";
  const std::string& name = model.materials[static_cast<std::size_t>(index)].name;
  return name.empty() ? fmt::format("material {}", index) : name;
}

GltfMaterial materialAt(const tinygltf::Model& model, int index, std::vector<std::string>& notes) {
  return materialFrom(index < 0 ? tinygltf::Material() : model.materials[static_cast<std::size_t>(index)],
                      materialName(model, index), notes);
}

std::string factorsOf(const GltfMaterial& m) {
  if (m.specularGlossiness)
    return fmt::format("Factors: glossiness {:.4g}, specular {:.4g} {:.4g} {:.4g}.", m.glossiness,
                       m.reflectance[0], m.reflectance[1], m.reflectance[2]);
  std::string text = fmt::format("Factors: roughness {:.4g}, metallic {:.4g}", m.roughness, m.metallic);
  if (m.anisotropy > 0.0) text += fmt::format(", anisotropy {:.4g}", m.anisotropy);
  if (m.metallic > 0.0)
    text += fmt::format(", base colour {:.4g} {:.4g} {:.4g}", m.baseColor[0], m.baseColor[1], m.baseColor[2]);
  if (m.metallic < 1.0)
    text += fmt::format(", index of refraction {:.4g}, specular {:.4g}", m.ior, m.specular);
  return text + ".";
}

// What is shared by the materials of a file.
class Reader {
 public:
  Reader(const GltfFile& file, SceneUse& use) : accessors_(file), textures_(file, accessors_), use_(use) {
    surfaces_ = surfacesOf(file, accessors_, use.notes);
    for (const GltfSurface& surface : surfaces_)
      for (const int material : surface.materials) used_[material].push_back(&surface);
  }

  const MaterialSurfaces& used() const { return used_; }

  void addMaterials(const tinygltf::Model& model) {
    std::vector<std::pair<GltfMaterial, const std::vector<const GltfSurface*>*>> shiny;
    for (const auto& [index, surfaces] : used_) {
      GltfMaterial material = materialAt(model, index, use_.notes);
      if (material.unlit) {
        use_.notes.push_back(fmt::format("Material '{}' is unlit: no lobe is counted.", material.name));
      } else {
        addLight(material, surfaces);
        shiny.emplace_back(std::move(material), &surfaces);
      }
    }
    double total = 0.0;
    bool compressed = false;
    for (const auto& [material, surfaces] : shiny)
      for (const GltfSurface* surface : *surfaces) {
        total += surface->area;
        compressed = compressed || surface->compressed;
      }
    const bool known = !compressed && total > 0.0;
    if (!known && !shiny.empty())
      use_.notes.push_back(fmt::format(
          "{}: all materials count alike.",
          compressed ? "Areas are not known (compressed geometry)" : "The surfaces have no area"));
    for (const auto& [material, surfaces] : shiny) {
      double area = 0.0;
      for (const GltfSurface* surface : *surfaces) area += surface->area;
      const double share = known ? area / total : 1.0 / static_cast<double>(shiny.size());
      addBase(material, *surfaces, share);
      if (material.clearcoat > 0.0) addCoat(material, *surfaces, share);
    }
  }

 private:
  void addBase(const GltfMaterial& material, const std::vector<const GltfSurface*>& surfaces, double share) {
    MaterialUse out;
    out.name = material.name;
    out.area = share;
    out.reasons = {factorsOf(material)};
    const std::vector<TextureSlot> slots = slotsOfBase(material);
    out.textured = !slots.empty();
    LobeHistogram lobes;
    out.texels = textures_.forEachTexel(material, slots, surfaces, out.reasons,
                                        [&](const SlotTexels& texels, double area) {
                                          LobeUse lobe = baseLobe(material, texels);
                                          lobe.weight = area;
                                          lobes.add(lobe);
                                        });
    out.lobes = lobes.lobes(share);
    addMaterial(use_, std::move(out));
  }

  void addCoat(const GltfMaterial& material, const std::vector<const GltfSurface*>& surfaces, double share) {
    MaterialUse out;
    out.name = material.name + ", clearcoat";
    out.reasons = {fmt::format("Factors: clearcoat {:.4g}, roughness {:.4g}.", material.clearcoat,
                               material.clearcoatRoughness)};
    const std::vector<TextureSlot> slots = slotsOfCoat(material);
    out.textured = !slots.empty();
    LobeHistogram lobes;
    double all = 0.0;
    out.texels = textures_.forEachTexel(material, slots, surfaces, out.reasons,
                                        [&](const SlotTexels& texels, double area) {
                                          all += area;
                                          if (clearcoatAt(material, texels) <= 0.0) return;
                                          LobeUse lobe = coatLobe(material, texels);
                                          lobe.weight = area;
                                          lobes.add(lobe);
                                        });
    if (lobes.weight() <= 0.0) {
      use_.notes.push_back(
          fmt::format("Material '{}': its clearcoat texture leaves no coat.", material.name));
      return;
    }
    out.area = share * std::min(lobes.weight() / all, 1.0);
    out.lobes = lobes.lobes(out.area);
    addMaterial(use_, std::move(out));
  }

  void addLight(const GltfMaterial& material, const std::vector<const GltfSurface*>& surfaces) {
    if (!material.emits) return;
    std::size_t triangles = 0;
    for (const GltfSurface* surface : surfaces) triangles += surface->triangles.size();
    LightUse& lights = use_.lights;
    (material.emissiveTexture ? lights.textured : lights.polygon) = true;
    (material.doubleSided ? lights.twoSided : lights.oneSided) = true;
    lights.reasons.push_back(fmt::format(
        "Material '{}' emits: {} triangles as {}{} polygon lights.", material.name, triangles,
        material.emissiveTexture ? "textured, " : "", material.doubleSided ? "two-sided" : "one-sided"));
  }

  GltfAccessors accessors_;
  GltfTextures textures_;
  SceneUse& use_;
  std::vector<GltfSurface> surfaces_;
  MaterialSurfaces used_;
};

void noteUnused(const tinygltf::Model& model, const MaterialSurfaces& used, std::vector<std::string>& notes) {
  constexpr std::size_t kMostNames = 5;
  std::vector<std::string> names;
  std::size_t count = 0;
  for (int i = 0; i < static_cast<int>(model.materials.size()); ++i) {
    if (used.contains(i)) continue;
    if (++count <= kMostNames) names.push_back(materialName(model, i));
  }
  if (count > kMostNames) names.push_back(fmt::format("{} more", count - kMostNames));
  if (count > 0) notes.push_back(fmt::format("Not shown and not counted: {}.", fmt::join(names, ", ")));
}

void noteExtensions(const tinygltf::Model& model, std::vector<std::string>& notes) {
  const auto uses = [&](const char* name) {
    return std::find(model.extensionsUsed.begin(), model.extensionsUsed.end(), name) !=
           model.extensionsUsed.end();
  };
  if (uses("KHR_lights_punctual"))
    notes.push_back("Lights of KHR_lights_punctual have no extent and need no tables.");
  if (uses("KHR_animation_pointer"))
    notes.push_back("Materials that KHR_animation_pointer animates are counted as they are stored.");
  static const std::set<std::string> kKnown{"KHR_materials_anisotropy",
                                            "KHR_materials_clearcoat",
                                            "KHR_materials_emissive_strength",
                                            "KHR_materials_ior",
                                            "KHR_materials_pbrSpecularGlossiness",
                                            "KHR_materials_specular",
                                            "KHR_materials_unlit",
                                            "KHR_materials_variants",
                                            "KHR_mesh_quantization",
                                            "KHR_texture_transform",
                                            "KHR_lights_punctual"};
  for (const std::string& name : model.extensionsRequired)
    if (!kKnown.contains(name))
      notes.push_back(fmt::format("The file requires {}, which is not read.", name));
}

}  // namespace

SceneUse sceneFromGltf(std::string_view bytes, const std::filesystem::path& folder) {
  const GltfFile file = parseGltf(bytes, folder);
  SceneUse use;
  Reader reader(file, use);
  reader.addMaterials(file.model);
  if (use.materials.empty()) use.notes.push_back("Nothing that the scene shows has a specular lobe.");
  noteUnused(file.model, reader.used(), use.notes);
  noteExtensions(file.model, use.notes);
  if (!use.lights.any()) use.lights.reasons.push_back("glTF knows no area lights: say which by --lights.");
  return use;
}

}  // namespace ltcfit
