#include "report/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>
#include <vector>

namespace ltcfit {
namespace {

std::string replaced(std::string_view text, std::string_view characters,
                     const std::vector<std::string_view>& by) {
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    const std::size_t k = characters.find(c);
    if (k == std::string_view::npos) {
      out += c;
    } else {
      out += by[k];
    }
  }
  return out;
}

}  // namespace

std::string fillPage(const PageParts& parts, const std::string& title, const std::string& report,
                     const std::string& images) {
  const std::string titleText = replaced(title, "&<>", {"&amp;", "&lt;", "&gt;"});
  // in JSON '<' stands in strings only, where the escape is the same character
  const std::string reportText = replaced(report, "<", {"\\u003c"});
  const std::string imagesText = replaced(images, "<", {"\\u003c"});
  const std::array<std::pair<std::string_view, std::string_view>, 6> contents{{
      {"<!--LTCFIT-TITLE-->", titleText},
      {"/*LTCFIT-CSS*/", parts.css},
      {"/*LTCFIT-CHARTS*/", parts.charts},
      {"/*LTCFIT-SCRIPT*/", parts.script},
      {"/*LTCFIT-REPORT*/", reportText},
      {"/*LTCFIT-IMAGES*/", imagesText},
  }};
  // all places are found in the HTML before any is filled: what is filled in may look like a place
  struct Place {
    std::size_t at;
    std::size_t content;
  };
  std::vector<Place> places;
  for (std::size_t i = 0; i < contents.size(); ++i) {
    const std::string_view mark = contents[i].first;
    const std::size_t at = parts.html.find(mark);
    if (at == std::string_view::npos || parts.html.find(mark, at + 1) != std::string_view::npos)
      throw std::runtime_error(fmt::format("the page needs {} once", mark));
    places.push_back({at, i});
  }
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.at < b.at; });
  std::string out;
  std::size_t from = 0;
  for (const Place& place : places) {
    const auto& [mark, content] = contents[place.content];
    out += parts.html.substr(from, place.at - from);
    out += content;
    from = place.at + mark.size();
  }
  out += parts.html.substr(from);
  return out;
}

}  // namespace ltcfit
