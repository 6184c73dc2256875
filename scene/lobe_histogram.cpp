#include "scene/lobe_histogram.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ltcfit {
namespace {

constexpr double kLevels = 255.0;
constexpr double kReflectanceLevels = 16.0;

// The fields of a cell's number, from the most significant: roughness 8 bits, anisotropy 9, f0 5, f90 5.
struct Cell {
  std::uint32_t roughness = 0;
  std::uint32_t anisotropy = 0;
  std::uint32_t f0 = 0;
  std::uint32_t f90 = 0;

  std::uint32_t number() const { return roughness << 19 | anisotropy << 10 | f0 << 5 | f90; }
  Cell coarser(unsigned level) const {
    // no anisotropy stays apart from little
    return {roughness >> level, anisotropy == 0 ? 0 : ((anisotropy - 1) >> level) + 1, f0 >> level,
            f90 >> level};
  }
};

Cell cellFrom(std::uint32_t number) {
  return {number >> 19, number >> 10 & 511, number >> 5 & 31, number & 31};
}

std::uint32_t step(double value, double levels) {
  return static_cast<std::uint32_t>(std::lround(std::clamp(value, 0.0, 1.0) * levels));
}

double ratioOf(const LobeUse& lobe) {
  return lobe.alphaX > 0.0 ? lobe.alphaY / lobe.alphaX : 1.0;
}

}  // namespace

std::uint32_t LobeHistogram::cellOf(const LobeUse& lobe) const {
  const double more = lobe.alphaX - lobe.alphaY;
  const double anisotropy = more > 0.0 ? std::sqrt(more / (1.0 - lobe.alphaY)) : 0.0;
  const Cell cell{step(std::sqrt(lobe.alphaY), kLevels), step(anisotropy, kLevels),
                  step(lobe.f0, kReflectanceLevels), step(lobe.f90, kReflectanceLevels)};
  return cell.coarser(level_).number();
}

void LobeHistogram::add(const LobeUse& lobe) {
  const std::uint32_t number = cellOf(lobe);
  const double alphaX = cellFrom(number).anisotropy == 0 ? lobe.alphaY : lobe.alphaX;
  LobeUse& sum = cells_.try_emplace(number, LobeUse{0.0, 0.0, 0.0, 0.0, 0.0}).first->second;
  sum.alphaX += lobe.weight * alphaX;
  sum.alphaY += lobe.weight * lobe.alphaY;
  sum.f0 += lobe.weight * lobe.f0;
  sum.f90 += lobe.weight * lobe.f90;
  sum.weight += lobe.weight;
  weight_ += lobe.weight;
  const auto keep = [&lobe](LobeUse& end, double value, double known, int sign) {
    if (end.weight == 0.0 || sign * value > sign * known) end = lobe;
  };
  keep(ends_[0], lobe.alphaX, ends_[0].alphaX, -1);
  keep(ends_[1], lobe.alphaX, ends_[1].alphaX, 1);
  keep(ends_[2], ratioOf(lobe), ratioOf(ends_[2]), -1);
  keep(ends_[3], ratioOf(lobe), ratioOf(ends_[3]), 1);
  while (cells_.size() > kMaxLobes) coarsen();
}

void LobeHistogram::coarsen() {
  std::vector<std::pair<std::uint32_t, LobeUse>> old(cells_.begin(), cells_.end());
  // in one order, so that the sums do not depend on the hash table
  std::sort(old.begin(), old.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  cells_.clear();
  ++level_;
  for (const auto& [number, sum] : old) {
    LobeUse& into = cells_.try_emplace(cellFrom(number).coarser(1).number(), LobeUse{0.0, 0.0, 0.0, 0.0, 0.0})
                        .first->second;
    into.alphaX += sum.alphaX;
    into.alphaY += sum.alphaY;
    into.f0 += sum.f0;
    into.f90 += sum.f90;
    into.weight += sum.weight;
  }
}

std::vector<LobeUse> LobeHistogram::lobes(double share) const {
  std::vector<std::pair<std::uint32_t, LobeUse>> sorted(cells_.begin(), cells_.end());
  std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<LobeUse> out;
  out.reserve(sorted.size());
  for (const auto& [number, sum] : sorted) {
    const double w = sum.weight;
    // a mean of equal numbers may differ in the last bit
    const auto mean = [w](double value) { return std::clamp(value / w, 0.0, 1.0); };
    LobeUse lobe{mean(sum.alphaX), mean(sum.alphaY), mean(sum.f0), mean(sum.f90), share * w / weight_};
    lobe.alphaX = std::max(lobe.alphaX, lobe.alphaY);
    out.push_back(lobe);
  }
  if (level_ == 0) return out;
  double total = share;
  for (const LobeUse& end : ends_) {
    out.push_back(end);
    out.back().weight *= share / weight_;
    total += out.back().weight;
  }
  for (LobeUse& lobe : out) lobe.weight *= share / total;
  return out;
}

}  // namespace ltcfit
