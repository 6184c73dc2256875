#include "export/half_matrix.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "base/refusal.h"
#include "export/little_endian.h"
#include "ltc/ltc.h"

namespace ltcfit {
namespace {

// Directions of the cosine by which lobes are compared. 32 tell the roundings of one matrix apart as well as
// 512 do: the mean shift over the tables of data/ differs by less than 1 %.
constexpr int kDirections = 32;
// Halves in order: 0 for zero, one more for the next larger half.
constexpr int kSmallestNormal = 0x0400;
constexpr int kLargest = 0x7BFF;

int ordinal(double value) {
  const int bits = halfBits(static_cast<float>(value));
  const int magnitude = std::min(bits & 0x7FFF, kLargest);
  return (bits & 0x8000) != 0 ? -magnitude : magnitude;
}

double valueOf(int ordinal) {
  const double magnitude = static_cast<double>(halfValue(static_cast<std::uint16_t>(std::abs(ordinal))));
  return ordinal < 0 ? -magnitude : magnitude;
}

using Directions = Eigen::Matrix<double, 3, kDirections>;
using Ordinals = std::array<int, 9>;  // of the free entries, in their order

// A lattice over the disk, lifted: equal masses of the cosine.
Directions makeCosineDirections() {
  Directions x;
  for (int i = 0; i < kDirections; ++i)
    x.col(i) = sampleCosine({(i + 0.5) / kDirections, std::fmod(i * (1.0 / std::numbers::phi), 1.0)});
  return x;
}

struct Cost {
  double detError = std::numeric_limits<double>::infinity();
  double shift = std::numeric_limits<double>::infinity();

  bool withinBound() const { return detError <= kHalfDeterminantLimit; }
};

class Search {
 public:
  Search(const Eigen::Matrix3d& stored, MatrixStorage stores, const std::array<bool, 9>& free)
      : stored_(stored), inverse_(stores == MatrixStorage::kMinv), det_(stored.determinant()) {
    for (int k = 0; k < 9; ++k) {
      if (free[static_cast<std::size_t>(k)]) entries_[count_++] = k;
    }
    for (std::size_t i = 0; i < count_; ++i) nearest_[i] = clamped(i, exactOrdinal(i));
    references_.push_back({Eigen::Matrix3d::Zero(), transform(stored_)});
    best_ = nearest_;
    bestCost_ = cost(best_);
  }

  std::size_t count() const { return count_; }

  // Whether the nearest halves leave the diagonal zero or subnormal, or are none.
  bool isOutOfReach() const {
    for (std::size_t i = 0; i < count_; ++i) {
      const double exact = stored_(entries_[i] / 3, entries_[i] % 3);
      if (nearest_[i] != exactOrdinal(i) || std::abs(exact) > valueOf(kLargest)) return true;
    }
    return false;
  }

  // From now on the shift on the way to these counts as well: near the node and halfway.
  void addNeighbours(std::span<const Eigen::Matrix3d> neighbours) {
    for (const Eigen::Matrix3d& n : neighbours) {
      for (double t : {0.5, 0.125, 0.03125}) {
        const Eigen::Matrix3d added = t / (1.0 - t) * n;
        references_.push_back({added, transform(stored_ + added)});
      }
    }
    bestCost_ = cost(best_);
  }

  // All combinations of the two halves about each entry. `bound`: determinants count first.
  void roundings(bool bound) {
    Ordinals other = nearest_;
    for (std::size_t i = 0; i < count_; ++i) {
      const double exact = stored_(entries_[i] / 3, entries_[i] % 3);
      const double near = valueOf(nearest_[i]);
      if (near != exact) other[i] = clamped(i, near > exact ? nearest_[i] - 1 : nearest_[i] + 1);
    }
    best_ = nearest_;
    bestCost_ = cost(best_);
    for (std::size_t combination = 1; combination < (std::size_t{1} << count_); ++combination) {
      Ordinals candidate = nearest_;
      for (std::size_t i = 0; i < count_; ++i) {
        if (((combination >> i) & 1u) != 0) candidate[i] = other[i];
      }
      tryCandidate(candidate, bound);
    }
  }

  // Every combination within `reach` places of the nearest halves that keeps the determinant.
  void neighbourhood(int reach) {
    Ordinals offset{};
    std::fill_n(offset.begin(), count_, -reach);
    for (;;) {
      Ordinals candidate = nearest_;
      for (std::size_t i = 0; i < count_; ++i) candidate[i] = clamped(i, nearest_[i] + offset[i]);
      // the determinant is cheap, the shift is not
      if (detError(matrix(candidate)) <= kHalfDeterminantLimit) tryCandidate(candidate, true);
      std::size_t i = 0;
      while (i < count_ && ++offset[i] > reach) offset[i++] = -reach;
      if (i == count_) return;
    }
  }

  // Single entries and pairs by steps of halving length, in units of the last place, which are relative for
  // normal halves. With `bound` the determinant is a penalty that grows, so that the search leaves the lobe
  // only as far as it must.
  void pattern(bool bound) {
    Ordinals at = nearest_;
    const std::vector<double> weights =
        bound ? std::vector<double>{1e-4, 1e-3, 1e-2, 1e-1, 1.0} : std::vector<double>{0.0};
    for (double weight : weights) {
      const auto penalized = [&](const Ordinals& candidate) {
        const Cost c = cost(candidate);
        return weight == 0.0 ? c.shift
                             : c.shift + weight * std::log(std::max(c.detError / kHalfDeterminantLimit, 1.0));
      };
      double least = penalized(at);
      for (int step = 2048; step >= 1;) {
        bool better = false;
        for (std::size_t move = 0; move < 4 * count_ * count_; ++move) {
          const std::size_t i = move / 4 / count_;
          const std::size_t j = move / 4 % count_;
          if (j < i) continue;
          Ordinals candidate = at;
          candidate[i] = clamped(i, candidate[i] + ((move & 1u) != 0 ? -step : step));
          if (j != i) candidate[j] = clamped(j, candidate[j] + ((move & 2u) != 0 ? -step : step));
          const double value = penalized(candidate);
          if (!(value < least)) continue;
          least = value;
          at = candidate;
          better = true;
        }
        if (!better) step /= 2;
      }
    }
    best_ = at;
    bestCost_ = cost(at);
  }

