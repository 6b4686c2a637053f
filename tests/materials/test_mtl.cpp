#include "core/materials/mtl_file.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/materials/texture.h"

namespace dmise {
namespace {

std::vector<std::string> notes;

std::optional<Material> library(std::string_view name) {
  if (name != "kapton") return std::nullopt;
  Material m;
  m.name = "kapton";
  m.reflectance = {{0.5e-6}, {0.44}};
  return m;
}

std::map<std::string, Material> parse(std::string_view text) {
  notes.clear();
  return parse_mtl(text, "a.mtl", library, notes);
}

std::string complaint(std::string_view text) {
  try {
    parse(text);
    return "";
  } catch (const ConfigError& error) {
    return error.what();
  }
}

TEST(Mtl, ColoursBecomePhongByWavelength) {
  const auto all = parse("newmtl hull\r\nKd 0.3 0.2 0.1\r\nKs 0.1 0.1 0.1\r\nNs 20\r\nillum 2\r\n");
  const auto brdf = std::get<Phong>(brdf_at(all.at("hull"), 0.45e-6));
  EXPECT_DOUBLE_EQ(brdf.diffuse, 0.1);
  EXPECT_DOUBLE_EQ(brdf.specular, 0.1);
  EXPECT_DOUBLE_EQ(brdf.exponent, 20);
  EXPECT_DOUBLE_EQ(std::get<Phong>(brdf_at(all.at("hull"), 0.61e-6)).diffuse, 0.3);
  EXPECT_TRUE(notes.empty());
}

TEST(Mtl, ThatReflectsMoreThanFallsInIsScaledDownWithANote) {
  const auto all = parse("newmtl shiny\nKd 0.8 0.8 0.8\nKs 0.8 0.8 0.8\n");
  const auto brdf = std::get<Phong>(brdf_at(all.at("shiny"), 0.55e-6));
  EXPECT_NEAR(brdf.diffuse + brdf.specular, 1.0, 1e-12);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0].substr(0, 23), "a.mtl:1: newmtl shiny: ");
}

TEST(Mtl, TakesANamedMaterialAndItsWarmth) {
  const auto all =
      parse("newmtl foil\nKd 1 0 0\nbrdf kapton\ntemperature_k 330\nthermal_emissivity 0.7\n");
  EXPECT_DOUBLE_EQ(std::get<Lambert>(brdf_at(all.at("foil"), 0.5e-6)).reflectance, 0.44);
  EXPECT_DOUBLE_EQ(all.at("foil").temperature_k, 330);
  EXPECT_DOUBLE_EQ(all.at("foil").thermal_emissivity, 0.7);
}

TEST(Mtl, WhatCannotBeUsedPointsAtItsLine) {
  EXPECT_EQ(complaint("\n# x\nKd 1 1 1\n"), "a.mtl:3: Kd: precedes any newmtl");
  EXPECT_EQ(complaint("newmtl a\nKd 1 x 1\n"), "a.mtl:2: Kd: must be a number, got x");
  EXPECT_EQ(complaint("newmtl a\nKd nan 0 0\n"), "a.mtl:2: Kd: must be a number, got nan");
  EXPECT_EQ(complaint("newmtl a\nbrdf kaptn\n"),
            "a.mtl:2: brdf: no such material in the library, got kaptn");
  EXPECT_EQ(complaint("newmtl a\nshine 3\n"), "a.mtl:2: shine: unknown keyword");
  EXPECT_EQ(complaint("newmtl a\nnewmtl a\n"), "a.mtl:2: newmtl: defined twice, got a");
  EXPECT_EQ(complaint("newmtl\n"), "a.mtl:1: newmtl: needs a name");
}

