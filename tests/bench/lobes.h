// What the benchmarks share: two lobes, a matrix for each, a set of lights.
//
// Every counter of a benchmark is an error, the lower the better, and a function of the build alone: measured
// outside of the timed loop on fixed seeds. scripts/bench_compare.py relies on it.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "ggx/ggx_lobe.h"
#include "ggx/moments.h"
#include "ltc/quad.h"

namespace ltcfit::bench {

/// alpha 0.2, theta 63 degrees.
const GgxLobe& isotropicLobe();
/// alpha 0.5 and 0.15, theta 63 degrees, phi 29 degrees: no symmetry, 7 parameters to fit.
const GgxLobe& anisotropicLobe();

/// computeMoments of these lobes at the default tolerance.
const LobeMoments& isotropicMoments();
const LobeMoments& anisotropicMoments();

/// momentStart of the lobes: matrices that are near, but not the best.
const Eigen::Matrix3d& isotropicMatrix();
const Eigen::Matrix3d& anisotropicMatrix();

/// 64 lights of the metric light_m: half-sizes about 0.25, anywhere above, some through the horizon.
const std::vector<Quad>& lights();

}  // namespace ltcfit::bench
