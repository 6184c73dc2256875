// Shaders small enough to be counted by hand.
#include "render/shader_cost.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace ltcfit {
namespace {

ShaderCost cost(const std::string& body) {
  return shaderCost(
      "#version 450\n"
      "uniform sampler2D table;\nuniform mat3 m;\nuniform int n;\nin vec4 a;\nin vec4 b;\nout vec4 colour;\n"
      "vec3 twice(vec3 v) { return v + v; }\n"
      "void main() { " +
      body + " }\n");
}

using Special = std::map<std::string, int>;

TEST(ShaderCost, NothingCostsNothing) {
  EXPECT_EQ(cost("colour = a;").total(), 0);
}

TEST(ShaderCost, CountsFetches) {
  const ShaderCost c = cost("colour = textureLod(table, a.xy, 0.0);");
  EXPECT_EQ(c.fetches, 1);
  EXPECT_EQ(c.total(), 1);
  EXPECT_EQ(cost("colour = texture(table, a.xy) + texelFetch(table, ivec2(3), 0);").fetches, 2);
}

TEST(ShaderCost, CountsScalarsOfVectors) {
  EXPECT_EQ(cost("colour = vec4(a.x + b.x);").arithmetic, 1);
  EXPECT_EQ(cost("colour = a * b;").arithmetic, 4);
  EXPECT_EQ(cost("colour = vec4(a.xyz + b.xyz, 1.0);").arithmetic, 3);
  EXPECT_EQ(cost("colour = vec4(dot(a.xyz, b.xyz));").arithmetic, 3);
  EXPECT_EQ(cost("colour = vec4(m * a.xyz, 1.0);").arithmetic, 9);
  EXPECT_EQ(cost("colour = vec4(cross(a.xyz, b.xyz), 1.0);").arithmetic, 6);
  EXPECT_EQ(cost("colour = mix(a, b, 0.25);").arithmetic, 8);
  EXPECT_EQ(cost("colour = -abs(a);").total(), 0);
}

TEST(ShaderCost, CountsUnsignedComparisonsAndDerivatives) {
  // two comparisons and a product; truth becomes 0 or 1 by a select
  const ShaderCost c =
      cost("uint u = uint(n); uint w = uint(2 * n); colour = vec4(u > w, u <= w, 0.0, 0.0);");
  EXPECT_EQ(c.arithmetic, 3);
  EXPECT_EQ(c.selects, 2);
  EXPECT_EQ(c.total(), 5);
  EXPECT_EQ(cost("colour = vec4(dFdx(a.x), dFdy(a.xy), 0.0);").total(), 3);
  EXPECT_EQ(cost("colour = vec4(fwidth(a.xy), 0.0, 0.0);").total(), 6);
  EXPECT_EQ(cost("colour = vec4(-n);").total(), 1);  // a conversion
  const ShaderCost rest = cost("colour = vec4(float(uint(n) % 7u), float(n % 5), mod(a.x, b.x), 0.0);");
  EXPECT_EQ(rest.special, (Special{{"division", 3}}));
  EXPECT_EQ(rest.arithmetic, 2);  // conversions
}

TEST(ShaderCost, NamesWhatItCannotCount) {
  try {
    cost("colour = vec4(bitCount(n));");
    FAIL() << "counted";
  } catch (const std::runtime_error& e) {
    EXPECT_STREQ(e.what(), "no cost is known of OpBitCount of SPIR-V");
  }
}

TEST(ShaderCost, FusesProductsThatAreUsedOnce) {
  EXPECT_EQ(cost("colour = a * b + a;").arithmetic, 4);
  EXPECT_EQ(cost("colour = vec4(a.x * a.y + b.x * b.y);").arithmetic, 2);
  // the product is needed by itself
  EXPECT_EQ(cost("float p = a.x * b.x; colour = vec4(p + a.y, p, p, p);").arithmetic, 2);
}

TEST(ShaderCost, NamesSpecialFunctions) {
  const ShaderCost c = cost("colour = vec4(sqrt(a.x), atan(a.y, b.y), inversesqrt(a.z), a.w / b.w);");
  EXPECT_EQ(c.special, (Special{{"atan2", 1}, {"division", 1}, {"inversesqrt", 1}, {"sqrt", 1}}));
  EXPECT_EQ(c.arithmetic, 0);
  EXPECT_EQ(c.total(), 4);
  EXPECT_EQ(c.expanded(), 1 + 25 + 1 + 2);
  const ShaderCost l = cost("colour = vec4(length(a.xyz));");
  EXPECT_EQ(l.special, (Special{{"sqrt", 1}}));
  EXPECT_EQ(l.arithmetic, 3);
  EXPECT_EQ(cost("colour = vec4(textureSize(table, 0), 0.0, 0.0);").special, (Special{{"textureSize", 1}}));
}

TEST(ShaderCost, CountsOnlyWhatIsNeeded) {
  EXPECT_EQ(cost("vec4 unused = a * b + textureLod(table, a.xy, 0.0); colour = a;").total(), 0);
  EXPECT_EQ(cost("colour = vec4(twice(a.xyz), 1.0);").total(), 3);
  // once for both
  EXPECT_EQ(cost("colour = vec4(twice(a.xyz).x, twice(a.xyz).y, 0.0, 0.0);").total(), 3);
}

TEST(ShaderCost, UnrollsLoopsOfConstantLength) {
  EXPECT_EQ(cost("float s = a.x; for (int i = 0; i < 5; ++i) s = s * b.x + a.y; colour = vec4(s);").total(),
            5);
  // an array is registers then
  EXPECT_EQ(
      cost("float v[3]; for (int i = 0; i < 3; ++i) v[i] = sqrt(a[i]); colour = vec4(v[0] + v[2]);").total(),
      3);
  const ShaderCost open =
      cost("float s = a.x; for (int i = 0; i < n; ++i) s = s * b.x + a.y; colour = vec4(s);");
  EXPECT_EQ(open.branches, 1);
  // the body once, the counter's increment and its test
  EXPECT_EQ(open.arithmetic, 3);
}

TEST(ShaderCost, CountsBranchesAndSelects) {
  const ShaderCost branch =
      cost("if (a.x > 0.0) colour = textureLod(table, a.xy, 0.0); else colour = b * b;");
  EXPECT_EQ(branch.branches, 1);
  // both sides
  EXPECT_EQ(branch.fetches, 1);
  EXPECT_EQ(branch.arithmetic, 5);
  const ShaderCost select = cost("float p = a.y; float q = b.y; colour = vec4(a.x > 0.0 ? p : q);");
  EXPECT_EQ(select.selects, 1);
  EXPECT_EQ(select.branches, 0);
  EXPECT_EQ(select.arithmetic, 1);
}

TEST(ShaderCost, SaysWhatDoesNotCompile) {
  try {
    cost("colour = nothing;");
    FAIL() << "compiled";
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("nothing"), std::string::npos) << e.what();
  }
  EXPECT_THROW(shaderCost("#version 450\nvoid other() {}\n"), std::runtime_error);
  EXPECT_THROW(shaderCost(""), std::runtime_error);
}

}  // namespace
}  // namespace ltcfit
