// The report as JSON: what the page draws, and other programs read (README, Report).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "export/json_fields.h"
#include "report/table_report.h"

namespace ltcfit {

/// The options, as the file states them.
struct ReportSettings {
  ReportOptions options;
  std::uint64_t seed = 1;
  std::string storedAs;  ///< --stored-as
  std::string command;
};

/// All of the report but its tables; `shading`, `pareto` and `stability` left empty for the caller.
Json reportHead(const ReportSettings& settings);

/// An element of "tables". `number` is its place there, a part of the names of the pictures; these go to
/// `images` as data URLs.
Json tableReportJson(const std::vector<ReportTable>& tables, const TableReport& report, std::size_t number,
                     Json& images);

}  // namespace ltcfit
