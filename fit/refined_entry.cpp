#include "fit/refined_entry.h"

#include <Eigen/LU>
#include <cmath>

namespace ltcfit {

using Eigen::Matrix3d;

namespace {

using Change = RefinedEntry::Change;
using Factor = Change::Factor;

// Positive, 1 + x near 0 and about 2 x far above: entries of needles may grow to their neighbours' size.
double positive(double x) {
  return x >= 0.0 ? x + std::hypot(1.0, x) : 1.0 / (std::hypot(1.0, x) - x);
}
double positiveSlope(double x) {
  return positive(x) / std::hypot(1.0, x);
}

std::vector<Change> changesOf(MatrixFamily family) {
  const Change x{Factor::kDiagonal, 0, 0};
  const Change y{Factor::kDiagonal, 1, 1};
  switch (family) {
    case MatrixFamily::kGeneral:
      return {x,
              y,
              {Factor::kUpper, 0, 1},
              {Factor::kLower, 1, 0},
              {Factor::kUpper, 0, 2},
              {Factor::kUpper, 1, 2},
              {Factor::kLower, 2, 0},
              {Factor::kLower, 2, 1}};
    case MatrixFamily::kMirrorY:
      return {x, y, {Factor::kUpper, 0, 2}, {Factor::kLower, 2, 0}};
    case MatrixFamily::kMirrorX:
      return {x, y, {Factor::kUpper, 1, 2}, {Factor::kLower, 2, 1}};
    case MatrixFamily::kMirrorXY:
      return {x, y};
    case MatrixFamily::kRotational:
      break;
  }
  return {{Factor::kDiagonal, 0, 1}};
}

// To the length, or the element, that the normalization makes 1, and its derivative.
Matrix3d normalizedDerivative(const Matrix3d& m, const Matrix3d& dm, MatrixNormalization normalization) {
  switch (normalization) {
    case MatrixNormalization::kThirdColumnUnit: {
      const double length = m.col(2).norm();
      const Eigen::Vector3d unit = m.col(2) / length;
      return (dm - m * (unit.dot(dm.col(2)) / length)) / length;
    }
    case MatrixNormalization::kMiddleElement:
      return (dm - m * (dm(1, 1) / m(1, 1))) / m(1, 1);
    case MatrixNormalization::kNone:
      break;
  }
  return dm;
}

}  // namespace

RefinedEntry::RefinedEntry(const Matrix3d& m, MatrixFamily family, StoredForm form)
    : base_(m), family_(family), form_(form), changes_(changesOf(family)) {
  if (form.normalization == MatrixNormalization::kNone) changes_.push_back({Factor::kScale, 0, 0});
  parameters_.assign(changes_.size(), 0.0);
  derivatives_.resize(changes_.size());
  update();
}

void RefinedEntry::update() {
  Matrix3d lower = Matrix3d::Identity();
  Matrix3d diagonal = Matrix3d::Identity();
  Matrix3d upper = Matrix3d::Identity();
  double scale = 1.0;
  for (std::size_t k = 0; k < changes_.size(); ++k) {
    const Change& c = changes_[k];
    const double p = parameters_[k];
    switch (c.factor) {
      case Factor::kLower:
        lower(c.row, c.column) = p;
        break;
      case Factor::kUpper:
        upper(c.row, c.column) = p;
        break;
      case Factor::kDiagonal:
        diagonal(c.row, c.row) = diagonal(c.column, c.column) = positive(p);
        break;
      case Factor::kScale:
        scale = positive(p);
        break;
    }
  }
  const Matrix3d left = scale * base_ * lower;
  const Matrix3d right = diagonal * upper;
  const Matrix3d m = left * right;
  const bool inverse = form_.stores == MatrixStorage::kMinv;
  const Matrix3d raw = inverse ? Matrix3d(m.inverse()) : m;
  stored_ = normalized(raw, form_.normalization);
  for (std::size_t k = 0; k < changes_.size(); ++k) {
    const Change& c = changes_[k];
    Matrix3d unit = Matrix3d::Zero();
    unit(c.row, c.column) = 1.0;
    Matrix3d d;
    switch (c.factor) {
      case Factor::kLower:
        d = scale * base_ * unit * right;
        break;
      case Factor::kUpper:
        d = left * diagonal * unit;
        break;
      case Factor::kDiagonal:
        unit.setZero();
        unit(c.row, c.row) = unit(c.column, c.column) = positiveSlope(parameters_[k]);
        d = left * unit * upper;
        break;
      case Factor::kScale:
        d = m * (positiveSlope(parameters_[k]) / scale);
        break;
    }
    if (inverse) d = (-raw * d * raw).eval();
    derivatives_[k] = normalizedDerivative(raw, d, form_.normalization);
  }
}

}  // namespace ltcfit
