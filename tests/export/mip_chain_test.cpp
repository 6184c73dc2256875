// Chains of mip maps in every container: read back exactly, and damaged.
#include "export/mip_chain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "export/atomic_file.h"
#include "export/dds.h"
#include "export/exr.h"
#include "export/ktx2.h"
#include "ggx/random.h"

namespace ltcfit {
namespace {

using Pairs = std::vector<std::pair<std::string, std::string>>;

struct Chain {
  std::vector<Image> levels;
  Pairs texts;  // empty for DDS, which has no place for any
};

struct Container {
  std::string name;
  std::function<std::string(const Chain&)> write;
  std::function<Chain(std::string_view)> read;
};

std::vector<Container> containers() {
  const auto readKtx2 = [](std::string_view bytes) {
    Ktx2Mips file = parseKtx2Mips(bytes, "T");
    return Chain{std::move(file.levels), std::move(file.keyValues)};
  };
  return {{"dds", [](const Chain& c) { return mipsToDds(c.levels); },
           [](std::string_view bytes) {
             return Chain{parseDdsMips(bytes, "T"), {}};
           }},
          {"ktx2_plain",
           [](const Chain& c) {
             return mipsToKtx2({c.levels, c.texts}, Ktx2Compression::kNone);
           },
           readKtx2},
          {"ktx2_zstd",
           [](const Chain& c) {
             return mipsToKtx2({c.levels, c.texts}, Ktx2Compression::kZstd);
           },
           readKtx2},
          {"exr",
           [](const Chain& c) {
             return mipsToExr({c.levels, c.texts});
           },
           [](std::string_view bytes) {
             ExrMips file = parseExrMips(bytes, "T");
             return Chain{std::move(file.levels), std::move(file.attributes)};
           }}};
}

// Every value another one, and a half.
Chain chainOf(std::size_t width, std::size_t height, std::size_t count, Precision precision) {
  Image finest;
  finest.width = width;
  finest.height = height;
  finest.precision = precision;
  Chain chain{mipLevels(finest, count), {}};
  float next = 1.0f;
  for (Image& level : chain.levels) {
    level.values.resize(level.texels() * 4);
    for (float& v : level.values) v = next < 2048.0f ? next++ : next = 1.0f;
  }
  return chain;
}

void expectSame(const std::vector<Image>& found, const std::vector<Image>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t l = 0; l < found.size(); ++l) {
    EXPECT_EQ(found[l].width, expected[l].width);
    EXPECT_EQ(found[l].height, expected[l].height);
    EXPECT_EQ(found[l].precision, expected[l].precision);
    EXPECT_EQ(found[l].values, expected[l].values) << "level " << l;
  }
}

class MipChain : public testing::TestWithParam<Container> {
 protected:
  // From a block of exactly that length, so that a sanitizer sees a read beyond it.
  std::optional<Chain> read(std::string_view bytes) {
    const auto block = std::make_unique<char[]>(bytes.size());
    std::copy(bytes.begin(), bytes.end(), block.get());
    try {
      Chain chain = GetParam().read({block.get(), bytes.size()});
      EXPECT_TRUE(isMipChain(chain.levels));
      return chain;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).rfind("T: ", 0), 0u) << error.what();
    }
    return std::nullopt;
  }
};

TEST_P(MipChain, ReadsBack) {
  for (const Precision precision : {Precision::kHalf, Precision::kFloat}) {
    for (const auto& [width, height, count] :
         {std::array<std::size_t, 3>{1, 1, 1}, {8, 8, 4}, {200, 90, 8}, {1, 6, 3}}) {
      Chain chain = chainOf(width, height, count, precision);
      if (GetParam().name != "dds") chain.texts = {{"alpha", "one"}, {"beta", "{\"x\": 2}"}};
      const std::optional<Chain> back = read(GetParam().write(chain));
      ASSERT_TRUE(back);
      expectSame(back->levels, chain.levels);
      for (const auto& pair : chain.texts)
        EXPECT_NE(std::find(back->texts.begin(), back->texts.end(), pair), back->texts.end()) << pair.first;
    }
  }
}

