#include "fit/projected_cdf_loss.h"

#include <Eigen/LU>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

namespace ltcfit {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

// Compiled twice, chosen by the processor: 1.5 times faster with AVX2. The same operations on each element
// (contraction is off), so the same results. Not under sanitizers, whose start-up comes after the choice.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define LTCFIT_VECTOR_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define LTCFIT_VECTOR_CLONES
#endif

// 2^kCellBits cells for each doubling of 1 + |t - centre| / scale.
constexpr int kCellBits = 4;
constexpr int kShift = 23 - kCellBits;
constexpr std::int32_t kOne = std::bit_cast<std::int32_t>(1.0f);
constexpr std::int32_t kPartMask = (1 << kShift) - 1;
constexpr double kFullPart = 1 << kShift;
// The LTC's histogram is one 64-bit sum a cell: weights above bit kWeightBit, in units of 2^-kWeightBits of
// all, and below it weight times part, the part cut to kPartBits. Exact, so that the order does not matter.
constexpr int kWeightBit = 38;
constexpr int kWeightBits = 25;
constexpr int kPartBits = 12;
constexpr double kAllWeight = std::int64_t{1} << kWeightBits;
constexpr std::uint64_t kPartsMask = (std::uint64_t{1} << kWeightBit) - 1;
// CDFs in the same units: 1 is this many.
constexpr double kAllParts = kAllWeight * (1 << kPartBits);
constexpr std::int32_t kOctave = 1 << kCellBits;
// The scale of the cells against the width of the start, projected.
constexpr double kScaleFactor = 0.5;
// Of the differences of CDFs, as a part of their mean, below which the curvature no longer grows.
constexpr double kCurvatureFloor = 0.3;
// Octaves of the longest axis: 2^30 times the scale. A lobe narrower than 1e-9 keeps its core.
constexpr int kMostOctaves = 30;

// First and last cell that holds a point.
struct CellRange {
  std::int32_t first, last;
};

// Cells of a slice have the size 2^octave times the smallest.
int octaveOf(const ProjectedSlice& s, std::int32_t cell) {
  const std::int32_t half = s.octaves << kCellBits;
  return (cell < half ? half - 1 - cell : cell - half) >> kCellBits;
}

// The cell of each point on a slice, and the part of the cell that lies above it: 2^kShift times the mean
// over the cell of the step that the point adds to the CDF.
LTCFIT_VECTOR_CLONES void binSlice(const ProjectedSlice& s, std::size_t n, const float* px, const float* py,
                                   const float* pz, std::int32_t* cell, std::int32_t* part,
                                   CellRange* range) {
  const std::int32_t middle = s.octaves << kCellBits;
  const std::int32_t largest = (s.octaves << 23) - 1;
  const float dx = s.x;
  const float dy = s.y;
  const float dz = s.z;
  const float inverse = s.inverse;
  std::int32_t first = std::numeric_limits<std::int32_t>::max();
  std::int32_t last = 0;
#pragma omp simd reduction(min : first) reduction(max : last)
  for (std::size_t i = 0; i < n; ++i) {
    const float t = (dx * px[i] + dy * py[i] + dz * pz[i]) * inverse;
    const std::int32_t bits = std::bit_cast<std::int32_t>(1.0f + std::abs(t)) - kOne;
    const std::int32_t u = bits < largest ? bits : largest;
    const std::int32_t k = u >> kShift;
    const std::int32_t low = u & kPartMask;
    const std::int32_t mirror =
        std::bit_cast<std::int32_t>(t) >> 31;  // -1 below the centre: ~k and low there
    const std::int32_t c = middle + (k ^ mirror);
    cell[i] = c;
    first = c < first ? c : first;
    last = c > last ? c : last;
    part[i] = (low ^ ~mirror) + (mirror + 1) + (~mirror & (1 << kShift));
  }
  *range = {first, last};
}

// Adds sign * (x, y, z) of the slice to the pull on each sample.
LTCFIT_VECTOR_CLONES void pullSamples(const ProjectedSlice& s, std::size_t n, const float* sign,
                                      const std::int32_t* cell, float* gx, float* gy, float* gz) {
#pragma omp simd
  for (std::size_t i = 0; i < n; ++i) {
    const float g = sign[cell[i]];
    gx[i] += g * s.x;
    gy[i] += g * s.y;
    gz[i] += g * s.z;
  }
}

}  // namespace

