// The shading check as files for people and programs.
#pragma once

#include <string>
#include <vector>

#include "export/texture_files.h"
#include "render/shading_check.h"

namespace ltcfit {

/// Pictures of a check:
///   NAME.png   of each named scene: the table in GL, the reference, their difference (absolute, times
///              kDifferenceGain), and the same of the other table, if any;
///   NAME.exr   the same in linear float32: R, G, B of the table in GL, layers "reference", "difference",
///              "against", "against_difference" (amplified likewise);
///   contact.png  all named scenes;  lost.png  the random ones where the other table is closer, if any.
/// `name`, `otherName`: of the tables, for headings.
std::vector<ExportFile> shadingPictures(const ShadingCheck& check, const std::string& name,
                                        const std::string& otherName);

}  // namespace ltcfit
