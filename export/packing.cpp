#include "export/packing.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "base/refusal.h"
#include "export/half_table.h"
#include "export/little_endian.h"
#include "ltc/sphere.h"

namespace ltcfit {
namespace {

[[noreturn]] void fail(const std::string& what) {
  throw Refusal(what);
}

// Index 0..8 of "m{row}{column}", nothing for other components.
std::optional<std::size_t> matrixIndex(std::string_view component) {
  if (component.size() != 3 || component[0] != 'm') return std::nullopt;
  const auto row = static_cast<std::size_t>(component[1] - '0');
  const auto column = static_cast<std::size_t>(component[2] - '0');
  if (row > 2 || column > 2) return std::nullopt;
  return row * 3 + column;
}

std::optional<std::size_t> divisorIndex(Divisor divisor) {
  switch (divisor) {
    case Divisor::kM00:
      return 0;
    case Divisor::kM11:
      return 4;
    case Divisor::kM22:
      return 8;
    case Divisor::kNone:
    case Divisor::kThirdColumn:
      break;
  }
  return std::nullopt;
}

Divisor divisorOf(MatrixNormalization normalization) {
  if (normalization == MatrixNormalization::kMiddleElement) return Divisor::kM11;
  if (normalization == MatrixNormalization::kThirdColumnUnit) return Divisor::kThirdColumn;
  return Divisor::kNone;
}

// M or its inverse over the divisor. Mirrors of x and y (columns of M, rows of its inverse) are the same
// lobe, so that m00 and m11 can be made positive.
Eigen::Matrix3d divided(const TableEntry& entry, const Packing& packing) {
  const bool inverse = packing.stores == MatrixStorage::kMinv;
  Eigen::Matrix3d m = inverse ? entry.mInv : entry.m;
  if (packing.divisor == Divisor::kThirdColumn) return normalized(m, MatrixNormalization::kThirdColumnUnit);
  const std::optional<std::size_t> index = divisorIndex(packing.divisor);
  if (!index) return m;
  const auto d = static_cast<Eigen::Index>(*index / 3);
  if (m(d, d) < 0.0 && d < 2) {
    if (inverse) {
      m.row(d) *= -1.0;
    } else {
      m.col(d) *= -1.0;
    }
  }
  if (!(m(d, d) > 0.0))
    fail("has a matrix that cannot be divided by " + std::string(divisorName(packing.divisor)));
  return m / m(d, d);
}

bool holds(const TableInfo& info, std::string_view channel) {
  return std::find(info.channels.begin(), info.channels.end(), channel) != info.channels.end();
}

// The table's matrices as the packing holds them, float32 values in doubles.
std::vector<Eigen::Matrix3d> packedMatrices(const Table& table, const Packing& packing) {
  const TableInfo& info = table.info();
  // as they are where they are so already: dividing twice moves last bits
  const bool asIs = packing.stores == info.stores &&
                    (packing.divisor == Divisor::kNone || packing.divisor == divisorOf(info.normalization));
  const std::optional<std::size_t> divisor = divisorIndex(packing.divisor);
  std::vector<Eigen::Matrix3d> out;
  out.reserve(table.nodeCount());
  for (std::size_t i = 0; i < table.nodeCount(); ++i) {
    const TableEntry entry = table.entry(table.node(i));
    try {
      if (!entry.invertible) fail("has no inverse");
      const Eigen::Matrix3d& m = packing.stores == MatrixStorage::kM ? entry.m : entry.mInv;
      const bool keep = asIs && (!divisor || m.diagonal()[static_cast<Eigen::Index>(*divisor / 3)] == 1.0);
      const Eigen::Matrix3d exact = keep ? m : divided(entry, packing);
      const Eigen::Matrix3f rounded = exact.cast<float>();
      if (!rounded.allFinite()) fail("has a matrix that does not fit float32");
      out.push_back(rounded.cast<double>());
    } catch (const Refusal& error) {
      fail(fmt::format("{} {}", placeOf(table, i), error.what()));
    }
  }
  return out;
}

// What a texture of the layout has no component for must be zero, or the divisor.
void checkPlaces(const Table& table, const std::vector<Eigen::Matrix3d>& matrices,
                 const std::array<bool, 9>& placed, Divisor divisor) {
  for (std::size_t k = 0; k < 9; ++k) {
    if (placed[k] || divisorIndex(divisor) == k) continue;
    for (std::size_t i = 0; i < matrices.size(); ++i) {
      if (matrices[i](static_cast<int>(k / 3), static_cast<int>(k % 3)) != 0.0) {
        fail(fmt::format("{} has an entry m{}{}, for which this layout has no place", placeOf(table, i),
                         k / 3, k % 3));
      }
    }
  }
}

void needRoomForSpheres(const TableInfo& info) {
  for (const Axis& axis : info.axes) {
    if (axis.size() == 1)
      fail(
          fmt::format("axis '{}' has one node: the layout of 2017 also holds a table of spheres, which needs "
                      "two along each; the layout lean does not",
                      axis.name));
  }
}

double sphereAt(const Image& image, std::size_t texel) {
  const auto at = [](std::size_t i, std::size_t n) {
    return static_cast<double>(i) / static_cast<double>(n - 1);
  };
  return sphereTableValue(2.0 * at(texel % image.width, image.width) - 1.0,
                          at(texel / image.width, image.height));
}

Image emptyImage(const TableInfo& info, std::size_t components, Precision precision) {
  Image image;
  const std::vector<Axis>& axes = info.axes;
  image.width = axes.back().size();
  image.height = axes[axes.size() - 2].size();
  image.depth = axes.size() == 4 ? axes[0].size() * axes[1].size() : 1;
  image.components = components;
  image.precision = precision;
  image.values.resize(image.texels() * components);
  return image;
}

}  // namespace

std::string_view divisorName(Divisor divisor) {
  switch (divisor) {
    case Divisor::kM00:
      return "m00";
    case Divisor::kM11:
      return "m11";
    case Divisor::kM22:
      return "m22";
    case Divisor::kThirdColumn:
      return "third-column";
    case Divisor::kNone:
      break;
  }
  return "none";
}

Divisor divisorFromName(std::string_view name) {
  for (Divisor d : {Divisor::kNone, Divisor::kM00, Divisor::kM11, Divisor::kM22, Divisor::kThirdColumn}) {
    if (divisorName(d) == name) return d;
  }
  fail("matrix.divided_by '" + std::string(name) + "' (none, m00, m11, m22 or third-column)");
}

MatrixNormalization normalizationOf(Divisor divisor) {
  if (divisor == Divisor::kM11) return MatrixNormalization::kMiddleElement;
  if (divisor == Divisor::kThirdColumn) return MatrixNormalization::kThirdColumnUnit;
  return MatrixNormalization::kNone;
}

Packing packing2017() {
  return {MatrixStorage::kMinv,
          Divisor::kM11,
          {{"matrix", {"m00", "m20", "m02", "m22"}}, {"amplitude", {"norm", "fresnel", "0", "sphere"}}}};
}

Packing packingOfRows() {
  return {MatrixStorage::kM,
          Divisor::kThirdColumn,
          {{"row0", {"m00", "m01", "m02", "norm"}},
           {"row1", {"m10", "m11", "m12", "fresnel"}},
           {"row2", {"m20", "m21", "m22", "0"}}}};
}

Packing packingLean(const TableInfo& info) {
  if (info.axes.size() == 4) {
    Packing packing = packingOfRows();
    for (TextureSpec& row : packing.textures) {
      std::string& last = row.components.back();
      if (!holds(info, last)) last.assign(1, '0');
    }
    return packing;
  }
  Packing packing = packing2017();
  packing.textures[1].components = amplitudesOf(info);
  if (packing.textures[1].components.empty()) packing.textures.pop_back();
  return packing;
}

std::vector<std::string> amplitudesOf(const TableInfo& info) {
  std::vector<std::string> out;
  for (const char* const channel : {"norm", "fresnel"})
    if (holds(info, channel)) out.emplace_back(channel);
  return out;
}

LeanSize leanSize(const TableInfo& info, Precision precision) {
  const Packing packing = packingLean(info);
  std::size_t numbers = 0;
  for (const TextureSpec& texture : packing.textures) numbers += texture.components.size();
  for (const Axis& axis : info.axes) numbers *= axis.size();
  return {numbers * (precision == Precision::kHalf ? 2 : 4),
          info.axes.size() == 4 ? 1 : packing.textures.size()};
}

Packing packingOfChannels(const TableInfo& info, std::size_t components) {
  Packing packing{info.stores, divisorOf(info.normalization), {}};
  for (std::size_t c = 0; c < info.channels.size(); c += components) {
    TextureSpec texture{"channels", {}};
    if (components < info.channels.size()) texture.name = fmt::format("channels{}", c / components);
    for (std::size_t k = c; k < c + components; ++k)
      texture.components.push_back(k < info.channels.size() ? info.channels[k] : "0");
    packing.textures.push_back(texture);
  }
  return packing;
}

PackedTable pack(const Table& table, const Packing& asked, Precision precision) {
  PackedTable packed;
  packed.info = table.info();
  packed.packing = asked;
  // scales that were chosen for what lies between the nodes
  if (asked.divisor == Divisor::kThirdColumn && !table.isIsotropic() &&
      table.info().stores == MatrixStorage::kM && table.info().normalization == MatrixNormalization::kNone) {
    packed.packing.divisor = Divisor::kNone;
  }
  const Packing packing = packed.packing;
  packed.precision = precision;
  std::array<bool, 9> placed{};
  for (TextureSpec& texture : packed.packing.textures) {
    for (std::string& component : texture.components) {
      if (const std::optional<std::size_t> k = matrixIndex(component)) placed[*k] = true;
      if ((component == "norm" || component == "fresnel") && !holds(table.info(), component))
        component.assign(1, '0');
      if (component == "sphere" && !table.isIsotropic()) component.assign(1, '0');
      if (component == "sphere") needRoomForSpheres(table.info());
    }
  }
  std::vector<Eigen::Matrix3d> matrices = packedMatrices(table, packing);
  checkPlaces(table, matrices, placed, packing.divisor);
  if (precision == Precision::kHalf) {
    std::array<bool, 9> free = placed;
    if (const std::optional<std::size_t> fixed = divisorIndex(packing.divisor)) free[*fixed] = false;
    packed.scale = divisorIndex(packing.divisor) ? 1.0 : halfScale(matrices);
    packed.half = roundMatrices(table, matrices, packing.stores, free, packed.scale);
  }

  for (const TextureSpec& texture : packed.packing.textures) {
    Image image = emptyImage(table.info(), texture.components.size(), precision);
    for (std::size_t c = 0; c < texture.components.size(); ++c) {
      const std::string& component = texture.components[c];
      if (component == "0") continue;
      const std::optional<std::size_t> k = matrixIndex(component);
      const auto channel = std::find(table.info().channels.begin(), table.info().channels.end(), component) -
                           table.info().channels.begin();
      for (std::size_t i = 0; i < table.nodeCount(); ++i) {
        float value = 0.0f;
        if (k) {
          value = static_cast<float>(matrices[i](static_cast<int>(*k / 3), static_cast<int>(*k % 3)));
        } else if (component == "sphere") {
          value = static_cast<float>(sphereAt(image, i));
        } else {
          value = table.data()[i * table.channelCount() + static_cast<std::size_t>(channel)];
        }
        const float written = precision == Precision::kHalf ? halfValue(halfBits(value)) : value;
        if (!std::isfinite(written))
          fail(fmt::format("{} has a {} of {}, which no half can hold", placeOf(table, i), component, value));
        image.values[i * image.components + c] = written;
      }
    }
    packed.images.push_back(std::move(image));
  }
  // what a reader makes of it
  packed.info.stores = packing.stores;
  packed.info.normalization = normalizationOf(packing.divisor);
  return packed;
}

Table unpack(const PackedTable& packed) {
  TableInfo info = packed.info;
  info.channels.clear();
  std::vector<std::pair<const Image*, std::size_t>> sources;  // image and component of each channel
  if (packed.images.empty() || packed.images.size() != packed.packing.textures.size())
    fail("the number of textures is wrong");
  const std::size_t nodes = packed.images[0].texels();
  for (std::size_t t = 0; t < packed.images.size(); ++t) {
    const Image& image = packed.images[t];
    const std::vector<std::string>& components = packed.packing.textures[t].components;
    if (components.size() != image.components) fail("a texture has a wrong number of components");
    if (image.values.size() != nodes * image.components) fail("the textures differ in size");
    for (std::size_t c = 0; c < components.size(); ++c) {
      if (components[c] == "0" || components[c] == "sphere") continue;
      info.channels.push_back(components[c]);
      sources.emplace_back(&image, c);
    }
  }
  const std::optional<std::size_t> fixed = divisorIndex(packed.packing.divisor);
  if (fixed && !holds(info, divisorName(packed.packing.divisor))) {
    info.channels.emplace_back(divisorName(packed.packing.divisor));
    sources.emplace_back(nullptr, 0);
  }
  // in the order of the table file
  std::vector<std::size_t> order(info.channels.size());
  for (std::size_t c = 0; c < order.size(); ++c) order[c] = c;
  const auto rank = [&](std::size_t c) {
    const std::string& name = info.channels[c];
    return matrixIndex(name) ? *matrixIndex(name) : name == "norm" ? std::size_t{9} : std::size_t{10};
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
  std::vector<std::string> channels;
  for (std::size_t c : order) channels.push_back(info.channels[c]);

  std::vector<float> data;
  data.reserve(nodes * order.size());
  const auto scale = static_cast<float>(packed.scale);
  for (std::size_t i = 0; i < nodes; ++i) {
    for (std::size_t c : order) {
      const auto [image, component] = sources[c];
      const float value = image == nullptr ? 1.0f : image->values[i * image->components + component];
      data.push_back(matrixIndex(info.channels[c]) && image != nullptr ? value / scale : value);
    }
  }
  info.channels = std::move(channels);
  return Table(std::move(info), std::move(data));
}

}  // namespace ltcfit
