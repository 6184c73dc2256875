// What a fragment shader costs, counted in its compiled and optimised SPIR-V.
#pragma once

#include <map>
#include <string>

namespace ltcfit {

/// Counts of one invocation over the whole module, all sides of its branches together: an upper bound where
/// branches exclude each other, exact where there are none. Loops of constant length are unrolled; of others
/// the body counts once.
///
/// The unit is what a scalar GPU issues, so that an operation on vectors counts once a component: addition,
/// subtraction, multiplication, min, max, comparison, rounding, conversion: 1 a component; a product used
/// once, in a sum, is fused with it (1 for both). Derivatives count 1, fwidth 3 a component; a remainder is a
/// division. dot: its terms (a product, then fused sums). Matrix times vector: its entries. cross 6, mix and
/// clamp 2 a component, length a dot and a sqrt, normalize a dot, an inversesqrt and a product a component.
/// Negation and abs are modifiers of operands and count nothing, nor do moves between registers and access to
/// them. Special functions count 1 a component whatever they expand to, and are listed by name.
struct ShaderCost {
  int fetches = 0;                     ///< texture fetches
  int arithmetic = 0;                  ///< scalar operations without the special ones and selects
  int selects = 0;                     ///< scalar choices between two values
  int branches = 0;                    ///< conditional branches and switches
  std::map<std::string, int> special;  ///< by name as in GLSL; "division", "textureSize"

  /// Sum of `special`.
  int specials() const {
    int sum = 0;
    for (const auto& [name, n] : special) sum += n;
    return sum;
  }
  /// Sum of all of the above.
  int total() const { return fetches + arithmetic + selects + branches + specials(); }
  /// The same with special functions that no GPU has as one instruction at what compilers make of them, an
  /// estimate: atan of two arguments 25, atan, acos and asin 15, division and exp 2, pow 3.
  int expanded() const;
};

/// Compiles GLSL (with its #version line, main() without arguments) for OpenGL 4.5 and counts. What does not
/// compile throws std::runtime_error with the compiler's log, and so does an instruction of unknown cost, by
/// name.
ShaderCost shaderCost(const std::string& fragmentSource);

}  // namespace ltcfit
