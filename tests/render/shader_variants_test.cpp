// The counts of the look-up's variants hang together.
#include "render/shader_variants.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "export/shader_lookup.h"
#include "render/shader_text.h"
#include "tests/support/tailored.h"

namespace ltcfit {
namespace {

const std::vector<ShaderVariantCost>& costs() {
  static const std::vector<ShaderVariantCost> all = costsOf(shaderVariants());
  return all;
}

const ShaderCost& costOf(const std::string& name) {
  const auto found =
      std::find_if(costs().begin(), costs().end(), [&](const auto& c) { return c.variant.name == name; });
  if (found == costs().end()) throw std::runtime_error(name);
  return found->cost;
}

TEST(ShaderVariants, FetchWhatTheyNeed) {
  for (const auto& [variant, cost] : costs()) {
    const int lookup = variant.name.starts_with("isotropic") ? 2 : 6;
    const int sphere = variant.name.ends_with("by table") ? 1 : 0;
    EXPECT_EQ(cost.fetches, lookup + sphere) << variant.name;
    // the isotropic look-up needs no angles, and no integral does
    EXPECT_EQ(cost.special.count("atan2"), variant.name.starts_with("isotropic") ? 0 : 1) << variant.name;
    EXPECT_FALSE(variant.purpose.empty());
  }
}

TEST(ShaderVariants, FullReflectanceCarriesNoFresnel) {
  const ShaderCost fresnel = shaderCost("#version 450\n" + std::string(shaderText("ltc.glsl")) +
                                        "in float norm; in float fresnel; in vec3 f0; out vec3 colour;\n"
                                        "void main() { LtcEntry e; e.norm = norm; e.fresnel = fresnel;\n"
                                        "colour = ltcFresnel(e, f0, vec3(1.0)); }\n");
  EXPECT_EQ(fresnel.total(), 9);  // f90 - f0, two products, of which the sum takes one in
  for (const std::string lookup : {"isotropic", "anisotropic"}) {
    for (const std::string light : {"quad", "polygon of 5", "proxy sphere"}) {
      const ShaderCost& with = costOf(lookup + ", Fresnel, " + light);
      const ShaderCost& without = costOf(lookup + ", F0 = 1, " + light);
      EXPECT_EQ(with.total() - without.total(), fresnel.total()) << lookup << light;
      EXPECT_EQ(with.fetches, without.fetches);
    }
  }
}

TEST(ShaderVariants, ClippingCostsWhatItIsTakenFor) {
  const int quad = costOf("isotropic, F0 = 1, quad").total();
  const int above = costOf("isotropic, F0 = 1, quad above horizon").total();
  const int sphere = costOf("isotropic, F0 = 1, proxy sphere").total();
  EXPECT_LT(above, sphere);
  EXPECT_LT(sphere, quad);
  // that of ltcFrame: edges have no cases
  EXPECT_EQ(costOf("isotropic, F0 = 1, quad above horizon").branches, 1);
}

TEST(ShaderVariants, ATablesOwnLookUpCostsLess) {
  for (const test::Tailored& t : test::tailoredTables()) {
    const std::vector<ShaderVariantCost> own = costsOf(lookupVariants(t.table.info()));
    const ShaderCost& general = own[0].cost;
    const ShaderCost& alone = own[1].cost;
    std::printf("  %-16s %d fetches, %d operations (%d expanded); of ltc.glsl %d, %d (%d)\n", t.name.c_str(),
                alone.fetches, alone.total() - alone.fetches, alone.expanded(), general.fetches,
                general.total() - general.fetches, general.expanded());
    EXPECT_EQ(alone.fetches, fetchesOf(t.table.info())) << t.name;
    // of angles evenly spaced an isotropic look-up takes an atan, which ltcFetch has not
    if (t.name != "isoLinear") {
      EXPECT_LT(alone.expanded(), general.expanded()) << t.name;
    }
    EXPECT_EQ(lookupCost(t.table.info()).total(), alone.total());
    EXPECT_EQ(alone.special.count("textureSize"), 0u) << t.name;
    EXPECT_EQ(own.size(), amplitudesOf(t.table.info()).size() == 2 ? 4u : 3u) << t.name;
  }
  // no arithmetic but the mirrors and the inverse, and no angle
  const ShaderCost theta = lookupCost(test::tailoredTable("anisoTheta").info());
  EXPECT_EQ(theta.special.count("atan2"), 0u);
  // one row of one node: nothing at all
  EXPECT_EQ(lookupCost(test::tailoredTable("isoNode").info()).total(), 2);
}

TEST(ShaderVariants, TableHasALineEach) {
  const std::string text = formatShaderCosts(costs());
  EXPECT_EQ(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')), costs().size() + 1);
  const ShaderVariantCost one{{"name", "purpose", ""}, {2, 30, 4, 5, {{"division", 6}, {"sqrt", 1}}}};
  const std::string line = formatShaderCosts({&one, 1});
  EXPECT_NE(line.find("name "), std::string::npos);
  // 48 in all; a division is two
  EXPECT_NE(line.find("      2         30       4        5       7    48       54  division 6, sqrt 1\n"),
            std::string::npos)
      << line;
}

}  // namespace
}  // namespace ltcfit
