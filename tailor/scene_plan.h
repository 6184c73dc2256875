// The plan of a scene's tables: what is needed, why, and what it is expected to cost.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "scene/scene_use.h"
#include "tailor/interpolation_model.h"
#include "tailor/lobe_distribution.h"

namespace ltcfit {

/// What the user asks for.
struct PlanRequest {
  /// Bound of the mean difference between the table's look-ups and direct fits (tailor/light_response.h), in
  /// radiance under lights of radiance 1; 1e-5..1. 0: as small as maxBytes, which must then be set, allows.
  double maxError = 1e-3;
  /// A table's bound is the full table's error where that is larger: nothing is out of reach.
  bool noStricterThanFull = false;
  std::size_t maxBytes = 0;  ///< of all textures together; 0: no bound
  double margin = 0.01;      ///< around ranges: in roughness and in lambda, 0..1
  double alphaFloor = 1e-4;  ///< GGX alphas below count as this one, 1e-5..0.1
  std::int64_t seed = 1;

  /// False with a message naming the field, its value and its range.
  bool isValid(std::string* error) const;
};

/// Size and cost of a table.
struct TableCost {
  std::vector<std::size_t> nodes;  ///< along each axis
  std::size_t bytes = 0;           ///< of its textures
  std::size_t textures = 0;        ///< that a shader binds
  std::size_t fetches = 0;         ///< of a look-up
  double error = 0.0;              ///< predicted: InterpolationModel::error
};

/// One table of the plan.
struct PlannedTable {
  LobeDistribution distribution;
  std::vector<std::string> amplitudes;  ///< of norm, fresnel those that are needed
  std::vector<Axis> axes;               ///< predicted to be enough
  double maxError = 0.0;                ///< its bound; 0: none
  std::size_t maxBytes = 0;             ///< its share of PlanRequest::maxBytes; 0: no bound
  TableCost cost;                       ///< in halves; the fit takes floats where halves are too coarse
  TableCost full;                       ///< of the table for every scene, in halves too
  std::vector<std::pair<std::size_t, double>> curve;  ///< bytes and predicted error of the best designs
  bool reachable = true;                              ///< maxError can be kept
  std::vector<std::string> reasons;
};

/// What is known of a material, for people.
struct MaterialSummary {
  std::string name;
  double area = 0.0;
  std::size_t texels = 0;             ///< 0: not textured
  std::array<double, 3> roughness{};  ///< least, mean, largest root of alpha (of the larger alpha)
  std::array<double, 2> lambda{};     ///< least and largest alpha_y / alpha_x
  std::array<double, 2> f0{};
  std::vector<std::string> reasons;
};

struct ScenePlan {
  std::string scene;
  PlanRequest request;
  std::vector<MaterialSummary> materials;
  /// None (then the last note says why), one, or an isotropic and an anisotropic one.
  std::vector<PlannedTable> tables;
  LightUse lights;
  std::vector<std::string> shading;  ///< what the shader has to do: integrals, clipping, sides, textures
  std::vector<std::string> notes;
};

/// The lobes of a scene that a table of one kind is for: alphaX = alphaY or not, as told; alike ones merged,
/// those without specular reflection left out.
LobeDistribution distributionOf(const SceneUse& use, bool isotropic);

/// Why a scene has no lobes that a table is for, a sentence: of one that neither distributionOf has any.
std::string whyNoTable(const SceneUse& use);

/// The model that a planned table is designed by; the same for the same request.
InterpolationModelOptions modelOptions(const PlanRequest& request, bool isotropic, int threads);

/// Makes the plan. Where bytes alone are bounded, and there are two tables, they are shared out so that the
/// mean error over all lobes is least; else the isotropic one takes what its bound needs, and the other has
/// the rest. Some 2,000 fits of single lobes for each table. `request` must be valid.
ScenePlan planScene(const SceneUse& use, const PlanRequest& request, int threads,
                    const FitProgress& progress = {});

}  // namespace ltcfit
