#include "export/published_table.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>

#include "base/angles.h"
#include "base/refusal.h"
#include "export/atomic_file.h"
#include "export/direction_moments.h"
#include "export/reading_verdict.h"
#include "export/texture_files.h"

namespace ltcfit {
namespace {

// What the authors' fitting codes clamp to.
constexpr double kFloor2017 = 1e-5;
constexpr double kTheta2017 = 1.57;
constexpr double kFloor2022 = 1e-4;
constexpr double kTheta2022 = 0.9999 * kHalfPi;
constexpr double kMaxOdd = 0.02;  // part of the texels
// The misfit of every table fitted to GGX is below; that of another layout is 0.2 or more.
constexpr double kWellRead = 0.06;
// Mean distances of lobes between two of a table with axes alpha_x and alpha_y.
constexpr double kSymmetric = 0.03;
constexpr double kClearlySymmetric = 4.0;

Axis withLastValue(Axis axis, double value) {
  axis.values.back() = value;
  return axis;
}

// What nearly every texel of such a table has, and other layouts do not: a diagonal and a determinant above
// zero; a norm in (0, 1] not below the Fresnel term, and an empty third component. Published tables break
// each at a few texels.
void checkIs2017(const Image& first, const Image* second, const std::string& name) {
  std::size_t badMatrix = 0;
  std::size_t badAmplitude = 0;
  for (std::size_t i = 0; i < first.texels(); ++i) {
    const float* const m = first.values.data() + i * first.components;
    badMatrix += m[0] > 0.0f && m[0] * m[3] - m[1] * m[2] > 0.0f ? 0 : 1;
    if (second == nullptr) continue;
    const float* const a = second->values.data() + i * second->components;
    const bool good = a[0] > 0.0f && a[0] < 1.01f && a[1] > -0.01f && a[1] < a[0] + 0.01f &&
                      (second->components < 3 || a[2] == 0.0f);
    badAmplitude += good ? 0 : 1;
  }
  const auto check = [&](std::size_t bad, const char* what) {
    if (static_cast<double>(bad) <= kMaxOdd * static_cast<double>(first.texels())) return;
    throw InputError(
        fmt::format("{}: not the layout of 2017 ({} texels of {} have {}), and no description of another one "
                    "beside it",
                    name, bad, first.texels(), what));
  };
  check(badMatrix, "no matrix of it: Minv00 and the determinant must be above 0");
  check(badAmplitude, "no norm in 0..1 with a Fresnel term below it in the second texture");
}

bool isComponentZero(const Image& image, std::size_t component) {
  for (std::size_t i = component; i < image.values.size(); i += image.components)
    if (image.values[i] != 0.0f) return false;
  return true;
}

// A layout, and how well it fits.
struct LayoutFit {
  const TableLayout* layout;
  PackedTable packed;
  double misfit;
};

std::vector<LayoutFit> layoutFits(const Image& first, const Image* second, const std::string& name) {
  std::vector<LayoutFit> out;
  for (const TableLayout& layout : tableLayouts()) {
    const bool takesSecond = layout.packing.textures.size() > 1;
    if ((second != nullptr && !takesSecond) || (second == nullptr && !layout.hasWholeMatrix())) continue;
    PackedTable packed = packedAs(layout, first, second, name);
    const double misfit = misfitOf(tableFromPacked(packed, name));
    out.push_back({&layout, std::move(packed), misfit});
  }
  return out;
}

std::string misfitsOf(const std::vector<LayoutFit>& fits) {
  std::string list;
  for (const LayoutFit& c : fits)
    list += fmt::format("{}{} {:.3f}", list.empty() ? "" : ", ", c.layout->name, c.misfit);
  return list;
}

[[noreturn]] void refuseLayout(const std::string& name, const std::string& layout, const std::string& known) {
  throw InputError(
      fmt::format("{}: layout '{}' is not one for these numbers (there are {})", name, layout, known));
}

// M of the lobe that the array has at a node, as nine numbers.
Eigen::Matrix3d matrixAt(const FloatArray& array, std::size_t i, std::size_t j, std::size_t k,
                         std::size_t l) {
  const auto& s = array.shape;
  const std::size_t at = (((i * s[1] + j) * s[2] + k) * s[3] + l) * 9;
  Eigen::Matrix3d m;
  for (int c = 0; c < 9; ++c)
    m(c / 3, c % 3) = static_cast<double>(array.values[at + static_cast<std::size_t>(c)]);
  return m;
}

// Whether the first two axes are alpha_x and alpha_y. Their exchange then is that of x and y. Measured: the
// mean distance of the lobes is 0.001 with the exchange for such a table, 0.1 for one of alpha and lambda.
bool hasAlphaAxes(const FloatArray& array) {
  const auto& s = array.shape;
  if (s[0] != s[1]) return false;
  Eigen::Matrix3d swap = Eigen::Vector3d(0.0, 0.0, 1.0).asDiagonal();
  swap(0, 1) = swap(1, 0) = 1.0;
  double exchanged = 0.0;
  double asIs = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < s[0]; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      for (std::size_t k = 0; k < s[2]; ++k) {
        for (std::size_t l = 0; l < s[3]; ++l) {
          const DirectionMoments lobe = ltcMoments(matrixAt(array, i, j, k, l));
          const Eigen::Matrix3d other = matrixAt(array, j, i, k, s[3] - 1 - l);
          exchanged += momentDistance(lobe, ltcMoments(swap * other * swap));
          asIs += momentDistance(lobe, ltcMoments(matrixAt(array, j, i, k, l)));
          ++count;
        }
      }
    }
  }
  return exchanged < kSymmetric * static_cast<double>(count) && kClearlySymmetric * exchanged < asIs;
}

