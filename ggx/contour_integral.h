// Many light integrals of one lobe: Green's theorem in the coordinates where the lobe is smooth.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "ggx/lobe.h"
#include "ggx/polygon_integral.h"

namespace ltcfit {

struct ContourIntegratorOptions {
  int azimuths = 80;  ///< rays of the table, a multiple of 4, at least 16
  int radii = 32;     ///< cells along each, at least 4
  /// A piece of an edge is split while its integral and that of its halves differ by more than this, > 0.
  double tolerance = 1e-5;
};

/// Integrals of a lobe over polygonal lights: the same values as integrateLobeOverPolygon, for anisotropic
/// and grazing lobes too. A table is made once for each lobe, after which an integral costs some evaluations
/// along the polygon's outline and none inside.
///
/// In the stretched configuration (Lobe::atStretched), seen in stereographic projection c = s.xy / (1 + s.z),
/// every lobe is a bounded density rho on a part of the unit disk. With K(c) the integral over t in 0..1 of
/// rho(t c) t, div(K c) = rho, so that the integral over a region is that of K (x dy - y dx) along its
/// outline. K is tabulated over azimuth and over the radius up to the horizon.
class ContourIntegrator {
 public:
  /// The lobe is not kept. Options out of range are a caller's bug and abort.
  explicit ContourIntegrator(const Lobe& lobe, const ContourIntegratorOptions& options = {});

  /// As integrateLobeOverPolygon; vertices finite. `error` sums the differences between pieces of edges and
  /// their halves; the table's own error is not in it (hemisphere() tells of it; see the tests: some 1e-5).
  PolygonIntegral integrate(std::span<const Eigen::Vector3d> vertices) const;

  /// The integral over the upper hemisphere, as the table has it: compared with the albedo it shows the
  /// table's error.
  double hemisphere() const;

 private:
  struct Node {
    Eigen::Vector3d p;  // on the edge
    double x, y, k;
  };
  Node at(const Eigen::Vector3d& p) const;
  double potential(double x, double y) const;
  double piece(const Node& a, const Node& b, const Node& middle, double whole, int depth,
               PolygonIntegral& out) const;
  // Both add what lies between a node and another, or a unit vector, and return the node there.
  Node addPiece(const Node& a, const Node& b, PolygonIntegral& out) const;
  Node addEdge(const Node& start, const Eigen::Vector3d& b, PolygonIntegral& out) const;

  ContourIntegratorOptions options_;
  StretchedMap map_;
  double nothing_;             // squared length of centre + linear wi below which it is rounding
  Eigen::Vector2d axis_;       // azimuth 0
  std::vector<double> reach_;  // for each ray: radius of the horizon. Each quadrant has both its borders
  std::vector<double> k_;      // ray-major, radii + 1 each
};

}  // namespace ltcfit
