// How much what a renderer shows differs between two entries: the measure by which tables are tailored.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "ltc/quad.h"
#include "ltc/table.h"
#include "tailor/lobe_distribution.h"

namespace ltcfit {

/// Lights of each of the three sizes of the metrics light_s, light_m and light_l at a look-up.
inline constexpr std::size_t kResponseLights = 32;

/// Of plastic and glass.
inline constexpr double kLeastReflectance = 0.04;

/// Width below which lobes are judged by wider ones: two edges of 96 random lights hit such a lobe.
inline constexpr double kSharpWidth = 0.05;

/// The matrix and amplitudes of a look-up, in the form that a table stores and interpolates.
using StoredEntry = Eigen::Matrix<double, 11, 1>;  ///< stored matrix row by row, norm, fresnel

/// Form in which isotropic and anisotropic tables are looked up by the shaders: Minv with element (1, 1) = 1
/// (the layout of 2017), M with a third column of length 1.
MatrixStorage lookUpStorage(bool isotropic);
/// `m` is M, det != 0.
StoredEntry storedEntry(const Eigen::Matrix3d& m, double norm, double fresnel, MatrixStorage stores);
/// M of it; not finite where it has none.
Eigen::Matrix3d matrixOf(const StoredEntry& entry, MatrixStorage stores);

/// Radiance reflected from random white lights of radiance 1, drawn as the metrics light_s, light_m and
/// light_l draw theirs, kResponseLights of each size, towards one view:
///   (f0 norm + (f90 - f0) fresnel) Psi(light) r,   r = norm / (f0 norm + (f90 - f0) fresnel) of the truth,
/// Psi the integral of the LTC over the light. By r a dielectric counts as much as a metal: tables are judged
/// by how well they draw a highlight, however strong it is. What reflects less than kLeastReflectance of the
/// lobe counts as if it reflected that much.
///
/// Of lobes sharper than kSharpWidth no light's edge may come near, and of 96 lights the mean says nothing.
/// To such a lobe an edge is straight, and hits it in proportion to its width w: so the same relative change
/// P of M (I + P) is made to the lobe widened to kSharpWidth, and its mean square counts w / kSharpWidth.
class LightResponse {
 public:
  /// `truth`: the entry that `lookUp` should yield, its amplitudes exact.
  LightResponse(const LookUp& lookUp, const StoredEntry& truth, MatrixStorage stores, std::uint64_t seed);

  /// Root mean square over the lights of the difference to the truth; infinite where the entry has no
  /// inverse.
  double difference(const StoredEntry& entry) const;

  /// The same squared, for small changes of the truth: (entry - truth)^T G (entry - truth).
  Eigen::Matrix<double, 11, 11> metric() const;

  /// How far a change moves the lobe, in its own widths: entries (0, 2) and (1, 2) of P, linear in the
  /// change. Beyond one width light is lost at one place and found at another, and the squared difference
  /// grows with the way, no longer with its square.
  Eigen::Matrix<double, 2, 11> displacement() const;

 private:
  Eigen::VectorXd radiances(const StoredEntry& entry) const;
  double amplitude(const StoredEntry& entry) const;

  LookUp lookUp_;
  StoredEntry truth_;
  MatrixStorage stores_;
  std::vector<Quad> lights_;
  double scale_;              // r
  double widening_ = 1.0;     // of the lobe, 1 or more
  Eigen::Matrix3d m_;         // the truth
  Eigen::Matrix3d mInverse_;  // its inverse
  Eigen::Matrix3d widened_;
  Eigen::VectorXd exact_;
};

}  // namespace ltcfit
