// Pieces of the C headers.
#pragma once

#include <string>

#include "ltc/axis.h"

namespace ltcfit {

/// Part of a C identifier: every character that cannot be in one is turned into '_'; starts with a letter.
std::string identifier(const std::string& text);
std::string upper(std::string text);
/// Text of a file inside a comment: it neither ends it nor breaks its lines.
std::string commentSafe(std::string text);
/// How a shader gets the texture coordinate of an axis, 0..1 from the first node to the last.
std::string axisFormula(const Axis& axis);
/// The values of the nodes, eight a line, each line starting with " *".
std::string valuesComment(const Axis& axis);

}  // namespace ltcfit
