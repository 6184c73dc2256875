// Textures of unlike coordinates are independent: what occurs together is the product of what occurs.
#include "scene/texel_values.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "ggx/random.h"
#include "scene/gltf_scene.h"
#include "scene/gltf_textures.h"
#include "tests/scene/gltf_builder.h"

namespace ltcfit {
namespace {

using test::GltfBuilder;
using test::GltfJson;
using test::imageOf;
using Rgba = std::array<std::uint8_t, 4>;

// sums of at most some ten thousand weights
constexpr double kRounding = 1e-11;

using Histogram = std::map<std::vector<std::uint8_t>, double>;

// The image of each slot, looked up by a mapping of its own, on squares that show the given parts of it.
struct Scene {
  std::vector<TextureSlot> slots;
  std::vector<TexelImage> images;
  std::vector<std::array<float, 4>> quads;
};

// Calls `visit` with the values of all slots together, by the channels that lobes depend on.
template <typename Visit>
std::vector<std::string> forEachValue(const Scene& scene, const Visit& visit) {
  GltfBuilder builder;
  builder.material(GltfJson::object());
  GltfMaterial material;
  for (std::size_t i = 0; i < scene.slots.size(); ++i) {
    TextureUse& use = material.textures[scene.slots[i]];
    use.texture = builder.texture(scene.images[i], {{"wrapS", 33071}, {"wrapT", 33071}});
    use.rotation = 1e-6 * static_cast<double>(scene.slots[i]);
  }
  for (const auto& quad : scene.quads) builder.quad(0, quad);
  const GltfFile file = parseGltf(builder.glb(), {});
  GltfAccessors accessors(file);
  std::vector<std::string> reasons;
  const std::vector<GltfSurface> surfaces = surfacesOf(file, accessors, reasons);
  std::vector<const GltfSurface*> pointers;
  for (const GltfSurface& surface : surfaces) pointers.push_back(&surface);
  std::vector<std::uint8_t> key;
  double total = 0.0;
  GltfTextures(file, accessors)
      .forEachTexel(material, scene.slots, pointers, reasons, [&](const SlotTexels& texels, double weight) {
        key.clear();
        for (const TextureSlot slot : scene.slots)
          for (const std::size_t channel : channelsOf(slot)) key.push_back(texels[slot][channel]);
        visit(key, weight);
        total += weight;
      });
  EXPECT_NEAR(total, 1.0, 1e-9);  // of some million at most
  return reasons;
}

Histogram histogramOf(const Scene& scene) {
  Histogram out;
  forEachValue(scene, [&](const std::vector<std::uint8_t>& key, double weight) { out[key] += weight; });
  return out;
}

// Of several histograms, as if each were independent of the others.
Histogram product(const std::vector<Histogram>& parts) {
  Histogram all{{{}, 1.0}};
  for (const Histogram& part : parts) {
    Histogram next;
    for (const auto& [left, a] : all)
      for (const auto& [right, b] : part) {
        std::vector<std::uint8_t> key = left;
        key.insert(key.end(), right.begin(), right.end());
        next[key] = a * b;
      }
    all = std::move(next);
  }
  return all;
}

void expectEqual(const Histogram& found, const Histogram& expected, const std::string& what) {
  ASSERT_EQ(found.size(), expected.size()) << what;
  double most = 0.0;
  for (const auto& [key, weight] : expected) {
    ASSERT_TRUE(found.contains(key)) << what;
    most = std::max(most, std::abs(found.at(key) - weight));
  }
  EXPECT_LT(most, kRounding) << what;
}

// The joint histogram is the product of those that the groups have alone.
void expectIndependent(const Scene& scene, const std::string& what) {
  std::vector<Histogram> alone;
  for (std::size_t i = 0; i < scene.slots.size(); ++i)
    alone.push_back(histogramOf({{scene.slots[i]}, {scene.images[i]}, scene.quads}));
  expectEqual(histogramOf(scene), product(alone), what);
}

struct Size {
  std::size_t width;
  std::size_t height;
};
constexpr std::array<Size, 15> kSizes{{{1, 1},
                                       {1, 2},
                                       {2, 1},
                                       {1, 3},
                                       {7, 1},
                                       {2, 2},
                                       {3, 3},
                                       {4, 4},
                                       {2, 4},
                                       {5, 3},
                                       {8, 8},
                                       {1, 16},
                                       {7, 5},
                                       {9, 9},
                                       {16, 16}}};

std::string name(const Size& size) {
  return std::to_string(size.width) + " x " + std::to_string(size.height) + ", ";
}

// Each texel another number, the same in all channels.
TexelImage counting(const Size& size) {
  return imageOf(size.width, size.height, [&](std::size_t x, std::size_t y) {
    const auto v = static_cast<std::uint8_t>(y * size.width + x);
    return Rgba{v, v, v, v};
  });
}

TEST(IndependentTextures, TwoOfEverySize) {
  for (const Size& a : kSizes)
    for (const Size& b : kSizes) {
      const Scene scene{{kMetallicRoughness, kBaseColor}, {counting(a), counting(b)}, {}};
      const Histogram found = histogramOf(scene);
      // every pair of texels, once
      const std::size_t pairs = a.width * a.height * b.width * b.height;
      ASSERT_EQ(found.size(), pairs) << name(a) << name(b);
      for (const auto& [key, weight] : found)
        ASSERT_NEAR(weight * static_cast<double>(pairs), 1.0, 1e-12) << name(a) << name(b);
    }
}

TEST(IndependentTextures, ThreeOfManySizes) {
  const std::array<Size, 6> sizes{{{1, 1}, {2, 1}, {1, 3}, {2, 2}, {4, 4}, {3, 5}}};
  for (const Size& a : sizes)
    for (const Size& b : sizes)
      for (const Size& c : sizes)
        expectIndependent(
            {{kMetallicRoughness, kBaseColor, kSpecular}, {counting(a), counting(b), counting(c)}, {}},
            name(a) + name(b) + name(c));
}

TEST(IndependentTextures, FourPatternsOfOneSize) {
  // each alone half and half; in step, two at a time, they would be the same or the opposite
  const auto pattern = [](bool wide) {
    return imageOf(8, 8, [=](std::size_t x, std::size_t y) {
      const std::uint8_t v = ((wide ? x / 2 + y / 2 : x + y) % 2) != 0 ? 200 : 60;
      return Rgba{v, v, v, v};
    });
  };
  const Scene scene{{kMetallicRoughness, kBaseColor, kAnisotropy, kSpecular},
                    {pattern(false), pattern(true), pattern(false), pattern(true)},
                    {}};
  const Histogram found = histogramOf(scene);
  EXPECT_EQ(found.size(), 16u);
  for (const auto& [key, weight] : found) EXPECT_NEAR(weight, 1.0 / 16.0, kRounding);
}

TEST(IndependentTextures, AreasAreWeights) {
  // unlike parts shown by unlike areas, some texels by none; values that occur more than once
  Random random(5);
  const auto few = [&](const Size& size) {
    return imageOf(size.width, size.height, [&](std::size_t, std::size_t) {
      Rgba texel{};
      for (std::uint8_t& channel : texel)
        channel = static_cast<std::uint8_t>(40.0 * std::floor(4.0 * random.uniform()));
      return texel;
    });
  };
  for (const auto& [a, b] : std::vector<std::pair<Size, Size>>{
           {{8, 8}, {8, 8}}, {{16, 16}, {4, 4}}, {{5, 7}, {16, 1}}, {{12, 12}, {9, 9}}})
    expectIndependent({{kMetallicRoughness, kBaseColor, kSpecular},
                       {few(a), few(b), few(b)},
                       {{0.0f, 0.0f, 0.5f, 0.5f}, {0.1f, 0.2f, 0.25f, 0.9f}}},
                      name(a) + name(b));
}

TEST(IndependentTextures, TwoCheckerboardsMakeFourLobes) {
  GltfBuilder builder;
  const auto board = [&](const Rgba& even, const Rgba& odd) {
    return builder.texture(
        imageOf(4, 4, [&](std::size_t x, std::size_t y) { return (x + y) % 2 == 0 ? even : odd; }));
  };
  const int rough = board({0, 180, 255, 255}, {0, 80, 255, 255});
  const int color = board({20, 20, 20, 255}, {255, 255, 255, 255});
  builder.quad(builder.material({{"pbrMetallicRoughness",
                                  {{"metallicRoughnessTexture", {{"index", rough}}},
                                   {"baseColorTexture", {{"index", color}, {"texCoord", 1}}}}}}));
  GltfJson& attributes = builder.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["TEXCOORD_1"] = attributes["TEXCOORD_0"];
  const MaterialUse material = sceneFromGltf(builder.glb(), {}).materials.at(0);
  ASSERT_EQ(material.lobes.size(), 4u);
  for (const LobeUse& lobe : material.lobes) EXPECT_NEAR(lobe.weight, 0.25, 1e-6);  // float areas
  EXPECT_NE(material.reasons.back().find("independent of each other: all 4 combinations"), std::string::npos)
      << material.reasons.back();
}

TexelImage noise(std::size_t size, std::uint64_t seed) {
  Random random(seed);
  return imageOf(size, size, [&](std::size_t, std::size_t) {
    Rgba texel{};
    // not even, and not up to the ends
    for (std::uint8_t& channel : texel)
      channel = static_cast<std::uint8_t>(10.0 + 230.0 * random.uniform() * random.uniform());
    return texel;
  });
}

// How often each value of a channel occurs.
using Channel = std::array<double, 256>;

double below(const Channel& channel, int end) {
  double sum = 0.0;
  for (int v = 0; v < std::min(end, 256); ++v) sum += channel[static_cast<std::size_t>(v)];
  return sum;
}

std::pair<int, int> endsOf(const Channel& channel) {
  int low = 0;
  int high = 255;
  while (channel[static_cast<std::size_t>(low)] == 0.0) ++low;
  while (channel[static_cast<std::size_t>(high)] == 0.0) --high;
  return {low, high};
}

TEST(IndependentTextures, TooManyCombinationsAreMergedByStatedSteps) {
  const Scene scene{{kMetallicRoughness, kBaseColor}, {noise(64, 1), noise(64, 2)}, {}};
  std::vector<Channel> channels(5);
  std::size_t count = 0;
  double both = 0.0;
  double first = 0.0;
  double second = 0.0;
  const std::vector<std::string> reasons =
      forEachValue(scene, [&](const std::vector<std::uint8_t>& key, double weight) {
        for (std::size_t c = 0; c < channels.size(); ++c) channels[c][key[c]] += weight;
        const bool a = key[0] < 60 && key[1] > 30;
        const bool b = key[2] < 50 && key[3] < 100 && key[4] > 20;
        first += a ? weight : 0.0;
        second += b ? weight : 0.0;
        both += a && b ? weight : 0.0;
        ++count;
      });
  EXPECT_LE(count, kMaxTexelCombinations);
  // no coarser than by one halving of three channels
  EXPECT_GT(count, kMaxTexelCombinations / 16);
  EXPECT_NEAR(both, first * second, 1e-9);  // some million additions
  EXPECT_GT(both, 0.1);
  bool merged = false;
  for (std::size_t i = 0, c = 0; i < 2; ++i) {
    const std::string words = "Values of image " + std::to_string(i) + " were merged to steps of ";
    const std::size_t at = reasons.back().find(words);
    merged = merged || at != std::string::npos;
    const int step = at == std::string::npos ? 1 : std::stoi(reasons.back().substr(at + words.size()));
    EXPECT_LE(step, 16) << reasons.back();
    for (const std::size_t of : channelsOf(scene.slots[i])) {
      Channel exact{};
      for (const Rgba& texel : scene.images[i].texels) exact[texel[of]] += 1.0 / 4096.0;
      // no value moved by a step, none of the ends at all
      EXPECT_EQ(endsOf(channels[c]), endsOf(exact));
      for (int v = 0; v <= 256; ++v) {
        EXPECT_GE(below(channels[c], v), below(exact, v - step + 1) - 1e-9) << step << " " << v;
        EXPECT_LE(below(channels[c], v), below(exact, v + step - 1) + 1e-9) << step << " " << v;
      }
      ++c;
    }
  }
  EXPECT_TRUE(merged) << reasons.back();
}

SlotTexels texelsOf(TextureSlot slot, const Rgba& texel) {
  SlotTexels out;
  for (auto& all : out) all.fill(255);
  out[slot] = texel;
  return out;
}

TEST(TexelValues, ManyValuesAreMergedWhileTheyCome) {
  TexelValues values({kBaseColor});
  const TexelImage image = noise(1024, 3);
  std::array<double, 3> mean{};
  for (const Rgba& texel : image.texels) values.widen(texelsOf(kBaseColor, texel));
  for (const Rgba& texel : image.texels) {
    values.add(texelsOf(kBaseColor, texel), 2.0);
    for (std::size_t c = 0; c < 3; ++c) mean[c] += texel[c] / static_cast<double>(image.texels.size());
  }
  EXPECT_LE(values.size(), TexelValues::kMaxValues);
  EXPECT_GT(values.size(), TexelValues::kMaxValues / 16);  // no coarser than by one halving of three channels
  EXPECT_GE(values.level(), 1u);
  double total = 0.0;
  std::array<double, 3> merged{};
  for (const TexelValues::Value& value : values.values()) {
    total += value.weight;
    for (std::size_t c = 0; c < 3; ++c) merged[c] += value.weight * value.texels[kBaseColor][c];
    EXPECT_EQ(value.texels[kBaseColor][3], 255);  // no lobe depends on it
  }
  EXPECT_NEAR(total, 1.0, 1e-9);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(merged[c], mean[c], 0.5);  // rounded to 8 bits
}

TEST(TexelValues, OrderDoesNotMatter) {
  const TexelImage image = noise(64, 4);
  const auto read = [](const std::vector<Rgba>& texels) {
    TexelValues values({kMetallicRoughness});
    for (const Rgba& texel : texels) values.widen(texelsOf(kMetallicRoughness, texel));
    for (const Rgba& texel : texels) values.add(texelsOf(kMetallicRoughness, texel), 1.0);
    values.coarsen();
    values.coarsen();
    return values.values();
  };
  std::vector<Rgba> backwards(image.texels.rbegin(), image.texels.rend());
  const auto a = read(image.texels);
  const auto b = read(backwards);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].texels, b[i].texels);
    EXPECT_EQ(a[i].weight, b[i].weight);  // sums of whole numbers
  }
}

