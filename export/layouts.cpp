#include "export/layouts.h"

#include <algorithm>

namespace ltcfit {

const std::vector<TableLayout>& tableLayouts() {
  static const std::vector<TableLayout> list{
      {"2017", "", "(m00, m20, m02, m22) / m11 of Minv; norm, Fresnel; rows by sqrt(1 - cos theta)",
       packing2017()},
      {"2016",
       "o3de",
       "(m22, m20, m11, m02) / m00 of Minv; norm, Fresnel; rows by theta",
       {MatrixStorage::kMinv,
        Divisor::kM00,
        {{"matrix", {"m22", "m20", "m11", "m02"}}, {"amplitude", {"norm", "fresnel"}}}},
       AxisMap::kLinear},
      {"hdrp",
       "unity-hdrp",
       "(m00, m20, m11, m02) / m22 of Minv; rows by sqrt(1 - cos theta)",
       {MatrixStorage::kMinv, Divisor::kM22, {{"matrix", {"m00", "m20", "m11", "m02"}}}}},
      {"godot",
       "",
       "M: (m00, m20, m11, m02) and (m22, norm, Fresnel); rows by theta",
       {MatrixStorage::kM,
        Divisor::kThirdColumn,
        {{"lut1", {"m00", "m20", "m11", "m02"}}, {"lut2", {"m22", "norm", "fresnel", "0"}}}},
       AxisMap::kLinear}};
  return list;
}

const TableLayout* findLayout(std::string_view name) {
  const auto& list = tableLayouts();
  const auto found = std::find_if(list.begin(), list.end(), [&](const TableLayout& layout) {
    return name == layout.name || (!layout.also.empty() && name == layout.also);
  });
  return found == list.end() ? nullptr : &*found;
}

}  // namespace ltcfit
