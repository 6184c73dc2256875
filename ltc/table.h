// A table of LTC matrices with the norm and Fresnel of its lobes, and the look-up that a shader does.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "ltc/axis.h"

namespace ltcfit {

enum class MatrixStorage { kM, kMinv };
enum class MatrixNormalization {
  kNone,
  kThirdColumnUnit,  ///< column 2 of the stored matrix has length 1
  kMiddleElement,    ///< element (1, 1) of the stored matrix is 1
};

/// Names in the table file: "M", "Minv"; "none", "third-column-unit", "middle-element". The reverse functions
/// throw Refusal for an unknown name.
std::string_view matrixStorageName(MatrixStorage storage);
std::string_view matrixNormalizationName(MatrixNormalization normalization);
MatrixStorage matrixStorageFromName(std::string_view name);
MatrixNormalization matrixNormalizationFromName(std::string_view name);

/// `m` scaled as told. The element divided by must not be 0; the lobe stays the same where it is positive,
/// and is mirrored through the origin where it is negative (caller's duty: see storedAs).
Eigen::Matrix3d normalized(const Eigen::Matrix3d& m, MatrixNormalization normalization);

/// What one lobe depends on: roughness along x and y (alpha, not its root), view angles in radians.
struct LobeParameters {
  double alphaX = 1.0;
  double alphaY = 1.0;
  double theta = 0.0;
  double phi = 0.0;
};

/// Who made a table, how: written into every file.
struct Provenance {
  using Value = std::variant<std::string, double, std::int64_t, bool>;
  std::string tool;
  std::string toolVersion;
  std::string command;
  std::int64_t seed = 0;
  std::vector<std::pair<std::string, Value>> options;
};

/// Everything about a table but its numbers; the fields are those of the table file (README, "The table
/// file").
struct TableInfo {
  std::string brdf = "ggx";
  std::vector<Axis> axes;  ///< slowest first: theta, alpha or alpha, lambda, theta, phi
  MatrixStorage stores = MatrixStorage::kM;
  MatrixNormalization normalization = MatrixNormalization::kNone;
  std::vector<std::string> channels;  ///< of m00..m22, norm, fresnel; innermost in the data
  double alphaFloor = 0.0;            ///< smallest alpha_x, alpha_y that a node was fitted with
  Provenance provenance;
};

/// The name of one number of a table's data in messages: "theta[7], alpha[3], m02"; "data[5]" where the
/// numbers of `info` do not tell.
std::string numberName(const TableInfo& info, std::size_t index);

/// What a look-up yields.
struct TableEntry {
  Eigen::Matrix3d m;
  Eigen::Matrix3d mInv;
  bool invertible = false;  ///< both matrices finite, det != 0
  std::optional<double> norm;
  std::optional<double> fresnel;
};

/// The nodes that a look-up interpolates, by their number in the order of the data, and their weights, which
/// sum to 1: up to 16 of an anisotropic table, 4 of an isotropic one. Nodes of weight 0 are left out.
struct LookUpNodes {
  std::array<std::size_t, 16> node{};
  std::array<double, 16> weight{};
  std::size_t count = 0;
};
/// Of the lobe at these parameters, alphaX >= alphaY, phi in [0, pi/2] (canonicalLobe). Parameters outside of
/// the axes, valid for a Table, are clamped to them.
LookUpNodes lookUpNodes(const std::vector<Axis>& axes, const LobeParameters& parameters);

/// An immutable, checked table.
class Table {
 public:
  /// Throws Refusal naming the field: unknown or doubled channels, no matrix, axes other than
  /// the two sets above, no nodes, values that do not increase or leave their range, a map that
  /// does not fit the values, a count that is not the product, a number that is not finite.
  Table(TableInfo info, std::vector<float> data);

  const TableInfo& info() const { return info_; }
  const std::vector<float>& data() const { return data_; }
  std::size_t nodeCount() const { return nodeCount_; }
  std::size_t channelCount() const { return info_.channels.size(); }
  bool isIsotropic() const { return info_.axes.size() == 2; }

  /// Offset in data() of a node's first channel; one index for each axis, in their order.
  std::size_t index(std::span<const std::size_t> node) const;
  /// The node with number `flat` in 0..nodeCount()-1, in the order of the data.
  std::vector<std::size_t> node(std::size_t flat) const;
  /// Parameters at which a node was fitted: axis values, with alpha_x and alpha_y no smaller than the floor.
  LobeParameters parameters(std::span<const std::size_t> node) const;

  /// The entry stored at a node.
  TableEntry entry(std::span<const std::size_t> node) const;

  /// Multilinear look-up of the stored values at the parameters, then the inversion: what a shader does, in
  /// double arithmetic on the float32 values. Parameters outside of the axes are clamped to them. For an
  /// anisotropic table phi is any angle and the alphas come in any order (symmetry.h), and the result is
  /// continuous in all of them; an isotropic one uses alphaX and theta.
  TableEntry fetch(const LobeParameters& parameters) const;

 private:
  void validateAxes() const;
  void bindChannels();
  TableEntry unpack(const double* channels) const;

  TableInfo info_;
  std::vector<float> data_;
  std::size_t nodeCount_ = 0;
  std::array<int, 9> matrixChannel_{};  // position of m{row}{col}, -1 where absent
  int normChannel_ = -1;
  int fresnelChannel_ = -1;
};

/// The same lobes stored otherwise: M or its inverse, scaled as told, rounded to float32; norm and Fresnel as
/// they are. This is how a table is read by shaders that interpolate the inverse (the layout of 2017):
/// between nodes the two differ. Channels: m00, m02, m11, m20, m22 where all other entries are 0, else all
/// nine. For kMiddleElement a matrix whose element (1, 1) is negative is replaced by the equivalent one with
/// a flip of y. Throws Refusal for a node without an inverse, or with one that does not fit
/// float32.
Table storedAs(const Table& table, MatrixStorage stores, MatrixNormalization normalization);

}  // namespace ltcfit
