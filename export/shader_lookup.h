// The look-up of one table as shader source, with that table's constants and nothing that it does not need.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "export/shader_arrays.h"
#include "ltc/table.h"

namespace ltcfit {

/// Texture fetches of the look-up. Isotropic: 1, and another one for norm and fresnel if the table has
/// either. Anisotropic: 3, one for each row of M, and 6 where both alpha and lambda have more than one node.
int fetchesOf(const TableInfo& info);

/// An include file that follows ltc.glsl or ltc.hlsl (render/shaders).
struct ShaderLookup {
  std::string source;
  std::string function;  ///< PREFIXFetch or PREFIXFetchAnisotropic; returns an LtcEntry
  /// Names of its parameters, in their order. Isotropic, of matrixTable, amplitudeTable, roughness, nDotV,
  /// and anisotropic, of table, alphaX, alphaY, view, those that the table has a use for; under HLSL
  /// `bilinear` stands behind the textures. They mean what they mean in ltcFetch and ltcFetchAnisotropic.
  std::vector<std::string> parameters;

  /// The expression that calls it, with these for the parameters by name; all that it has must be there.
  std::string call(const std::map<std::string, std::string>& arguments) const;
};

/// The look-up in textures of packingLean, in float or half: maps, ranges and warps of the axes as constants;
/// of axes of one node neither arithmetic nor interpolation is left. What Table::fetch yields, in float32:
/// parameters outside of the axes are taken for their ends. Of a table without norm entry.norm is 1, of one
/// without fresnel entry.fresnel is 0. `prefix` becomes an identifier. Throws Refusal for an
/// axis of several nodes without a map, which a shader would have to search.
ShaderLookup makeShaderLookup(const TableInfo& info, ShadingLanguage language, const std::string& prefix);

}  // namespace ltcfit
