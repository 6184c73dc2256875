#include "export/json_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>

#include "export/atomic_file.h"
#include "ggx/random.h"
#include "tests/support/small_table.h"

namespace ltcfit {
namespace {

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string messageOf(const std::string& text) {
  try {
    tableFromJson(text, "T.json");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(JsonTable, ReadsBackWhatWasWritten) {
  const Table table = test::smallTable();
  const std::string text = tableToJson(table);
  const Table back = tableFromJson(text, "T.json");
  EXPECT_EQ(back.data(), table.data());
  EXPECT_EQ(back.info().channels, table.info().channels);
  EXPECT_EQ(back.info().stores, table.info().stores);
  EXPECT_EQ(back.info().normalization, table.info().normalization);
  EXPECT_EQ(back.info().alphaFloor, table.info().alphaFloor);
  for (std::size_t a = 0; a < 2; ++a) {
    EXPECT_EQ(back.info().axes[a].values, table.info().axes[a].values);
    EXPECT_EQ(back.info().axes[a].map, table.info().axes[a].map);
    EXPECT_EQ(back.info().axes[a].low, table.info().axes[a].low);
    EXPECT_EQ(back.info().axes[a].high, table.info().axes[a].high);
  }
  EXPECT_EQ(back.info().provenance.options, table.info().provenance.options);
  EXPECT_EQ(tableToJson(back), text);
}

TEST(JsonTable, WarpsAndSingleNodesSurvive) {
  TableInfo info = test::smallTable().info();
  info.axes[0] = makeAxis("theta", "rad", AxisMap::kSqrtOneMinusCos, 4, 0.1, 1.2, 0.0, {0.3, -0.125});
  info.axes[1] = singleNodeAxis("alpha", "1", 0.25);
  const Table table(info, std::vector<float>(4 * info.channels.size(), 1.0f));
  const std::string text = tableToJson(table);
  const Table back = tableFromJson(text, "T.json");
  EXPECT_EQ(back.info().axes[0].warp, info.axes[0].warp);
  EXPECT_EQ(back.info().axes[0].values, info.axes[0].values);
  EXPECT_EQ(back.info().axes[1].values, info.axes[1].values);
  EXPECT_EQ(tableToJson(back), text);
  EXPECT_EQ(messageOf(replaced(text, "[0.3,-0.125]", "[0.3]")), "T.json: axes[0].warp needs two numbers");
}

TEST(JsonTable, EveryFloatSurvives) {
  // random bit patterns: all exponents, subnormals included
  Random random(1);
  TableInfo info = test::smallTable().info();
  std::vector<float> data;
  while (data.size() < 84) {
    const auto bits = static_cast<std::uint32_t>(random.uniform() * 4294967296.0);
    float f = 0.0f;
    std::memcpy(&f, &bits, sizeof f);
    if (std::isfinite(f)) data.push_back(f);
  }
  const Table back = tableFromJson(tableToJson(Table(info, data)), "T.json");
  EXPECT_EQ(std::memcmp(back.data().data(), data.data(), data.size() * sizeof(float)), 0);
}

TEST(JsonTable, TruncatedAtEveryLength) {
  const std::string text = tableToJson(test::smallTable());
  for (std::size_t n = 0; n + 2 < text.size(); ++n) {
    EXPECT_THROW(tableFromJson(std::string_view(text).substr(0, n), "T.json"), InputError) << n;
  }
}

TEST(JsonTable, SingleBytesChanged) {
  // whatever a flipped bit makes of it, it is a table or a message
  const std::string text = tableToJson(test::smallTable());
  Random random(2);
  for (int i = 0; i < 3000; ++i) {
    std::string damaged = text;
    const auto at = static_cast<std::size_t>(random.uniform() * static_cast<double>(text.size()));
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << static_cast<int>(random.uniform() * 8.0)));
    try {
      tableFromJson(damaged, "T.json");
    } catch (const InputError&) {
    }
  }
}

TEST(JsonTable, MessagesNameTheField) {
  const std::string good = tableToJson(test::smallTable());
  EXPECT_EQ(messageOf(good), "accepted");
  const auto expectMessage = [&](const std::string& from, const std::string& to, const std::string& part) {
    const std::string message = messageOf(replaced(good, from, to));
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_EQ(message.find("T.json: "), 0u) << message;
  };
  expectMessage("\"version\": 1", "\"version\": 2", "version 2");
  expectMessage("\"version\": 1", "\"version\": 1.5", "version 1.5");
  expectMessage("ltc-table", "png", "format");
  expectMessage("\"brdf\": \"ggx\"", "\"brdf\": \"phong\"", "phong");
  expectMessage("\"brdf\": \"ggx\"", "\"brdf\": 3", "brdf is not a string");
  expectMessage("\"channels\": [", "\"channels\": [1,", "channels[0] is not a string");
  expectMessage("\"m00\"", "\"m77\"", "m77");
  expectMessage("\"stores\":\"M\"", "\"stores\":\"Q\"", "matrix.stores");
  expectMessage("\"normalization\":\"third-column-unit\"", "\"normalization\":\"x\"", "matrix.normalization");
  expectMessage("\"map\":\"sqrt\"", "\"map\":\"cubic\"", "cubic");
  expectMessage("\"range\":[", "\"range\":[0,", "range");
  expectMessage("\"values\":[", "\"values\":[\"a\",", "axes[0].values[0] is not a number");
  expectMessage("0.1,", "NaN,", "not valid JSON");
  expectMessage("0.1,", "1e60,", "data[0] = 1e+60");
  expectMessage("0.1,", "1e999,", "T.json");
  expectMessage("0.1,", "true,", "data[0] is not a number");
  expectMessage("0.1,", "0.1, 0.1,", "85 numbers");
  expectMessage("\"data\"", "\"dada\"", "data is missing");
  expectMessage("\"seed\":7", "\"seed\":\"x\"", "provenance.seed");
  expectMessage("\"matrix\": {", "\"matrix\": 3, \"m\": {", "matrix");
  EXPECT_NE(messageOf("[1, 2]").find("not an object"), std::string::npos);
  EXPECT_NE(messageOf("").find("not valid JSON"), std::string::npos);
}

TEST(JsonTable, DeepNestingIsOnlyAMessage) {
  EXPECT_THROW(tableFromJson(std::string(200000, '[') + std::string(200000, ']'), "T.json"), InputError);
}

}  // namespace
}  // namespace ltcfit
