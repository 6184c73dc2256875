#include "ltc/table.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/refusal.h"
#include "ltc/symmetry.h"

namespace ltcfit {
namespace {

[[noreturn]] void fail(const std::string& what) {
  throw Refusal(what);
}

struct AxisRange {
  std::string_view name;
  double low;
  double high;
};
constexpr std::array<AxisRange, 2> kIsotropicAxes{{{"theta", 0.0, kHalfPi}, {"alpha", 0.0, 1.0}}};
constexpr std::array<AxisRange, 4> kAnisotropicAxes{
    {{"alpha", 0.0, 1.0}, {"lambda", 0.0, 1.0}, {"theta", 0.0, kHalfPi}, {"phi", 0.0, kHalfPi}}};
// Slack for angles that were written with few digits.
constexpr double kRangeSlack = 1e-6;
// A node inside the axis may differ from its texel's coordinate by this much of a texel, for rounding in the
// file, or by this part of the axis: the authors of 2022 fitted every theta at 0.9999 of where it is looked
// up.
constexpr double kTexelSlack = 1e-3;
constexpr double kAxisSlack = 1.0001e-4;
// Nodes per axis: far above any texture, far below what overflows a count.
constexpr std::size_t kMaxNodes = 65536;
// Nodes of a table: 64^4, the largest that was ever proposed (KT et al. 2022, section 8), fits with room.
constexpr std::size_t kMaxTableNodes = std::size_t{1} << 28;

bool hasAxes(const std::vector<Axis>& axes, std::span<const AxisRange> ranges) {
  return std::equal(axes.begin(), axes.end(), ranges.begin(), ranges.end(),
                    [](const Axis& axis, const AxisRange& range) { return axis.name == range.name; });
}

void validateAxis(const Axis& axis, const AxisRange& range) {
  const std::string where = "axis '" + axis.name + "'";
  const auto& v = axis.values;
  if (v.empty() || v.size() > kMaxNodes) {
    fail(where + ": " + std::to_string(v.size()) + " values, need 1 to " + std::to_string(kMaxNodes));
  }
  for (std::size_t i = 0; i < v.size(); ++i) {
    const std::string at = where + " values[" + std::to_string(i) + "]";
    if (!std::isfinite(v[i])) fail(at + " is not finite");
    if (v[i] < range.low || v[i] > range.high + kRangeSlack) {
      fail(at + " = " + std::to_string(v[i]) + " is outside of [" + std::to_string(range.low) + ", " +
           std::to_string(range.high) + "]");
    }
    if (i > 0 && !(v[i] > v[i - 1])) fail(at + " does not increase");
  }
  if (axis.unit != (range.high > 1.0 ? "rad" : "1"))
    fail(where + ": unit '" + axis.unit + "' is not " + (range.high > 1.0 ? "rad" : "1"));
  if (axis.map == AxisMap::kNone && axis.warp != AxisWarp{}) fail(where + " has a warp, but no map");
  if (axis.map == AxisMap::kNone) return;
  if (v.size() == 1) fail(where + " has one value, and can have no map");
  if (!isMonotone(axis.warp)) {
    fail(where + " warp: (" + std::to_string(axis.warp[0]) + ", " + std::to_string(axis.warp[1]) +
         ") leaves nodes too far apart (ltc/axis.h)");
  }
  if (!std::isfinite(axis.low) || !std::isfinite(axis.high) || !(axis.low < axis.high) ||
      axis.low < range.low || axis.high > range.high + kRangeSlack) {
    fail(where + " range: need two increasing numbers inside [" + std::to_string(range.low) + ", " +
         std::to_string(range.high) + "]");
  }
  const bool angle = range.high > 1.0;
  if ((axis.map == AxisMap::kSqrt && angle) || (axis.map == AxisMap::kSqrtOneMinusCos && !angle)) {
    fail(where + " cannot have the map '" + std::string(axisMapName(axis.map)) + "'");
  }
  for (std::size_t i = 0; i < v.size(); ++i) {
    // only the first and last node may be clamped, and not as far as the next texel
    const bool end = i == 0 || i + 1 == v.size();
    const double inside = std::max(kTexelSlack, kAxisSlack * static_cast<double>(v.size() - 1));
    const double slack = end ? 1.0 - kTexelSlack : inside;
    if (v[i] < axis.low - kRangeSlack || v[i] > axis.high + kRangeSlack ||
        !(std::abs(axis.texelFromValue(v[i]) - static_cast<double>(i)) <= slack)) {
      fail(where + " values[" + std::to_string(i) + "] is not where its map '" +
           std::string(axisMapName(axis.map)) + "' puts it");
    }
  }
}

}  // namespace

std::string_view matrixStorageName(MatrixStorage storage) {
  return storage == MatrixStorage::kM ? "M" : "Minv";
}

std::string_view matrixNormalizationName(MatrixNormalization normalization) {
  switch (normalization) {
    case MatrixNormalization::kThirdColumnUnit:
      return "third-column-unit";
    case MatrixNormalization::kMiddleElement:
      return "middle-element";
    case MatrixNormalization::kNone:
      break;
  }
  return "none";
}

MatrixStorage matrixStorageFromName(std::string_view name) {
  if (name == "M") return MatrixStorage::kM;
  if (name == "Minv") return MatrixStorage::kMinv;
  fail("matrix.stores '" + std::string(name) + "' (M or Minv)");
}

MatrixNormalization matrixNormalizationFromName(std::string_view name) {
  for (auto n : {MatrixNormalization::kNone, MatrixNormalization::kThirdColumnUnit,
                 MatrixNormalization::kMiddleElement}) {
    if (name == matrixNormalizationName(n)) return n;
  }
  fail("matrix.normalization '" + std::string(name) + "' (none, third-column-unit or middle-element)");
}

Eigen::Matrix3d normalized(const Eigen::Matrix3d& m, MatrixNormalization normalization) {
  switch (normalization) {
    case MatrixNormalization::kThirdColumnUnit:
      return m / m.col(2).norm();
    case MatrixNormalization::kMiddleElement:
      return m / m(1, 1);
    case MatrixNormalization::kNone:
      break;
  }
  return m;
}

Table::Table(TableInfo info, std::vector<float> data) : info_(std::move(info)), data_(std::move(data)) {
  validateAxes();
  bindChannels();
  if (!std::isfinite(info_.alphaFloor) || info_.alphaFloor < 0.0 || info_.alphaFloor > 1.0) {
    fail("alpha_floor is not in [0, 1]");
  }
  nodeCount_ = 1;
  for (const Axis& axis : info_.axes) {
    nodeCount_ *= axis.size();
    if (nodeCount_ > kMaxTableNodes) fail("axes: more than " + std::to_string(kMaxTableNodes) + " nodes");
  }
  if (data_.size() != nodeCount_ * channelCount()) {
    fail("data: " + std::to_string(data_.size()) + " numbers, but the axes and channels need " +
         std::to_string(nodeCount_) + " x " + std::to_string(channelCount()));
  }
  const auto bad = std::find_if(data_.begin(), data_.end(), [](float x) { return !std::isfinite(x); });
  if (bad != data_.end())
    fail(numberName(info_, static_cast<std::size_t>(bad - data_.begin())) + " is not finite");
}

std::string numberName(const TableInfo& info, std::size_t index) {
  std::size_t rest = info.channels.empty() ? 0 : index / info.channels.size();
  std::string name;
  for (auto axis = info.axes.rbegin(); axis != info.axes.rend() && axis->size() > 0; ++axis) {
    name = axis->name + "[" + std::to_string(rest % axis->size()) + "], " + name;
    rest /= axis->size();
  }
  if (info.channels.empty() || rest > 0) return "data[" + std::to_string(index) + "]";
  return name + info.channels[index % info.channels.size()];
}

void Table::validateAxes() const {
  std::span<const AxisRange> ranges;
  if (hasAxes(info_.axes, kIsotropicAxes)) ranges = kIsotropicAxes;
  if (hasAxes(info_.axes, kAnisotropicAxes)) ranges = kAnisotropicAxes;
  if (ranges.empty()) fail("axes: need theta, alpha or alpha, lambda, theta, phi, in this order");
  for (std::size_t i = 0; i < ranges.size(); ++i) validateAxis(info_.axes[i], ranges[i]);
}

void Table::bindChannels() {
  matrixChannel_.fill(-1);
  for (std::size_t i = 0; i < info_.channels.size(); ++i) {
    const std::string& name = info_.channels[i];
    int* slot = nullptr;
    if (name == "norm") slot = &normChannel_;
    if (name == "fresnel") slot = &fresnelChannel_;
    if (name.size() == 3 && name[0] == 'm' && name[1] >= '0' && name[1] <= '2' && name[2] >= '0' &&
        name[2] <= '2') {
      slot = &matrixChannel_[static_cast<std::size_t>((name[1] - '0') * 3 + (name[2] - '0'))];
    }
    if (slot == nullptr) fail("channels[" + std::to_string(i) + "]: unknown name '" + name + "'");
    if (*slot >= 0) fail("channels[" + std::to_string(i) + "]: '" + name + "' occurs twice");
    *slot = static_cast<int>(i);
  }
  for (std::size_t d : {0u, 4u, 8u}) {
    if (matrixChannel_[d] < 0) fail("channels: the matrix needs m00, m11 and m22");
  }
}

std::size_t Table::index(std::span<const std::size_t> node) const {
  std::size_t flat = 0;
  for (std::size_t a = 0; a < info_.axes.size(); ++a) flat = flat * info_.axes[a].size() + node[a];
  return flat * channelCount();
}

std::vector<std::size_t> Table::node(std::size_t flat) const {
  std::vector<std::size_t> out(info_.axes.size());
  for (std::size_t a = out.size(); a-- > 0;) {
    out[a] = flat % info_.axes[a].size();
    flat /= info_.axes[a].size();
  }
  return out;
}

LobeParameters Table::parameters(std::span<const std::size_t> node) const {
  const auto value = [&](std::size_t a) { return info_.axes[a].values[node[a]]; };
  const double floor = info_.alphaFloor;
  if (isIsotropic()) {
    const double alpha = std::max(value(1), floor);
    return {alpha, alpha, std::min(value(0), kHalfPi), 0.0};
  }
  return {std::max(value(0), floor), std::max(value(0) * value(1), floor), std::min(value(2), kHalfPi),
          std::min(value(3), kHalfPi)};
}

TableEntry Table::unpack(const double* channels) const {
  Eigen::Matrix3d stored;
  for (int k = 0; k < 9; ++k) {
    const int c = matrixChannel_[static_cast<std::size_t>(k)];
    stored(k / 3, k % 3) = c < 0 ? 0.0 : channels[c];
  }
  TableEntry entry;
  const Eigen::Matrix3d inverse = stored.inverse();
  entry.m = info_.stores == MatrixStorage::kM ? stored : inverse;
  entry.mInv = info_.stores == MatrixStorage::kM ? inverse : stored;
  entry.invertible = inverse.allFinite() && std::abs(entry.m.determinant()) > 0.0;
  if (normChannel_ >= 0) entry.norm = channels[normChannel_];
  if (fresnelChannel_ >= 0) entry.fresnel = channels[fresnelChannel_];
  return entry;
}

TableEntry Table::entry(std::span<const std::size_t> node) const {
  const std::size_t offset = index(node);
  std::vector<double> channels(channelCount());
  for (std::size_t c = 0; c < channels.size(); ++c) channels[c] = static_cast<double>(data_[offset + c]);
  return unpack(channels.data());
}

Table storedAs(const Table& table, MatrixStorage stores, MatrixNormalization normalization) {
  TableInfo info = table.info();
  info.stores = stores;
  info.normalization = normalization;
  const auto has = [&](std::string_view name) {
    return std::find(table.info().channels.begin(), table.info().channels.end(), name) !=
           table.info().channels.end();
  };
  const bool planar = !has("m01") && !has("m10") && !has("m12") && !has("m21");
  info.channels = {"m00", "m02", "m11", "m20", "m22"};
  if (!planar) info.channels = {"m00", "m01", "m02", "m10", "m11", "m12", "m20", "m21", "m22"};
  const std::size_t matrixChannels = info.channels.size();
  if (has("norm")) info.channels.push_back("norm");
  if (has("fresnel")) info.channels.push_back("fresnel");

  std::vector<float> data;
  data.reserve(table.nodeCount() * info.channels.size());
  for (std::size_t i = 0; i < table.nodeCount(); ++i) {
    const TableEntry entry = table.entry(table.node(i));
    const auto refuse = [&](const char* what) { fail("node " + std::to_string(i) + " " + what); };
    if (!entry.invertible) refuse("has no inverse");
    Eigen::Matrix3d m = stores == MatrixStorage::kM ? entry.m : entry.mInv;
    if (normalization == MatrixNormalization::kMiddleElement && m(1, 1) < 0.0) {
      // M diag(1, -1, 1) is the same lobe: column 1 of M, row 1 of its inverse
      if (stores == MatrixStorage::kM) {
        m.col(1) *= -1.0;
      } else {
        m.row(1) *= -1.0;
      }
    }
    const Eigen::Matrix3f f = normalized(m, normalization).cast<float>();
    if (!f.allFinite()) refuse("has an inverse that does not fit float32");
    for (std::size_t c = 0; c < matrixChannels; ++c) {
      data.push_back(f(info.channels[c][1] - '0', info.channels[c][2] - '0'));
    }
    if (entry.norm) data.push_back(static_cast<float>(*entry.norm));
    if (entry.fresnel) data.push_back(static_cast<float>(*entry.fresnel));
  }
  return Table(std::move(info), std::move(data));
}

LookUpNodes lookUpNodes(const std::vector<Axis>& axes, const LobeParameters& p) {
  const std::size_t dims = axes.size();
  // at alpha 0 all lambdas are the same lobe, that of the floor
  const double lambda = p.alphaX > 0.0 ? p.alphaY / p.alphaX : 1.0;
  const std::array<double, 4> value = dims == 2 ? std::array<double, 4>{p.theta, p.alphaX, 0.0, 0.0}
                                                : std::array<double, 4>{p.alphaX, lambda, p.theta, p.phi};
  std::array<std::size_t, 4> base{};
  std::array<double, 4> fraction{};
  for (std::size_t a = 0; a < dims; ++a) {
    const double t = axes[a].texelFromValue(value[a]);
    base[a] = std::min(static_cast<std::size_t>(t), std::max<std::size_t>(axes[a].size(), 2) - 2);
    fraction[a] = t - static_cast<double>(base[a]);
  }
  LookUpNodes out;
  for (std::size_t corner = 0; corner < (std::size_t{1} << dims); ++corner) {
    std::size_t node = 0;
    double weight = 1.0;
    for (std::size_t a = 0; a < dims; ++a) {
      const bool upper = ((corner >> a) & 1u) != 0;
      node = node * axes[a].size() + base[a] + (upper ? 1 : 0);
      weight *= upper ? fraction[a] : 1.0 - fraction[a];
    }
    if (weight == 0.0) continue;
    out.node[out.count] = node;
    out.weight[out.count++] = weight;
  }
  return out;
}

TableEntry Table::fetch(const LobeParameters& asked) const {
  const CanonicalLobe lobe =
      isIsotropic() ? CanonicalLobe{asked, Eigen::Matrix3d::Identity()} : canonicalLobe(asked);
  const LookUpNodes nodes = lookUpNodes(info_.axes, lobe.parameters);
  std::vector<double> channels(channelCount(), 0.0);
  for (std::size_t k = 0; k < nodes.count; ++k) {
    const std::size_t offset = nodes.node[k] * channelCount();
    for (std::size_t c = 0; c < channels.size(); ++c)
      channels[c] += nodes.weight[k] * static_cast<double>(data_[offset + c]);
  }
  TableEntry entry = unpack(channels.data());
  if (!isIsotropic()) {
    entry.m = fromCanonical(lobe, entry.m);
    entry.mInv = fromCanonical(lobe, entry.mInv);
  }
  return entry;
}

}  // namespace ltcfit
