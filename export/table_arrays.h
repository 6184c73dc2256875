// Which arrays of a text are the textures of a table.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "export/image.h"
#include "export/text_arrays.h"

namespace ltcfit {

/// What an array is by its name.
enum class Role { kUnknown, kMatrices, kAmplitudes };

/// By the names that engines' files have: kMatrices for g_ltc_1, LTC_MAT_1, ltc_mat,
/// s_LtcMatrixData_BRDF_GGX, tabM and their like, kAmplitudes for g_ltc_2, LTC_MAT_2, ltc_amp, ltc_mag_ggx,
/// tabMagnitude.
Role roleOf(std::string_view name);

/// "a (64 numbers), b (32)", of many arrays the first few; empty without any.
std::string listOf(const std::vector<TextArray>& arrays);

/// The product of a shape; 0 where a length is not known or the product does not fit.
std::size_t productOf(const std::vector<std::size_t>& shape);

struct TextureSize {
  std::size_t width = 0;
  std::size_t height = 0;

  std::size_t texels() const { return width * height; }
};

/// Arrays that may be a table's textures. They point into the list that they were found in.
struct Candidate {
  const TextArray* matrices = nullptr;
  const TextArray* amplitudes = nullptr;
  TextureSize size;
  bool fits = false;    ///< the numbers are those of a table in the layout of 2017
  int names = 0;        ///< how well the names tell the roles: -2 (exchanged) to 2
  bool inOrder = true;  ///< the matrices come first
};

/// Pairs of matrices (4 numbers a texel, square unless the shape tells more) and norm and Fresnel (2 to 4),
/// of the largest size that has any. InputError with `name` where there are too many to try.
std::vector<Candidate> pairsOf(const std::vector<TextArray>& arrays, const std::string& name);
/// Arrays that may be matrices, without others.
std::vector<Candidate> matricesOf(const std::vector<TextArray>& arrays, const std::string& name);
/// Arrays that may be norm and Fresnel for so many texels.
std::vector<Candidate> amplitudesFor(const std::vector<TextArray>& arrays, const TextureSize& size);

/// The best by fit, then names, then order. InputError with `name` and `list` where several are.
Candidate bestOf(std::vector<Candidate> candidates, const std::string& name, const std::string& list);

Image imageOf(const TextArray& array, const TextureSize& size);

}  // namespace ltcfit
