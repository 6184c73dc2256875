#include "export/anisotropic_c_header.h"

#include <fmt/format.h>

#include <Eigen/LU>

#include "base/refusal.h"
#include "export/c_text.h"
#include "export/packing.h"
#include "export/texture_metadata.h"

namespace ltcfit {
namespace {

std::string anisotropicComment(const Table& table, const std::string& name,
                               const std::vector<std::string>& channels) {
  const TableInfo& info = table.info();
  std::size_t negative = 0;
  for (std::size_t i = 0; i < table.nodeCount(); ++i)
    negative += table.entry(table.node(i)).m.determinant() > 0.0 ? 0 : 1;
  std::string out = fmt::format(
      "/* Linearly Transformed Cosines for anisotropic GGX (height-correlated Smith, F = 1).\n"
      " * {}\n"
      " *\n"
      " * Axes, slowest first; coordinates from 0 (first node) to 1 (last):\n",
      originText(info.provenance));
  for (const Axis& axis : info.axes)
    out += fmt::format(" *   {:<6} {} nodes at {}\n", axis.name, axis.size(), axisFormula(axis));
  out += fmt::format(
      " * alpha = max(alpha_x, alpha_y), lambda = min / max, GGX alphas (not roughness); theta, phi: polar "
      "angle and\n"
      " * azimuth of the view vector in the tangent frame, radians.\n"
      " *\n"
      " * {}: M, 9 floats row-major, {}. M takes clamped-cosine directions to the "
      "lobe.\n"
      " *   Interpolate M in all four axes, then invert it; integrate with the inverse. {}\n"
      " *   phi beyond [0, pi/2]: mirror the view into the first quadrant and use F M F with F the mirror "
      "matrix\n"
      " *   diag(-1, 1, 1), diag(1, -1, 1) or both. alpha_y > alpha_x: swap x and y of the view and use P M "
      "P with\n"
      " *   P the swap. With F and P on both sides the winding of light polygons stays as it is. At alpha = "
      "0 any\n"
      " *   lambda will do: mind the 0 / 0.\n",
      name,
      info.stores == MatrixStorage::kM && info.normalization == MatrixNormalization::kNone
          ? "of a scale that weighs the node in look-ups"
          : "third column of length 1",
      negative == 0
          ? std::string("det M > 0 at every node.")
          : fmt::format("det M < 0 at {} nodes:\n *   take the absolute value of the integral.", negative));
  if (!channels.empty()) out += amplitudeComment(name + "_amplitude", channels, ", ");
  out += fmt::format(" *\n * alpha_x and alpha_y were fitted no smaller than {:.9g}. Node values:\n",
                     info.alphaFloor);
  for (const Axis& axis : info.axes) out += fmt::format(" * {}:{}\n", axis.name, valuesComment(axis));
  return out + " */\n";
}

}  // namespace

std::string tableToAnisotropicCHeader(const Table& table, const std::string& name) {
  if (table.isIsotropic()) throw Refusal("needs an anisotropic table (alpha, lambda, theta, phi)");
  const std::vector<std::string> channels = amplitudesOf(table.info());
  Packing packing{
      MatrixStorage::kM,
      Divisor::kThirdColumn,
      {{"matrix", {"m00", "m01", "m02", "m10", "m11", "m12", "m20", "m21", "m22"}}, {"amplitude", channels}}};
  if (channels.empty()) packing.textures.pop_back();
  const PackedTable packed = pack(table, packing, Precision::kFloat);
  // alone it may be a word of the language, as "float"
  const std::string id = isCWord(identifier(name)) ? identifier(name) + "_table" : identifier(name);
  std::string sizes;
  for (const Axis& axis : table.info().axes) sizes += fmt::format("[{}]", axis.size());

  std::string matrices;
  std::string amplitudes;
  const std::size_t phis = table.info().axes[3].size();
  const std::size_t thetas = table.info().axes[2].size();
  const std::size_t lambdas = table.info().axes[1].size();
  // braces open before the first and close after the last node of each row, plane and volume
  const auto open = [&](std::size_t i) {
    std::string text;
    if (i % (phis * thetas * lambdas) == 0) text += "{";
    if (i % (phis * thetas) == 0) text += "{";
    if (i % phis == 0) text += "{\n";
    return text;
  };
  const auto close = [&](std::size_t i) {
    const bool last = i + 1 == table.nodeCount();
    std::string text;
    ++i;
    if (i % phis == 0) text += "}";
    if (i % (phis * thetas) == 0) text += "}";
    if (i % (phis * thetas * lambdas) == 0) text += "}";
    if (!last) text += ",";
    text += "\n";
    return text;
  };
  // nine digits of a float32 read back to the same number
  const auto row = [](const Image& image, std::size_t i) {
    const auto first = image.values.begin() + static_cast<std::ptrdiff_t>(i * image.components);
    return fmt::format("  {{{:.8e}f}}",
                       fmt::join(first, first + static_cast<std::ptrdiff_t>(image.components), "f, "));
  };
  for (std::size_t i = 0; i < table.nodeCount(); ++i) {
    matrices += open(i) + row(packed.images[0], i) + close(i);
    if (!channels.empty()) amplitudes += open(i) + row(packed.images[1], i) + close(i);
  }
  const std::string guard = upper(id) + "_H";
  std::string out = anisotropicComment(table, id, channels);
  out += fmt::format("#ifndef {0}\n#define {0}\n\n", guard);
  out += fmt::format("static const float {}{}[9] = {{\n{}}};\n", id, sizes, matrices);
  if (!channels.empty())
    out += fmt::format("\nstatic const float {}_amplitude{}[{}] = {{\n{}}};\n", id, sizes, channels.size(),
                       amplitudes);
  out += fmt::format("\n#endif /* {} */\n", guard);
  return out + fmt::format("/* {} */\n", metadataLine(packed, "arrays of C, in this order"));
}

}  // namespace ltcfit
