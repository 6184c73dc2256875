#include "scene/gltf_textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "export/atomic_file.h"
#include "scene/gltf_uri.h"
#include "scene/texel_values.h"

namespace ltcfit {
namespace {

constexpr std::array<const char*, kTextureSlots> kSlotNames{
    "roughness and metallic", "base colour",         "anisotropy", "specular",
    "specular colour",        "specular-glossiness", "clearcoat",  "clearcoat roughness"};

Wrap wrapOf(int mode) {
  if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::kClamp;
  return mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::kMirror : Wrap::kRepeat;
}

// Extensions that give a texture another image, of a kind that is not read.
constexpr std::array<std::pair<const char*, const char*>, 4> kOtherImages{{{"KHR_texture_basisu", "KTX2"},
                                                                           {"EXT_texture_webp", "WebP"},
                                                                           {"EXT_texture_avif", "AVIF"},
                                                                           {"MSFT_texture_dds", "DDS"}}};

// Media types of images, of glTF and of the extensions above, and the kinds that are not read.
constexpr std::array<std::pair<std::string_view, const char*>, 6> kMediaTypes{{{"image/png", ""},
                                                                               {"image/jpeg", ""},
                                                                               {"image/ktx2", "KTX2"},
                                                                               {"image/webp", "WebP"},
                                                                               {"image/avif", "AVIF"},
                                                                               {"image/vnd-ms.dds", "DDS"}}};

// The kind by its media type, where there are no bytes to tell: of those that are not read.
std::string unreadableType(const std::string& mimeType, const std::string& name) {
  if (mimeType.empty()) return {};
  std::string all;
  for (const auto& [type, kind] : kMediaTypes) {
    if (mimeType == type) return kind;
    all += fmt::format("{}{}", all.empty() ? "" : ", ", type);
  }
  throw InputError(
      fmt::format("{}: mimeType is '{}'; glTF and its extensions have {}", name, shortened(mimeType), all));
}

}  // namespace

LoadedTexture GltfTextures::load(int index, const std::string& material) {
  const tinygltf::Model& model = file_.model;
  if (index < 0 || static_cast<std::size_t>(index) >= model.textures.size())
    throw InputError(
        fmt::format("material '{}' names texture {} of {}", material, index, model.textures.size()));
  const tinygltf::Texture& texture = model.textures[static_cast<std::size_t>(index)];
  LoadedTexture out;
  if (texture.sampler >= 0) {
    if (static_cast<std::size_t>(texture.sampler) >= model.samplers.size())
      throw InputError(
          fmt::format("texture {} names sampler {} of {}", index, texture.sampler, model.samplers.size()));
    const tinygltf::Sampler& sampler = model.samplers[static_cast<std::size_t>(texture.sampler)];
    out.wrapU = wrapOf(sampler.wrapS);
    out.wrapV = wrapOf(sampler.wrapT);
  }
  const auto assume = [&](const std::string& kind) {
    static const auto kUniform = std::make_shared<const TexelImage>(uniformTexels());
    out.image = kUniform;
    out.assumed = kind;
    return out;
  };
  out.name = fmt::format("texture {}", index);
  if (texture.source < 0) {
    for (const auto& [extension, kind] : kOtherImages)
      if (texture.extensions.contains(extension)) return assume(kind);
    throw InputError(fmt::format("texture {} has no image", index));
  }
  const auto source = static_cast<std::size_t>(texture.source);
  if (source >= file_.images.size())
    throw InputError(fmt::format("texture {} names image {} of {}", index, source, file_.images.size()));
  out.name = imageName(file_, source);
  const GltfImage& image = file_.images[source];
  if (const std::string kind = unreadableType(image.mimeType, out.name); !kind.empty()) return assume(kind);
  const bool inView = image.uri.empty() && image.bufferView >= 0 &&
                      static_cast<std::size_t>(image.bufferView) < model.bufferViews.size();
  if (inView && isMeshoptCompressed(model.bufferViews[static_cast<std::size_t>(image.bufferView)]))
    return assume("compressed");
  if (const auto known = images_.find(source); known != images_.end()) {
    out.image = known->second;
    return out;
  }
  const std::string bytes = imageBytes(file_, source);
  if (const std::string kind = unreadableKind(bytes); !kind.empty()) return assume(kind);
  out.image = std::make_shared<const TexelImage>(decodeTexels(bytes, out.name, kMaxTexels - decodedTexels_));
  decodedTexels_ += out.image->texels.size();
  images_[source] = out.image;
  return out;
}

std::vector<GltfTextures::Group> GltfTextures::groupsOf(const GltfMaterial& material,
                                                        const std::vector<TextureSlot>& slots) {
  std::vector<Group> groups;
  for (const TextureSlot slot : slots) {
    const TextureUse& use = material.textures[slot];
    LoadedTexture texture = load(use.texture, material.name);
    const auto alike = std::find_if(groups.begin(), groups.end(), [&](const Group& group) {
      const LoadedTexture& first = group.textures.front();
      if (!first.assumed.empty() || !texture.assumed.empty())
        return first.assumed == texture.assumed && group.mapping.texture == use.texture;
      TextureUse same = use;
      same.texture = group.mapping.texture;
      return same == group.mapping && first.wrapU == texture.wrapU && first.wrapV == texture.wrapV;
    });
    Group& group = alike == groups.end() ? groups.emplace_back() : *alike;
    if (group.slots.empty()) group.mapping = use;
    group.slots.push_back(slot);
    group.textures.push_back(std::move(texture));
    if (group.textures.back().image->texels.size() > group.largest().image->texels.size())
      group.reference = group.textures.size() - 1;
  }
  return groups;
}

// Fills in the areas of the group's texels; or says why it does not.
std::string GltfTextures::cover(Group& group, const std::vector<const GltfSurface*>& surfaces) {
  const LoadedTexture& texture = group.largest();
  if (!texture.assumed.empty()) return "assumed";
  const std::string attribute = fmt::format("TEXCOORD_{}", group.mapping.texCoord);
  double total = 0.0;
  for (const GltfSurface* surface : surfaces) {
    if (surface->compressed) return "the geometry is compressed";
    const auto found = surface->primitive->attributes.find(attribute);
    if (found == surface->primitive->attributes.end()) return fmt::format("a mesh has no {}", attribute);
    if (!accessors_.readable(found->second, surface->name)) return fmt::format("{} is compressed", attribute);
    total += surface->area;
  }
  UvCoverage coverage(texture.image->width, texture.image->height, texture.wrapU, texture.wrapV);
  bool any = false;
  for (const GltfSurface* surface : surfaces) {
    const std::vector<float> uv =
        accessors_.vectors(surface->primitive->attributes.at(attribute), 2, surface->name);
    for (std::size_t t = 0; t < surface->triangles.size(); ++t) {
      const double area = total > 0.0 ? surface->areas[t] : 1.0;
      if (area <= 0.0) continue;
      std::array<std::array<double, 2>, 3> corners{};
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t at = 2 * std::size_t{surface->triangles[t][i]};
        if (at + 2 > uv.size())
          throw InputError(fmt::format("{}: {} has {} vertices", surface->name, attribute, uv.size() / 2));
        corners[i] = group.mapping.transformed({uv[at], uv[at + 1]});
      }
      coverage.add(corners, area);
      any = true;
      if (coverage.work() > kMaxCoverageWork - coverageWork_) return "too many triangles lie on it";
    }
  }
  coverageWork_ += coverage.work();
  if (!any) return "no triangle shows it";
  group.areas = coverage.areas();
  group.shown = static_cast<std::size_t>(
      std::count_if(group.areas.begin(), group.areas.end(), [](float area) { return area > 0.0f; }));
  return {};
}

