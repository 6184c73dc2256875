#include "report/page.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <stdexcept>

namespace ltcfit {
namespace {

constexpr std::string_view kPlaces =
    "<title><!--LTCFIT-TITLE--></title><style>/*LTCFIT-CSS*/</style>"
    "<script id=\"report\">/*LTCFIT-REPORT*/</script><script id=\"images\">/*LTCFIT-IMAGES*/</script>"
    "<script>/*LTCFIT-CHARTS*/</script><script>/*LTCFIT-SCRIPT*/</script>";

std::string file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

std::size_t countOf(const std::string& text, std::string_view what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

TEST(Page, FillsEveryPlace) {
  EXPECT_EQ(fillPage({kPlaces, "css", "charts", "script"}, "a & b", "{\"r\":1}", "{}"),
            "<title>a &amp; b</title><style>css</style><script id=\"report\">{\"r\":1}</script>"
            "<script id=\"images\">{}</script><script>charts</script><script>script</script>");
}

TEST(Page, NoNameBreaksOut) {
  const std::string name = "</script><script>alert(1)</script><!--";
  const std::string page = fillPage({kPlaces, "", "", ""}, name, "{\"name\":\"" + name + "\"}", "{}");
  EXPECT_EQ(countOf(page, "</script>"), 4u);
  EXPECT_EQ(countOf(page, "<script"), 4u);
  EXPECT_EQ(countOf(page, "<!--"), 0u);
  EXPECT_NE(page.find("\\u003c/script>\\u003cscript>alert(1)"), std::string::npos);
}

TEST(Page, WhatIsFilledInIsNoPlace) {
  const std::string page = fillPage({kPlaces, "", "", "s"}, "t", "[\"/*LTCFIT-SCRIPT*/\"]", "{}");
  EXPECT_NE(page.find("[\"/*LTCFIT-SCRIPT*/\"]"), std::string::npos);
}

TEST(Page, RefusesAPageWithoutAPlaceOrWithTwo) {
  EXPECT_THROW(fillPage({"<title></title>", "", "", ""}, "", "", ""), std::runtime_error);
  const std::string twice = std::string(kPlaces) + "/*LTCFIT-CSS*/";
  EXPECT_THROW(fillPage({twice, "", "", ""}, "", "", ""), std::runtime_error);
}

TEST(Page, TheBuiltInPartsAreTheFiles) {
  const PageParts parts = builtInPage();
  const std::string folder = LTCFIT_PAGE_DIR;
  EXPECT_EQ(parts.html, file(folder + "/page.html"));
  EXPECT_EQ(parts.css, file(folder + "/page.css"));
  std::string script;
  std::istringstream names(file(folder + "/scripts.txt"));
  for (std::string name; std::getline(names, name);) script += file(folder + "/" + name);
  EXPECT_TRUE(parts.script == script);
  if (parts.charts.empty()) GTEST_SKIP() << "built without the charting library";
  EXPECT_EQ(parts.charts, file(LTCFIT_CHARTS_FILE));
  const std::string page = fillPage(parts, "t", "{}", "{}");
  EXPECT_EQ(countOf(page, "LTCFIT-"), 0u);
}

}  // namespace
}  // namespace ltcfit
