#include "export/npy.h"

#include <gtest/gtest.h>

#include <cstring>

#include "export/atomic_file.h"

namespace ltcfit {
namespace {

std::string npy(const std::string& dictionary, std::size_t floats) {
  std::string header = dictionary;
  header.resize((header.size() + 10 + 64) / 64 * 64 - 10 - 1, ' ');
  header += '\n';
  std::string out("\x93NUMPY\x01\x00", 8);
  out += static_cast<char>(header.size() & 0xFF);
  out += static_cast<char>(header.size() >> 8);
  out += header;
  for (std::size_t i = 0; i < floats; ++i) {
    const float v = 0.5f + 0.001f * static_cast<float>(i);
    char bytes[4];
    std::memcpy(bytes, &v, 4);
    out.append(bytes, 4);
  }
  return out;
}

std::string goodNpy() {
  return npy("{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3, 4), }", 24);
}

TEST(Npy, Reads) {
  const FloatArray a = parseNpy(goodNpy(), "a.npy");
  EXPECT_EQ(a.shape, (std::vector<std::size_t>{2, 3, 4}));
  EXPECT_EQ(a.values[5], 0.5f + 0.001f * 5.0f);
  const FloatArray one =
      parseNpy(npy("{'descr': '<f4', 'fortran_order': False, 'shape': (5,), }", 5), "a.npy");
  EXPECT_EQ(one.shape, (std::vector<std::size_t>{5}));
}

TEST(Npy, RefusesEverythingElse) {
  const std::string good = goodNpy();
  for (std::size_t n = 0; n < good.size(); ++n)
    EXPECT_THROW(parseNpy(good.substr(0, n), "a"), InputError) << n;
  EXPECT_THROW(parseNpy(good + "x", "a"), InputError);
  for (const char* header :
       {"{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3, 4), }",
        "{'descr': '<f4', 'fortran_order': True, 'shape': (2, 3, 4), }",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3, 5), }",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (0, 3, 4), }",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (4294967296, 4294967296, 4), }",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (-2, 3, 4), }",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3, 4",
        "{'descr': '<f4', 'fortran_order': False, }"}) {
    EXPECT_THROW(parseNpy(npy(header, 24), "a"), InputError) << header;
  }
}

TEST(Npy, WritesWhatItReads) {
  const FloatArray array{{2, 1, 3}, {1.0f, -0.5f, 6.103515625e-5f, 65504.0f, 0.0f, 2.0f}};
  for (Precision precision : {Precision::kFloat, Precision::kHalf}) {
    const std::string bytes = arrayToNpy(array, precision);
    EXPECT_EQ(bytes.find('\n') % 64, 63u);  // the numbers are aligned
    const FloatArray back = parseNpy(bytes, "a");
    EXPECT_EQ(back.shape, array.shape);
    EXPECT_EQ(back.values, array.values);
  }
}

}  // namespace
}  // namespace ltcfit
