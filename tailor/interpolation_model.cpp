#include "tailor/interpolation_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "base/angles.h"
#include "base/parallel_for.h"
#include "fit/table_fit.h"
#include "fit/table_plan.h"
#include "ggx/random.h"

namespace ltcfit {
namespace {

// Of a displacement in widths: brings predictions nearest to measurements over roughness 0.01 to 0.2 and 6 to
// 60 nodes (tests/tailor/table_designs_test.cpp, PredictionsComeNearForMirrorsToo).
constexpr double kSaturation = 0.5;

// What a table of one node is planned with: the node's job, turned and mirrored as it has to be.
TablePlan planOfOne(const LobeParameters& p, bool isotropic, const InterpolationModelOptions& options) {
  const Axis theta = singleNodeAxis("theta", "rad", p.theta);
  const Axis alpha = singleNodeAxis("alpha", "1", p.alphaX);
  if (isotropic) return planIsotropicTable({theta, alpha}, options.alphaFloor);
  return planAnisotropicTable(
      {alpha, singleNodeAxis("lambda", "1", p.alphaY / p.alphaX), theta, singleNodeAxis("phi", "rad", p.phi)},
      options.alphaFloor, SymmetryMode::kDuring);
}

}  // namespace

StoredEntry fitLookUp(const LobeParameters& parameters, bool isotropic,
                      const InterpolationModelOptions& options) {
  const NodeFit fit = fitNode(planOfOne(parameters, isotropic, options), 0, options.fit);
  if (!fit.usable) return StoredEntry::Constant(std::nan(""));
  return storedEntry(fit.m, fit.norm, fit.fresnel, lookUpStorage(isotropic));
}

InterpolationModel::InterpolationModel(const LobeDistribution& distribution,
                                       const std::vector<AxisRange>& ranges,
                                       const InterpolationModelOptions& options, const FitProgress& progress)
    : isotropic_(distribution.isotropic), alphaFloor_(options.alphaFloor), ranges_(ranges) {
  const std::vector<Axis> full = fullAxes(isotropic_, options.alphaFloor);
  for (std::size_t a = 0; a < ranges.size(); ++a) {
    const AxisRange& range = ranges[a];
    const Axis& axis = full[a];
    const double below = axis.valueFromTexel(std::floor(axis.texelFromValue(range.low) + 1e-9));
    const double above = axis.valueFromTexel(std::ceil(axis.texelFromValue(range.high) - 1e-9));
    extents_.push_back({mapCoordinate(range.map, std::min(below, range.low)),
                        mapCoordinate(range.map, std::max(above, range.high))});
  }
  const auto n = static_cast<Eigen::Index>(options.lineFits);
  nodes_.resize(n);
  weights_.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    nodes_[i] = 0.5 - 0.5 * std::cos(std::numbers::pi * static_cast<double>(i) / static_cast<double>(n - 1));
    weights_[i] = (i % 2 == 0 ? 1.0 : -1.0) * (i == 0 || i == n - 1 ? 0.5 : 1.0);
  }

  // one fit for each look-up, then those on its lines
  const std::vector<LookUp> all = drawLookUps(distribution, options.points, options.alphaFloor, options.seed);
  const std::size_t perLookUp = 1 + ranges.size() * options.lineFits;
  fits_ = all.size() * perLookUp;
  std::vector<StoredEntry> fitted(fits_);
  std::size_t done = 0;
  parallelFor(fits_, {.threads = options.threads}, [&](std::size_t k) {
    LobeParameters p = all[k / perLookUp].parameters;
    if (const std::size_t i = k % perLookUp; i > 0) {
      const std::size_t axis = (i - 1) / options.lineFits;
      const double u = nodes_[static_cast<Eigen::Index>((i - 1) % options.lineFits)];
      const Extent& extent = extents_[axis];
      p = moved(axis, p, unmapCoordinate(ranges_[axis].map, extent.low + u * (extent.high - extent.low)));
    }
    fitted[k] = fitLookUp(p, isotropic_, options);
    return [&] {
      if (progress) progress(++done, fits_);
    };
  });
  threads_ = options.threads;
  for (std::size_t l = 0; l < all.size(); ++l) {
    const auto begin = fitted.begin() + static_cast<std::ptrdiff_t>(l * perLookUp);
    if (!std::all_of(begin, begin + static_cast<std::ptrdiff_t>(perLookUp),
                     [](const StoredEntry& e) { return e.allFinite(); })) {
      ++leftOut_;
      continue;
    }
    lookUps_.push_back(all[l]);
    entries_.push_back(*begin);
    const LightResponse response(all[l], *begin, lookUpStorage(isotropic_), mixSeed(options.seed, 100 + l));
    metrics_.push_back(response.metric());
    displacements_.push_back(response.displacement());
    std::vector<Line>& lines = lines_.emplace_back(ranges.size());
    for (std::size_t a = 0; a < ranges.size(); ++a) {
      lines[a].entries.resize(11, n);
      for (Eigen::Index i = 0; i < n; ++i)
        lines[a].entries.col(i) = *(begin + 1 + static_cast<std::ptrdiff_t>(a) * n + i);
    }
  }
  if (lookUps_.empty()) throw std::runtime_error("none of the scene's lobes could be fitted");
}

