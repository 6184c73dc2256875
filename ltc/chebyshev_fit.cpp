#include "ltc/chebyshev_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "base/angles.h"
#include "base/refusal.h"

namespace ltcfit {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t kTerms = kChebyshevRows * kChebyshevColumns;  // of one function
constexpr auto kUnknowns = static_cast<Eigen::Index>(kChebyshevFunctions * kTerms);
constexpr std::size_t kShapeFunctions = 4;

// Below it the fits of neighbouring nodes at grazing view scatter by more than the form's error (by 2 in
// width at 90 degrees), and a difference from one of them says nothing.
constexpr double kSharpAlpha = 0.002;

// Of squared errors of norm and Fresnel against squared shifts in units of the lobe's spread: a shift of 0.01
// changes the integral over a quad near the lobe by 0.003 on average, an error of 0.01 of norm by that of it.
constexpr double kAmplitudeWeight = 4.0;

// A term whose part that no chosen term can take is smaller than this of its square is left alone.
constexpr double kDependent = 1e-7;
// A node says six numbers; with as many coefficients the form would do what it likes between them.
constexpr std::size_t kCoefficientsPerNode = 3;
// How far from the ends of alpha and theta the outer nodes may be: published tables were clamped there.
constexpr double kEndSlack = 0.01;
// Terms of one row that may be chosen in one step: the odd ones alone may be worth nothing.
constexpr std::size_t kLookAhead = 3;

// Directions of the cosine, equally weighted: rings of equal mass, symmetric in x and y.
constexpr int kLobeRings = 12;
constexpr int kAzimuths = 16;
constexpr int kLobeDirections = kLobeRings * kAzimuths;
using Directions = Eigen::Matrix<double, 3, kLobeDirections>;

Directions cosineDirections() {
  Directions x;
  for (int i = 0; i < kLobeRings; ++i) {
    const double r2 = (i + 0.5) / kLobeRings;
    for (int j = 0; j < kAzimuths; ++j) {
      const double phi = 2.0 * std::numbers::pi * (j + 0.5) / kAzimuths;
      x.col(i * kAzimuths + j) << std::sqrt(r2) * std::cos(phi), std::sqrt(r2) * std::sin(phi),
          std::sqrt(1.0 - r2);
    }
  }
  return x;
}

Directions directionsOf(const Matrix3d& m) {
  static const Directions kCosine = cosineDirections();
  return (m * kCosine).colwise().normalized();
}

double spreadOf(const Directions& directions) {
  // the angle whose cosine is the mean's length, without the digits that acos loses near 1
  const double length = directions.rowwise().mean().norm();
  return 2.0 * std::asin(std::sqrt(std::max(0.0, 0.5 * (1.0 - length))));
}

// The lobe as the form's matrices have it: unit third column, apertures positive. M diag(+-1, +-1, 1) is the
// same lobe.
Matrix3d oriented(const TableEntry& entry, std::size_t node) {
  const auto refuse = [&](const char* what) { throw Refusal("node " + std::to_string(node) + " " + what); };
  if (!entry.invertible) refuse("has no inverse");
  Matrix3d m = normalized(entry.m, MatrixNormalization::kThirdColumnUnit);
  if (m(0, 1) != 0.0 || m(1, 0) != 0.0 || m(1, 2) != 0.0 || m(2, 1) != 0.0)
    refuse("has a matrix that mixes y with the plane of incidence");
  if (!(m(2, 2) > 0.0)) refuse("has a lobe that leans below the horizon");
  if (m(1, 1) < 0.0) m.col(1) *= -1.0;
  if (m(0, 0) * m(2, 2) - m(2, 0) * m(0, 2) < 0.0) m.col(0) *= -1.0;
  return m;
}

struct Node {
  double alpha, theta, cosTheta, weight;
  Matrix3d m;
  Eigen::Vector4d shape;  // the four functions' values
  double norm, fresnel;
};

Matrix3d matrixOf(const Eigen::Vector4d& shape, double alpha, double theta) {
  ChebyshevForm form;
  form.alphaFloor = alpha;
  for (std::size_t f = 0; f < kShapeFunctions; ++f)
    form.functions[f].push_back({shape(static_cast<Eigen::Index>(f))});
  return form.evaluate({alpha, alpha, theta, 0.0}).m;
}

Eigen::Vector4d shapeOf(const Matrix3d& m, double alpha, double theta) {
  const double cosPsi = m(2, 2);
  const double sinPsi = -m(0, 2);
  const double width = (m(0, 0) * cosPsi + m(2, 0) * sinPsi) / alpha;
  const double across = m(1, 1) / (alpha * cosPsi);
  const double sine = std::sin(theta);
  // at normal view the others have no weight
  if (sine == 0.0) return {0.5 * (width + across), 0.0, 0.0, 0.0};
  return {width, (across - width) / (sine * sine),
          std::tan(0.5 * (theta - std::atan2(sinPsi, cosPsi))) / (alpha * sine),
          (m(2, 0) * cosPsi - m(0, 0) * sinPsi) / sine};
}

// d^T G d is the mean squared distance of directions over the squared spread for small d.
Matrix4d metricOf(const Node& node) {
  constexpr double kStep = 1e-4;
  Eigen::Matrix<double, 3 * kLobeDirections, 4> jacobian;
  for (int k = 0; k < 4; ++k) {
    Eigen::Vector4d low = node.shape;
    Eigen::Vector4d high = node.shape;
    low(k) -= kStep;
    high(k) += kStep;
    const Directions change = (directionsOf(matrixOf(high, node.alpha, node.theta)) -
                               directionsOf(matrixOf(low, node.alpha, node.theta))) /
                              (2.0 * kStep);
    jacobian.col(k) = change.reshaped();
  }
  const double spread = spreadOf(directionsOf(node.m));
  return jacobian.transpose() * jacobian / (kLobeDirections * spread * spread);
}

// Half the distance between the neighbours of each node in the coordinate that is uniform for an eye.
std::vector<double> cellWidths(const Axis& axis, AxisMap map) {
  const std::size_t n = axis.size();
  std::vector<double> widths(n);
  const auto at = [&](std::size_t i) { return mapCoordinate(map, axis.values[i]); };
  for (std::size_t i = 0; i < n; ++i) widths[i] = 0.5 * (at(std::min(i + 1, n - 1)) - at(i > 0 ? i - 1 : 0));
  return widths;
}

// The values of all terms at a point, T_j(s) T_i(x) at j * kChebyshevColumns + i.
VectorXd termsAt(const ChebyshevPoint& point) {
  const auto polynomials = [](double t, std::size_t n) {
    std::vector<double> p{1.0, t};
    while (p.size() < n) p.push_back(2.0 * t * p[p.size() - 1] - p[p.size() - 2]);
    return p;
  };
  const std::vector<double> overS = polynomials(point.s, kChebyshevRows);
  const std::vector<double> overX = polynomials(point.x, kChebyshevColumns);
  VectorXd terms(kTerms);
  for (std::size_t j = 0; j < kChebyshevRows; ++j)
    for (std::size_t i = 0; i < kChebyshevColumns; ++i)
      terms(static_cast<Eigen::Index>(j * kChebyshevColumns + i)) = overS[j] * overX[i];
  return terms;
}

// Minimise c^T matrix c - 2 c^T right; kTerms unknowns for each function, in their order.
struct NormalEquations {
  MatrixXd matrix = MatrixXd::Zero(kUnknowns, kUnknowns);
  VectorXd right = VectorXd::Zero(kUnknowns);

