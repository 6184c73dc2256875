// Adaptive integration of functions of a lobe over spherical triangles. Internal to ggx/.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "ggx/lobe.h"

namespace ltcfit::internal {

/// A triangle of points; it stands for the directions that it covers seen from the origin.
struct Triangle {
  std::array<Eigen::Vector3d, 3> p;

  std::array<Triangle, 4> quarters() const {
    const Eigen::Vector3d ab = 0.5 * (p[0] + p[1]);
    const Eigen::Vector3d bc = 0.5 * (p[1] + p[2]);
    const Eigen::Vector3d ca = 0.5 * (p[2] + p[0]);
    return {{{{p[0], ab, ca}}, {{ab, p[1], bc}}, {{ca, bc, p[2]}}, {{ab, bc, ca}}}};
  }
};

struct RulePoint {
  double a, b, c, weight;  // barycentric coordinates; the weights sum to 1
};
constexpr std::size_t kRulePoints = 7;

/// Radon's rule of degree 5 on the triangle.
inline const std::array<RulePoint, kRulePoints>& radonRule() {
  static const std::array<RulePoint, kRulePoints> rule = [] {
    const double s = std::sqrt(15.0);
    const double p = (6.0 - s) / 21.0;
    const double q = (6.0 + s) / 21.0;
    const double wp = (155.0 - s) / 1200.0;
    const double wq = (155.0 + s) / 1200.0;
    return std::array<RulePoint, kRulePoints>{{{1.0 / 3, 1.0 / 3, 1.0 / 3, 9.0 / 40},
                                               {1 - 2 * p, p, p, wp},
                                               {p, 1 - 2 * p, p, wp},
                                               {p, p, 1 - 2 * p, wp},
                                               {1 - 2 * q, q, q, wq},
                                               {q, 1 - 2 * q, q, wq},
                                               {q, q, 1 - 2 * q, wq}}};
  }();
  return rule;
}

/// Integrates a vector of Integrand::kCount functions. The integrand turns a direction and the lobe's value
/// there into its vector, `Values operator()(const Vector3d& wi, double eval)`, and says by `double
/// deviation(const Values& difference)` how large a difference between two estimates of a cell is.
///
/// First a triangle is bisected, across the edge that is longest in the lobe's own coordinates, until no peak
/// can hide between the points of the rule: the cells follow ridges, which at grazing view are 1/alpha times
/// longer than wide. Then cells are split into quarters while that changes them by more than the tolerance.
template <class Integrand>
class Cubature {
 public:
  using Values = Eigen::Array<double, Integrand::kCount, 1>;

  Cubature(const Lobe& lobe, const Integrand& integrand, double cellTolerance)
      : lobe_(lobe), integrand_(integrand), cellTolerance_(cellTolerance) {}

  void add(const Triangle& triangle) {
    bisect({triangle.p, {view(triangle.p[0]), view(triangle.p[1]), view(triangle.p[2])}}, 0);
  }

  const Values& values() const { return values_; }
  /// Sum over the accepted cells of the deviation between cell and quarters, over 15: for a rule of degree 5
  /// the quarters are better by 2^6 or more where the integrand is smooth, so this leaves a margin.
  double error() const { return error_; }
  std::size_t evaluations() const { return evaluations_; }

 private:
  // Cells end up no wider than this seen from the origin (radians, about), and in the stretched coordinates.
  static constexpr double kWidestCell = 0.6;
  static constexpr double kWidestStretched = 0.9;
  // Each bisection halves the area, so after this many a cell covers 1e-24 sr, a mass of 1e-10 under the
  // sharpest lobe there is (alpha = 1e-5 at grazing view: a peak of 1e14). Reached at singular points of the
  // stretched coordinates (the mirror direction at theta = 90 degrees) and by slivers along curved ridges.
  static constexpr int kMaxBisections = 80;
  // Quarterings of a cell; not reached where the integrand is bounded.
  static constexpr int kMaxDepth = 12;

  // A vertex as seen from the origin: unit direction, and the lobe's stretched coordinates.
  struct View {
    Eigen::Vector3d w;
    Eigen::Vector4d s;
  };
  struct Cell {
    std::array<Eigen::Vector3d, 3> p;
    std::array<View, 3> view;
  };

