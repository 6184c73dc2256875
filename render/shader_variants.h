// The look-up in its variants, as whole fragment shaders, and what each costs.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "ltc/table.h"
#include "render/shader_cost.h"

namespace ltcfit {

struct ShaderVariant {
  std::string name;     ///< "isotropic, F0 = 1, quad"
  std::string purpose;  ///< when to take it, one line
  std::string source;   ///< GLSL 4.50: the shipped files and a main() that shades one light
};

/// One light on one point, from interpolated position, normal, tangent and view to a colour: isotropic and
/// anisotropic look-up, with F0 = 1 (a metal's tint multiplies the light) and with Schlick's Fresnel, with
/// each way to integrate over the light; with a diffuse base added; and with the tests that skip lights.
/// "above horizon" is also the way that an exactly clipped quad takes where all of it is above the lobe's
/// horizon, less the two tests that find that out.
std::vector<ShaderVariant> shaderVariants();

/// The look-up made for one table (makeShaderLookup): alone, after that of ltc.glsl alone, and with a quad by
/// F0 = 1 and, if it has fresnel, by Schlick's Fresnel. Alone means from roughness and N.V, or alphas and
/// view, to the entry. Refusal for tables that have none.
std::vector<ShaderVariant> lookupVariants(const TableInfo& info);

struct ShaderVariantCost {
  ShaderVariant variant;
  ShaderCost cost;
};
std::vector<ShaderVariantCost> costsOf(std::vector<ShaderVariant> variants);
/// Of a table's look-up alone.
ShaderCost lookupCost(const TableInfo& info);

/// A line a variant, after one of headings: columns of fixed width, the special functions by name at the end.
std::string formatShaderCosts(std::span<const ShaderVariantCost> costs);

}  // namespace ltcfit
