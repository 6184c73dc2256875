#include "report/table_at_lobes.h"

#include <gtest/gtest.h>

#include <numbers>

#include "export/read_table.h"

namespace ltcfit {
namespace {

TEST(TableAtLobes, IsTheDefaultTableThere) {
  const LobeParameters round{0.2, 0.2, 1.1, 0.0};
  const LobeParameters grazing{1e-4, 1e-4, 0.5 * std::numbers::pi, 0.0};  // the last cell
  const LobeParameters brushed{0.3, 0.04, 0.9, 0.7};
  const TablesAtLobes at = fitTablesAt({round, grazing, brushed}, 0);
  ASSERT_TRUE(at.isotropic && at.anisotropic);
  const Table iso = readTable(LTCFIT_DATA_DIR "/ltc_iso.json");
  const Table aniso = readTable(LTCFIT_DATA_DIR "/ltc_aniso.json");
  // the same fits; another processor's sin and exp may differ in the last bits
  for (const LobeParameters& p : {round, grazing})
    EXPECT_LT((at.isotropic->fetch(p).m - iso.fetch(p).m).norm(), 1e-4 * iso.fetch(p).m.norm());
  EXPECT_LT((at.anisotropic->fetch(brushed).m - aniso.fetch(brushed).m).norm(), 1e-4);
  // and nowhere else
  const LobeParameters elsewhere{0.8, 0.8, 0.3, 0.0};
  EXPECT_GT((at.isotropic->fetch(elsewhere).m - iso.fetch(elsewhere).m).norm(), 1e-2);
}

TEST(TableAtLobes, NoLobesNoTable) {
  const TablesAtLobes at = fitTablesAt({{0.2, 0.2, 1.1, 0.0}}, 0);
  EXPECT_TRUE(at.isotropic);
  EXPECT_FALSE(at.anisotropic);
}

}  // namespace
}  // namespace ltcfit