// A sentence for each texture of the group; `uncovered` is why its texels are not covered by triangles.
void GltfTextures::explain(const Group& group, const std::string& uncovered,
                           std::vector<std::string>& reasons) {
  for (std::size_t i = 0; i < group.slots.size(); ++i) {
    const LoadedTexture& texture = group.textures[i];
    const char* const what = kSlotNames[group.slots[i]];
    const TexelImage& image = *texture.image;
    if (!texture.assumed.empty()) {
      reasons.push_back(
          fmt::format("The {} texture, {}, could not be read ({}): every value was assumed, uniformly.", what,
                      texture.name, texture.assumed));
    } else if (!uncovered.empty()) {
      reasons.push_back(fmt::format("All {} x {} texels of {} ({}) were counted, because {}.", image.width,
                                    image.height, texture.name, what, uncovered));
    } else if (i == group.reference) {
      reasons.push_back(fmt::format("The triangles show {} of the {} x {} texels of {} ({}).", group.shown,
                                    image.width, image.height, texture.name, what));
    } else {
      reasons.push_back(fmt::format("{} ({} x {}, {}) was looked up there.", texture.name, image.width,
                                    image.height, what));
    }
  }
}

// Calls `visit` with what the group's slots show together, the others 255, and with its share of the area.
void GltfTextures::forEachShown(const Group& group,
                                const std::function<void(const SlotTexels&, double)>& visit) {
  const TexelImage& reference = *group.largest().image;
  const double total = std::accumulate(group.areas.begin(), group.areas.end(), 0.0);
  SlotTexels texels;
  for (auto& texel : texels) texel.fill(255);
  SlotTexels last = texels;
  double run = 0.0;
  for (std::size_t texel = 0; texel < reference.texels.size(); ++texel) {
    if (!group.areas.empty() && !(group.areas[texel] > 0.0f)) continue;
    const std::size_t x = texel % reference.width;
    const std::size_t y = texel / reference.width;
    for (std::size_t i = 0; i < group.slots.size(); ++i) {
      const TexelImage& image = *group.textures[i].image;
      // the texel in which the centre of the reference's lies
      texels[group.slots[i]] = image.at((2 * x + 1) * image.width / (2 * reference.width),
                                        (2 * y + 1) * image.height / (2 * reference.height));
    }
    // neighbours are often equal, and looking them up costs more than comparing them
    if (run > 0.0 && texels != last) {
      visit(last, run);
      run = 0.0;
    }
    last = texels;
    run += group.areas.empty() ? 1.0 / static_cast<double>(reference.texels.size())
                               : static_cast<double>(group.areas[texel]) / total;
  }
  visit(last, run);
}

