// How far an LTC is from its target lobe: every figure of the project. f is the LTC, g = rho cos / n_D the
// lobe.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "ggx/lobe.h"
#include "ggx/moments.h"
#include "ltc/ltc.h"
#include "ltc/table.h"
#include "report/projections.h"
#include "report/random_lights.h"

namespace ltcfit {

/// What the polygon integral of the LTC is computed by, in form and light_s, light_m, light_l. The lobe's is
/// exact in either.
enum class LightIntegrator {
  kExact,        ///< exact clipping at the horizon
  kProxySphere,  ///< the shortcut of engines: proxySphereFormFactor
};

struct MetricOptions {
  int samples = 4096;   ///< directions of each of f and g, for SW1, TV and L3
  int directions = 32;  ///< projections for SW1
  int quads = 64;       ///< random quads for form
  int lights = 64;      ///< random lights of each size for light_s, light_m, light_l
  LightIntegrator integrator = LightIntegrator::kExact;
  std::uint64_t seed = 1;
};

/// The metrics of one entry, in the order in which they are printed.
enum class Metric : std::size_t {
  kSw1,                 ///< sliced Wasserstein distance: mean over directions of integral |F - G| dt, 0..2
  kSw1Rel,              ///< SW1 / spread of the lobe
  kForm,                ///< mean over random quads near the lobe of |integral f - integral g|
  kLightS,              ///< RMS over random lights of n_D |integral f - integral g|: half-size 0.05
  kLightM,              ///< half-size 0.25
  kLightL,              ///< half-size 0.8
  kTv,                  ///< total variation, 1/2 integral |f - g|, 0..1
  kL3,                  ///< (integral |f - g|^3)^(1/3), sr^-2/3
  kL3Cost,              ///< integral |rho cos - n_D f|^3, sr^-2: the objective of Heitz et al. 2016
  kBelow,               ///< mass of f below the horizon, 0..1
  kAlbedoError,         ///< |stored norm - n_D|
  kFresnelError,        ///< |stored fresnel - f_D|
  kDetError,            ///< |det of the inverse a shader ends up with / its exact value - 1|
  kInterpolationRatio,  ///< SW1 of the fetched matrix / SW1 of a direct fit at the same point
  kCount,
};
inline constexpr std::size_t kMetricCount = static_cast<std::size_t>(Metric::kCount);
/// Name as in the output: "SW1", "SW1rel", "form", "light_s", ...
std::string_view metricName(Metric metric);

/// One value for each metric. `present` is false where a figure does not exist for this table or point (no
/// norm channel; no direct fit asked for); a value that is present and not finite counts as a fault.
struct EntryMetrics {
  std::array<double, kMetricCount> value{};
  std::array<bool, kMetricCount> present{};

  void set(Metric m, double v) {
    value[static_cast<std::size_t>(m)] = v;
    present[static_cast<std::size_t>(m)] = true;
  }
  double get(Metric m) const { return value[static_cast<std::size_t>(m)]; }
};

/// Everything about a target that does not depend on the LTC it is compared with: samples, projections,
/// lights and their true integrals. Made once for each point, used for every table.
class MetricTarget {
 public:
  MetricTarget(const Lobe& lobe, const MetricOptions& options);

  const LobeMoments& moments() const { return moments_; }

  /// All metrics of the distribution alone: SW1 to below.
  EntryMetrics evaluate(const Ltc& ltc) const;

  /// SW1 alone, for interpolation ratios.
  double sw1(const Ltc& ltc) const;

 private:
  void compareDensities(const Ltc& ltc, EntryMetrics& out) const;

  struct Light {
    Quad quad;
    double integral;  // of g
  };

  const Lobe& lobe_;
  MetricOptions options_;
  LobeMoments moments_;
  std::vector<Eigen::Vector3d> lobeDirections_;  // of g, with weights that sum to 1
  std::vector<double> lobeWeights_;
  std::vector<Eigen::Vector3d> cosineDirections_;
  std::vector<Eigen::Vector3d> projections_;
  std::vector<std::vector<WeightedPosition>> sortedTarget_;  // for each projection
  std::vector<Light> quads_;
  std::array<std::vector<Light>, 3> lights_;
};

/// Adds albedo, Fresnel and det error of a table entry. The matrix is taken as stored in float32 (`entry` in
/// double), inverted in float as a shader does.
void addEntryErrors(const TableEntry& entry, MatrixStorage stores, const LobeMoments& moments,
                    EntryMetrics& out);

}  // namespace ltcfit
