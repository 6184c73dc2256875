#include "export/npy.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "export/atomic_file.h"
#include "export/little_endian.h"

namespace ltcfit {
namespace {

// A header, and behind it any bytes.
std::string npy(const std::string& dictionary, const std::string& data) {
  std::string header = dictionary;
  header.resize((header.size() + 10 + 64) / 64 * 64 - 10 - 1, ' ');
  header += '\n';
  std::string out("\x93NUMPY\x01\x00", 8);
  out += static_cast<char>(header.size() & 0xFF);
  out += static_cast<char>(header.size() >> 8);
  out += header;
  return out + data;
}

std::string npy(const std::string& dictionary, std::size_t floats) {
  std::string data;
  for (std::size_t i = 0; i < floats; ++i)
    append(data, std::bit_cast<std::uint32_t>(0.5f + 0.001f * static_cast<float>(i)));
  return npy(dictionary, data);
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
        "{'descr': '<i4', 'fortran_order': False, 'shape': (2, 3, 4), }",
        "{'descr': '<f16', 'fortran_order': False, 'shape': (2, 3), }",
        "{'descr': '<c8', 'fortran_order': False, 'shape': (2, 3, 2), }",
        "{'descr': [('a', '<f4')], 'fortran_order': False, 'shape': (2, 3, 4), }",
        "{'fortran_order': False, 'shape': (2, 3, 4), }", "{'descr': '<f4', 'shape': (2, 3, 4), }",
        "{'descr': '<f4', 'fortran_order': True, 'shape': (2, 3, 5), }",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3, 5), }",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (0, 3, 4), }",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (4294967296, 4294967296, 4), }",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (-2, 3, 4), }",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3, 4",
        "{'descr': '<f4', 'fortran_order': False, }"}) {
    EXPECT_THROW(parseNpy(npy(header, 24), "a"), InputError) << header;
  }
}

// The numbers 0, 0.25, 0.5, .. of an array of 2 x 3 x 4 in C order, in every type and order that NumPy
// writes.
TEST(Npy, NumberTypesAndOrders) {
  std::vector<float> expected;
  for (int i = 0; i < 24; ++i) expected.push_back(0.25f * static_cast<float>(i));
  for (const bool fortran : {false, true}) {
    for (const char* const type : {"<f2", ">f2", "<f4", ">f4", "<f8", ">f8"}) {
      std::string data;
      for (std::size_t place = 0; place < 24; ++place) {
        // Fortran's first index is the fastest
        const std::size_t i = fortran ? place % 2 * 12 + place / 2 % 3 * 4 + place / 6 : place;
        std::string number;
        if (type[2] == '2') append(number, halfBits(expected[i]));
        if (type[2] == '4') append(number, std::bit_cast<std::uint32_t>(expected[i]));
        if (type[2] == '8') append(number, std::bit_cast<std::uint64_t>(static_cast<double>(expected[i])));
        if (type[0] == '>') std::reverse(number.begin(), number.end());
        data += number;
      }
      const std::string bytes =
          npy(fmt::format("{{'descr': '{}', 'fortran_order': {}, 'shape': (2, 3, 4), }}", type,
                          fortran ? "True" : "False"),
              data);
      const FloatArray array = parseNpy(bytes, "a");
      EXPECT_EQ(array.shape, (std::vector<std::size_t>{2, 3, 4})) << type;
      EXPECT_EQ(array.values, expected) << type << fortran;
      for (std::size_t n = 0; n < bytes.size(); ++n)
        EXPECT_THROW(parseNpy(bytes.substr(0, n), "a"), InputError) << type << n;
      for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
        std::string flipped = bytes;
        flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
        try {
          EXPECT_EQ(parseNpy(flipped, "a").values.size(), 24u);
        } catch (const InputError&) {
        }
      }
    }
  }
}

TEST(Npy, DoublesAreRoundedOrRefused) {
  const auto read = [](double value) {
    std::string data;
    for (const double v : {1.0, 2.0, value, 4.0}) append(data, std::bit_cast<std::uint64_t>(v));
    return parseNpy(npy("{'descr': '<f8', 'fortran_order': False, 'shape': (2, 2), }", data), "a").values[2];
  };
  EXPECT_EQ(read(1.0 + 1e-9), 1.0f);
  EXPECT_EQ(read(0.1), 0.1f);
  EXPECT_EQ(read(1e-300), 0.0f);
  EXPECT_TRUE(std::isnan(read(std::nan(""))));
  try {
    read(-1e300);
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "a: number [1, 0] = -1e+300 does not fit a float32");
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
