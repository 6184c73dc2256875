// Distributions and quick fits of the tests of tailored tables.
#pragma once

#include "tailor/interpolation_model.h"

namespace ltcfit::test {

/// Roughness uniform between two ends, `count` lobes of equal weight.
inline LobeDistribution isotropicLobes(double low, double high, int count = 9) {
  LobeDistribution d;
  for (int i = 0; i < count; ++i) {
    const double r = count > 1 ? low + (high - low) * i / (count - 1) : low;
    d.lobes.push_back({r * r, r * r, 1.0, 1.0, 1.0 / count});
  }
  return d;
}

inline LobeDistribution anisotropicLobes() {
  LobeDistribution d;
  d.isotropic = false;
  for (double alpha : {0.2, 0.3, 0.4})
    for (double lambda : {0.4, 0.6}) d.lobes.push_back({alpha, alpha * lambda, 1.0, 1.0, 1.0 / 6.0});
  return d;
}

/// A model of few look-ups: seconds instead of tens.
inline InterpolationModelOptions quickModel(bool isotropic) {
  InterpolationModelOptions o;
  o.fit = tableFitPreset(isotropic ? TableKind::kIsotropic : TableKind::kAnisotropic, kDefaultFitter);
  o.points = isotropic ? 32 : 12;
  o.lineFits = 9;
  return o;
}

}  // namespace ltcfit::test
