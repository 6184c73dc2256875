#include "fit/table_plan.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <sstream>
#include <tuple>

#include "base/angles.h"
#include "base/refusal.h"

namespace ltcfit {
namespace {

constexpr std::size_t kSmallestAxis = 2;
constexpr std::size_t kLargestIsotropicAxis = 1024;
constexpr std::size_t kLargestAnisotropicAxis = 64;
constexpr double kSmallestFloor = 1e-5;

// A number for a message, without trailing zeros or rounding to 0.
std::string plain(double v) {
  std::ostringstream out;
  out << v;
  return out.str();
}

bool checkNodes(const char* name, std::size_t n, std::size_t largest, std::string* error) {
  if (n >= kSmallestAxis && n <= largest) return true;
  *error = "--size: " + std::to_string(n) + " " + name + " nodes, need " + std::to_string(kSmallestAxis) +
           " to " + std::to_string(largest);
  return false;
}

// `second`: alpha of the node after the first.
bool checkFloor(double floor, double second, std::string* error) {
  if (floor >= kSmallestFloor && floor < second) return true;
  *error = "--alpha-floor " + plain(floor) + ": need " + plain(kSmallestFloor) + " up to (not including) " +
           plain(second) + ", the alpha of the second node";
  return false;
}

// `before`: theta of the node before the last.
bool checkThetaMax(double thetaMax, double before, std::string* error) {
  if (thetaMax > before && thetaMax <= kHalfPi) return true;
  *error = "--theta-max " + plain(thetaMax) + ": need more than " + plain(before) +
           " (the node before the last) up to pi/2";
  return false;
}

bool checkEnds(const Axis& alpha, double alphaFloor, const Axis& theta, double thetaMax, std::string* error) {
  return checkFloor(alphaFloor, alpha.values[1], error) &&
         checkThetaMax(thetaMax, theta.values[theta.size() - 2], error);
}

Axis thetaAxis(const NodePlacement& placement, std::size_t nodes, double thetaMax) {
  Axis axis = placedAxis("theta", placement, nodes);
  axis.values.back() = std::min(axis.values.back(), thetaMax);
  return axis;
}

}  // namespace

bool IsotropicTableOptions::isValid(std::string* error) const {
  if (!checkNodes("theta", thetaNodes, kLargestIsotropicAxis, error) ||
      !checkNodes("alpha", alphaNodes, kLargestIsotropicAxis, error)) {
    return false;
  }
  try {
    const Axis theta = placedAxis("theta", axes[0], thetaNodes);
    return checkEnds(placedAxis("alpha", axes[1], alphaNodes), alphaFloor, theta, thetaMax, error);
  } catch (const Refusal& refusal) {
    *error = refusal.what();
    return false;
  }
}

bool AnisotropicTableOptions::isValid(std::string* error) const {
  if (!checkNodes("alpha", alphaNodes, kLargestAnisotropicAxis, error) ||
      !checkNodes("lambda", lambdaNodes, kLargestAnisotropicAxis, error) ||
      !checkNodes("theta", thetaNodes, kLargestAnisotropicAxis, error) ||
      !checkNodes("phi", phiNodes, kLargestAnisotropicAxis, error)) {
    return false;
  }
  try {
    const Axis alpha = placedAxis("alpha", axes[0], alphaNodes);
    placedAxis("lambda", axes[1], lambdaNodes);
    const Axis theta = placedAxis("theta", axes[2], thetaNodes);
    placedAxis("phi", axes[3], phiNodes);
    return checkEnds(alpha, alphaFloor, theta, thetaMax, error);
  } catch (const Refusal& refusal) {
    *error = refusal.what();
    return false;
  }
}

MatrixFamily familyOf(const LobeParameters& p) {
  if (p.theta == 0.0) return p.alphaX == p.alphaY ? MatrixFamily::kRotational : MatrixFamily::kMirrorXY;
  if (p.phi == 0.0) return MatrixFamily::kMirrorY;
  if (p.phi == kHalfPi) return MatrixFamily::kMirrorX;
  return MatrixFamily::kGeneral;
}

NodePlan planNode(const LobeParameters& node, bool isotropicTable, SymmetryMode symmetry) {
  const MatrixFamily family = familyOf(node);
  if (isotropicTable) return {{node, family}, {0, 0.0, family, family}};
  LobeParameters lobe = node;
  const bool isotropic = node.alphaX == node.alphaY;
  if (isotropic || node.theta == 0.0) lobe.phi = 0.0;
  // the view from 45 degrees above an isotropic surface has no mirror symmetry in x or y: kGeneral
  const NodeSource source{0, isotropic ? node.phi : 0.0, familyOf(lobe), family};
  return {{lobe, symmetry == SymmetryMode::kAfter ? MatrixFamily::kGeneral : source.jobFamily}, source};
}

Eigen::Matrix3d turned(const Eigen::Matrix3d& m, double angle) {
  if (angle == 0.0) return m;
  const Eigen::Matrix3d r = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return r * m * r.transpose();
}

TablePlan planIsotropicTable(const IsotropicTableOptions& o) {
  return planIsotropicTable({thetaAxis(o.axes[0], o.thetaNodes, o.thetaMax),
                             placedAxis("alpha", o.axes[1], o.alphaNodes, o.alphaFloor)},
                            o.alphaFloor);
}

TablePlan planIsotropicTable(std::vector<Axis> axes, double alphaFloor) {
  TablePlan plan;
  plan.info.axes = std::move(axes);
  plan.info.stores = MatrixStorage::kM;
  plan.info.normalization = MatrixNormalization::kThirdColumnUnit;
  plan.info.channels = {"m00", "m02", "m11", "m20", "m22", "norm", "fresnel"};
  plan.info.alphaFloor = alphaFloor;
  for (const double theta : plan.info.axes[0].values) {
    for (const double value : plan.info.axes[1].values) {
      const double alpha = std::max(value, alphaFloor);
      NodePlan node = planNode({alpha, alpha, theta, 0.0}, true, SymmetryMode::kDuring);
      node.source.job = plan.jobs.size();
      plan.nodes.push_back(node.source);
      plan.jobs.push_back(node.job);
    }
  }
  return plan;
}

TablePlan planAnisotropicTable(const AnisotropicTableOptions& o, SymmetryMode symmetry) {
  return planAnisotropicTable(
      {placedAxis("alpha", o.axes[0], o.alphaNodes, o.alphaFloor),
       placedAxis("lambda", o.axes[1], o.lambdaNodes), thetaAxis(o.axes[2], o.thetaNodes, o.thetaMax),
       placedAxis("phi", o.axes[3], o.phiNodes)},
      o.alphaFloor, symmetry);
}

TablePlan planAnisotropicTable(std::vector<Axis> axes, double alphaFloor, SymmetryMode symmetry) {
  TablePlan plan;
  plan.info.axes = std::move(axes);
  plan.info.stores = MatrixStorage::kM;
  plan.info.normalization = MatrixNormalization::kThirdColumnUnit;
  plan.info.channels = {"m00", "m01", "m02", "m10", "m11", "m12", "m20", "m21", "m22", "norm", "fresnel"};
  plan.info.alphaFloor = alphaFloor;

  // jobs by the parameters that a lobe really depends on, at the first node that has them
  std::map<std::tuple<double, double, double, double>, std::size_t> jobOf;
  for (const double value : plan.info.axes[0].values) {
    const double alpha = std::max(value, alphaFloor);
    for (const double lambda : plan.info.axes[1].values) {
      for (const double theta : plan.info.axes[2].values) {
        for (const double phi : plan.info.axes[3].values) {
          const LobeParameters node{alpha, std::max(alpha * lambda, alphaFloor), theta, phi};
          auto [job, source] = planNode(node, false, symmetry);
          const LobeParameters& lobe = job.parameters;
          if (symmetry == SymmetryMode::kAfter) plan.jobs.push_back({node, MatrixFamily::kGeneral});
          const auto [found, isNew] =
              jobOf.try_emplace({lobe.alphaX, lobe.alphaY, lobe.theta, lobe.phi},
                                plan.jobs.size() - (symmetry == SymmetryMode::kAfter));
          if (isNew && symmetry == SymmetryMode::kDuring) plan.jobs.push_back(job);
          source.job = found->second;
          plan.nodes.push_back(source);
        }
      }
    }
  }
  return plan;
}

}  // namespace ltcfit
