// Joint refinement: all entries of a table at once, for what is read between its nodes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fit/lobe_fit.h"
#include "fit/lookup_loss.h"
#include "fit/optimizer.h"
#include "ltc/table.h"

namespace ltcfit {

/// What the parts of the loss of a look-up count. Each is an error over its mean among direct fits, so that
/// the parts are alike; all >= 0, not all 0.
struct RefinementWeights {
  double sw = 1.3;           ///< sliced Wasserstein distance
  double swRel = 0.8;        ///< the same over the lobe's spread: sharp lobes count as much as wide ones
  double ratio = 0.9;        ///< the same over that of the point's direct fit: the interpolation ratio
  double form = 0.8;         ///< quads about the lobe
  double light = 1.05;       ///< lights over the hemisphere, and mass below the horizon
  double lightRatio = 0.05;  ///< the same over that of the point's direct fit
};

struct RefinementOptions {
  LookUpLossOptions loss{.slices = 16,
                         .targetSamples = 2048,
                         .samples = 512,
                         .lights = {.lights = 96, .sizeExponent = 0.0},
                         .quads = 40,
                         .leakWeight = 0.12};
  RefinementWeights weights;
  int points = 40000;  ///< look-ups over the table's domain, 16..2^22
  /// The nodes are look-ups too, each counting as much as this many of the others, 0..1000.
  double nodeWeight = 1.0;
  /// Of neighbours' changes to differ, 0..1000: the root of what a difference of 1 costs. Keeps entries that
  /// few look-ups see from making up their own.
  double smoothness = 0.4;
  /// The same for changes at all.
  double prior = 0.06;
  int iterations = 13;  ///< of Levenberg-Marquardt, 1..1000
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: as many as OpenMP offers; does not change the result

  /// False with a message naming the option, its value and its range.
  bool isValid(std::string* error) const;
};

/// Those of a kind of table. An isotropic one has many entries, each read by few look-ups: it is held
/// stiffer, else at sharp lobes and grazing view the inverses of neighbours do not interpolate.
RefinementOptions refinementDefaults(TableKind kind);

/// Where a refinement stands.
struct RefinementState {
  int iterations = 0;
  double radius = 0.0;               ///< of the trust region; 0: as at the start
  double cost = 0.0;                 ///< of the parameters: mean over the look-ups, with prior and smoothness
  std::vector<double> parameters{};  ///< of all entries, in order; empty: as at the start
};

struct RefinementResult {
  Table table;
  double startCost = 0.0;
  RefinementState state{};
  Termination termination = Termination::kFailure;
  std::size_t unusable = 0;  ///< nodes without an inverse in float32, or with det <= 0
};

class RefinementObserver {
 public:
  virtual ~RefinementObserver() = default;
  /// While look-ups are prepared: from any thread, but never from two at once. May throw, too.
  virtual void prepared(std::size_t done, std::size_t total) = 0;
  /// At the start and after each iteration, from the calling thread. May throw: that ends the refinement.
  virtual void iterated(const RefinementState& state) = 0;
};

/// Minimises the sum over random look-ups, and nodes, of LookUpLoss over all entries of the table together
/// (sparse Levenberg-Marquardt, Ceres). What is interpolated is what the table stores (info().stores), in its
/// normalization; symmetries and equal lobes are kept by construction: eq. 13 to 16 of KT et al. 2022 and
/// lambda = 1 stay exact. Norm and Fresnel stay as they are.
///
/// Look-ups are drawn evenly over the axes: uniformly in alpha, lambda, theta and phi, in sqrt(alpha) and
/// sqrt(1 - cos theta) for isotropic tables, more of less weight where lobes change fast. `resumed`, or null:
/// where an earlier call of the same arguments stood. `options` valid. Throws Refusal for an
/// unknown brdf, an anisotropic table that does not store M, one whose nodes are no LTCs with det > 0, or no
/// lobes (alpha 0), or whose channels leave out what refinement would change, and a `resumed` of another
/// table.
RefinementResult refineTable(const Table& table, const RefinementOptions& options,
                             const RefinementState* resumed = nullptr,
                             RefinementObserver* observer = nullptr);

/// Means over look-ups.
struct FreshErrors {
  LookUpErrors mean;         ///< errors of 1 where a look-up yields no LTC
  double swRel = 0.0;        ///< of mean.sw over the lobe's spread
  double below = 0.0;        ///< mass below the horizon
  std::size_t unusable = 0;  ///< look-ups with det M <= 0: a shader must turn the winding there
};

/// Of direct fits of `count` look-ups that no refinement with this seed has seen, drawn evenly over the axes
/// of the first table, then of what each table yields there.
std::vector<FreshErrors> errorsAtFreshPoints(const std::vector<const Table*>& tables,
                                             const LookUpLossOptions& options, std::size_t count,
                                             std::uint64_t seed, int threads);

}  // namespace ltcfit
