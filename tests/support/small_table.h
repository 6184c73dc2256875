// A small table with odd numbers in it, for readers and writers.
#pragma once

#include <numbers>
#include <vector>

#include "ltc/table.h"

namespace ltcfit::test {

inline Table smallTable() {
  TableInfo info;
  info.axes = {makeAxis("theta", "rad", AxisMap::kSqrtOneMinusCos, 3, 0.0, 0.5 * std::numbers::pi),
               makeAxis("alpha", "1", AxisMap::kSqrt, 4, 0.0, 1.0, 1e-4)};
  info.stores = MatrixStorage::kM;
  info.normalization = MatrixNormalization::kThirdColumnUnit;
  info.channels = {"m00", "m02", "m11", "m20", "m22", "norm", "fresnel"};
  info.alphaFloor = 1e-4;
  info.provenance = {
      "ltcfit",
      "1.2.3",
      "ltcfit fit iso --size 3x4",
      7,
      {{"size", std::string("3x4")}, {"samples", std::int64_t{1024}}, {"alpha_floor", 1e-4}, {"flag", true}}};
  std::vector<float> data;
  for (int i = 0; i < 12; ++i) {
    const float v = static_cast<float>(i);
    data.insert(data.end(), {0.1f + 0.37f * v, -1.0f / (v + 3.0f), 0.2f + 0.1f * v, 1e-7f * v, 0.9f,
                             0.999f - 0.01f * v, 1.17549435e-38f * v});
  }
  return Table(info, data);
}

}  // namespace ltcfit::test
