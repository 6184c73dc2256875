#include "export/published_table.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>

#include "export/atomic_file.h"
#include "export/read_table.h"
#include "ggx/random.h"

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

std::string dds(std::uint32_t width, std::uint32_t height, std::size_t halves) {
  std::string out("DDS ", 4);
  out.resize(128, '\0');
  const auto put = [&](std::size_t at, std::uint32_t v) { std::memcpy(out.data() + at, &v, 4); };
  put(4, 124);
  put(12, height);
  put(16, width);
  put(84, 113);
  for (std::size_t i = 0; i < halves; ++i) out += std::string("\x00\x3C", 2);  // 1.0
  return out;
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

TEST(Dds, Reads) {
  const FloatArray a = parseDds(dds(3, 2, 24), "a.dds");
  EXPECT_EQ(a.shape, (std::vector<std::size_t>{2, 3, 4}));
  EXPECT_EQ(a.values, std::vector<float>(24, 1.0f));
}

TEST(Dds, RefusesEverythingElse) {
  const std::string good = dds(3, 2, 24);
  for (std::size_t n = 0; n < good.size(); ++n)
    EXPECT_THROW(parseDds(good.substr(0, n), "a"), InputError) << n;
  EXPECT_THROW(parseDds(dds(0xFFFFFFFF, 0xFFFFFFFF, 24), "a"), InputError);
  EXPECT_THROW(parseDds(dds(0, 2, 0), "a"), InputError);
  std::string other = good;
  other[84] = 'D';
  EXPECT_THROW(parseDds(other, "a"), InputError);
}

TEST(PublishedTable, BitFlipsAreHarmless) {
  Random random(3);
  for (const std::string& good : {goodNpy(), dds(3, 2, 24)}) {
    for (int i = 0; i < 2000; ++i) {
      std::string bad = good;
      const auto at = static_cast<std::size_t>(random.uniform() * static_cast<double>(bad.size()));
      bad[at] = static_cast<char>(bad[at] ^ (1 << static_cast<int>(8.0 * random.uniform())));
      try {
        const FloatArray a = isNpy(bad) ? parseNpy(bad, "a") : parseDds(bad, "a");
        tableFrom2017(a, &a, "a");
      } catch (const InputError&) {
      }
    }
  }
}

TEST(PublishedTable, MeaningOfThe2017Layout) {
  const FloatArray first = parseNpy(goodNpy(), "a");
  const Table table = tableFrom2017(first, &first, "a");
  const TableEntry e = table.entry(std::vector<std::size_t>{1, 2});
  const std::size_t texel = (1 * 3 + 2) * 4;
  EXPECT_FLOAT_EQ(static_cast<float>(e.mInv(0, 0)), first.values[texel]);
  EXPECT_FLOAT_EQ(static_cast<float>(e.mInv(2, 0)), first.values[texel + 1]);
  EXPECT_FLOAT_EQ(static_cast<float>(e.mInv(0, 2)), first.values[texel + 2]);
  EXPECT_FLOAT_EQ(static_cast<float>(e.mInv(2, 2)), first.values[texel + 3]);
  EXPECT_EQ(e.mInv(1, 1), 1.0);
  EXPECT_FLOAT_EQ(static_cast<float>(*e.norm), first.values[texel]);
  EXPECT_EQ(table.parameters(std::vector<std::size_t>{1, 0}).theta, 1.57);
  EXPECT_EQ(table.parameters(std::vector<std::size_t>{1, 0}).alphaX, 1e-5);
}

TEST(PublishedTable, SecondTextureAloneIsTold) {
  FloatArray second = parseNpy(goodNpy(), "a");
  for (std::size_t i = 2; i < second.values.size(); i += 4) second.values[i] = 0.0f;
  EXPECT_THROW(tableFrom2017(second, nullptr, "a"), InputError);
}

TEST(PublishedTable, TheRealOnes) {
  const std::filesystem::path folder(LTCFIT_REFERENCE_DIR);
  if (!std::filesystem::exists(folder / "ltc2017-1.npy")) {
    GTEST_SKIP() << "the published tables are not at " << folder << " (LTCFIT_REFERENCE_DIR)";
  }
  const Table npyTable = readTable(folder / "ltc2017-1.npy");
  const Table ddsTable = readTable(folder / "ltc2017-1.dds");
  EXPECT_EQ(npyTable.nodeCount(), 4096u);
  // alpha 1, normal view: nearly the cosine
  const TableEntry e = npyTable.entry(std::vector<std::size_t>{0, 63});
  EXPECT_NEAR(e.mInv(0, 0), 1.0, 1e-3);
  EXPECT_NEAR(*e.norm, 0.307, 1e-2);
  // half is float rounded
  for (std::size_t i = 0; i < npyTable.data().size(); ++i) {
    EXPECT_NEAR(ddsTable.data()[i], npyTable.data()[i], 1e-3f * std::abs(npyTable.data()[i]) + 1e-7f);
  }
  const Table aniso = readTable(folder / "kt2022-alpha-lambda-theta-phi.npy");
  EXPECT_EQ(aniso.nodeCount(), 4096u);
  EXPECT_FALSE(aniso.isIsotropic());
  EXPECT_NEAR(aniso.entry(std::vector<std::size_t>{4, 4, 4, 4}).m.col(2).norm(), 1.0, 1e-5);
}

}  // namespace
}  // namespace ltcfit
