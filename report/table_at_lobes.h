// The default tables, fitted only where some lobes are looked up.
#pragma once

#include <optional>
#include <vector>

#include "ltc/table.h"

namespace ltcfit {

/// The tables of `ltcfit fit iso` and `ltcfit fit aniso`, all defaults, whose entries are fitted at the
/// corners of the cells that hold the lobes, and nowhere else: Table::fetch is right at these lobes alone.
/// Isotropic lobes (alpha_x = alpha_y) count for the first, the others for the second; without a lobe there
/// is no table. A corner whose lobe another node of the table shares is that lobe's.
struct TablesAtLobes {
  std::optional<Table> isotropic;
  std::optional<Table> anisotropic;
};

/// Lobes with alpha_x >= alpha_y, phi in [0, pi/2]. Independent of threads.
TablesAtLobes fitTablesAt(const std::vector<LobeParameters>& lobes, int threads);

}  // namespace ltcfit
