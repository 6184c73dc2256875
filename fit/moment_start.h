// A first matrix from a lobe's samples, for lobes of any symmetry.
#pragma once

#include <Eigen/Core>

#include "fit/lobe_samples.h"

namespace ltcfit {

/// The LTC that is most likely to have made the samples, among those whose matrix is a frame times
/// [A c; 0 1] with A 2x2: in the slopes (x/z, y/z) of the frame such an LTC is a bivariate Student t with two
/// degrees of freedom, density (1 + d^2)^-2 / (pi det A) with d the distance from c in units of A; its most
/// likely centre and scale are found by a few steps of reweighted moments, which heavy tails do not upset
/// (plain moments of a sharp GGX lobe are all tail). The frame is that of the samples' mean direction, then
/// of the centre found. Aligned; det > 0. Needs two or more samples that differ.
Eigen::Matrix3d momentStart(const LobeSamples& samples);

}  // namespace ltcfit
