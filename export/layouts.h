// Layouts of tables as engines and authors have them: what the numbers of a texture mean.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "export/packing.h"

namespace ltcfit {

/// One layout of isotropic tables: x = sqrt(alpha), rows of theta.
struct TableLayout {
  std::string_view name;  ///< "2017"
  std::string_view also;  ///< another name for it, or empty
  std::string_view contents;
  Packing packing;
  AxisMap theta = AxisMap::kSqrtOneMinusCos;

  /// Whether the first texture has the matrix but for the element that it is divided by.
  bool hasWholeMatrix() const { return packing.divisor != Divisor::kThirdColumn; }
};

/// 2017, 2016 (also o3de), hdrp (also unity-hdrp), godot. Exports and readers take the packings from here.
const std::vector<TableLayout>& tableLayouts();

/// The layout of either name; nullptr for none.
const TableLayout* findLayout(std::string_view name);

}  // namespace ltcfit
