#include "export/readings.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/angles.h"
#include "export/layouts.h"

namespace ltcfit {
namespace {

void addName(std::string& name, std::string_view part) {
  if (!name.empty()) name += ", ";
  name += part;
}

AxisMap otherMap(const Axis& axis) {
  if (axis.map != AxisMap::kLinear) return AxisMap::kLinear;
  return axis.unit == "rad" ? AxisMap::kSqrtOneMinusCos : AxisMap::kSqrt;
}

// The same range in so many texels; nothing where the nodes follow no formula.
std::optional<Axis> withSize(const Axis& axis, std::size_t n) {
  if (n == axis.size()) return axis;
  if (axis.map == AxisMap::kNone || n < 2) return std::nullopt;
  return makeAxis(axis.name, axis.unit, axis.map, n, axis.low, axis.high, 0.0, axis.warp);
}

// The axis spaced in the map that others use; nothing where that makes no difference or there is no map.
std::optional<Axis> withOtherMap(const Axis& axis) {
  if (axis.map == AxisMap::kNone || axis.warp != AxisWarp{} || axis.size() < 3) return std::nullopt;
  return makeAxis(axis.name, axis.unit, otherMap(axis), axis.size(), axis.low, axis.high);
}

std::string nameOfMap(const Axis& axis) {
  if (axis.map == AxisMap::kLinear) return fmt::format("{} linear", axis.name);
  if (axis.map == AxisMap::kSqrt) return fmt::format("{} by its square root", axis.name);
  return fmt::format("{0} by sqrt(1 - cos {0})", axis.name);
}

// The axes in another order, of the sizes that the data have.
std::optional<std::vector<Axis>> inOrder(const std::vector<Axis>& axes,
                                         const std::vector<std::size_t>& order) {
  std::vector<Axis> out;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    std::optional<Axis> axis = withSize(axes[order[a]], axes[a].size());
    if (!axis) return std::nullopt;
    out.push_back(std::move(*axis));
  }
  return out;
}

std::string nameOfOrder(const std::vector<Axis>& axes, const std::vector<std::size_t>& order) {
  if (axes.size() == 2) return "axes exchanged";
  std::string out;
  for (std::size_t a : order) addName(out, axes[a].name);
  return "axes in the order " + out;
}

// Every subset of the axes reversed, and of their maps replaced, up to so many changes.
void addVariants(const Arrangement& base, int most, std::vector<Arrangement>& out) {
  const std::size_t n = base.axes.size();
  for (unsigned bits = 0; bits < (1u << (2 * n)); ++bits) {
    Arrangement arrangement = base;
    bool exists = true;
    for (std::size_t a = 0; a < n; ++a) {
      Axis& axis = arrangement.axes[a];
      if ((bits >> (n + a) & 1u) != 0) {
        const std::optional<Axis> other = withOtherMap(axis);
        exists = exists && other && axis.name != "phi";
        if (!exists) break;
        axis = *other;
        addName(arrangement.name, nameOfMap(axis));
        ++arrangement.changes;
      }
      if ((bits >> a & 1u) != 0) {
        exists = exists && axis.size() > 1;
        std::reverse(axis.values.begin(), axis.values.end());
        addName(arrangement.name, axis.name + " reversed");
        ++arrangement.changes;
      }
    }
    if (exists && arrangement.changes <= most) out.push_back(std::move(arrangement));
  }
}

Eigen::Matrix3d swapOfXAndY() {
  Eigen::Matrix3d swap;
  swap << 0, 1, 0,  //
      1, 0, 0,      //
      0, 0, 1;
  return swap;
}

// Whether element (d, d) of every stored matrix is 1: what its layout divides by.
bool isDividedBy(const Table& table, Divisor divisor) {
  const std::vector<std::string>& channels = table.info().channels;
  const auto channel = static_cast<std::size_t>(
      std::find(channels.begin(), channels.end(), divisorName(divisor)) - channels.begin());
  for (std::size_t i = channel; i < table.data().size(); i += channels.size())
    if (table.data()[i] != 1.0f) return false;
  return true;
}

// The matrix as another packing has it whose texels have the same four numbers.
struct Repacking {
  std::string name;
  std::array<std::pair<int, int>, 4> from;
  std::array<std::pair<int, int>, 4> to;