// Throws where `texels` more are too many.
void GltfTextures::spend(std::size_t texels) {
  countedTexels_ += texels;
  if (countedTexels_ > kMaxCountedTexels)
    throw InputError(
        fmt::format("its materials have more than {} texels, each counted by itself", kMaxCountedTexels));
}

std::size_t GltfTextures::forEachTexel(const GltfMaterial& material, const std::vector<TextureSlot>& slots,
                                       const std::vector<const GltfSurface*>& surfaces,
                                       std::vector<std::string>& reasons,
                                       const std::function<void(const SlotTexels&, double)>& count) {
  if (slots.empty()) {
    SlotTexels texels;
    for (auto& texel : texels) texel.fill(255);
    count(texels, 1.0);
    return 0;
  }
  std::vector<Group> groups = groupsOf(material, slots);
  std::vector<TexelValues> values;
  std::size_t ofImages = 0;
  for (Group& group : groups) {
    explain(group, cover(group, surfaces), reasons);
    spend(group.texels());
    if (group.largest().assumed.empty()) ofImages = std::max(ofImages, group.texels());
    if (groups.size() == 1) {
      forEachShown(group, count);
      return ofImages;
    }
    TexelValues& ofGroup = values.emplace_back(group.slots);
    forEachShown(group, [&](const SlotTexels& texels, double) { ofGroup.widen(texels); });
    forEachShown(group, [&](const SlotTexels& texels, double area) { ofGroup.add(texels, area); });
    // of all groups at once they could take gigabytes
    group.areas = {};
  }
  const std::size_t combinations = limitCombinations(values);
  spend(combinations);
  std::string merged;
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (values[g].level() > 0)
      merged += fmt::format(" Values of {} were merged to steps of {}/255 for that.",
                            groups[g].largest().name, 1 << values[g].level());
  reasons.push_back(
      fmt::format("Textures of unlike texture coordinates were taken as independent of each other: all {} "
                  "combinations of their values count.{}",
                  combinations, merged));
  forEachCombination(values, count);
  return ofImages;
}

}  // namespace ltcfit
