// Which lobes a table needs, and how its nodes follow from them.
#pragma once

#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include "fit/matrix_family.h"
#include "fit/node_placement.h"
#include "ltc/table.h"

namespace ltcfit {

struct IsotropicTableOptions {
  std::size_t thetaNodes = 64;
  std::size_t alphaNodes = 64;
  /// 2017 (isotropicPlacement)
  IsotropicPlacement axes{NodePlacement{AxisMap::kSqrtOneMinusCos}, NodePlacement{AxisMap::kSqrt}};
  double alphaFloor = 1e-4;  ///< alpha of the node at alpha = 0, in [1e-5, 1)
  /// theta of the last node, radians, at most pi/2. Grazing view needs no clamp; the 2017 table has 1.57.
  double thetaMax = 0.5 * std::numbers::pi;

  /// False with a message naming the option, its value and its range.
  bool isValid(std::string* error) const;
};

struct AnisotropicTableOptions {
  std::size_t alphaNodes = 8;
  std::size_t lambdaNodes = 8;
  std::size_t thetaNodes = 8;
  std::size_t phiNodes = 8;
  AnisotropicPlacement axes{};  ///< 2022 (anisotropicPlacement)
  double alphaFloor = 1e-4;     ///< smallest alpha_x and alpha_y, in [1e-5, 1)
  double thetaMax = 0.5 * std::numbers::pi;

  bool isValid(std::string* error) const;
};

/// How the lobe's symmetries come into the table.
enum class SymmetryMode {
  kDuring,  ///< each entry is sought among the matrices of its symmetry; equal lobes are fitted once
  kAfter,   ///< all entries are fitted freely, symmetry is enforced on the table (KT et al. 2022, eq. 16)
};

/// One fit.
struct LobeJob {
  LobeParameters parameters;
  MatrixFamily family;  ///< among which its matrix is sought
};

/// Where the matrix of a node comes from: T = Rz(rotation) M Rz(-rotation) of a job's M, then the nearest
/// member of `family`.
struct NodeSource {
  std::size_t job;
  double rotation = 0.0;   ///< radians
  MatrixFamily jobFamily;  ///< symmetry of the job's lobe
  MatrixFamily family;     ///< symmetry of the node's lobe
};

struct TablePlan {
  TableInfo info;  ///< without provenance
  std::vector<LobeJob> jobs;
  std::vector<NodeSource> nodes;  ///< in the order of the table's data
};

/// A node alone: its lobe's job, of number 0, and how the node follows from it.
struct NodePlan {
  LobeJob job;
  NodeSource source;
};

/// Of a node at these parameters (Table::parameters): what the plans below have for it, but that the job is
/// its own where a plan shares it with other nodes.
NodePlan planNode(const LobeParameters& node, bool isotropicTable, SymmetryMode symmetry);

/// `options` must be valid.
///
/// Isotropic: every node is a job, mirrored by the plane of incidence, at normal view also turned about z.
/// Anisotropic, kDuring: one job for all phi at normal view; where alpha_x = alpha_y (lambda = 1, and where
/// the floor makes it so) one for all phi, which are turned copies: T(theta, phi) = Rz(phi) T(theta, 0)
/// Rz(-phi). The rows phi = 0 and pi/2 have the mirror symmetry of eq. 16.
TablePlan planIsotropicTable(const IsotropicTableOptions& options);
TablePlan planAnisotropicTable(const AnisotropicTableOptions& options, SymmetryMode symmetry);

/// The same for axes of any ranges, sizes and warps: theta, alpha, or alpha, lambda, theta, phi, whose values
/// are valid for a Table. alpha_x and alpha_y of a node are no smaller than `alphaFloor`.
TablePlan planIsotropicTable(std::vector<Axis> axes, double alphaFloor);
TablePlan planAnisotropicTable(std::vector<Axis> axes, double alphaFloor, SymmetryMode symmetry);

/// The symmetry of a lobe, from its parameters: exact comparisons, phi in [0, pi/2].
MatrixFamily familyOf(const LobeParameters& parameters);

/// A matrix turned about the normal: Rz(angle) M Rz(-angle).
Eigen::Matrix3d turned(const Eigen::Matrix3d& m, double angle);

}  // namespace ltcfit
