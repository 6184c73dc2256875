#include "export/c_header.h"

#include <fmt/format.h>

#include "base/refusal.h"
#include "export/c_text.h"
#include "export/packing.h"
#include "export/texture_metadata.h"

namespace ltcfit {
namespace {

std::string isotropicComment(const Table& table, const std::string& name,
                             const std::vector<std::string>& amplitudes) {
  const TableInfo& info = table.info();
  const Axis& y = info.axes[0];
  const Axis& x = info.axes[1];
  std::string out = fmt::format(
      "/* Linearly Transformed Cosines for isotropic GGX (height-correlated Smith, F = 1).\n"
      " * {}\n"
      " *\n"
      " * Layout: {}x{} texels, row-major; x = roughness fastest, y = view angle. Texel (0, 0) is the "
      "smoothest\n"
      " * lobe at normal view. float32.\n"
      " *   x: {}      (alpha is the GGX alpha; its root is the artist's roughness)\n"
      " *   y: {}\n"
      " * For a texture with linear filtering: uv = (x, y) * (size - 1) / size + 0.5 / size.\n"
      " *\n"
      " * {}_matrix: the inverse matrix divided by its middle element, 4 numbers t a texel:\n"
      " *   t = (Minv00, Minv20, Minv02, Minv22) / Minv11, and\n"
      " *          [ t0  0  t2 ]\n"
      " *   Minv = [ 0   1  0  ]  (rows, times a column vector; GLSL: mat3(vec3(t.x,0,t.y), vec3(0,1,0), "
      "vec3(t.z,0,t.w)))\n"
      " *          [ t1  0  t3 ]\n"
      " *   takes light vectors of the frame below to the clamped cosine. It has no scale: integrate with it "
      "as\n"
      " *   it is. Frame: z = normal, the view vector in the x-z plane with x >= 0, so that the lobe leans "
      "to -x.\n",
      originText(info.provenance), x.size(), y.size(), axisFormula(x), axisFormula(y), name);
  if (!amplitudes.empty()) out += " *\n" + amplitudeComment(name + "_amplitude", amplitudes, " a texel: ");
  out += fmt::format(
      " *\n"
      " * alpha floor: {:.9g} (alpha of the nodes at x = 0). Node values, alpha:{}\n"
      " * theta, radians:{}\n"
      " */\n",
      info.alphaFloor, valuesComment(x), valuesComment(y));
  return out;
}

}  // namespace

std::string tableToCHeader(const Table& table, const std::string& prefix) {
  if (!table.isIsotropic()) throw Refusal("format h needs an isotropic table (axes theta, alpha)");
  const std::vector<std::string> amplitudes = amplitudesOf(table.info());
  const PackedTable packed = pack(table, packingLean(table.info()), Precision::kFloat);
  const std::string name = identifier(prefix);
  const std::string guard = upper(name) + "_H";
  const std::size_t n = table.nodeCount();

  std::string out = isotropicComment(table, name, amplitudes);
  out += fmt::format("#ifndef {0}\n#define {0}\n\n", guard);
  out += fmt::format("enum {{ {0}_width = {1}, {0}_height = {2} }};\n\n", name, packed.images[0].width,
                     packed.images[0].height);
  out += fmt::format("static const float {}_matrix[{}][4] = {{\n{}}};\n", name, n,
                     bracedRows(packed.images[0].values, 4));
  if (!amplitudes.empty()) {
    out += fmt::format("\nstatic const float {}_amplitude[{}][{}] = {{\n{}}};\n", name, n, amplitudes.size(),
                       bracedRows(packed.images[1].values, amplitudes.size()));
  }
  out += fmt::format("\n#endif /* {} */\n", guard);
  return out + fmt::format("/* {} */\n", metadataLine(packed, "arrays of C, in this order"));
}

}  // namespace ltcfit
