#include "ltc/chebyshev.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>

#include "base/angles.h"
#include "base/refusal.h"

namespace ltcfit {
namespace {

// k of v = c (1 + k alpha) / (c + k alpha). For the 64 x 64 table and 256 coefficients 1.5, 2 and 3 leave the
// same error to 2 %; for 80, 2 and 3 are better than 1.5. Against theta, cos(theta) or sqrt(1 - cos(theta))
// in the place of v, 80 coefficients leave less than half of the error.
constexpr double kLayer = 2.0;

constexpr std::size_t kCheckedNodes = 65;
constexpr double kSmallestWidth = 0.01;

// sum of c_i T_i(t)
template <class Coefficient>
double clenshaw(std::size_t count, double t, const Coefficient& c) {
  double b1 = 0.0;
  double b2 = 0.0;
  for (std::size_t i = count; i-- > 1;) {
    const double b = c(i) + 2.0 * t * b1 - b2;
    b2 = b1;
    b1 = b;
  }
  return count == 0 ? 0.0 : c(0) + t * b1 - b2;
}

// cos(acos(0)) is not 0
double cosOf(double theta) {
  return theta >= kHalfPi ? 0.0 : std::cos(theta);
}

}  // namespace

std::string_view chebyshevFunctionName(ChebyshevFunction function) {
  static constexpr std::array<std::string_view, kChebyshevFunctions> kNames{"width", "across", "turn",
                                                                            "shear", "norm",   "fresnel"};
  return kNames[static_cast<std::size_t>(function)];
}

ChebyshevPoint chebyshevPoint(double alpha, double cosTheta) {
  const double v = cosTheta * (1.0 + kLayer * alpha) / (cosTheta + kLayer * alpha);
  return {2.0 * std::sqrt(alpha) - 1.0, 2.0 * v - 1.0};
}

std::size_t ChebyshevForm::coefficients() const {
  std::size_t count = 0;
  for (const ChebyshevRows& rows : functions)
    for (const std::vector<double>& row : rows) count += row.size();
  return count;
}

double ChebyshevForm::function(ChebyshevFunction f, const ChebyshevPoint& at) const {
  const ChebyshevRows& rows = functions[static_cast<std::size_t>(f)];
  return clenshaw(rows.size(), at.s, [&](std::size_t j) {
    return clenshaw(rows[j].size(), at.x, [&](std::size_t i) { return rows[j][i]; });
  });
}

TableEntry ChebyshevForm::evaluate(const LobeParameters& parameters) const {
  const double alpha = std::clamp(parameters.alphaX, alphaFloor, 1.0);
  const double theta = std::clamp(parameters.theta, 0.0, kHalfPi);
  const double cosTheta = cosOf(theta);
  const double sinTheta = std::sin(theta);
  const ChebyshevPoint at = chebyshevPoint(alpha, cosTheta);
  const auto value = [&](ChebyshevFunction f) { return function(f, at); };

  const double width = value(ChebyshevFunction::kWidth);
  const double across = width + sinTheta * sinTheta * value(ChebyshevFunction::kAcross);
  const double turn = 2.0 * std::atan(alpha * sinTheta * value(ChebyshevFunction::kTurn));
  const double shear = sinTheta * value(ChebyshevFunction::kShear);
  // cos(theta - turn), which keeps its digits where theta is 90 degrees
  const double cosPsi = cosTheta * std::cos(turn) + sinTheta * std::sin(turn);
  const double sinPsi = sinTheta * std::cos(turn) - cosTheta * std::sin(turn);
  const Eigen::Vector3d tangent(cosPsi, 0.0, sinPsi);
  const Eigen::Vector3d normal(-sinPsi, 0.0, cosPsi);

  TableEntry entry;
  entry.m.col(0) = alpha * width * tangent + shear * normal;
  entry.m.col(1) = Eigen::Vector3d(0.0, alpha * cosPsi * across, 0.0);
  entry.m.col(2) = normal;
  entry.mInv = entry.m.inverse();
  entry.invertible = entry.mInv.allFinite() && std::abs(entry.m.determinant()) > 0.0;
  entry.norm = 1.0 - 0.5 * (at.s + 1.0) * value(ChebyshevFunction::kNorm);
  // an albedo: where it is next to nothing, what the sum is off by would make it negative
  entry.fresnel = std::max(0.0, std::pow(1.0 - cosTheta, 5) + value(ChebyshevFunction::kFresnel));
  return entry;
}

void checkChebyshev(const ChebyshevForm& form) {
  const auto fail = [](const std::string& what) { throw Refusal(what); };
  if (!(form.alphaFloor > 0.0 && form.alphaFloor < 1.0)) fail("alpha_floor is not between 0 and 1");
  for (std::size_t f = 0; f < kChebyshevFunctions; ++f) {
    const std::string name(chebyshevFunctionName(static_cast<ChebyshevFunction>(f)));
    const ChebyshevRows& rows = form.functions[f];
    if (rows.size() > kChebyshevRows)
      fail(name + ": " + std::to_string(rows.size()) + " rows, not " + std::to_string(kChebyshevRows) +
           " at most");
    for (const std::vector<double>& row : rows) {
      if (row.size() > kChebyshevColumns)
        fail(name + ": a row of " + std::to_string(row.size()) + " coefficients, not " +
             std::to_string(kChebyshevColumns) + " at most");
      if (!std::all_of(row.begin(), row.end(), [](double c) { return std::isfinite(c); }))
        fail(name + ": a coefficient is not finite");
    }
  }
  for (std::size_t i = 0; i < kCheckedNodes; ++i) {
    const double u = static_cast<double>(i) / (kCheckedNodes - 1);
    const double theta = unmapCoordinate(AxisMap::kSqrtOneMinusCos, u);
    for (std::size_t j = 0; j < kCheckedNodes; ++j) {
      const double root = static_cast<double>(j) / (kCheckedNodes - 1);
      const double alpha = std::max(root * root, form.alphaFloor);
      const TableEntry entry = form.evaluate({alpha, alpha, theta, 0.0});
      const std::string where =
          " at alpha " + std::to_string(alpha) + ", cos theta " + std::to_string(cosOf(theta));
      if (!entry.m.allFinite() || !std::isfinite(*entry.norm) || !std::isfinite(*entry.fresnel))
        fail("a lobe that is not finite" + where);
      const double cosPsi = entry.m(2, 2);
      if (!(cosPsi > 0.0)) fail("a lobe below the horizon" + where);
      const double width = entry.m(0, 0) * cosPsi - entry.m(2, 0) * entry.m(0, 2);
      if (!(width > kSmallestWidth * alpha) || !(entry.m(1, 1) > kSmallestWidth * alpha * cosPsi))
        fail("a lobe that is turned inside out, or nearly so," + where);
    }
  }
}

Table tableOfChebyshev(const ChebyshevForm& form, std::size_t n) {
  TableInfo info;
  info.axes = {makeAxis("theta", "rad", AxisMap::kSqrtOneMinusCos, n, 0.0, kHalfPi),
               makeAxis("alpha", "1", AxisMap::kSqrt, n, 0.0, 1.0)};
  info.normalization = MatrixNormalization::kThirdColumnUnit;
  info.channels = {"m00", "m02", "m11", "m20", "m22", "norm", "fresnel"};
  info.alphaFloor = form.alphaFloor;
  info.provenance = form.provenance;
  constexpr const char* kOption = "chebyshev_coefficients";
  auto& options = info.provenance.options;
  std::erase_if(options, [&](const auto& option) { return option.first == kOption; });
  options.emplace_back(kOption, static_cast<std::int64_t>(form.coefficients()));
  std::vector<float> data;
  data.reserve(n * n * info.channels.size());
  for (const double theta : info.axes[0].values) {
    for (const double alpha : info.axes[1].values) {
      const TableEntry entry = form.evaluate({alpha, alpha, theta, 0.0});
      for (const double value : {entry.m(0, 0), entry.m(0, 2), entry.m(1, 1), entry.m(2, 0), entry.m(2, 2),
                                 *entry.norm, *entry.fresnel})
        data.push_back(static_cast<float>(value));
    }
  }
  return Table(std::move(info), std::move(data));
}

}  // namespace ltcfit