TEST(TexelValues, TheCoarsestHasThreeOfEachChannel) {
  TexelValues values({kMetallicRoughness, kSpecular});
  const TexelImage image = noise(64, 5);
  SlotTexels texels = texelsOf(kMetallicRoughness, {});
  for (const bool first : {true, false})
    for (const Rgba& texel : image.texels) {
      texels[kMetallicRoughness] = texel;
      texels[kSpecular] = texel;
      if (first) {
        values.widen(texels);
      } else {
        values.add(texels, 1.0);
      }
    }
  while (values.level() < TexelValues::kCoarsest) values.coarsen();
  EXPECT_LE(values.size(), 27u);
  // the ends stay
  const auto ends = [](const auto& all, const auto& valueOf) {
    const auto less = [&](const auto& a, const auto& b) { return valueOf(a) < valueOf(b); };
    const auto [low, high] = std::minmax_element(all.begin(), all.end(), less);
    return std::pair<int, int>(valueOf(*low), valueOf(*high));
  };
  const std::vector<TexelValues::Value> merged = values.values();
  for (const auto& [slot, c] : std::vector<std::pair<TextureSlot, std::size_t>>{
           {kMetallicRoughness, 1}, {kMetallicRoughness, 2}, {kSpecular, 3}})
    EXPECT_EQ(ends(merged, [s = slot, i = c](const TexelValues::Value& v) { return v.texels[s][i]; }),
              ends(image.texels, [i = c](const Rgba& texel) { return texel[i]; }));
  std::vector<TexelValues> groups(5, values);
  EXPECT_LE(limitCombinations(groups), kMaxTexelCombinations);
}