double InterpolationModel::coordinate(std::size_t axis, const LobeParameters& p) const {
  const std::string& name = ranges_[axis].name;
  if (name == "theta") return p.theta;
  if (name == "phi") return p.phi;
  return name == "alpha" ? p.alphaX : p.alphaY / p.alphaX;
}

LobeParameters InterpolationModel::moved(std::size_t axis, const LobeParameters& p, double physical) const {
  const std::string& name = ranges_[axis].name;
  LobeParameters out = p;
  if (name == "theta") out.theta = std::clamp(physical, 0.0, kHalfPi);
  if (name == "phi") out.phi = std::clamp(physical, 0.0, kHalfPi);
  const double lambda = name == "lambda" ? physical : p.alphaY / p.alphaX;
  if (name == "alpha") out.alphaX = std::max(physical, alphaFloor_);
  out.alphaY = isotropic_ ? out.alphaX : std::clamp(out.alphaX * lambda, alphaFloor_, out.alphaX);
  return out;
}

StoredEntry InterpolationModel::along(std::size_t axis, std::size_t look, double physical) const {
  const Extent& extent = extents_[axis];
  const Eigen::Matrix<double, 11, Eigen::Dynamic>& entries = lines_[look][axis].entries;
  if (extent.high == extent.low) return entries.col(0);
  const double at = (mapCoordinate(ranges_[axis].map, physical) - extent.low) / (extent.high - extent.low);
  StoredEntry sum = StoredEntry::Zero();
  double total = 0.0;
  for (Eigen::Index i = 0; i < nodes_.size(); ++i) {
    const double distance = std::clamp(at, 0.0, 1.0) - nodes_[i];
    if (distance == 0.0) return entries.col(i);
    sum += weights_[i] / distance * entries.col(i);
    total += weights_[i] / distance;
  }
  return sum / total;
}

InterpolationModel::Shifts InterpolationModel::shifts(std::size_t axis, const Axis& nodes) const {
  Shifts out(11, static_cast<Eigen::Index>(lookUps_.size()));
  for (std::size_t l = 0; l < lookUps_.size(); ++l) {
    const double value = coordinate(axis, lookUps_[l].parameters);
    const double t = nodes.texelFromValue(value);
    const double below = std::min(std::floor(t), std::max(1.0, static_cast<double>(nodes.size() - 1)) - 1.0);
    const StoredEntry low = along(axis, l, nodes.valueFromTexel(below));
    StoredEntry fetched = low;
    if (nodes.size() > 1) fetched += (t - below) * (along(axis, l, nodes.valueFromTexel(below + 1.0)) - low);
    out.col(static_cast<Eigen::Index>(l)) = fetched - along(axis, l, value);
  }
  return out;
}

double InterpolationModel::error(std::span<const Shifts* const> shifts) const {
  double sum = 0.0;
  for (std::size_t l = 0; l < lookUps_.size(); ++l) {
    StoredEntry shift = StoredEntry::Zero();
    for (const Shifts* s : shifts) shift += s->col(static_cast<Eigen::Index>(l));
    const double square =
        shift.dot(metrics_[l] * shift) / (1.0 + kSaturation * (displacements_[l] * shift).norm());
    sum += square < 0.0 ? 0.0 : std::sqrt(square);  // rounding of what is 0; NaN stays
  }
  return sum / static_cast<double>(lookUps_.size());
}

double InterpolationModel::error(const std::vector<Axis>& axes) const {
  std::vector<Shifts> all;
  for (std::size_t a = 0; a < axes.size(); ++a) all.push_back(shifts(a, axes[a]));
  std::vector<const Shifts*> pointers;
  for (const Shifts& s : all) pointers.push_back(&s);
  return error(pointers);
}

}  // namespace ltcfit
