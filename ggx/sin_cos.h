// Sine and cosine for inner loops of samplers.
#pragma once

namespace ltcfit {

/// For x in [-pi, pi], to 1e-13 absolute. Without branches and calls, so that loops vectorise, and the same
/// on every platform.
inline void sinCos(double x, double& sine, double& cosine) {
  // Taylor's series of a quarter of the angle, where the first terms left out are below 3e-14; then doubled.
  const double q = 0.25 * x;
  const double t = q * q;
  const double s =
      q * (1.0 +
           t * (-1.0 / 6.0 +
                t * (1.0 / 120.0 + t * (-1.0 / 5040.0 +
                                        t * (1.0 / 362880.0 + t * (-1.0 / 39916800.0 + t / 6227020800.0))))));
  const double c =
      1.0 + t * (-0.5 + t * (1.0 / 24.0 +
                             t * (-1.0 / 720.0 +
                                  t * (1.0 / 40320.0 + t * (-1.0 / 3628800.0 +
                                                            t * (1.0 / 479001600.0 - t / 87178291200.0))))));
  const double s2 = 2.0 * s * c;
  const double c2 = c * c - s * s;
  sine = 2.0 * s2 * c2;
  cosine = c2 * c2 - s2 * s2;
}

}  // namespace ltcfit
