// Tries the fitters on stiff and extreme lobes, from good and bad starts.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fit/lobe_fit.h"
#include "report/objective_probe.h"

namespace ltcfit {

/// Where a descent begins.
enum class Start : std::size_t {
  kMoments,    ///< the start that tables use: momentStart()
  kIdentity,   ///< the cosine lobe
  kNeighbour,  ///< the fit of the lobe of 1.5 times the alphas, 5 degrees nearer to the normal
  kNoOverlap,  ///< a needle low over the horizon on the other side; at normal view, where the family has no
               ///< such lobe, a needle a thousandth as wide as the lobe
};
inline constexpr std::size_t kStartCount = 4;
/// "moments", "identity", "neighbour", "no-overlap".
std::string_view startName(Start start);

/// How a run ended.
enum class Outcome : std::size_t {
  kConverged,
  kMaxEvaluations,
  kFlat,          ///< did not reach the lobe, and at the start nothing says where it is: see kFlatGradient
  kNoOverlap,     ///< the fit does not overlap the lobe: TV above kNoOverlapTv
  kOtherMinimum,  ///< converged, to an SW1 of more than kOtherMinimum times the best known: another minimum,
                  ///< or an objective that wants something else
  kNonFinite,     ///< M is not finite, or has no inverse
  kFailure,       ///< the optimizer gave up
};
inline constexpr std::size_t kOutcomeCount = 7;
/// "converged", "max-evaluations", "flat", "no-overlap", "other-minimum", "non-finite", "failure".
std::string_view outcomeName(Outcome outcome);

inline constexpr double kNoOverlapTv = 0.98;
inline constexpr double kOtherMinimum = 3.0;
/// An SW1 below this part of the lobe's width counts as this much where errors are compared: less is the
/// noise of any number of samples where needles have heavy tails.
inline constexpr double kSmallestError = 0.01;
/// Relative change of the L3 cost by the steps of P that move the lobe, below which a start is flat.
inline constexpr double kFlatGradient = 1e-6;
/// Up to this TV a lobe is one that LTCs can represent.
inline constexpr double kRepresentableTv = 0.2;
/// From this alpha_y on halves hold a lobe: the floor that `ltcfit export data/ltc_iso.json --precision half`
/// states (HalfReport::alphaFloor).
inline constexpr double kHalfAlpha = 0.001008;

/// What the default fitters are held to. `id` is the name in the JSON.
struct StabilityLimit {
  std::string_view id;
  double limit;
  std::string_view text;
};
const std::vector<StabilityLimit>& stabilityLimits();

struct StabilityRun {
  Start start = Start::kMoments;
  std::uint64_t seed = 1;
  Outcome outcome = Outcome::kConverged;
  double sw1 = 0.0;         ///< on samples that no fit sees; NaN where the matrix is unusable
  bool restarted = false;   ///< LobeFit::restarted
  bool handedOver = false;  ///< LobeFit::handedOver
  bool startKept = false;   ///< LobeFit::startKept
  bool detNegative = false;
};

/// One fitter on one lobe.
struct StabilityRow {
  LobeParameters parameters;
  Fitter fitter = kDefaultFitter;
  bool isDefault = true;
  std::vector<StabilityRun> runs;
  std::array<int, kOutcomeCount> outcomes{};
  int nonFinite = 0;
  double sw1 = 0.0;           ///< from the usual start, first seed
  double sw1OverBest = 0.0;   ///< the worst of the runs over the best that any fitter found on the lobe
  double tv = 0.0;            ///< as sw1
  double spreadStarts = 0.0;  ///< largest over seeds of (max - min) / min of SW1 over the starts
  double spreadSeeds = 0.0;   ///< (max - min) / min over the seeds, from the usual start
  double conditionM = 0.0;
  ObjectiveProbe probe;
  /// Mean distance between directions of the lobe before and after: M stored as float32 and inverted in
  /// float32, in widths of the lobe; M^-1 stored as halves, in radians (export/half_matrix.h).
  double float32Shift = 0.0;
  double halfShift = 0.0;
  /// SW1 between the lobe fetched from the default table (its nodes fitted) and the direct fit, in widths;
  /// for the default fitters, from the floor of the tables on (alpha_y 1e-4).
  std::optional<double> interpolation;
  std::vector<std::string_view> broken;  ///< ids of limits; of default fitters only
};

/// `value` over `best`, both at least kSmallestError of the lobe's width.
double errorOver(double value, double best, double width);
/// (max - min) / min of SW1: over the starts, the largest of all seeds; over the seeds, from the usual start.
/// Infinite where a run is unusable.
double spreadOverStarts(const std::vector<StabilityRun>& runs);
double spreadOverSeeds(const std::vector<StabilityRun>& runs);

/// The figure of a row that a limit of stabilityLimits() bounds.
double limitedFigure(const StabilityRow& row, std::string_view id);
/// Ids of the limits that the row's figures are not within, NaN included.
std::vector<std::string_view> brokenLimits(const StabilityRow& row);

/// A failure that theory promises, or one that is overcome: counted over rows.
struct StabilityFinding {
  std::string title;
  std::string text;      ///< what is counted, after "rows of `of`"
  std::size_t rows = 0;  ///< where it shows
  std::size_t of = 0;    ///< where it could
};

struct StabilityOptions {
  std::vector<LobeParameters> lobes;
  std::vector<Fitter> fitters{Fitter::kLight, Fitter::kSlicedWasserstein, Fitter::kSlicedWassersteinSgd,
                              Fitter::kL3};
  int seeds = 3;      ///< of the default fitters; others have one
  bool full = false;  ///< all seeds and all lobes for every fitter
  int sgdEvery = 24;  ///< sw-sgd, which takes half a second a run, sees one of so many lobes
  int threads = 0;    ///< 0: as many as OpenMP offers
};

struct StabilityResult {
  std::vector<StabilityRow> rows;  ///< lobe by lobe
  std::vector<StabilityFinding> findings;
  std::size_t failed = 0;  ///< rows of default fitters that break a limit
};

/// `options` as tables are fitted: isotropic ones where alpha_x = alpha_y, else anisotropic ones. The result
/// does not depend on threads.
StabilityResult runStability(const StabilityOptions& options,
                             const std::function<void(std::size_t done, std::size_t total)>& progress = {});

/// A start for a lobe of the family with its mean direction opposite to azimuth phi.
Eigen::Matrix3d startMatrix(Start start, const LobeJob& job, const Eigen::Matrix3d& moments,
                            const Eigen::Matrix3d& neighbour);

}  // namespace ltcfit