  View view(const Eigen::Vector3d& p) const {
    const Eigen::Vector3d w = p.normalized();
    return {w, lobe_.stretched(w)};
  }

  template <std::size_t N>
  void estimate(const std::array<Triangle, N>& triangles, std::array<Values, N>& out) {
    const auto& rule = radonRule();
    constexpr std::size_t kPoints = N * kRulePoints;
    std::array<double, kPoints> x, y, z, weight, eval, pdf;
    for (std::size_t t = 0; t < N; ++t) {
      const auto& p = triangles[t].p;
      // the solid angle is det(p0, p1, p2) / |p|^3 du dv: signed by the winding
      const double det = p[0].dot(p[1].cross(p[2]));
      for (std::size_t k = 0; k < kRulePoints; ++k) {
        const Eigen::Vector3d v = rule[k].a * p[0] + rule[k].b * p[1] + rule[k].c * p[2];
        const double inv = 1.0 / v.norm();
        const std::size_t i = t * kRulePoints + k;
        x[i] = v.x() * inv;
        y[i] = v.y() * inv;
        z[i] = v.z() * inv;
        weight[i] = 0.5 * rule[k].weight * det * inv * inv * inv;
      }
    }
    lobe_.evalBatch(x, y, z, eval, pdf);
    evaluations_ += kPoints;
    for (std::size_t t = 0; t < N; ++t) {
      out[t].setZero();
      for (std::size_t i = t * kRulePoints; i < (t + 1) * kRulePoints; ++i) {
        out[t] += weight[i] * integrand_(Eigen::Vector3d(x[i], y[i], z[i]), eval[i]);
      }
    }
  }

  void bisect(const Cell& cell, int depth) {
    double longest = 0.0;
    std::size_t edge = 0;
    std::array<Eigen::Vector3d, 3> middle;
    std::array<View, 3> middleView;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      const View& a = cell.view[i];
      const View& b = cell.view[j];
      middle[i] = 0.5 * (cell.p[i] + cell.p[j]);
      middleView[i] = view(middle[i]);
      const double seen = (a.w - b.w).norm();
      // through the middle: both ends of an edge may lie on a curved ridge that the edge itself leaves
      const double stretched = (a.s - middleView[i].s).norm() + (middleView[i].s - b.s).norm();
      // where the coordinates are undefined at one end the edge counts as long, a wide one as longer
      const double length =
          std::isnan(stretched) ? 10.0 + seen : std::max(seen / kWidestCell, stretched / kWidestStretched);
      if (length > longest) {
        longest = length;
        edge = i;
      }
    }
    if (longest <= 1.0 || depth >= kMaxBisections) {
      const Triangle triangle{cell.p};
      std::array<Values, 1> whole;
      estimate<1>({triangle}, whole);
      refine(triangle, whole[0], 0);
      return;
    }
    const std::size_t next = (edge + 1) % 3;
    Cell first = cell;
    first.p[next] = middle[edge];
    first.view[next] = middleView[edge];
    bisect(first, depth + 1);
    Cell second = cell;
    second.p[edge] = middle[edge];
    second.view[edge] = middleView[edge];
    bisect(second, depth + 1);
  }

  void refine(const Triangle& triangle, const Values& whole, int depth) {
    const std::array<Triangle, 4> parts = triangle.quarters();
    std::array<Values, 4> values;
    estimate<4>(parts, values);
    const Values sum = (values[0] + values[1]) + (values[2] + values[3]);
    const double deviation = integrand_.deviation(sum - whole);
    if (deviation <= cellTolerance_ || depth >= kMaxDepth) {
      values_ += sum;
      error_ += deviation / 15.0;
      return;
    }
    for (std::size_t k = 0; k < 4; ++k) refine(parts[k], values[k], depth + 1);
  }

  const Lobe& lobe_;
  const Integrand& integrand_;
  double cellTolerance_;
  Values values_ = Values::Zero();
  double error_ = 0.0;
  std::size_t evaluations_ = 0;
};

}  // namespace ltcfit::internal