  // sums over nodes (columns of `terms`) of weight value_a value_b and of goal value_a
  void add(Eigen::Index a, Eigen::Index b, const MatrixXd& terms, const VectorXd& weight) {
    matrix.block(a * block, b * block, block, block) += terms * weight.asDiagonal() * terms.transpose();
  }
  void addRight(Eigen::Index a, const MatrixXd& terms, const VectorXd& values) {
    right.segment(a * block, block) += terms * values;
  }
  static constexpr auto block = static_cast<Eigen::Index>(kTerms);
};

void addNodes(const std::vector<Node>& nodes, NormalEquations& equations) {
  const auto count = static_cast<Eigen::Index>(nodes.size());
  MatrixXd terms(kTerms, count);
  MatrixXd metric(16, count);
  MatrixXd goal(4, count);
  VectorXd weight(count);
  VectorXd v(count);
  VectorXd norm(count);
  VectorXd fresnel(count);
  for (Eigen::Index n = 0; n < count; ++n) {
    const Node& node = nodes[static_cast<std::size_t>(n)];
    const ChebyshevPoint point = chebyshevPoint(node.alpha, node.cosTheta);
    terms.col(n) = termsAt(point);
    const Matrix4d g = metricOf(node) * node.weight;
    metric.col(n) = g.reshaped();
    goal.col(n) = g * node.shape;
    weight(n) = kAmplitudeWeight * node.weight;
    v(n) = 0.5 * (point.s + 1.0);
    norm(n) = 1.0 - node.norm;
    fresnel(n) = node.fresnel - std::pow(1.0 - node.cosTheta, 5);
  }
  for (Eigen::Index a = 0; a < 4; ++a) {
    for (Eigen::Index b = 0; b < 4; ++b) equations.add(a, b, terms, metric.row(4 * b + a).transpose());
    equations.addRight(a, terms, goal.row(a).transpose());
  }
  equations.add(4, 4, terms, weight.cwiseProduct(v.cwiseAbs2()));
  equations.addRight(4, terms, weight.cwiseProduct(v).cwiseProduct(norm));
  equations.add(5, 5, terms, weight);
  equations.addRight(5, terms, weight.cwiseProduct(fresnel));
}

using Lengths = std::array<std::array<std::size_t, kChebyshevRows>, kChebyshevFunctions>;

// Forward selection: rows grow from their first term. Returns the terms in the order of their choice.
std::vector<Eigen::Index> chooseTerms(const NormalEquations& equations, std::size_t count) {
  MatrixXd h = equations.matrix;
  VectorXd b = equations.right;
  const VectorXd square = h.diagonal();
  Lengths lengths{};
  std::vector<Eigen::Index> chosen;
  while (chosen.size() < count) {
    double best = 0.0;
    Eigen::Index first = 0;
    Eigen::Index many = 0;
    for (std::size_t f = 0; f < kChebyshevFunctions; ++f) {
      for (std::size_t j = 0; j < kChebyshevRows; ++j) {
        const std::size_t length = lengths[f][j];
        const auto start = static_cast<Eigen::Index>(f * kTerms + j * kChebyshevColumns + length);
        const std::size_t room = std::min({kLookAhead, kChebyshevColumns - length, count - chosen.size()});
        for (Eigen::Index n = 1; n <= static_cast<Eigen::Index>(room); ++n) {
          const auto last = start + n - 1;
          if (!(h(last, last) > kDependent * square(last))) break;
          const VectorXd part = b.segment(start, n);
          const double gain =
              part.dot(h.block(start, start, n, n).ldlt().solve(part)) / static_cast<double>(n);
          if (gain > best) {
            best = gain;
            first = start;
            many = n;
          }
        }
      }
    }
    if (many == 0) break;
    for (Eigen::Index k = first; k < first + many; ++k) {
      // what is left of the others once term k is free
      const VectorXd column = h.col(k) / h(k, k);
      const double value = b(k);
      b -= column * value;
      h -= column * h.row(k).eval();
      h.row(k).setZero();
      h.col(k).setZero();
      chosen.push_back(k);
      const auto at = static_cast<std::size_t>(k);
      ++lengths[at / kTerms][at % kTerms / kChebyshevColumns];
    }
  }
  return chosen;
}

// Solves for the chosen terms and rounds each before those chosen later are solved for.
VectorXd roundedSolution(const NormalEquations& equations, const std::vector<Eigen::Index>& chosen,
                         const std::function<double(double)>& round) {
  // unknowns in reverse order of choice: substitution starts with the last, that is the first one chosen
  const std::vector<Eigen::Index> order(chosen.rbegin(), chosen.rend());
  const Eigen::LLT<MatrixXd> factors(MatrixXd(equations.matrix(order, order)));
  if (factors.info() != Eigen::Success)
    throw Refusal("the table's nodes are too few for that many coefficients");
  const MatrixXd upper = factors.matrixU();
  const VectorXd right = factors.matrixL().solve(VectorXd(equations.right(order)));
  VectorXd solution = VectorXd::Zero(kUnknowns);
  VectorXd x = VectorXd::Zero(upper.cols());
  for (Eigen::Index k = upper.cols(); k-- > 0;) {
    const Eigen::Index after = upper.cols() - k - 1;
    x(k) = (right(k) - upper.row(k).tail(after).dot(x.tail(after))) / upper(k, k);
    if (round) x(k) = round(x(k));
    solution(order[static_cast<std::size_t>(k)]) = x(k);
  }
  return solution;
}

void setRows(const VectorXd& solution, const std::vector<Eigen::Index>& chosen, ChebyshevForm& form) {
  std::vector<Eigen::Index> sorted = chosen;
  std::sort(sorted.begin(), sorted.end());
  for (const Eigen::Index k : sorted) {
    const auto at = static_cast<std::size_t>(k);
    ChebyshevRows& rows = form.functions[at / kTerms];
    rows.resize(at % kTerms / kChebyshevColumns + 1);
    rows.back().push_back(solution(k));
  }
}

Node nodeOf(const Table& table, std::size_t row, std::size_t column, double weight) {
  const std::array<std::size_t, 2> at{row, column};
  const TableEntry entry = table.entry(at);
  if (!entry.norm || !entry.fresnel) throw Refusal("the table has no norm and Fresnel");
  const LobeParameters p = table.parameters(at);
  Node node;
  node.alpha = p.alphaX;
  node.theta = p.theta;
  node.cosTheta = p.theta >= kHalfPi ? 0.0 : std::cos(p.theta);
  node.weight = weight;
  node.m = oriented(entry, table.index(at) / table.channelCount());
  node.shape = shapeOf(node.m, node.alpha, node.theta);
  node.norm = *entry.norm;
  node.fresnel = *entry.fresnel;
  return node;
}

// The nodes of one theta after the other: a table may have more of them than fit into memory as terms.
template <class Function>
void forRowsOfNodes(const Table& table, const Function& f) {
  if (!table.isIsotropic())
    throw Refusal("the Chebyshev form is for isotropic tables (axes theta, alpha); this one has four axes");
  if (!(table.info().alphaFloor > 0.0 && table.info().alphaFloor < 1.0))
    throw Refusal("the Chebyshev form needs an alpha floor between 0 and 1");
  const std::vector<double>& theta = table.info().axes[0].values;
  const std::vector<double>& alpha = table.info().axes[1].values;
  if (theta.front() > kEndSlack || theta.back() < kHalfPi - kEndSlack || alpha.front() > kEndSlack ||
      alpha.back() < 1.0 - kEndSlack)
    throw Refusal(
        "the Chebyshev form needs a table over all of alpha and theta: beyond its nodes polynomials go where "
        "they like");
  const std::vector<double> heights = cellWidths(table.info().axes[0], AxisMap::kSqrtOneMinusCos);
  const std::vector<double> widths = cellWidths(table.info().axes[1], AxisMap::kSqrt);
  for (std::size_t row = 0; row < heights.size(); ++row) {
    std::vector<Node> nodes;
    for (std::size_t column = 0; column < widths.size(); ++column)
      nodes.push_back(nodeOf(table, row, column, heights[row] * widths[column]));
    f(nodes);
  }
}

struct Mean {
  double sum = 0.0, largest = 0.0;
  std::size_t count = 0;
  void add(double value) {
    sum += value;
    largest = std::max(largest, value);
    ++count;
  }
  double mean() const { return count > 0 ? sum / static_cast<double>(count) : 0.0; }
};

}  // namespace