std::vector<Vector3d> familySlices(MatrixFamily family, int count) {
  double azimuth = 2.0 * std::numbers::pi;
  double from = 0.0;
  if (family == MatrixFamily::kMirrorY || family == MatrixFamily::kMirrorX) azimuth = std::numbers::pi;
  if (family == MatrixFamily::kMirrorX) from = -0.5 * std::numbers::pi;
  if (family == MatrixFamily::kMirrorXY) azimuth = 0.5 * std::numbers::pi;
  std::vector<Vector3d> out;
  for (int i = 0; i < count; ++i) {
    const double z = (i + 0.5) / count;
    const double phi = from + azimuth * std::fmod(i * (std::numbers::phi - 1.0), 1.0);
    const double r = std::sqrt(1.0 - z * z);
    out.emplace_back(r * std::cos(phi), r * std::sin(phi), z);
  }
  return out;
}

ProjectedLobe::ProjectedLobe(const LobeSamples& target, const Matrix3d& start,
                             const std::vector<Vector3d>& directions) {
  const Matrix3d scaled = start / start.col(2).norm();
  reference = scaled.col(2);
  std::size_t cells = 0;
  for (const Vector3d& w : directions) {
    const Vector3d projected = scaled.transpose() * w;
    const double apertures = scaled.leftCols<2>().norm();
    // the width to first order, and to second order where the slice is the lobe's own axis
    const double width = std::max(std::hypot(projected.x(), projected.y()),
                                  0.25 * std::min(1.0, apertures * apertures) * std::abs(projected.z()));
    const double scale = std::max(kScaleFactor * width, 1e-12);
    ProjectedSlice s{};
    s.x = static_cast<float>(w.x());
    s.y = static_cast<float>(w.y());
    s.z = static_cast<float>(w.z());
    s.scale = static_cast<float>(scale);
    s.inverse = 1.0f / s.scale;
    s.octaves = std::min(kMostOctaves, 1 + static_cast<int>(std::ceil(std::log2(1.0 + 2.0 / scale))));
    s.at = cells;
    const std::size_t own = static_cast<std::size_t>(s.octaves) << (kCellBits + 1);
    cells += own;
    mostCells = std::max(mostCells, own);
    slices.push_back(s);
  }
  cdf.resize(cells);

  const std::size_t n = target.directions.size();
  std::vector<float> x(n), y(n), z(n);
  std::vector<std::int32_t> cell(n), part(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Vector3d d = target.directions[i] - reference;
    x[i] = static_cast<float>(d.x());
    y[i] = static_cast<float>(d.y());
    z[i] = static_cast<float>(d.z());
  }
  std::vector<double> mass;
  for (ProjectedSlice& s : slices) {
    CellRange range{};
    binSlice(s, n, x.data(), y.data(), z.data(), cell.data(), part.data(), &range);
    s.first = range.first;
    s.last = range.last;
    const std::size_t own = static_cast<std::size_t>(s.octaves) << (kCellBits + 1);
    mass.assign(own + 1, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
      const auto c = static_cast<std::size_t>(cell[i]);
      const double now = target.weights[i] * static_cast<double>(part[i]) / kFullPart;
      mass[c] += now;
      mass[c + 1] += target.weights[i] - now;
    }
    double sum = 0.0;
    for (std::size_t c = 0; c < own; ++c) {
      sum += mass[c];
      cdf[s.at + c] = std::llround(sum * kAllParts);
    }
  }
}

ProjectedCosine::ProjectedCosine(const LobeSamples& cosine) : reference_(Vector3d::Zero()) {
  for (const Vector3d& x : cosine.directions) {
    cosX_.push_back(x.x());
    cosY_.push_back(x.y());
    cosZ_.push_back(x.z());
  }
  // rounded so that the running sum is exact to one unit
  double sum = 0.0;
  std::int64_t given = 0;
  for (const double w : cosine.weights) {
    sum += w;
    const auto upTo = static_cast<std::int64_t>(std::llround(sum * kAllWeight));
    weight_.push_back(static_cast<std::int32_t>(upTo - given));
    given = upTo;
  }
  for (auto* v : {&x_, &y_, &z_, &gx_, &gy_, &gz_}) v->resize(cosX_.size());
  invLength_.resize(cosX_.size());
  cell_.resize(cosX_.size());
  part_.resize(cosX_.size());
}

