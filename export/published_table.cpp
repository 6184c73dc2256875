#include "export/published_table.h"

#include <fmt/format.h>

#include "base/angles.h"
#include "base/refusal.h"
#include "export/atomic_file.h"
#include "export/texture_files.h"

namespace ltcfit {
namespace {

// What the authors' fitting codes clamp to.
constexpr double kFloor2017 = 1e-5;
constexpr double kTheta2017 = 1.57;
constexpr double kFloor2022 = 1e-4;
constexpr double kTheta2022 = 0.9999 * kHalfPi;
constexpr double kMaxOdd = 0.02;  // part of the texels

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

}  // namespace

PackedTable packedFrom2017(const Image& first, const Image* second, const std::string& name) {
  const auto size = [](const Image& image) {
    return fmt::format("{} x {} x {}, {} components, {} layers", image.width, image.height, image.depth,
                       image.components, image.layers);
  };
  if (first.components != 4 || first.depth != 1 || first.layers != 1 || first.width < 2 || first.height < 2)
    throw InputError(name + ": " + size(first) +
                     ": not the layout of 2017, which is a 2D texture of 4 components");
  if (second != nullptr &&
      (second->width != first.width || second->height != first.height || second->texels() != first.texels() ||
       second->components < 2 || second->components > 4)) {
    throw InputError(name + ": the second texture, " + size(*second) + ", does not go with the first, " +
                     size(first));
  }
  const std::size_t texels = first.texels();
  bool thirdIsZero = true;
  for (std::size_t i = 0; i < texels; ++i) thirdIsZero = thirdIsZero && first.values[i * 4 + 2] == 0.0f;
  if (thirdIsZero)
    throw InputError(name + ": this is the second texture (norm, Fresnel); give the first one");

  checkIs2017(first, second, name);
  PackedTable packed;
  packed.packing = packing2017();
  packed.precision = first.precision;
  packed.images = {first};
  packed.packing.textures.resize(second != nullptr ? 2 : 1);
  if (second != nullptr) {
    packed.packing.textures[1].components.resize(second->components);
    packed.images.push_back(*second);
  }
  TableInfo& info = packed.info;
  info.stores = packed.packing.stores;
  info.normalization = normalizationOf(packed.packing.divisor);
  info.alphaFloor = kFloor2017;
  info.provenance.tool = "an undescribed table in the layout of 2017, taken for its axes";
  info.provenance.options = {{"family", std::string("3")}};  // what its authors' code fits
  try {
    info.axes.push_back(withLastValue(
        makeAxis("theta", "rad", AxisMap::kSqrtOneMinusCos, first.height, 0.0, kHalfPi), kTheta2017));
    info.axes.push_back(makeAxis("alpha", "1", AxisMap::kSqrt, first.width, 0.0, 1.0, kFloor2017));
  } catch (const Refusal& error) {
    throw InputError(name + ": " + error.what());
  }
  return packed;
}

Table tableFrom2017(const Image& first, const Image* second, const std::string& name) {
  return tableFromPacked(packedFrom2017(first, second, name), name);
}

Table tableFrom2022(const FloatArray& array, const std::string& name) {
  const auto& s = array.shape;
  if (s.size() != 6 || s[4] != 3 || s[5] != 3)
    throw InputError(name + ": shape (" + fmt::format("{}", fmt::join(s, ", ")) + ") is not (.., 3, 3)");
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

}  // namespace ltcfit
