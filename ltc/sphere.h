// Irradiance of spheres under the clamped cosine.
#pragma once

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

}  // namespace ltcfit
