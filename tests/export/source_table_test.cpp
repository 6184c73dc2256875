// Tables in the source code that users have, whatever its language and the names in it.
#include "export/source_table.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "export/atomic_file.h"
#include "export/little_endian.h"
#include "export/published_table.h"
#include "tests/support/texture_2017.h"

namespace ltcfit {
namespace {

const std::vector<Image>& textures() {
  static const std::vector<Image> images = test::textures2017();
  return images;
}

const std::vector<float>& expected() {
  static const Table table = tableFrom2017(textures()[0], &textures()[1], "T");
  return table.data();
}

// Nine digits of a float32 read back to the same number.
std::string flat(std::size_t texture, const char* format = "{:.9g}") {
  std::string out;
  for (const float v : textures()[texture].values)
    out += (out.empty() ? "" : ", ") + fmt::format(fmt::runtime(format), v);
  return out;
}

std::string nested(std::size_t texture, char open, char close, bool rows = false,
                   std::size_t components = 4) {
  std::string out(1, open);
  const std::vector<float>& values = textures()[texture].values;
  for (std::size_t i = 0; i < values.size(); i += 4) {
    if (rows && i % 32 == 0) out += (i > 0 ? fmt::format("{},", close) : std::string()) + open;
    out += fmt::format("{}{:.9g}{},", open,
                       fmt::join(values.begin() + static_cast<std::ptrdiff_t>(i),
                                 values.begin() + static_cast<std::ptrdiff_t>(i + components), ","),
                       close);
  }
  return out + (rows ? std::string{close, close} : std::string(1, close));
}

std::string messageOf(const std::string& text, bool isFirstOfTwo = false) {
  try {
    const SourceContents contents = contentsOfSource(text, "T", isFirstOfTwo);
    return contents.table || !contents.textures.empty() ? "read" : "nothing in " + contents.arrays;
  } catch (const InputError& error) {
    return error.what();
  }
}

void expectRead(const std::string& text, const std::string& what) {
  try {
    const std::optional<Table> table = tableFromSource(text, "T");
    ASSERT_TRUE(table) << what;
    EXPECT_EQ(table->data(), expected()) << what;
  } catch (const InputError& error) {
    ADD_FAILURE() << what << ": " << error.what();
  }
}

TEST(SourceTable, NamesChangeNothing) {
  for (const auto& [first, second] : std::initializer_list<std::pair<std::string, std::string>>{
           {"LTC_MAT_1", "LTC_MAT_2"},
           {"g_ltc_1", "g_ltc_2"},
           {"LTC_1", "LTC_2"},
           {"ltc_mat", "ltc_amp"},
           {"ltc_mat_ggx", "ltc_mag_ggx"},
           {"tabM", "tabMagnitude"},
           {"kMinv", "kScale"},
           {"a", "b"},
           // what the names say of these is the wrong way round
           {"second2", "first1"}}) {
    const std::string one = fmt::format("const {} = [{}];\n", first, flat(0));
    const std::string two = fmt::format("const {} = [{}];\n", second, flat(1));
    expectRead(one + two, first);
    expectRead(two + one, first + " after the other");
    expectRead("const other = [1, 2, 3, 4];\n" + one + two + "const size = [8, 8];\n",
               first + " among others");
  }
}

TEST(SourceTable, LanguagesChangeNothing) {
  const auto both = [](const std::string& form, auto text) {
    return fmt::format(fmt::runtime(form), 1, text(0)) + "\n" + fmt::format(fmt::runtime(form), 2, text(1)) +
           "\n";
  };
  const auto list = [](std::size_t t) { return flat(t); };
  for (const char* form :
       {"export const LTC_MAT_{}: number[] = [{}];", "export const LTC_MAT_{}: readonly number[] = [{}];",
        "export const LTC_MAT_{} = [{}] as const;", "const m{}: ReadonlyArray<number> = [{}];",
        "const m{}: Float32Array = new Float32Array([{}]);", "const m{} = Float32Array.of({});",
        "const m{}: Float32Array = Float32Array.of( {} )", "const m{} = Float32Array.from([{}]);",
        "m{}: list[float] = [{}]", "m{} = np.array([{}], dtype=np.float32)",
        "pub const LTC_{}: [f32; 256] = [{}];", "pub static LTC_{}: &[f32] = &[{}];", "let ltc{} = vec![{}];",
        "static readonly float[] s_Ltc{} = {{ {} }};", "float[] ltc{} = new float[256] {{ {} }};",
        "public: static constexpr float kLtc{}[256] = {{ {} }};",
        "constexpr std::array<float, 256> kLtc{} = {{{{ {} }}}};", "float ltc{}[8 * 8 * 4] = {{ {} }};"}) {
    expectRead(both(form, list), form);
  }
  expectRead(
      both("pub const LTC_{}: [f32; 256] = [{}];", [](std::size_t t) { return flat(t, "{:.9e}_f32"); }),
      "suffixes of Rust");
  expectRead(both("const float ltc{}[] = {{{}}};", [](std::size_t t) { return flat(t, "{:.9e}f"); }),
             "suffixes of C");
  expectRead(
      both("pub const LTC_{}: [[f32; 4]; 64] = {};", [](std::size_t t) { return nested(t, '[', ']'); }),
      "nested in Rust");
  expectRead(
      both("const float ltc{}[8][8][4] = {};", [](std::size_t t) { return nested(t, '{', '}', true); }),
      "nested in C");
  expectRead(fmt::format("export default {{ mat: [{}], amp: [{}] }};", flat(0), flat(1)), "members");
  // EEVEE's arrays: two components, and one array more
  expectRead(
      fmt::format("const float ltc_mat_ggx[8][8][4] = {};\nconst float ltc_mag_ggx[8][8][2] = {};\n"
                  "const float ltc_disk_integral[8][8][1] = {};",
                  nested(0, '{', '}', true), nested(1, '{', '}', true, 2), nested(1, '{', '}', true, 1)),
      "EEVEE");
}

TEST(SourceTable, TablesOfTwoSidesByTheirShape) {
  const std::string four = "[[[1,0,2,4],[1,0,2,4],[1,0,2,4]],[[1,0,2,4],[1,0,2,4],[1,0,2,4]]]";
  const std::string two = "[[[1,0.2],[1,0.2],[1,0.2]],[[1,0.2],[1,0.2],[1,0.2]]]";
  const std::optional<Table> table = tableFromSource("a = " + four + "\nb = " + two, "T");
  ASSERT_TRUE(table);
  EXPECT_EQ(table->info().axes[0].size(), 2u);
  EXPECT_EQ(table->info().axes[1].size(), 3u);
}

TEST(SourceTable, BitsOfHalves) {
  std::string decimal;
  std::string hexadecimal;
  std::vector<Image> halves = textures();
  for (std::size_t t = 0; t < 2; ++t) {
    std::vector<std::uint16_t> bits;
    for (float& v : halves[t].values) {
      bits.push_back(halfBits(v));
      v = halfValue(bits.back());
    }
    decimal += fmt::format("const LTC_{} = new Uint16Array([{}]);\n", t + 1, fmt::join(bits, ","));
    hexadecimal +=
        fmt::format("static ushort[] s_ltc{} = new ushort[] {{ {:#06x} }};\n", t + 1, fmt::join(bits, ", "));
  }
  const std::vector<float> rounded = tableFrom2017(halves[0], &halves[1], "T").data();
  EXPECT_NE(rounded, expected());
  for (const std::string& text : {decimal, hexadecimal}) {
    const std::optional<Table> table = tableFromSource(text, "T");
    ASSERT_TRUE(table);
    EXPECT_EQ(table->data(), rounded);
  }
}

TEST(SourceTable, FourAndMoreDimensionsAreThe2022Layout) {
  std::string matrix = "[[1,0,0],[0,1,0],[0,0,1]]";
  const auto twice = [](const std::string& s) { return "[" + s + "," + s + "]"; };
  for (const char* const text : {"pub const M: [[[[[[f32; 3]; 3]; 2]; 2]; 2]; 2] = {};", "{{\"M\": {}}}"}) {
    const std::optional<Table> table =
        tableFromSource(fmt::format(fmt::runtime(text), twice(twice(twice(twice(matrix))))), "T");
    ASSERT_TRUE(table) << text;
    EXPECT_EQ(table->nodeCount(), 16u);
    EXPECT_FALSE(table->isIsotropic());
  }
}

TEST(SourceTable, MessagesListTheArraysFound) {
  const std::string one = flat(0);
  const std::string two = flat(1);
  const auto expectMessage = [](const std::string& text, const std::string& part) {
    const std::string message = messageOf(text);
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  // two tables of equal right
  expectMessage(
      fmt::format("a = [{}]; b = [{}]; c = [{}]; d = [{}];", one, two, one, two),
      "several arrays can be a table's; leave those of one: a (256 numbers), b (256), c (256), d (256)");
  // names settle it
  EXPECT_EQ(messageOf(fmt::format("a = [{}]; b = [{}]; LTC_1 = [{}]; LTC_2 = [{}];", one, two, one, two)),
            "read");
  expectMessage(
      fmt::format("g_ltc_1 = [{}]; sizes = [1, 2];", one),
      "g_ltc_1 without the array of norm and Fresnel: cut off, or in another file (--second)? Arrays found: "
      "g_ltc_1 (256 numbers), sizes (2)");
  expectMessage("x = [1, 2, 3]; y = [5];", "nothing in x (3 numbers), y (1)");
  EXPECT_EQ(messageOf(fmt::format("x = [{}];", one), true), "read");
  EXPECT_EQ(messageOf(fmt::format("ushort[] s_LtcMatrixData_BRDF_GGX = {{ {} }};", one)), "read");
  // a number that is none is told by its texel
  std::string broken = one;
  broken.replace(broken.rfind(", ") + 2, std::string::npos, "nan");
  expectMessage(fmt::format("LTC_1 = [{}]; LTC_2 = [{}];", broken, two),
                "LTC_1: cut off, or something in it is no number: 'nan]; LTC_2 ' behind 255 numbers (of 4 a "
                "texel: texel "
                "63, component 3)");
}

TEST(SourceTable, TooManyCandidatesAreRefusedSoon) {
  std::string text;
  for (int i = 0; i < 100; ++i) text += fmt::format("m{} = [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1];\n", i);
  EXPECT_NE(messageOf(text).find("more than 32 arrays of 16 numbers"), std::string::npos) << messageOf(text);
}

TEST(SourceTable, AmplitudesOfAnotherFile) {
  EXPECT_EQ(amplitudesOfSource(fmt::format("var g_ltc_2 = [{}];", flat(1)), textures()[0], "T").values,
            textures()[1].values);
  EXPECT_THROW(amplitudesOfSource("var g_ltc_2 = [1, 2, 3, 4];", textures()[0], "T"), InputError);
  EXPECT_THROW(amplitudesOfSource(fmt::format("a = [{}]; b = [{}];", flat(1), flat(1)), textures()[0], "T"),
               InputError);
}

}  // namespace
}  // namespace ltcfit
