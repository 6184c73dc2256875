#include "tests/render/tables.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "export/atomic_file.h"
#include "export/json_table.h"

namespace ltcfit::test {
namespace {

Table read(const std::string& name) {
  const std::string path = std::string(LTCFIT_DATA_DIR) + "/" + name;
  return tableFromJson(readFile(path), path);
}

}  // namespace

const Table& isotropicTable() {
  static const Table table =
      storedAs(read("ltc_iso.json"), MatrixStorage::kMinv, MatrixNormalization::kMiddleElement);
  return table;
}

const Table& anisotropicTable() {
  static const Table table = read("ltc_aniso.json");
  return table;
}

IsotropicTextures isotropicTextures(const Table& table) {
  const auto& axes = table.info().axes;
  Texture matrix;
  matrix.width = static_cast<int>(axes[1].size());
  matrix.height = static_cast<int>(axes[0].size());
  Texture amplitude = matrix;
  for (std::size_t i = 0; i < table.nodeCount(); ++i) {
    const TableEntry e = table.entry(table.node(i));
    const Eigen::Matrix3f inv = e.mInv.cast<float>();
    matrix.texels.push_back({inv(0, 0), inv(2, 0), inv(0, 2), inv(2, 2)});
    amplitude.texels.push_back({static_cast<float>(*e.norm), static_cast<float>(*e.fresnel), 0.0f, 0.0f});
  }
  return {matrix, amplitude};
}

Texture anisotropicTexture(const Table& table) {
  const auto& axes = table.info().axes;  // alpha, lambda, theta, phi
  Texture texture;
  texture.width = static_cast<int>(axes[3].size());
  texture.height = static_cast<int>(axes[2].size());
  texture.depth = static_cast<int>(3 * axes[0].size() * axes[1].size());
  for (int row = 0; row < 3; ++row) {
    for (std::size_t i = 0; i < table.nodeCount(); ++i) {
      const TableEntry e = table.entry(table.node(i));
      const Eigen::Matrix3f m = e.m.cast<float>();
      const double extra = row == 0 ? *e.norm : row == 1 ? *e.fresnel : 0.0;
      texture.texels.push_back({m(row, 0), m(row, 1), m(row, 2), static_cast<float>(extra)});
    }
  }
  return texture;
}

Eigen::Vector3d toEigen(const Vec3& v) {
  return Eigen::Vector3f(v[0], v[1], v[2]).cast<double>();
}

Eigen::Matrix3d toEigen(const Mat3& m) {
  Eigen::Matrix3d out;
  for (int r = 0; r < 3; ++r) out.row(r) = toEigen(m[static_cast<std::size_t>(r)]).transpose();
  return out;
}

Vec3 toVec3(const Eigen::Vector3d& v) {
  const Eigen::Vector3f f = v.cast<float>();
  return {f.x(), f.y(), f.z()};
}

double displacement(const Mat3& inverse, const Eigen::Matrix3d& m) {
  Eigen::Matrix3d product = toEigen(inverse) * m;
  if (m.determinant() < 0.0) product.col(1) *= -1.0;
  const double scale = product.trace() / 3.0;
  const double worst = (product / scale - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  return scale > 0.0 && std::isfinite(worst) ? worst : std::numeric_limits<double>::infinity();
}

void raise(double& worst, double error) {
  if (!(error <= worst)) worst = std::isnan(error) ? std::numeric_limits<double>::infinity() : error;
}

}  // namespace ltcfit::test
