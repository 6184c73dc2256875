// What the numbers of a texture mean: which coefficient of which matrix, divided by what, in which texture.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "export/half_table.h"
#include "export/image.h"
#include "ltc/table.h"

namespace ltcfit {

/// By what every entry of the matrix is divided.
enum class Divisor {
  kNone,  ///< by nothing
  kM00,
  kM11,
  kM22,
  kThirdColumn,  ///< the length of the third column
};

/// Name in the metadata: "none", "m00", "m11", "m22", "third-column"; back: Refusal.
std::string_view divisorName(Divisor divisor);
Divisor divisorFromName(std::string_view name);
/// What a table file calls a matrix divided so.
MatrixNormalization normalizationOf(Divisor divisor);

/// One texture of a packing: what its components hold. Names are m{row}{column} of the stored matrix, "norm",
/// "fresnel", "sphere" (horizon-clipped sphere form factor over the form factor, which has axes of its own:
/// ltc/sphere.h) and "0".
struct TextureSpec {
  std::string name;
  std::vector<std::string> components;
};

/// A layout of textures over a table's nodes.
struct Packing {
  MatrixStorage stores = MatrixStorage::kM;
  Divisor divisor = Divisor::kNone;
  std::vector<TextureSpec> textures;
};

/// The layout of 2017: (Minv00, Minv20, Minv02, Minv22) / Minv11, and (norm, Fresnel, 0, sphere).
Packing packing2017();

/// Three volumes, one for each row of M: (M00, M01, M02, norm), (M10, M11, M12, fresnel), (M20, M21, M22, 0).
/// So norm and Fresnel cost no fetch of their own.
Packing packingOfRows();

/// What the table has and nothing else. Isotropic: the matrix of packing2017, and a texture of norm and
/// fresnel, or the one of them that there is; none where there is neither. Anisotropic: packingOfRows, "0"
/// for those that it lacks.
Packing packingLean(const TableInfo& info);

/// Of "norm" and "fresnel" those that the table has, in this order.
std::vector<std::string> amplitudesOf(const TableInfo& info);

/// What a table takes in packingLean.
struct LeanSize {
  std::size_t bytes = 0;     ///< of all texels
  std::size_t textures = 0;  ///< that a shader binds: the three rows of M lie in one volume
};
LeanSize leanSize(const TableInfo& info, Precision precision);

/// Every channel as the table stores it, in order, so many to a texture (the last one filled up with "0"):
/// nothing is lost in float.
Packing packingOfChannels(const TableInfo& info, std::size_t components);

/// The textures of a table, and all that a reader needs to make a table of them again.
struct PackedTable {
  TableInfo info;  ///< of the table; `stores`, `normalization` and `channels` as packed
  Packing packing;
  Precision precision = Precision::kFloat;
  double scale = 1.0;         ///< the matrix in the textures is this power of two times the one described
  std::vector<Image> images;  ///< one for each texture of the packing
  /// Where metadata lie beside their files: names in the same folder and checksums, one file for all textures
  /// or one for each.
  std::vector<std::pair<std::string, std::string>> files;
  std::string container;  ///< how the textures lie in the file, as the metadata say it
  HalfReport half;
};

/// Packs a table. An isotropic one gives images of alpha (x) by theta (y), an anisotropic one volumes of phi
/// (x) by theta (y) by lambda + n_lambda alpha (z). For kHalf every matrix is rounded as roundToHalf says and
/// the other components to the nearest half. An anisotropic table that stores M of any scale
/// (MatrixNormalization::kNone: a refined one) keeps its scales where the packing would divide by the third
/// column's length: they weigh its nodes in look-ups, and shaders take any. Where the divisor leaves a free
/// scale, the matrix is multiplied by the smallest power of two that keeps its diagonal away from subnormal
/// halves. For norm and Fresnel of a table without them, and for the sphere table of an anisotropic one, "0"
/// is written. Throws Refusal naming the node: an entry of a matrix has no place in the
/// packing, there is no inverse, a number does not fit; naming the axis: the packing has a sphere table, for
/// which an axis of one node has no room.
PackedTable pack(const Table& table, const Packing& packing, Precision precision);

/// The table that is in the textures. Inverse of pack for float; for half the rounded numbers. Throws
/// Refusal for what Table's constructor refuses and sizes that do not fit the axes.
Table unpack(const PackedTable& packed);

}  // namespace ltcfit