TEST(Mtl, TellsThePicturesOfAMaterialAndHowTheyLie) {
  const auto all = parse(
      "newmtl a\nmap_Kd -s 2 3 1 -o 0.25 -clamp on my hull.png\nmap_Bump -bm -0.02 -blendu on "
      "h.tif\n"
      "newmtl b\nKd 0.5 0.5 0.5\nbump h.tif\n");
  const Texture& colours = *all.at("a").colour_map;
  EXPECT_EQ(colours.file, "my hull.png");
  EXPECT_EQ(colours.where, "a.mtl:2: map_Kd");
  EXPECT_TRUE(colours.clamp);
  const TexturePlace place = colours.of({0.5f, 0.25f});  // u from the left, v from the top
  EXPECT_FLOAT_EQ(place.u, 0.25f + 2 * 0.5f);
  EXPECT_FLOAT_EQ(place.v, 1 - 3 * 0.25f);
  EXPECT_EQ(all.at("a").slope_map->file, "h.tif");
  EXPECT_DOUBLE_EQ(all.at("a").height_m, -0.02);
  EXPECT_EQ(all.at("b").colour_map, nullptr);
  EXPECT_DOUBLE_EQ(all.at("b").height_m, 1.0);
  // The picture is the reflectance where no Kd is given.
  EXPECT_DOUBLE_EQ(std::get<Phong>(brdf_at(all.at("a"), 0.55e-6)).diffuse, 1.0);
  EXPECT_TRUE(notes.empty());
}

TEST(Mtl, ReadsTheOptionsOfExporters) {
  const auto all = parse(
      "newmtl a\nmap_Kd -t 0.1 0.2 0.3 -mm 0.25 0.5 -imfchan l -texres 512 parts\\my hull.png\n");
  const Texture& colours = *all.at("a").colour_map;
  EXPECT_EQ(colours.file, "parts/my hull.png");
  EXPECT_DOUBLE_EQ(colours.base, 0.25);
  EXPECT_DOUBLE_EQ(colours.gain, 0.5);
  EXPECT_DOUBLE_EQ(colours.scale_u, 1.0);
  EXPECT_DOUBLE_EQ(colours.offset_v, 0.0);
  EXPECT_EQ(complaint("newmtl a\nmap_Kd -mm x 1 a.png\n"),
            "a.mtl:2: map_Kd: must be a number, got x");
}

TEST(Mtl, WhatOfAPictureCannotBeUsedPointsAtItsLine) {
  EXPECT_EQ(complaint("newmtl a\nmap_Kd\n"), "a.mtl:2: map_Kd: needs the name of a picture");
  EXPECT_EQ(complaint("newmtl a\nmap_Kd -s 2 2\n"), "a.mtl:2: map_Kd: needs the name of a picture");
  EXPECT_EQ(complaint("newmtl a\nmap_Kd -t 1 1 1 a.png\n"), "");  // turbulence has no effect
  EXPECT_EQ(complaint("newmtl a\nmap_Kd -bm 1 a.png\n"),
            "a.mtl:2: map_Kd: option cannot be used, got -bm");
  EXPECT_EQ(complaint("newmtl a\nbump -bm x a.png\n"), "a.mtl:2: bump: must be a number, got x");
}

TEST(Mtl, OtherMapsAndThoseOfALibraryMaterialAreLeftOutWithANote) {
  const auto all = parse("newmtl a\nmap_Ks hull.png\nnewmtl b\nbrdf kapton\nmap_Kd hull.png\n");
  EXPECT_EQ(notes, (std::vector<std::string>{
                       "a.mtl:2: map_Ks: this map is left out",
                       "a.mtl:5: map_Kd: left out: the material has a brdf of the library"}));
  EXPECT_EQ(all.at("b").colour_map, nullptr);
  parse("\xef\xbb\xbfnewmtl a\ndisp a.png\nrefl a.png\nnorm a.png\ndecal a.png\nmap_Ke a.png\n");
  EXPECT_EQ(notes,
            (std::vector<std::string>{
                "a.mtl:2: disp: this map is left out", "a.mtl:3: refl: this map is left out",
                "a.mtl:4: norm: this map is left out", "a.mtl:5: decal: this map is left out",
                "a.mtl:6: map_Ke: this map is left out"}));
}

TEST(Mtl, SurfacesThatEmitAColourAreNoted) {
  parse("newmtl a\nKe 0.000 0.0 0\nnewmtl b\nKe 0 2.5 0\n");
  EXPECT_EQ(notes,
            (std::vector<std::string>{"a.mtl:4: Ke: surfaces emit by their temperature alone"}));
}

}  // namespace
}  // namespace dmise