// Neighbouring samples go to two histograms, side by side: an addition need not wait for the one before where
// both hit one cell.
void ProjectedCosine::addToHistogram(std::size_t n) {
  const auto add = [&](std::size_t i, std::size_t side) {
    const auto w = static_cast<std::uint64_t>(weight_[i]);
    histogram_[2 * static_cast<std::size_t>(cell_[i]) + side] +=
        (w << kWeightBit) + w * static_cast<std::uint64_t>(part_[i] >> (kShift - kPartBits));
  };
  for (std::size_t i = 0; i + 1 < n; i += 2) {
    add(i, 0);
    add(i + 1, 1);
  }
  if (n % 2 == 1) add(n - 1, 0);
}

// Area between the two CDFs; leaves the derivatives' signs, and the histogram empty. All samples of both lie
// in the cells from `first` to `last`, so that both CDFs are 0 before and 1 after these.
double ProjectedCosine::areaBetweenCdfs(const ProjectedLobe& lobe, const ProjectedSlice& s,
                                        std::int32_t first, std::int32_t last) {
  const std::int64_t* const target = lobe.cdf.data() + s.at;
  std::uint64_t before = 0;
  double area = 0.0;
  for (std::int32_t block = first / kOctave * kOctave; block <= last; block += kOctave) {
    std::int64_t sum = 0;
    for (std::int32_t c = block; c < block + kOctave; ++c) {
      const auto at = static_cast<std::size_t>(c);
      const std::uint64_t h = histogram_[2 * at] + histogram_[2 * at + 1];
      histogram_[2 * at] = histogram_[2 * at + 1] = 0;
      const auto cdf = static_cast<std::int64_t>((before << kPartBits) + (h & kPartsMask));
      before += h >> kWeightBit;
      const std::int64_t difference = cdf - target[c];
      difference_[at] = difference;
      sum += std::abs(difference);
      sign_[at] = static_cast<float>((difference < 0) - (difference > 0));
    }
    area += std::ldexp(static_cast<double>(sum), octaveOf(s, block));
  }
  return area / kAllParts * static_cast<double>(s.scale) / kOctave;
}

// To each cell's mean of F, P adds motion / width of the cell; the loss is the sum of width |F - G|, of which
// width (F - G)^2 / |F - G| is the majorant.
void ProjectedCosine::addCurvature(const ProjectedSlice& s, std::int32_t first, std::int32_t last,
                                   Eigen::Matrix<double, 9, 9>* curvature) {
  const auto from = static_cast<std::size_t>(first);
  const auto to = static_cast<std::size_t>(last);
  std::fill(motion_.begin() + first, motion_.begin() + last + 1, std::array<double, 9>{});
  const Vector3d w(static_cast<double>(s.x), static_cast<double>(s.y), static_cast<double>(s.z));
  for (std::size_t i = 0; i < cosX_.size(); ++i) {
    const Vector3d u = pull_[i] * w;
    std::array<double, 9>& a = motion_[static_cast<std::size_t>(cell_[i])];
    const std::array<double, 3> x{cosX_[i], cosY_[i], cosZ_[i]};
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t c = 0; c < 3; ++c) a[3 * r + c] += u[static_cast<Eigen::Index>(r)] * x[c];
  }
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t c = from; c <= to; ++c) {
    const double d = std::abs(static_cast<double>(difference_[c]));
    const double area = std::ldexp(d, octaveOf(s, static_cast<std::int32_t>(c)));
    sum += area;
    squares += area * d;
  }
  const double floor = sum > 0.0 ? kCurvatureFloor * squares / sum : kAllParts / kAllWeight;
  const double unit = kAllParts / (kAllWeight * kAllWeight * static_cast<double>(s.scale) / kOctave);
  double* const h = curvature->data();
  for (std::size_t c = from; c <= to; ++c) {
    const std::array<double, 9>& a = motion_[c];
    if (a[8] == 0.0 && a[0] == 0.0) continue;  // no sample: x.z > 0, so that u = 0 or all are
    const double d = std::abs(static_cast<double>(difference_[c]));
    const double weight = std::ldexp(unit / (d + floor), -octaveOf(s, static_cast<std::int32_t>(c)));
    for (std::size_t i = 0; i < 9; ++i) {
      const double wa = weight * a[i];
      for (std::size_t j = 0; j < 9; ++j) h[9 * i + j] += wa * a[j];
    }
  }
}

