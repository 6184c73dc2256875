#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "ltc/alignment.h"
#include "report/stability.h"

namespace ltcfit {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Of the needle that misses the lobe: its elevation and its width.
constexpr double kNeedleTheta = 85.0 / 180.0 * std::numbers::pi;
constexpr double kNeedleWidth = 0.02;
constexpr double kNeedleInside = 1e-3;

double widthOf(const Matrix3d& m) {
  return m.leftCols<2>().norm() / m.col(2).norm();
}

}  // namespace

std::string_view startName(Start start) {
  switch (start) {
    case Start::kIdentity:
      return "identity";
    case Start::kNeighbour:
      return "neighbour";
    case Start::kNoOverlap:
      return "no-overlap";
    case Start::kMoments:
      break;
  }
  return "moments";
}

Matrix3d startMatrix(Start start, const LobeJob& job, const Matrix3d& moments, const Matrix3d& neighbour) {
  switch (start) {
    case Start::kMoments:
      return moments;
    case Start::kIdentity:
      return Matrix3d::Identity();
    case Start::kNeighbour:
      return projectOnFamily(align(neighbour).m, job.family);
    case Start::kNoOverlap:
      break;
  }
  if (job.family == MatrixFamily::kMirrorXY || job.family == MatrixFamily::kRotational) {
    const double width = kNeedleInside * std::min(1.0, widthOf(moments));
    return Vector3d(width, width, 1.0).asDiagonal();
  }
  // In the plane of incidence, where the view is: the lobe is on the other side of the normal.
  const double width = std::min(kNeedleWidth, widthOf(moments));
  const double s = std::sin(kNeedleTheta);
  const double c = std::cos(kNeedleTheta);
  Matrix3d needle;
  needle << width * c, 0.0, s, 0.0, width, 0.0, -width * s, 0.0, c;
  return projectOnFamily(turned(needle, job.parameters.phi), job.family);
}

}  // namespace ltcfit