  Eigen::Matrix3d operator()(const Eigen::Matrix3d& stored) const {
    Eigen::Matrix3d out = Eigen::Matrix3d::Zero();
    // the one of the diagonal that is in no texel
    for (int d = 0; d < 3; ++d)
      out(d, d) = std::find(to.begin(), to.end(), std::pair(d, d)) == to.end() ? 1.0 : 0.0;
    for (std::size_t c = 0; c < 4; ++c)
      out(to[c].first, to[c].second) = stored(from[c].first, from[c].second);
    return out;
  }
};

std::array<std::pair<int, int>, 4> placesOf(const TextureSpec& texture) {
  std::array<std::pair<int, int>, 4> out;
  for (std::size_t c = 0; c < 4; ++c)
    out[c] = {texture.components[c][1] - '0', texture.components[c][2] - '0'};
  return out;
}

std::vector<Repacking> repackingsOf(const Table& table) {
  std::vector<Repacking> out;
  if (!table.isIsotropic() || table.info().stores != MatrixStorage::kMinv) return out;
  const TableLayout* own = nullptr;
  for (const TableLayout& layout : tableLayouts()) {
    if (layout.hasWholeMatrix() && isDividedBy(table, layout.packing.divisor)) own = &layout;
  }
  if (own == nullptr) return out;
  for (const TableLayout& layout : tableLayouts()) {
    if (!layout.hasWholeMatrix() || layout.packing.divisor == own->packing.divisor) continue;
    out.push_back({fmt::format("components in the order of {}", layout.name),
                   placesOf(own->packing.textures[0]), placesOf(layout.packing.textures[0])});
  }
  return out;
}

}  // namespace

std::vector<Arrangement> arrangementsOf(const Table& table) {
  const std::vector<Axis>& axes = table.info().axes;
  std::vector<Arrangement> out;
  const Arrangement own{"", 0, axes};
  std::vector<std::size_t> order(axes.size());
  for (std::size_t a = 0; a < order.size(); ++a) order[a] = a;
  const bool isotropic = table.isIsotropic();
  addVariants(own, isotropic ? 3 : 1, out);
  if (!isotropic) {
    Arrangement both{"axes alpha_x, alpha_y instead of alpha, lambda", 1, axes};
    both.axes[0].name = "alpha_x";
    both.axes[1].name = "alpha_y";
    addVariants(both, 2, out);
  }
  while (std::next_permutation(order.begin(), order.end())) {
    const std::optional<std::vector<Axis>> other = inOrder(axes, order);
    if (other) addVariants({nameOfOrder(axes, order), 1, *other}, isotropic ? 3 : 1, out);
  }
  return out;
}

LobeParameters parametersOf(const Arrangement& arrangement, const std::vector<std::size_t>& node,
                            double floor) {
  LobeParameters p{1.0, 1.0, 0.0, 0.0};
  double lambda = 1.0;
  bool both = false;
  for (std::size_t a = 0; a < node.size(); ++a) {
    const Axis& axis = arrangement.axes[a];
    const double v = axis.values[node[a]];
    if (axis.name == "theta") p.theta = std::clamp(v, 0.0, kHalfPi);
    if (axis.name == "phi") p.phi = v;
    if (axis.name == "lambda") lambda = v;
    if (axis.name == "alpha" || axis.name == "alpha_x") p.alphaX = v;
    if (axis.name == "alpha_y") p.alphaY = v;
    both = both || axis.name == "alpha_y";
  }
  if (!both) p.alphaY = p.alphaX * lambda;
  p.alphaX = std::clamp(p.alphaX, floor, 1.0);
  p.alphaY = std::clamp(p.alphaY, floor, 1.0);
  return p;
}

std::vector<MatrixReading> matrixReadingsOf(const Table& table) {
  const bool storesM = table.info().stores == MatrixStorage::kM;
  const bool isotropic = table.isIsotropic();
  std::vector<Repacking> repackings = repackingsOf(table);
  const Eigen::Matrix3d swap = swapOfXAndY();
  // the view's side: a turn by 180 degrees, which for lobes symmetric in y mirrors x
  const Eigen::Matrix3d turn = Eigen::Vector3d(-1.0, -1.0, 1.0).asDiagonal();
  std::vector<MatrixReading> out;
  for (std::size_t r = 0; r <= repackings.size(); ++r) {
    for (unsigned bits = 0; bits < 16; ++bits) {
      const bool inverse = (bits & 1u) != 0;
      const bool transposed = (bits & 2u) != 0;
      const bool mirrored = (bits & 4u) != 0;
      const bool swapped = (bits & 8u) != 0;
      if (isotropic && swapped) continue;
      MatrixReading reading;
      if (r > 0) addName(reading.name, repackings[r - 1].name);
      if (inverse)
        addName(reading.name, storesM ? "the inverse of M in it, not M" : "M in it, not its inverse");
      if (transposed) addName(reading.name, "rows and columns of the matrix exchanged");
      if (mirrored) addName(reading.name, isotropic ? "x mirrored" : "x and y mirrored");
      if (swapped) addName(reading.name, "x and y exchanged");
      reading.changes = (r > 0) + inverse + transposed + mirrored + swapped;
      const auto repack = r > 0 ? std::optional<Repacking>(repackings[r - 1]) : std::nullopt;
      reading.m = [=](const TableEntry& entry) {
        Eigen::Matrix3d m = storesM ? entry.m : entry.mInv;
        if (repack) m = (*repack)(m);
        if (transposed) m.transposeInPlace();
        if (storesM == inverse) m = m.inverse().eval();
        if (mirrored) m = turn * m * turn;
        if (swapped) m = swap * m * swap;
        return m;
      };
      out.push_back(std::move(reading));
    }
  }
  return out;
}

}  // namespace ltcfit
