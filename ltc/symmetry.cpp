#include "ltc/symmetry.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angles.h"

namespace ltcfit {

CanonicalLobe canonicalLobe(const LobeParameters& p) {
  CanonicalLobe out{p, Eigen::Matrix3d::Identity()};
  double phi = std::fmod(p.phi, 2.0 * kPi);
  if (phi < 0.0) phi += 2.0 * kPi;
  // the view vector is mirrored into the first quadrant; cos and sin of phi keep their absolute values
  if (phi > kPi) {
    phi = 2.0 * kPi - phi;
    out.map(1, 1) = -1.0;
  }
  if (phi > 0.5 * kPi) {
    phi = kPi - phi;
    out.map(0, 0) = -1.0;
  }
  if (p.alphaY > p.alphaX) {
    std::swap(out.parameters.alphaX, out.parameters.alphaY);
    phi = 0.5 * kPi - phi;
    Eigen::Matrix3d swap;
    swap << 0, 1, 0,  //
        1, 0, 0,      //
        0, 0, 1;
    out.map = (out.map * swap).eval();
  }
  out.parameters.phi = std::clamp(phi, 0.0, 0.5 * kPi);
  return out;
}

Eigen::Matrix3d fromCanonical(const CanonicalLobe& lobe, const Eigen::Matrix3d& t) {
  return lobe.map * t * lobe.map.transpose();
}

}  // namespace ltcfit
