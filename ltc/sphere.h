// Irradiance of spheres under the clamped cosine.
#pragma once

#include <cstddef>
#include <vector>

namespace ltcfit {

/// Form factor of a sphere wholly above the horizon: sin^2(sigma) cosOmega (Heitz 2017, eq. 16).
/// `cosOmega`: cosine between its direction and the normal, [-1, 1]; `sinSigma`: sine of its angular radius,
/// [0, 1]. Below the horizon the value is negative: no clipping.
double sphereFormFactor(double cosOmega, double sinSigma);

/// The same clipped at the horizon, in [0, 1], for a sphere anywhere (Snyder 1996, "Area Light Sources for
/// Real-Time Graphics"; equal to his case list, in one expression derived in the .cpp).
double sphereFormFactorClipped(double cosOmega, double sinSigma);

/// What engines store of it in a texture, in [0, 1]: the clipped form factor of a sphere over the length of
/// its vector form factor, sin^2(sigma), by which the texture is addressed: x = (cosOmega + 1) / 2, y =
/// length (Hill and Heitz 2016). `length` in [0, 1]; at 0 the limit, max(0, cosOmega).
double sphereTableValue(double cosOmega, double length);

/// That texture, read as GPUs do: bilinear between nodes, constant beyond the outer ones.
class SphereTable {
 public:
  /// `size` x `size` nodes of sphereTableValue, evenly from -1 to 1 and from 0 to 1. `size` >= 2.
  explicit SphereTable(std::size_t size = 64);

  /// Value at a point; multiplied by `length` the form factor.
  double operator()(double cosOmega, double length) const;

 private:
  std::size_t size_;
  std::vector<double> values_;  // row by row, cosOmega fastest
};

}  // namespace ltcfit
