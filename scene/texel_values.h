// The values that textures take, as distributions: independent ones are combined by their product.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

#include "scene/gltf_material.h"

namespace ltcfit {

/// The texels of some slots that one surface shows together, alike ones counted once.
///
/// Values are kept as they are while there are at most kMaxValues. Beyond, and by coarsen(), those of a
/// channel are merged over 2^level neighbours, the smallest and the largest ones apart, to their weighted
/// mean, rounded to 8 bits: a channel is off by less than 2^level / 255, and the ends of its range stay.
class TexelValues {
 public:
  static constexpr std::size_t kMaxValues = std::size_t{1} << 18;
  /// All 8 bits of a channel, but its ends, are one.
  static constexpr unsigned kCoarsest = 8;

  struct Value {
    SlotTexels texels{};  ///< 255 in all channels of other slots, and in those that no lobe depends on
    double weight = 0.0;  ///< share of all, > 0
  };

  /// `slots` distinct.
  explicit TexelValues(const std::vector<TextureSlot>& slots);

  /// To be told of all texels before the first is added: where the ranges of channels end.
  void widen(const SlotTexels& texels);
  /// `weight` in any unit; ignored unless > 0.
  void add(const SlotTexels& texels, double weight);
  void coarsen();
  unsigned level() const { return level_; }
  std::size_t size() const { return cells_.size(); }
  /// In an order that does not depend on that of add(). Weights add up to 1.
  std::vector<Value> values() const;

 private:
  static constexpr std::size_t kMostChannels = 10;
  using Key = std::array<std::uint8_t, kMostChannels>;
  struct Hash {
    std::size_t operator()(const Key& key) const;
  };
  struct Sum {
    std::array<double, kMostChannels> channels{};
    double weight = 0.0;
  };
  struct Channel {
    TextureSlot slot;
    std::size_t index;  // 0 to 3: red to alpha
    std::uint8_t low = 255;
    std::uint8_t high = 0;
  };
  std::uint8_t cell(const Channel& channel, double value) const;
  void merge(const Sum& sum);

  std::vector<Channel> channels_;
  std::unordered_map<Key, Sum, Hash> cells_;
  unsigned level_ = 0;
};

/// Combinations that forEachCombination may make.
inline constexpr std::size_t kMaxTexelCombinations = std::size_t{1} << 22;

/// Coarsens the largest of `groups`, again and again, until their sizes' product is at most
/// kMaxTexelCombinations. Returns it.
std::size_t limitCombinations(std::vector<TexelValues>& groups);

/// Calls `visit` with every combination of a value of each group, which have no slot in common, and with the
/// product of their weights: as independent as can be. All weights together are 1.
void forEachCombination(const std::vector<TexelValues>& groups,
                        const std::function<void(const SlotTexels&, double weight)>& visit);

}  // namespace ltcfit
