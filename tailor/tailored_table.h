// Fits the smallest table that keeps to an error over what a scene looks up.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "export/image.h"
#include "tailor/fetch_check.h"
#include "tailor/table_designs.h"

namespace ltcfit {

struct TailorOptions {
  /// Bound of the mean LightResponse::difference between the table's look-ups, fetched and rounded as
  /// shipped, and direct fits of the same lobes; > 0.
  double maxError = 1e-3;
  std::size_t maxBytes = 0;  ///< of the textures; 0: no bound
  std::size_t checkPoints = 384;
  std::size_t maxTables = 16;  ///< fitted and measured on the way
  InterpolationModelOptions model;
};

/// One table that was fitted and measured.
struct TailorStep {
  TableDesign design;
  std::size_t bytes = 0;
  Precision precision = Precision::kHalf;
  FetchError error;
};

struct TailoredTable {
  /// The smallest one fitted that keeps to the error, else the best one; empty where none could be fitted.
  std::optional<Table> table;              ///< in float32, without the amplitudes that are not needed
  Precision precision = Precision::kHalf;  ///< that it is to be shipped in
  TailorStep step;                         ///< of that table
  bool kept = false;                       ///< within the bounds
  std::vector<TailorStep> steps;           ///< all, in the order of fitting
};

/// Which of norm and fresnel a distribution needs: fresnel is multiplied by f90 - f0, norm by f0.
std::vector<std::string> neededAmplitudes(const LobeDistribution& distribution);

/// Bytes of the textures that a table of these axes is shipped as (export/packing.h, packingLean).
std::size_t shippedBytes(const std::vector<Axis>& axes, const std::vector<std::string>& amplitudes,
                         Precision precision);

/// The table as a shader reads it: in the form that is looked up, rounded.
Table shippedTable(const Table& table, Precision precision);

/// A table of these axes, fitted, with these amplitudes; nothing where a node cannot be used.
std::optional<Table> fitAxes(const std::vector<Axis>& axes, bool isotropic,
                             const std::vector<std::string>& amplitudes,
                             const InterpolationModelOptions& options, const FitProgress& progress = {});

/// Goes along the front of the designs to a table whose measured error is within the bound while the next
/// smaller ones tried were not, then takes nodes away along single axes as long as it stays there. In halves,
/// unless these alone cost more than half of the bound. What was measured corrects what is predicted on the
/// way. All tables are measured at the same look-ups: whoever needs a figure that the choice has not seen
/// takes verifyTable.
TailoredTable tailorTable(const LobeDistribution& distribution, const TableDesigns& designs,
                          const TailorOptions& options, const FitProgress& progress = {});

}  // namespace ltcfit
