#include "export/half_matrix.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

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

  // first the bound, then the lobe
  bool operator<(const Cost& other) const {
    const double a = std::max(detError, kHalfDeterminantLimit);
    const double b = std::max(other.detError, kHalfDeterminantLimit);
    return a < b || (a == b && shift < other.shift);
  }
  bool withinBound() const { return detError <= kHalfDeterminantLimit; }
};

class Search {
 public:
  Search(const Eigen::Matrix3d& stored, MatrixStorage stores, const std::array<bool, 9>& free)
      : stored_(stored), inverse_(stores == MatrixStorage::kMinv), det_(stored.determinant()) {
    for (int k = 0; k < 9; ++k) {
      if (free[static_cast<std::size_t>(k)]) entries_.push_back(k);
    }
    target_ = transform(stored_, det_);
    for (int k : entries_) best_.push_back(clamped(k, ordinal(stored_(k / 3, k % 3))));
    nearest_ = best_;
    bestCost_ = cost(best_);
  }

  bool nearestIsAllowed() const {
    for (int k : entries_) {
      const int o = ordinal(stored_(k / 3, k % 3));
      if (clamped(k, o) != o) return false;
    }
    return cost(nearest_).withinBound();
  }

  // Both neighbours of each entry: every combination of few entries, one entry at a time for many.
  void roundings() {
    std::vector<std::array<int, 2>> choices;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      const int k = entries_[i];
      const double exact = stored_(k / 3, k % 3);
      const int other = valueOf(nearest_[i]) > exact ? nearest_[i] - 1 : nearest_[i] + 1;
      choices.push_back({nearest_[i], valueOf(nearest_[i]) == exact ? nearest_[i] : clamped(k, other)});
    }
    if (entries_.size() <= 5) {
      for (std::size_t combination = 1; combination < (std::size_t{1} << entries_.size()); ++combination) {
        std::vector<int> candidate = nearest_;
        for (std::size_t i = 0; i < candidate.size(); ++i) candidate[i] = choices[i][(combination >> i) & 1u];
        tryCandidate(candidate);
      }
      return;
    }
    for (bool better = true; better;) {
      better = false;
      for (std::size_t i = 0; i < entries_.size(); ++i) {
        std::vector<int> candidate = best_;
        candidate[i] = choices[i][candidate[i] == choices[i][0] ? 1 : 0];
        better = tryCandidate(candidate) || better;
      }
    }
  }

  // For bounds that forbid the whole neighbourhood of the nearest: from there single entries and pairs by
  // steps of halving length, in units of the last place, which are relative for normal halves. The
  // determinant is a penalty that grows, so that the search leaves the lobe only as far as it must.
  void pattern() {
    std::vector<int> at = nearest_;
    for (double weight : {1e-4, 1e-3, 1e-2, 1e-1, 1.0}) {
      const auto penalized = [&](const std::vector<int>& candidate) {
        const Cost c = cost(candidate);
        return c.shift +
               weight * std::log(std::max(c.detError, kHalfDeterminantLimit) / kHalfDeterminantLimit);
      };
      double least = penalized(at);
      for (int step = 2048; step >= 1;) {
        bool better = false;
        for (std::size_t move = 0; move < 4 * at.size() * at.size(); ++move) {
          const std::size_t i = move / 4 / at.size();
          const std::size_t j = move / 4 % at.size();
          if (j < i) continue;
          std::vector<int> candidate = at;
          candidate[i] = clamped(entries_[i], candidate[i] + ((move & 1u) != 0 ? -step : step));
          if (j != i) candidate[j] = clamped(entries_[j], candidate[j] + ((move & 2u) != 0 ? -step : step));
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

  // For matrices of the x-z plane whose diagonal had to be lifted far: the determinant is a difference of two
  // products, so one of m02 and m20 is tried over all magnitudes and the other one solved for.
  void solveOffDiagonal() {
    const auto m02 = std::find(entries_.begin(), entries_.end(), 2);
    const auto m20 = std::find(entries_.begin(), entries_.end(), 6);
    if (m02 == entries_.end() || m20 == entries_.end()) return;
    const auto first = static_cast<std::size_t>(m02 - entries_.begin());
    const auto second = static_cast<std::size_t>(m20 - entries_.begin());
    std::vector<int> overall = best_;
    Cost overallCost = bestCost_;
    for (int magnitude = 1; magnitude <= kLargest; magnitude += 1 + magnitude / 16) {
      for (int sign : {-1, 1}) {
        best_ = nearest_;
        best_[second] = sign * magnitude;
        const Eigen::Matrix3d m = matrix(best_);
        // det = m11 (m00 m22 - m02 m20)
        best_[first] = ordinal((m(0, 0) * m(2, 2) - det_ / m(1, 1)) / m(2, 0));
        bestCost_ = cost(best_);
        neighbourhood(2);
        if (bestCost_ < overallCost) {
          overall = best_;
          overallCost = bestCost_;
        }
      }
    }
    best_ = overall;
    bestCost_ = overallCost;
  }

  // Every combination within `reach` places of the best: the determinant first, which is cheap.
  void neighbourhood(int reach) {
    const std::vector<int> centre = best_;
    std::vector<int> candidate = centre;
    std::vector<int> offset(entries_.size(), -reach);
    for (;;) {
      for (std::size_t i = 0; i < candidate.size(); ++i)
        candidate[i] = clamped(entries_[i], centre[i] + offset[i]);
      if (!bestCost_.withinBound() || detError(matrix(candidate).determinant()) <= kHalfDeterminantLimit)
        tryCandidate(candidate);
      std::size_t i = 0;
      while (i < offset.size() && ++offset[i] > reach) offset[i++] = -reach;
      if (i == offset.size()) return;
    }
  }

  bool withinBound() const { return bestCost_.withinBound(); }

  HalfRounding result() const {
    HalfRounding out;
    out.matrix = matrix(best_);
    out.shift = bestCost_.shift;
    out.detError = bestCost_.detError;
    out.constrained = !nearestIsAllowed();
    for (std::size_t i = 0; i < entries_.size(); ++i)
      out.moved = out.moved || best_[i] != ordinal(stored_(entries_[i] / 3, entries_[i] % 3));
    return out;
  }

 private:
  // Within the halves; on the diagonal normal and of the same sign.
  int clamped(int k, int o) const {
    o = std::clamp(o, -kLargest, kLargest);
    if (k % 4 != 0) return o;
    return stored_(k / 3, k % 3) < 0.0 ? std::min(o, -kSmallestNormal) : std::max(o, kSmallestNormal);
  }

  Eigen::Matrix3d matrix(const std::vector<int>& ordinals) const {
    Eigen::Matrix3d m = stored_;
    for (std::size_t i = 0; i < ordinals.size(); ++i)
      m(entries_[i] / 3, entries_[i] % 3) = valueOf(ordinals[i]);
    return m;
  }

  double detError(double det) const { return std::abs(det / det_ - 1.0); }

  // Directions of the lobe. The inverse up to its positive scale: the adjugate, with the determinant's sign.
  Directions transform(const Eigen::Matrix3d& m, double det) const {
    static const Directions cosine = makeCosineDirections();
    Eigen::Matrix3d t = m;
    if (inverse_) {
      t.row(0) = m.col(1).cross(m.col(2));
      t.row(1) = m.col(2).cross(m.col(0));
      t.row(2) = m.col(0).cross(m.col(1));
      if (det < 0.0) t = -t;
    }
    return (t * cosine).colwise().normalized();
  }

  Cost cost(const std::vector<int>& ordinals) const {
    const Eigen::Matrix3d m = matrix(ordinals);
    const double det = m.determinant();
    Cost out;
    if (!(det / det_ > 0.0)) return out;
    out.detError = detError(det);
    out.shift = (transform(m, det) - target_).colwise().norm().mean();
    return out;
  }

  bool tryCandidate(const std::vector<int>& candidate) {
    const Cost c = cost(candidate);
    if (!(c < bestCost_)) return false;
    best_ = candidate;
    bestCost_ = c;
    return true;
  }

  Eigen::Matrix3d stored_;
  bool inverse_;
  double det_;
  std::vector<int> entries_;
  Directions target_;
  std::vector<int> nearest_;
  std::vector<int> best_;
  Cost bestCost_;
};

}  // namespace

HalfRounding roundToHalf(const Eigen::Matrix3d& stored, MatrixStorage stores,
                         const std::array<bool, 9>& free) {
  Search search(stored, stores, free);
  search.roundings();
  const bool few = std::count(free.begin(), free.end(), true) <= 5;
  if (!search.withinBound()) search.neighbourhood(few ? 4 : 1);
  if (!search.withinBound()) search.neighbourhood(few ? 4 : 2);
  if (!search.withinBound()) {
    search.pattern();
    search.neighbourhood(few ? 4 : 1);
  }
  if (!search.withinBound()) search.solveOffDiagonal();
  if (!search.withinBound()) throw std::invalid_argument("is out of reach of half precision");
  return search.result();
}

}  // namespace ltcfit