  bool withinBound() const { return bestCost_.withinBound(); }
  bool found() const { return std::isfinite(bestCost_.shift); }

  HalfRounding result() const {
    HalfRounding out;
    out.matrix = matrix(best_);
    out.shift = shiftOf(out.matrix, references_[0]);
    for (const Reference& reference : references_)
      out.between = std::max(out.between, shiftOf(out.matrix, reference));
    out.detError = bestCost_.detError;
    out.constrained = isOutOfReach() || detError(matrix(nearest_)) > kHalfDeterminantLimit;
    for (std::size_t i = 0; i < count_; ++i) out.moved = out.moved || best_[i] != exactOrdinal(i);
    return out;
  }

 private:
  // A matrix to be added, and the lobe of the sum with the exact one: what is fetched between two nodes.
  struct Reference {
    Eigen::Matrix3d added;
    Directions lobe;
  };

  int exactOrdinal(std::size_t i) const { return ordinal(stored_(entries_[i] / 3, entries_[i] % 3)); }

  // Within the halves of the same sign; on the diagonal within the normal ones.
  int clamped(std::size_t i, int o) const {
    const double exact = stored_(entries_[i] / 3, entries_[i] % 3);
    if (exact == 0.0) return 0;
    const int least = entries_[i] % 4 == 0 ? kSmallestNormal : 0;
    return exact < 0.0 ? std::clamp(o, -kLargest, -least) : std::clamp(o, least, kLargest);
  }

  Eigen::Matrix3d matrix(const Ordinals& ordinals) const {
    Eigen::Matrix3d m = stored_;
    for (std::size_t i = 0; i < count_; ++i) m(entries_[i] / 3, entries_[i] % 3) = valueOf(ordinals[i]);
    return m;
  }

  double detError(const Eigen::Matrix3d& m) const { return std::abs(m.determinant() / det_ - 1.0); }

  // Directions of the lobe. The inverse up to its positive scale: the adjugate, with the determinant's sign.
  Directions transform(const Eigen::Matrix3d& m) const {
    static const Directions cosine = makeCosineDirections();
    Eigen::Matrix3d t = m;
    if (inverse_) {
      t.row(0) = m.col(1).cross(m.col(2));
      t.row(1) = m.col(2).cross(m.col(0));
      t.row(2) = m.col(0).cross(m.col(1));
      if (det_ < 0.0) t = -t;
    }
    return (t * cosine).colwise().normalized();
  }

  double shiftOf(const Eigen::Matrix3d& m, const Reference& reference) const {
    return (transform(m + reference.added) - reference.lobe).colwise().norm().mean();
  }

  Cost cost(const Ordinals& ordinals) const {
    const Eigen::Matrix3d m = matrix(ordinals);
    Cost out;
    double sum = 0.0;
    for (const Reference& reference : references_) {
      // a determinant that changes its sign is a lobe turned inside out: black in a renderer
      const double exact = (stored_ + reference.added).determinant();
      if (!((m + reference.added).determinant() / exact > 0.0)) return out;
      sum += shiftOf(m, reference);
    }
    out.detError = detError(m);
    out.shift = sum / static_cast<double>(references_.size());
    return out;
  }

  void tryCandidate(const Ordinals& candidate, bool bound) {
    const Cost c = cost(candidate);
    if (bound) {
      const double a = std::max(c.detError, kHalfDeterminantLimit);
      const double b = std::max(bestCost_.detError, kHalfDeterminantLimit);
      if (!(a < b || (a == b && c.shift < bestCost_.shift))) return;
    } else if (!(c.shift < bestCost_.shift)) {
      return;
    }
    best_ = candidate;
    bestCost_ = c;
  }

  Eigen::Matrix3d stored_;
  bool inverse_;
  double det_;
  std::array<int, 9> entries_{};
  std::size_t count_ = 0;
  std::vector<Reference> references_;
  Ordinals nearest_{};
  Ordinals best_{};
  Cost bestCost_;
};

}  // namespace

HalfRounding roundToHalf(const Eigen::Matrix3d& stored, MatrixStorage stores, const std::array<bool, 9>& free,
                         std::span<const Eigen::Matrix3d> neighbours) {
  Search search(stored, stores, free);
  if (!search.isOutOfReach()) {
    search.roundings(true);
    // 4 places of 5 entries and 2 of 9: 6,561 and 2 million determinants, the latter 40 ms
    const bool few = search.count() <= 5;
    if (!search.withinBound()) search.neighbourhood(few ? 4 : 1);
    if (!search.withinBound() && !few) search.neighbourhood(2);
    if (!search.withinBound()) search.roundings(false);
  } else {
    search.addNeighbours(neighbours);
    search.pattern(false);
    Search bounded = search;
    bounded.pattern(true);
    if (bounded.withinBound()) search = bounded;
  }
  if (!search.found()) throw Refusal("is out of reach of half precision");
  return search.result();
}

}  // namespace ltcfit