TEST(TexelValues, LobesDependOnTheChannelsThatAreSaid) {
  Random random(6);
  GltfMaterial all;
  all.roughness = all.metallic = all.anisotropy = all.clearcoat = all.clearcoatRoughness = 0.9;
  GltfMaterial old = all;
  old.specularGlossiness = true;
  const auto lobes = [&](const SlotTexels& texels) {
    const LobeUse a = baseLobe(all, texels);
    const LobeUse b = baseLobe(old, texels);
    const LobeUse c = coatLobe(all, texels);
    return std::array<double, 10>{a.alphaX, a.alphaY, a.f0,  a.f90,    b.alphaX,
                                  b.alphaY, b.f0,     b.f90, c.alphaX, clearcoatAt(all, texels)};
  };
  SlotTexels texels{};
  for (auto& texel : texels)
    for (std::uint8_t& channel : texel) channel = static_cast<std::uint8_t>(60.0 + 90.0 * random.uniform());
  for (std::size_t s = 0; s < kTextureSlots; ++s)
    for (std::size_t channel = 0; channel < 4; ++channel) {
      const auto read = channelsOf(static_cast<TextureSlot>(s));
      SlotTexels other = texels;
      other[s][channel] = static_cast<std::uint8_t>(other[s][channel] + 90);
      EXPECT_EQ(lobes(other) != lobes(texels), std::find(read.begin(), read.end(), channel) != read.end())
          << s << " " << channel;
    }
}

}  // namespace
}  // namespace ltcfit