ChebyshevForm fitChebyshev(const Table& table, const ChebyshevOptions& options) {
  if (options.coefficients < kLeastCoefficients || options.coefficients > kMostCoefficients)
    throw Refusal(std::to_string(options.coefficients) + " coefficients: need " +
                  std::to_string(kLeastCoefficients) + " to " + std::to_string(kMostCoefficients));
  if (options.coefficients > kCoefficientsPerNode * table.nodeCount())
    throw Refusal(std::to_string(options.coefficients) + " coefficients are too many for " +
                  std::to_string(table.nodeCount()) + " nodes; " +
                  std::to_string(kCoefficientsPerNode * table.nodeCount()) + " at most");
  NormalEquations equations;
  forRowsOfNodes(table, [&](const std::vector<Node>& nodes) { addNodes(nodes, equations); });
  const std::vector<Eigen::Index> chosen = chooseTerms(equations, options.coefficients);

  ChebyshevForm form;
  form.alphaFloor = table.info().alphaFloor;
  form.provenance = table.info().provenance;
  setRows(roundedSolution(equations, chosen, options.round), chosen, form);
  try {
    checkChebyshev(form);
  } catch (const Refusal& error) {
    throw Refusal(std::string(error.what()) + " (of " + std::to_string(options.coefficients) +
                  " coefficients; another number may do)");
  }
  return form;
}

ChebyshevDifference chebyshevDifference(const ChebyshevForm& form, const Table& table) {
  Mean shift;
  Mean norm;
  Mean fresnel;
  forRowsOfNodes(table, [&](const std::vector<Node>& nodes) {
    for (const Node& node : nodes) {
      if (node.alpha < kSharpAlpha) continue;
      const TableEntry entry = form.evaluate({node.alpha, node.alpha, node.theta, 0.0});
      const Directions directions = directionsOf(node.m);
      const double distance2 = (directionsOf(entry.m) - directions).colwise().squaredNorm().mean();
      shift.add(std::sqrt(distance2) / spreadOf(directions));
      norm.add(std::abs(*entry.norm - node.norm));
      fresnel.add(std::abs(*entry.fresnel - node.fresnel));
    }
  });
  return {shift.mean(), shift.largest, norm.mean(), norm.largest, fresnel.mean(), fresnel.largest};
}

}  // namespace ltcfit