TEST_P(MipChain, FewerLevels) {
  const Chain chain = chainOf(8, 8, 2, Precision::kHalf);
  if (GetParam().name == "exr") {
    EXPECT_THROW(GetParam().write(chain), std::invalid_argument);
    return;
  }
  const std::optional<Chain> back = read(GetParam().write(chain));
  ASSERT_TRUE(back);
  expectSame(back->levels, chain.levels);
}

TEST_P(MipChain, WhatIsNoChain) {
  const Chain good = chainOf(8, 4, 4, Precision::kHalf);
  ASSERT_NO_THROW(GetParam().write(good));
  const auto refused = [&](const auto& change) {
    Chain chain = good;
    change(chain.levels);
    EXPECT_THROW(GetParam().write(chain), std::invalid_argument);
  };
  refused([](auto& l) { l.clear(); });
  refused([](auto& l) { l[1].width = 3; });
  refused([](auto& l) { l[2].values.pop_back(); });
  refused([](auto& l) { l[3].precision = Precision::kFloat; });
  refused([](auto& l) { l.push_back(l.back()); });
  refused([](auto& l) {
    for (Image& level : l) level.components = 2;
  });
}

TEST_P(MipChain, CutOff) {
  const std::string bytes = GetParam().write(chainOf(8, 4, 4, Precision::kHalf));
  ASSERT_TRUE(read(bytes));
  for (std::size_t n = 0; n < bytes.size(); ++n)
    EXPECT_FALSE(read(std::string_view(bytes).substr(0, n))) << n;
}

TEST_P(MipChain, DamagedBitsAndAbsurdNumbers) {
  const std::string good = GetParam().write(chainOf(8, 4, 4, Precision::kHalf));
  for (std::size_t at = 0; at < good.size(); ++at) {
    for (int bit = 0; bit < 8; ++bit) {
      std::string bytes = good;
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << bit));
      read(bytes);
    }
  }
  for (std::size_t at = 0; at + 8 <= std::min<std::size_t>(good.size(), 400); ++at) {
    for (const std::uint64_t value : {std::uint64_t{0}, std::uint64_t{0x10000}, std::uint64_t{0x7fffffff},
                                      std::uint64_t{1} << 63, ~std::uint64_t{0}}) {
      for (const std::size_t size : {4, 8}) {
        std::string bytes = good;
        std::memcpy(bytes.data() + at, &value, size);
        read(bytes);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Containers, MipChain, testing::ValuesIn(containers()),
                         [](const auto& test) { return test.param.name; });

TEST(MipChains, TablesStillHaveNone) {
  const Chain chain = chainOf(8, 8, 4, Precision::kHalf);
  EXPECT_THROW(parseDds(mipsToDds(chain.levels), "T"), InputError);
  EXPECT_THROW(parseKtx2(mipsToKtx2({chain.levels, {}}, Ktx2Compression::kZstd), "T"), InputError);
  EXPECT_THROW(parseExr(mipsToExr({chain.levels, {}}), "T"), InputError);
  const std::string lines =
      channelsToExr({1, 1, Precision::kHalf, {"R", "G", "B", "A"}, {{1}, {1}, {1}, {1}}, {}});
  EXPECT_THROW(parseExrMips(lines, "T"), InputError);
}

TEST(MipChains, BlackPicturesPassTheBoundOfCompression) {
  Chain chain = chainOf(512, 512, 10, Precision::kHalf);
  for (Image& level : chain.levels) std::fill(level.values.begin(), level.values.end(), 0.0f);
  const std::string bytes = mipsToKtx2({chain.levels, {}}, Ktx2Compression::kZstd);
  EXPECT_LT(bytes.size(), 4096u);
  expectSame(parseKtx2Mips(bytes, "T").levels, chain.levels);
}

TEST(MipChains, Ktx2KeepsTheOrderOfTheSpecification) {
  const std::string bytes =
      mipsToKtx2({chainOf(8, 8, 4, Precision::kFloat).levels, {}}, Ktx2Compression::kNone);
  std::uint64_t last = bytes.size();
  for (std::size_t l = 0; l < 4; ++l) {
    std::uint64_t at = 0;
    std::memcpy(&at, bytes.data() + 80 + 24 * l, 8);
    EXPECT_LT(at, last);  // the finest level last
    EXPECT_EQ(at % 16, 0u);
    last = at;
  }
}

}  // namespace
}  // namespace ltcfit
