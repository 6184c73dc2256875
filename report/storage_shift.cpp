#include "report/storage_shift.h"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/refusal.h"
#include "export/half_matrix.h"
#include "export/half_table.h"
#include "ltc/ltc.h"

namespace ltcfit {

using Eigen::Matrix3d;

namespace {

constexpr int kShiftDirections = 64;

}  // namespace

double lobeShift(const Matrix3d& a, const Matrix3d& b) {
  double sum = 0.0;
  for (int i = 0; i < kShiftDirections; ++i) {
    const Eigen::Vector3d x =
        sampleCosine({(i + 0.5) / kShiftDirections, std::fmod(i * (1.0 / std::numbers::phi), 1.0)});
    sum += ((a * x).normalized() - (b * x).normalized()).norm();
  }
  return sum / kShiftDirections;
}

double float32Shift(const Matrix3d& m) {
  const Eigen::Matrix3f stored = normalized(m, MatrixNormalization::kThirdColumnUnit).cast<float>();
  const Matrix3d inverse = Eigen::Matrix3f(stored.inverse()).cast<double>();
  return lobeShift(m, inverse.inverse());
}

double halfShift(const Matrix3d& m, TableKind kind) {
  std::array<bool, 9> free;
  for (int i = 0; i < 9; ++i) free[static_cast<std::size_t>(i)] = m(i / 3, i % 3) != 0.0;
  try {
    if (kind == TableKind::kIsotropic) {
      free[4] = false;  // 1
      const Matrix3d stored = normalized(m.inverse(), MatrixNormalization::kMiddleElement);
      return lobeShift(m, roundToHalf(stored, MatrixStorage::kMinv, free).matrix.inverse());
    }
    const Matrix3d stored = normalized(m, MatrixNormalization::kThirdColumnUnit);
    return lobeShift(m, roundToHalf(halfScale({stored}) * stored, MatrixStorage::kM, free).matrix);
  } catch (const Refusal&) {
    return std::numeric_limits<double>::infinity();
  }
}

}  // namespace ltcfit
