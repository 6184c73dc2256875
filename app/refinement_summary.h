// What a refinement did to a table, measured where it did not look.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/refinement_run.h"
#include "report/smoothness.h"

namespace ltcfit::app {

/// Look-ups of the summary unless told otherwise.
inline constexpr int kFreshLookUps = 2000;

struct RefinementFigures {
  std::size_t count = 0;              ///< look-ups; 0: none were asked for, and the rest is empty
  std::vector<FreshErrors> errors{};  ///< of direct fits, the table before, the table after
  std::vector<AxisSmoothness> before{};
  std::vector<AxisSmoothness> after{};
};

/// At `count` look-ups that the refinement has not seen. 0: nothing.
RefinementFigures measureRefinement(const RefinementRun& run, std::size_t count,
                                    const RefinementOptions& options);

void printRefinement(const RefinementRun& run, const RefinementFigures& figures);
/// Adds "refinement".
void addRefinement(const RefinementRun& run, const RefinementFigures& figures, nlohmann::ordered_json* out);

}  // namespace ltcfit::app