void needMatrices(const FloatArray& array, const std::string& name) {
  const auto& s = array.shape;
  if (s.size() != 6 || s[4] != 3 || s[5] != 3)
    throw InputError(name + ": shape (" + fmt::format("{}", fmt::join(s, ", ")) + ") is not (.., 3, 3)");
}

}  // namespace

PackedTable packedAs(const TableLayout& layout, const Image& first, const Image* second,
                     const std::string& name) {
  const auto size = [](const Image& image) {
    return fmt::format("{} x {} x {}, {} components, {} layers", image.width, image.height, image.depth,
                       image.components, image.layers);
  };
  if (first.components != 4 || first.depth != 1 || first.layers != 1 || first.width < 2 || first.height < 2)
    throw InputError(fmt::format("{}: {}: not the layout of {}, which is a 2D texture of 4 components", name,
                                 size(first), layout.name));
  if (second != nullptr &&
      (second->width != first.width || second->height != first.height || second->texels() != first.texels() ||
       second->components < 2 || second->components > 4)) {
    throw InputError(name + ": the second texture, " + size(*second) + ", does not go with the first, " +
                     size(first));
  }
  if (isComponentZero(first, 2) || isComponentZero(first, 3))
    throw InputError(name + ": this is the second texture (norm, Fresnel); give the first one");

  PackedTable packed;
  packed.packing = layout.packing;
  packed.precision = first.precision;
  packed.images = {first};
  std::vector<TextureSpec>& textures = packed.packing.textures;
  if (textures.size() > 1 && second != nullptr) {
    textures[1].components.resize(second->components, "0");
    packed.images.push_back(*second);
  } else if (!layout.hasWholeMatrix()) {
    throw InputError(fmt::format("{}: the layout of {} has M22 in its second texture, and there is none",
                                 name, layout.name));
  }
  textures.resize(packed.images.size());
  TableInfo& info = packed.info;
  info.stores = packed.packing.stores;
  info.normalization = normalizationOf(packed.packing.divisor);
  info.alphaFloor = kFloor2017;
  info.provenance.tool =
      fmt::format("an undescribed table in the layout of {}, taken for its axes", layout.name);
  info.provenance.options = {{"family", std::string("3")}};  // what the authors' code of 2017 fits
  try {
    info.axes.push_back(
        withLastValue(makeAxis("theta", "rad", layout.theta, first.height, 0.0, kHalfPi), kTheta2017));
    info.axes.push_back(makeAxis("alpha", "1", AxisMap::kSqrt, first.width, 0.0, 1.0, kFloor2017));
  } catch (const Refusal& error) {
    throw InputError(name + ": " + error.what());
  }
  return packed;
}

PackedTable packedFrom2017(const Image& first, const Image* second, const std::string& name) {
  PackedTable packed = packedAs(*findLayout("2017"), first, second, name);
  checkIs2017(first, second, name);
  return packed;
}

Table tableFrom2017(const Image& first, const Image* second, const std::string& name) {
  return tableFromPacked(packedFrom2017(first, second, name), name);
}

