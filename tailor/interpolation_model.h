// Predicts what interpolation will cost a table, before the table is fitted.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "fit/lobe_fit.h"
#include "tailor/axis_range.h"
#include "tailor/light_response.h"
#include "tailor/lobe_distribution.h"

namespace ltcfit {

struct InterpolationModelOptions {
  LobeFitOptions fit;
  std::string brdf = "ggx";
  double alphaFloor = 1e-4;
  std::size_t points = 64;    ///< look-ups, 1 or more
  std::size_t lineFits = 13;  ///< fits along each axis through each look-up, 3 or more
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: as many as OpenMP offers
};

/// Called after each finished fit, never from two threads at once.
using FitProgress = std::function<void(std::size_t done, std::size_t total)>;

/// A direct fit as a table's look-up should yield it. Not usable: NaN.
StoredEntry fitLookUp(const LobeParameters& parameters, bool isotropic,
                      const InterpolationModelOptions& options);

/// Linear interpolation along one axis of a table shifts an entry by so much; to first order the shifts of
/// all axes add up. So direct fits along one line for each axis, through a sample of look-ups, tell the error
/// of every size and placement of nodes. Between its fits (Chebyshev's points in the axis' map) a line is the
/// polynomial through them.
class InterpolationModel {
 public:
  /// Throws std::runtime_error where no look-up is left. Lines reach over the range of their axis, and on to
  /// the nodes of the full table beside it.
  InterpolationModel(const LobeDistribution& distribution, const std::vector<AxisRange>& ranges,
                     const InterpolationModelOptions& options, const FitProgress& progress = {});

  int threads() const { return threads_; }
  std::size_t axisCount() const { return ranges_.size(); }
  const std::vector<AxisRange>& ranges() const { return ranges_; }
  std::size_t fits() const { return fits_; }
  /// Look-ups that count.
  std::size_t lookUps() const { return lookUps_.size(); }
  /// Look-ups whose lobe, or one on their lines, could not be fitted: left out.
  std::size_t leftOut() const { return leftOut_; }

  /// Shifts of all look-ups' entries, one column each, by interpolating along the axis between its nodes.
  using Shifts = Eigen::Matrix<double, 11, Eigen::Dynamic>;
  Shifts shifts(std::size_t axis, const Axis& nodes) const;

  /// Predicted LightResponse::difference, mean over the look-ups, for the sum of one shift for each axis: the
  /// root of the metric's square over 1 + the displacement, in widths of the lobe.
  double error(std::span<const Shifts* const> shifts) const;
  double error(const std::vector<Axis>& axes) const;

 private:
  struct Line {
    Eigen::Matrix<double, 11, Eigen::Dynamic> entries;  // one column for each fit
  };
  struct Extent {  // of the lines along an axis, in the coordinate of its map
    double low = 0.0;
    double high = 0.0;
  };
  StoredEntry along(std::size_t axis, std::size_t look, double physical) const;
  double coordinate(std::size_t axis, const LobeParameters& p) const;
  LobeParameters moved(std::size_t axis, const LobeParameters& p, double physical) const;

  bool isotropic_;
  int threads_ = 1;
  double alphaFloor_;
  std::vector<AxisRange> ranges_;
  std::vector<Extent> extents_;
  Eigen::VectorXd nodes_;    // Chebyshev's points in [0, 1]
  Eigen::VectorXd weights_;  // of the barycentric formula
  std::vector<LookUp> lookUps_;
  std::vector<StoredEntry> entries_;
  std::vector<Eigen::Matrix<double, 11, 11>> metrics_;
  std::vector<Eigen::Matrix<double, 2, 11>> displacements_;
  std::vector<std::vector<Line>> lines_;  // for each look-up, one for each axis
  std::size_t fits_ = 0;
  std::size_t leftOut_ = 0;
};

}  // namespace ltcfit
