#include "tailor/fetch_check.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel_for.h"
#include "ggx/random.h"

namespace ltcfit {

FetchCheck::FetchCheck(const LobeDistribution& distribution, std::size_t count,
                       const InterpolationModelOptions& fit, std::uint64_t seed, const FitProgress& progress)
    : isotropic_(distribution.isotropic),
      threads_(fit.threads),
      seed_(seed),
      lookUps_(drawLookUps(distribution, count, fit.alphaFloor, seed)),
      direct_(count) {
  std::size_t done = 0;
  parallelFor(count, {.threads = threads_}, [&](std::size_t i) {
    direct_[i] = fitLookUp(lookUps_[i].parameters, isotropic_, fit);
    return [&] {
      if (progress) progress(++done, count);
    };
  });
}

FetchError FetchCheck::measure(const Table& table) const {
  const MatrixStorage stores = lookUpStorage(isotropic_);
  const double infinity = std::numeric_limits<double>::infinity();
  std::vector<std::size_t> usable;
  for (std::size_t i = 0; i < direct_.size(); ++i)
    if (direct_[i].allFinite()) usable.push_back(i);
  std::vector<double> errors(usable.size(), infinity);
  parallelFor(usable.size(), {.threads = threads_}, [&](std::size_t k) {
    const std::size_t i = usable[k];
    const TableEntry entry = table.fetch(lookUps_[i].parameters);
    if (entry.invertible) {
      const double error = LightResponse(lookUps_[i], direct_[i], stores, mixSeed(seed_, 100 + i))
                               .difference(storedEntry(entry.m, entry.norm.value_or(0.0),
                                                       entry.fresnel.value_or(0.0), stores));
      if (std::isfinite(error)) errors[k] = error;
    }
  });
  FetchError out;
  out.lookUps = errors.size();
  if (errors.empty()) return out;
  std::sort(errors.begin(), errors.end());
  double sum = 0.0;
  double squares = 0.0;
  for (double e : errors) {
    sum += e;
    squares += e * e;
    out.singular += std::isinf(e) ? 1 : 0;
  }
  const auto n = static_cast<double>(errors.size());
  out.mean = sum / n;
  out.standardError =
      out.singular > 0 ? infinity : std::sqrt(std::max(0.0, squares / n - out.mean * out.mean) / n);
  out.p99 = errors[static_cast<std::size_t>(std::ceil(0.99 * n)) - 1];
  out.max = errors.back();
  return out;
}

}  // namespace ltcfit
