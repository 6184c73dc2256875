// The page of a report: one HTML file with everything in it.
#pragma once

#include <string>
#include <string_view>

namespace ltcfit {

/// What the page is made of, put into the program by the build.
struct PageParts {
  std::string_view html;  ///< with a place for each of the others
  std::string_view css;
  std::string_view charts;  ///< the charting library; empty in a build that had none
  std::string_view script;
};
PageParts builtInPage();

/// The filled page. `title` is plain text, `report` and `images` JSON. No text in them can end the element
/// that it stands in. Throws std::runtime_error where a place is missing in the HTML or is there twice.
std::string fillPage(const PageParts& parts, const std::string& title, const std::string& report,
                     const std::string& images);

}  // namespace ltcfit