// d y / d M = (I - y y^T) x^T / |M x|, y = M x / |M x|
Matrix3d ProjectedCosine::gradientOfPulls() const {
  Matrix3d sum = Matrix3d::Zero();
  for (std::size_t i = 0; i < cosX_.size(); ++i) {
    const Vector3d g(static_cast<double>(gx_[i]), static_cast<double>(gy_[i]), static_cast<double>(gz_[i]));
    const Vector3d y = reference_ + Vector3d(static_cast<double>(x_[i]), static_cast<double>(y_[i]),
                                             static_cast<double>(z_[i]));
    const Vector3d v = static_cast<double>(weight_[i]) / kAllWeight * invLength_[i] * (g - y.dot(g) * y);
    sum += v * Eigen::RowVector3d(cosX_[i], cosY_[i], cosZ_[i]);
  }
  return sum;
}

void ProjectedCosine::project(const ProjectedLobe& lobe, const Matrix3d& m) {
  reference_ = lobe.reference;
  if (sign_.size() < lobe.mostCells) {
    histogram_.assign(2 * lobe.mostCells, 0);
    sign_.resize(lobe.mostCells);
    difference_.resize(lobe.mostCells);
    motion_.resize(lobe.mostCells);
  }
  for (std::size_t i = 0; i < cosX_.size(); ++i) {
    const double a = m(0, 0) * cosX_[i] + m(0, 1) * cosY_[i] + m(0, 2) * cosZ_[i];
    const double b = m(1, 0) * cosX_[i] + m(1, 1) * cosY_[i] + m(1, 2) * cosZ_[i];
    const double c = m(2, 0) * cosX_[i] + m(2, 1) * cosY_[i] + m(2, 2) * cosZ_[i];
    const double inv = 1.0 / std::sqrt(a * a + b * b + c * c);
    invLength_[i] = inv;
    x_[i] = static_cast<float>(a * inv - reference_.x());
    y_[i] = static_cast<float>(b * inv - reference_.y());
    z_[i] = static_cast<float>(c * inv - reference_.z());
  }
  for (auto* v : {&gx_, &gy_, &gz_}) std::fill(v->begin(), v->end(), 0.0f);
}

double ProjectedCosine::loss(const ProjectedLobe& lobe, const Matrix3d& m, Matrix3d* gradient) {
  const std::size_t n = cosX_.size();
  project(lobe, m);
  double sum = 0.0;
  for (const ProjectedSlice& s : lobe.slices) {
    CellRange range{};
    binSlice(s, n, x_.data(), y_.data(), z_.data(), cell_.data(), part_.data(), &range);
    addToHistogram(n);
    sum += areaBetweenCdfs(lobe, s, std::min(s.first, range.first), std::max(s.last, range.last));
    if (gradient == nullptr) continue;
    pullSamples(s, n, sign_.data(), cell_.data(), gx_.data(), gy_.data(), gz_.data());
  }
  const double perSlice = 1.0 / static_cast<double>(lobe.slices.size());
  if (gradient != nullptr) *gradient = perSlice * gradientOfPulls();
  return sum * perSlice;
}

double ProjectedCosine::loss(const ProjectedLobe& lobe, const Matrix3d& m, Derivatives* derivatives) {
  const std::size_t n = cosX_.size();
  project(lobe, m);
  derivatives->curvature.setZero();
  pull_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Vector3d y = reference_ + Vector3d(static_cast<double>(x_[i]), static_cast<double>(y_[i]),
                                             static_cast<double>(z_[i]));
    const Vector3d my = m.transpose() * y;
    pull_[i] = static_cast<double>(weight_[i]) * invLength_[i] * (m.transpose() - my * y.transpose());
  }
  double sum = 0.0;
  for (const ProjectedSlice& s : lobe.slices) {
    CellRange range{};
    binSlice(s, n, x_.data(), y_.data(), z_.data(), cell_.data(), part_.data(), &range);
    addToHistogram(n);
    const std::int32_t first = std::min(s.first, range.first);
    const std::int32_t last = std::max(s.last, range.last);
    sum += areaBetweenCdfs(lobe, s, first, last);
    pullSamples(s, n, sign_.data(), cell_.data(), gx_.data(), gy_.data(), gz_.data());
    addCurvature(s, first, last, &derivatives->curvature);
  }
  const double perSlice = 1.0 / static_cast<double>(lobe.slices.size());
  const Matrix3d gradient = perSlice * m.transpose() * gradientOfPulls();
  for (Eigen::Index k = 0; k < 9; ++k) derivatives->gradient[k] = gradient(k / 3, k % 3);
  derivatives->curvature *= perSlice;
  derivatives->curvature.triangularView<Eigen::StrictlyUpper>() = derivatives->curvature.transpose().eval();
  return sum * perSlice;
}

}  // namespace ltcfit