PackedTable packedUndescribed(const Image& first, const Image* second, const std::string& layout,
                              const std::string& name, std::vector<std::string>& notes) {
  if (!layout.empty()) {
    const TableLayout* const known = findLayout(layout);
    if (known == nullptr) refuseLayout(name, layout, "2017, 2016 or o3de, hdrp or unity-hdrp, godot");
    if (second != nullptr && known->packing.textures.size() < 2)
      throw InputError(fmt::format("{}: the layout of {} has no second texture", name, known->name));
    return packedAs(*known, first, second, name);
  }
  std::vector<LayoutFit> fits = layoutFits(first, second, name);
  const auto best = std::min_element(
      fits.begin(), fits.end(), [](const LayoutFit& a, const LayoutFit& b) { return a.misfit < b.misfit; });
  LayoutFit& usual = fits.front();
  if (best->misfit <= kWellRead && best->misfit * kClearlyBetter < usual.misfit) {
    notes.push_back(fmt::format("{}: taken for the layout of {} by its numbers (misfits: {}): {}", name,
                                best->layout->name, misfitsOf(fits), best->layout->contents));
    return std::move(best->packed);
  }
  try {
    checkIs2017(first, second, name);
  } catch (const InputError& error) {
    throw InputError(
        fmt::format("{}; in none of the known ones do they make GGX lobes (misfits: {}): tell which it is",
                    error.what(), misfitsOf(fits)));
  }
  return std::move(usual.packed);
}

Table tableFrom2022(const FloatArray& array, const std::string& name) {
  needMatrices(array, name);
  const auto& s = array.shape;
  TableInfo info;
  info.stores = MatrixStorage::kM;
  info.normalization = MatrixNormalization::kThirdColumnUnit;
  info.channels = {"m00", "m01", "m02", "m10", "m11", "m12", "m20", "m21", "m22"};
  info.alphaFloor = kFloor2022;
  info.provenance.tool = "an undescribed table in the layout of 2022, taken for its axes";
  try {
    const AxisMap linear = AxisMap::kLinear;
    info.axes.push_back(makeAxis("alpha", "1", linear, s[0], 0.0, 1.0));
    info.axes.push_back(makeAxis("lambda", "1", linear, s[1], 0.0, 1.0));
    info.axes.push_back(makeAxis("theta", "rad", linear, s[2], 0.0, kHalfPi));
    // fitted at k / 7 * 0.9999 * pi/2, looked up with k / 7 * pi/2
    for (double& v : info.axes.back().values) v *= kTheta2022 / kHalfPi;
    info.axes.push_back(makeAxis("phi", "rad", linear, s[3], 0.0, kHalfPi));
    return Table(std::move(info), array.values);
  } catch (const Refusal& error) {
    throw InputError(name + ": " + error.what());
  }
}

Table tableFromAlphas(const FloatArray& array, const std::string& name) {
  needMatrices(array, name);
  const auto& s = array.shape;
  if (s[0] != s[1] || s[0] < 2)
    throw InputError(fmt::format("{}: {} by {} nodes of alpha_x and alpha_y: two equal numbers are needed",
                                 name, s[0], s[1]));
  FloatArray out{s, {}};
  for (std::size_t i = 0; i < s[0]; ++i) {
    for (std::size_t j = 0; j < s[1]; ++j) {
      // alpha_y = alpha lambda, in nodes
      const double t = static_cast<double>(i * j) / static_cast<double>(s[1] - 1);
      const std::size_t below = std::min(static_cast<std::size_t>(t), s[1] - 2);
      const double part = t - static_cast<double>(below);
      for (std::size_t k = 0; k < s[2]; ++k) {
        for (std::size_t l = 0; l < s[3]; ++l) {
          const Eigen::Matrix3d m =
              (1.0 - part) * matrixAt(array, i, below, k, l) + part * matrixAt(array, i, below + 1, k, l);
          for (int c = 0; c < 9; ++c) out.values.push_back(static_cast<float>(m(c / 3, c % 3)));
        }
      }
    }
  }
  const Table table = tableFrom2022(out, name);
  TableInfo info = table.info();
  info.normalization = MatrixNormalization::kNone;  // interpolated
  info.provenance.tool = "an undescribed table with axes alpha_x, alpha_y, interpolated at alpha, lambda";
  return Table(std::move(info), table.data());
}

Table tableFromArray(const FloatArray& array, const std::string& layout, const std::string& name,
                     std::vector<std::string>& notes) {
  needMatrices(array, name);
  if (layout == kLayoutAlphas) return tableFromAlphas(array, name);
  if (!layout.empty() && layout != kLayout2022 && layout != "anisotropic-2022")
    refuseLayout(name, layout, fmt::format("{}, {}", kLayout2022, kLayoutAlphas));
  if (!layout.empty() || !hasAlphaAxes(array)) return tableFrom2022(array, name);
  notes.push_back(
      fmt::format("{}: taken for a table with axes alpha_x, alpha_y, theta, phi by its symmetry, and "
                  "interpolated at alpha, lambda = alpha_y / alpha",
                  name));
  return tableFromAlphas(array, name);
}

}  // namespace ltcfit
