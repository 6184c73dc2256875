#include "scene/texel_values.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ltcfit {

TexelValues::TexelValues(const std::vector<TextureSlot>& slots) {
  for (const TextureSlot slot : slots)
    for (const std::size_t index : channelsOf(slot)) channels_.push_back({slot, index});
}

std::size_t TexelValues::Hash::operator()(const Key& key) const {
  // FNV-1a
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const std::uint8_t byte : key) hash = (hash ^ byte) * 0x100000001b3;
  return static_cast<std::size_t>(hash ^ hash >> 32);
}

void TexelValues::widen(const SlotTexels& texels) {
  for (Channel& c : channels_) {
    c.low = std::min(c.low, texels[c.slot][c.index]);
    c.high = std::max(c.high, texels[c.slot][c.index]);
  }
}

std::uint8_t TexelValues::cell(const Channel& channel, double value) const {
  // means of equal numbers may differ in their last bit
  const auto rounded = static_cast<std::uint8_t>(std::lround(value));
  if (level_ == 0) return rounded;
  if (rounded == channel.low) return 0;
  return rounded == channel.high ? 255 : static_cast<std::uint8_t>(1 + (rounded >> level_));
}

void TexelValues::add(const SlotTexels& texels, double weight) {
  if (!(weight > 0.0)) return;
  Sum sum;
  for (std::size_t i = 0; i < channels_.size(); ++i)
    sum.channels[i] = weight * texels[channels_[i].slot][channels_[i].index];
  sum.weight = weight;
  merge(sum);
  while (cells_.size() > kMaxValues && level_ < kCoarsest) coarsen();
}

void TexelValues::merge(const Sum& sum) {
  Key key{};
  for (std::size_t i = 0; i < channels_.size(); ++i)
    key[i] = cell(channels_[i], sum.channels[i] / sum.weight);
  Sum& into = cells_[key];
  for (std::size_t i = 0; i < channels_.size(); ++i) into.channels[i] += sum.channels[i];
  into.weight += sum.weight;
}

void TexelValues::coarsen() {
  // in one order, so that sums do not depend on the hash table
  std::vector<std::pair<Key, Sum>> old(cells_.begin(), cells_.end());
  std::sort(old.begin(), old.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  cells_.clear();
  ++level_;
  for (const auto& [key, sum] : old) merge(sum);
}

std::vector<TexelValues::Value> TexelValues::values() const {
  std::vector<std::pair<Key, Sum>> sorted(cells_.begin(), cells_.end());
  std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  double total = 0.0;
  for (const auto& [key, sum] : sorted) total += sum.weight;
  std::vector<Value> out;
  out.reserve(sorted.size());
  for (const auto& [key, sum] : sorted) {
    Value& value = out.emplace_back();
    for (auto& texel : value.texels) texel.fill(255);
    for (std::size_t i = 0; i < channels_.size(); ++i)
      value.texels[channels_[i].slot][channels_[i].index] =
          static_cast<std::uint8_t>(std::lround(sum.channels[i] / sum.weight));
    value.weight = sum.weight / total;
  }
  return out;
}

std::size_t limitCombinations(std::vector<TexelValues>& groups) {
  const auto product = [&] {
    double all = 1.0;
    for (const TexelValues& group : groups) all *= static_cast<double>(group.size());
    return all;
  };
  // ten channels of three cells each are 59,049
  while (product() > static_cast<double>(kMaxTexelCombinations)) {
    const auto coarsest = [](const TexelValues& group) { return group.level() == TexelValues::kCoarsest; };
    std::max_element(groups.begin(), groups.end(), [&](const TexelValues& a, const TexelValues& b) {
      return std::pair(!coarsest(a), a.size()) < std::pair(!coarsest(b), b.size());
    })->coarsen();
  }
  return static_cast<std::size_t>(product());
}

void forEachCombination(const std::vector<TexelValues>& groups,
                        const std::function<void(const SlotTexels&, double weight)>& visit) {
  std::vector<std::vector<TexelValues::Value>> values;
  values.reserve(groups.size());
  for (const TexelValues& group : groups) values.push_back(group.values());
  SlotTexels texels;
  for (auto& texel : texels) texel.fill(255);
  const std::function<void(std::size_t, const SlotTexels&, double)> descend =
      [&](std::size_t g, const SlotTexels& above, double weight) {
        if (g == values.size()) {
          visit(above, weight);
          return;
        }
        for (const TexelValues::Value& value : values[g]) {
          SlotTexels both = above;
          for (std::size_t s = 0; s < kTextureSlots; ++s)
            for (std::size_t c = 0; c < 4; ++c) both[s][c] = std::min(both[s][c], value.texels[s][c]);
          descend(g + 1, both, weight * value.weight);
        }
      };
  descend(0, texels, 1.0);
}

}  // namespace ltcfit
