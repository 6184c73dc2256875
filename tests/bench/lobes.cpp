#include "tests/bench/lobes.h"

#include "fit/moment_start.h"
#include "report/random_lights.h"

namespace ltcfit::bench {
namespace {

constexpr int kSamples = 8192;

}  // namespace

const GgxLobe& isotropicLobe() {
  static const GgxLobe lobe(viewDirection(1.1, 0.0), {0.2, 0.2});
  return lobe;
}

const GgxLobe& anisotropicLobe() {
  static const GgxLobe lobe(viewDirection(1.1, 0.5), {0.5, 0.15});
  return lobe;
}

const LobeMoments& isotropicMoments() {
  static const LobeMoments moments = computeMoments(isotropicLobe());
  return moments;
}

const LobeMoments& anisotropicMoments() {
  static const LobeMoments moments = computeMoments(anisotropicLobe());
  return moments;
}

const Eigen::Matrix3d& isotropicMatrix() {
  static const Eigen::Matrix3d m = momentStart(weightedSamples(isotropicLobe(), kSamples, 1));
  return m;
}

const Eigen::Matrix3d& anisotropicMatrix() {
  static const Eigen::Matrix3d m = momentStart(weightedSamples(anisotropicLobe(), kSamples, 1));
  return m;
}

const std::vector<Quad>& lights() {
  static const std::vector<Quad> quads = [] {
    Random random(1);
    std::vector<Quad> out;
    for (int i = 0; i < 64; ++i) out.push_back(randomLight(kLightSizes[1], random));
    return out;
  }();
  return quads;
}

}  // namespace ltcfit::bench
