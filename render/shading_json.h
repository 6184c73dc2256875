// The shading check as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "render/shader_variants.h"
#include "render/shading_check.h"

namespace ltcfit {

/// A table as the check names it.
struct CheckedTable {
  std::string name;  ///< of its file, without folders
  const ShaderTable* table = nullptr;
};

/// What `ltcfit check-gl` writes and `ltcfit report` reads ("ltcfit-shading", version 1): every figure, and
/// pictures (PNG, base64) of named scenes and of those where the other table is closer. `against.table` may
/// be null.
nlohmann::ordered_json shadingToJson(const CheckedTable& table, const CheckedTable& against,
                                     const ShadingCheckOptions& options, const ShadingCheck& check,
                                     std::span<const ShaderVariantCost> costs, const std::string& command);

}  // namespace ltcfit
