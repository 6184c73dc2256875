#include "report/shading_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "export/atomic_file.h"
#include "export/png.h"
#include "report/picture_checks.h"

namespace ltcfit {
namespace {

std::string pictureOf(std::size_t width, std::size_t height) {
  return toBase64(toPng({width, height, std::vector<std::uint8_t>(3 * width * height, 90)}));
}

// PSNRs are -20 log10 of the RMSE, to 5 digits.
Json errors(double rmse, double psnr) {
  return {{"rmse", rmse}, {"relative_mse", 0.001}, {"psnr", psnr}, {"largest", 0.2}};
}

Json scene(const char* name, bool random, Json error, Json against) {
  return {{"name", name},
          {"title", "t"},
          {"random", random},
          {"loss", "l"},
          {"alpha", {0.25, 1}},
          {"gl",
           {{"psnr", 98.2},
            {"floor", 50},
            {"largest", 1e-5},
            {"non_finite", 0},
            {"kinds_differ", 0},
            {"pixels", 9}}},
          {"passed", true},
          {"reference", {{"rmse", 1e-4}, {"samples", 256.5}, {"resolved", true}}},
          {"error", std::move(error)},
          {"against", std::move(against)},
          {"clipping", {{"exact", 0.003}, {"proxy-sphere", 0.006}, {"proxy-sphere-table", 0.005}}},
          {"explanation", ""},
          {"pictures", nullptr}};
}

// One named scene, and two random ones of which the other table has the second.
Json shading() {
  Json named = scene("rectangle", false, errors(0.003, 50.458), errors(0.006, 44.437));
  const std::string picture = pictureOf(4, 3);
  named["pictures"] = {{"ltc", picture},
                       {"reference", picture},
                       {"difference", picture},
                       {"against", picture},
                       {"against_difference", picture}};
  Json lost = scene("random-1", true, errors(0.004, 47.959), errors(0.002, 53.979));
  lost["explanation"] = "e";
  lost["reference"]["resolved"] = false;
  lost["reference"]["rmse"] = 0.003;
  lost["clipping"]["proxy-sphere"] = 0.008;
  return {{"format", "ltcfit-shading"},
          {"version", 1},
          {"command", "ltcfit check-gl t.dds"},
          {"tool_version", "0"},
          {"table", {{"name", "t.dds"}, {"source", "s"}, {"isotropic", true}, {"precision", "half"}}},
          {"against", {{"name", "o.dds"}, {"source", "s"}, {"isotropic", true}, {"precision", "float"}}},
          {"renderer", "r"},
          {"options", {{"width", 160}}},
          {"passed", true},
          {"scenes", {named, scene("random-0", true, errors(0.001, 60), errors(0.003, 50.458)), lost}},
          {"random",
           {{"scenes", 2},
            {"rmse", 0.0025},
            {"against_rmse", 0.0025},
            {"closer", 1},
            {"resolved", 1},
            {"reference_rmse", 0.00155},
            {"clipping", {{"exact", 0.003}, {"proxy-sphere", 0.007}, {"proxy-sphere-table", 0.005}}}}},
          {"cost",
           {{{"name", "quad"},
             {"fetches", 2},
             {"arithmetic", 300},
             {"selects", 4},
             {"branches", 1},
             {"special", {{"atan", 4}, {"sqrt", 5}}},
             {"total", 316}}}},
          {"frames", {{{"scene", "rectangle"}, {"seconds", 0.04}, {"width", 1280}, {"height", 720}}}}};
}

std::string messageOf(const std::string& text) {
  try {
    shadingFromJson(text, "f.json");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

// What is said of the file with values replaced.
std::string damaged(const std::vector<std::pair<const char*, Json>>& changes) {
  Json json = shading();
  for (const auto& [pointer, value] : changes) json[Json::json_pointer(pointer)] = value;
  return messageOf(json.dump());
}

std::string damaged(const char* pointer, const Json& value) {
  return damaged({{pointer, value}});
}

std::string without(const char* pointer) {
  const Json::json_pointer at(pointer);
  Json json = shading();
  json[at.parent_pointer()].erase(at.back());
  return messageOf(json.dump());
}

// Without the table compared with.
Json alone() {
  Json json = shading();
  json["against"] = nullptr;
  for (Json& one : json["scenes"]) {
    one["against"] = nullptr;
    one["explanation"] = "";
    if (one["pictures"].is_object())
      one["pictures"].erase("against"), one["pictures"].erase("against_difference");
  }
  json["random"]["against_rmse"] = nullptr;
  json["random"]["closer"] = nullptr;
  return json;
}

TEST(ShadingFile, WholeFilesAreTakenAsTheyAre) {
  EXPECT_EQ(shadingFromJson(shading().dump(), "s"), shading());
  EXPECT_EQ(shadingFromJson(alone().dump(), "s"), alone());
  Json named = alone();
  named["scenes"] = Json::array({named["scenes"][0]});
  named["random"] = nullptr;
  named["cost"] = Json::array();
  named["frames"] = Json::array();
  EXPECT_EQ(messageOf(named.dump()), "accepted");
  EXPECT_EQ(damaged("/new", 1), "accepted");
}

TEST(ShadingFile, EveryFieldIsNeeded) {
  for (const char* pointer : {"/command", "/tool_version", "/table", "/against", "/renderer", "/options",
                              "/passed", "/scenes", "/random", "/cost", "/frames", "/table/name",
                              "/table/source", "/table/isotropic", "/against/precision"})
    EXPECT_EQ(without(pointer).find("f.json: "), 0u) << pointer;
  const Json whole = shading();
  for (const char* part :
       {"/scenes/0", "/scenes/0/gl", "/scenes/0/reference", "/scenes/0/error", "/scenes/0/against",
        "/scenes/0/pictures", "/scenes/1/clipping", "/random", "/random/clipping", "/cost/0", "/frames/0"}) {
    for (const auto& [key, value] : whole[Json::json_pointer(part)].items()) {
      const std::string message = without(fmt::format("{}/{}", part, key).c_str());
      EXPECT_NE(message, "accepted") << part << " " << key;
      EXPECT_NE(message.find(std::string(part) == "/scenes/1/clipping" ? "clipping" : key), std::string::npos)
          << message;
    }
  }
}

TEST(ShadingFile, DamagedOnesAreRefusedByTheField) {
  EXPECT_EQ(damaged("/format", "ltc"), "f.json: not what is asked for: format is not \"ltcfit-shading\"");
  EXPECT_EQ(damaged("/version", 2), "f.json: version is not 1, the only one known");
  EXPECT_EQ(damaged("/renderer", 3), "f.json: renderer is not a string");
  EXPECT_EQ(damaged("/options/width", Json::array()), "f.json: options.width is neither number nor text");
  EXPECT_EQ(damaged("/table", nullptr), "f.json: table is not an object");
  EXPECT_EQ(damaged("/table/isotropic", 1), "f.json: table.isotropic is neither true nor false");
  EXPECT_EQ(damaged("/scenes", Json::array()), "f.json: scenes is empty");
  for (const char* name : {"", "Upper", "a b", "<b>", "../x"})
    EXPECT_EQ(damaged("/scenes/0/name", name),
              "f.json: scenes[0].name is not 1 to 64 lower-case letters, digits and '-'");
  EXPECT_EQ(damaged("/scenes/0/name", std::string(65, 'a')),
            "f.json: scenes[0].name is not 1 to 64 lower-case letters, digits and '-'");
  EXPECT_EQ(damaged("/scenes/1/name", "rectangle"), "f.json: scenes[1].name is taken: rectangle");
  for (const Json& alpha : {Json{0.1}, Json{0, 0.1}, Json{0.1, 1.5}, Json{0.1, 0.1, 0.1}})
    EXPECT_EQ(damaged("/scenes/0/alpha", alpha),
              "f.json: scenes[0].alpha is not two numbers above 0, up to 1");
  EXPECT_EQ(damaged("/scenes/0/gl/psnr", nullptr), "f.json: scenes[0].gl.psnr is not a number");
  EXPECT_EQ(damaged("/scenes/0/gl/psnr", 151), "f.json: scenes[0].gl.psnr is 151, not within -1000..150");
  EXPECT_EQ(damaged("/scenes/0/gl/pixels", 1.5), "f.json: scenes[0].gl.pixels is not a count");
  EXPECT_EQ(damaged("/scenes/0/reference/samples", 0),
            "f.json: scenes[0].reference.samples is 0, not within 1..1e+12");
  EXPECT_EQ(damaged("/scenes/0/error/rmse", -1), "f.json: scenes[0].error.rmse is -1, not within 0..1e+39");
  EXPECT_EQ(damaged("/scenes/0/error/largest", 1e300),
            "f.json: scenes[0].error.largest is 1e+300, not within 0..1e+39");
  EXPECT_EQ(damaged("/scenes/0/clipping", Json::object()), "f.json: scenes[0].clipping has no member exact");
  EXPECT_EQ(damaged("/frames/0/seconds", 0),
            "f.json: frames[0].seconds is 0, not a time within 1e-09..1e+06 s");
  EXPECT_EQ(damaged("/frames/0/height", 0), "f.json: frames[0].height is 0");
  EXPECT_EQ(damaged("/cost/0/special/atan", -1), "f.json: cost[0].special.atan is not a count");
  EXPECT_EQ(damaged("/cost/0/fetches", 9000000000000000000u), "f.json: cost[0].fetches is above 1e9");
}

TEST(ShadingFile, VerdictsAreThoseOfTheirFigures) {
  EXPECT_EQ(
      damaged("/scenes/0/passed", false),
      "f.json: scenes[0].passed is false, with a PSNR of 98.2 dB, a floor of 50 dB and finite pixels only");
  EXPECT_EQ(
      damaged("/scenes/0/gl/psnr", 49),
      "f.json: scenes[0].passed is true, with a PSNR of 49 dB, a floor of 50 dB and finite pixels only");
  EXPECT_EQ(
      damaged("/scenes/0/gl/non_finite", 2),
      "f.json: scenes[0].passed is true, with a PSNR of 98.2 dB, a floor of 50 dB and pixels that are not "
      "finite");
  EXPECT_EQ(damaged({{"/scenes/0/gl/non_finite", 2}, {"/scenes/0/passed", false}, {"/passed", false}}),
            "accepted");
  // 49.9999 dB to 5 digits
  EXPECT_EQ(damaged({{"/scenes/0/gl/psnr", 50}, {"/scenes/0/passed", false}, {"/passed", false}}),
            "accepted");
  EXPECT_EQ(damaged("/passed", false), "f.json: passed is false, and 0 scenes fail");
  EXPECT_EQ(damaged({{"/scenes/2/gl/psnr", 20}, {"/scenes/2/passed", false}}),
            "f.json: passed is true, and 1 scenes fail");
  EXPECT_EQ(damaged("/scenes/0/error/psnr", 50.6),
            "f.json: scenes[0].error.psnr is 50.6, and of the RMSE it is 50.458");
  EXPECT_EQ(damaged("/scenes/2/reference/resolved", true),
            "f.json: scenes[2].reference.resolved is true, and its own error is 0.003 where it judges 0.002");
  EXPECT_EQ(
      damaged("/scenes/0/reference/resolved", false),
      "f.json: scenes[0].reference.resolved is false, and its own error is 0.0001 where it judges 0.003");
  // outlines alone may fail a scene
  EXPECT_EQ(damaged({{"/scenes/0/gl/kinds_differ", 3}, {"/scenes/0/passed", false}, {"/passed", false}}),
            "accepted");
  EXPECT_EQ(damaged("/scenes/0/gl/pixels", 0),
            "f.json: scenes[0].passed is true, with a PSNR of 98.2 dB, a floor of 50 dB and no pixels");
}

TEST(ShadingFile, SumsAreThoseOfTheScenes) {
  const Json dielectric{
      {"f0", 0.04}, {"scenes", 2}, {"rmse", 0.001}, {"against_rmse", 0.0005}, {"closer", 1}};
  EXPECT_EQ(damaged("/dielectric", dielectric), "accepted");
  EXPECT_EQ(damaged("/dielectric", nullptr), "accepted");
  for (const char* const field : {"f0", "scenes", "rmse", "against_rmse", "closer"}) {
    Json broken = dielectric;
    broken[field] = field == std::string("scenes") ? Json(0) : Json(-1.0);
    EXPECT_NE(damaged("/dielectric", broken).find(field), std::string::npos) << field;
  }
  EXPECT_EQ(damaged("/random", nullptr), "f.json: random is null, and 2 scenes are random");
  EXPECT_EQ(damaged("/random/scenes", 3), "f.json: random.scenes is 3, and of the scenes listed it is 2");
  EXPECT_EQ(damaged("/random/closer", 2), "f.json: random.closer is 2, and of the scenes listed it is 1");
  // a lead within the reference's own error is none
  EXPECT_EQ(damaged({{"/scenes/1/reference/rmse", 0.0025},
                     {"/scenes/1/reference/resolved", false},
                     {"/random/resolved", 0},
                     {"/random/reference_rmse", 0.00275}}),
            "f.json: random.closer is 1, and of the scenes listed it is 0");
  EXPECT_EQ(damaged("/random/resolved", 2), "f.json: random.resolved is 2, and of the scenes listed it is 1");
  EXPECT_EQ(damaged("/random/rmse", 0.0026),
            "f.json: random.rmse is 0.0026, and of the scenes listed it is 0.0025");
  EXPECT_EQ(damaged("/random/rmse", 0.0025002), "accepted");
  EXPECT_EQ(damaged("/random/against_rmse", 0.003),
            "f.json: random.against_rmse is 0.003, and of the scenes listed it is 0.0025");
  EXPECT_EQ(damaged("/random/reference_rmse", 1e-4),
            "f.json: random.reference_rmse is 0.0001, and of the scenes listed it is 0.00155");
  EXPECT_EQ(damaged("/random/clipping/proxy-sphere", 0.006),
            "f.json: random.clipping.proxy-sphere is 0.006, and of the scenes listed it is 0.007");
  EXPECT_EQ(damaged("/random/clipping", nullptr),
            "f.json: random.clipping is null, and 2 random scenes have figures of it");
  EXPECT_EQ(damaged("/scenes/2/clipping", Json{{"exact", 0.003}}),
            "f.json: scenes[2].clipping has other members than that of scenes before");
  EXPECT_EQ(damaged("/cost/0/total", 317), "f.json: cost[0].total is not the sum of the counts, 316");
}

TEST(ShadingFile, AnotherTableIsThereThroughoutOrNowhere) {
  EXPECT_EQ(damaged("/against", nullptr),
            "f.json: scenes[0].against is there, and the file's against is null");
  EXPECT_EQ(damaged("/scenes/1/against", nullptr),
            "f.json: scenes[1].against is null, and the file's against is not");
  EXPECT_EQ(damaged("/random/closer", nullptr),
            "f.json: random.closer is null, and the file's against is not null");
  EXPECT_EQ(damaged("/scenes/1/explanation", "e"),
            "f.json: scenes[1].explanation is there, and the other table is not nearer");
  Json json = alone();
  json["scenes"][0]["pictures"]["against"] = pictureOf(2, 2);
  EXPECT_EQ(messageOf(json.dump()),
            "f.json: scenes[0].pictures.against is there, and the scene's against is null");
}

TEST(ShadingFile, PicturesAreWholePngsOfAllowedSize) {
  const auto picture = [](const std::string& text) {
    const std::string message = damaged("/scenes/0/pictures/reference", text);
    EXPECT_EQ(message.find("f.json: scenes[0].pictures.reference"), 0u) << message;
    return message;
  };
  const std::string good = pictureOf(4, 3);
  EXPECT_NE(picture("").find("is not base64"), std::string::npos);
  EXPECT_NE(picture(good + "A").find("not a multiple of 4"), std::string::npos);
  EXPECT_NE(picture("\"><b>" + good.substr(5)).find("not of its alphabet"), std::string::npos);
  EXPECT_NE(picture("====").find("not of its alphabet"), std::string::npos);
  EXPECT_NE(picture("QUJD").find("is not a PNG"), std::string::npos);
  EXPECT_NE(picture("iVBORw0KGgo=").find("ends within its header"), std::string::npos);
  for (std::size_t n = 32; n + 24 < good.size(); n += 4) picture(good.substr(0, n));
  EXPECT_NE(picture(pictureOf(4097, 1)).find("is 4097 x 1 pixels, more than 4096"), std::string::npos);
  // of such a size only the header: the sizes add up before anything is decoded
  const Json large{{"ltc", pictureOf(2000, 2000).substr(0, 48)}};
  PictureChecks checks;
  const auto next = [&] {
    try {
      checks.require(JsonFields(large, "p"), "ltc");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  for (int i = 0; i < 64; ++i) EXPECT_EQ(next(), "p.ltc: PNG: cut off");
  EXPECT_EQ(next(), "p.ltc: with it, the pictures have more than 256000000 pixels");
}

TEST(ShadingFile, EveryTruncationIsRefused) {
  Json json = alone();
  json["scenes"][0]["pictures"] = nullptr;
  const std::string text = json.dump();
  ASSERT_EQ(messageOf(text), "accepted");
  for (std::size_t n = 0; n < text.size(); ++n) EXPECT_NE(messageOf(text.substr(0, n)), "accepted") << n;
}

}  // namespace
}  // namespace ltcfit
