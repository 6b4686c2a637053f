#include "core/materials/obj_file.h"

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace dmise {
namespace {

ObjModel parse(std::string_view text) {
  const ObjSources sources{[](const std::string& name) -> std::string {
                             if (name != "a.mtl") throw ConfigError(name + ": cannot be read");
                             return "newmtl red\nKd 0.5 0 0\nnewmtl dark side\nKd 0 0 0\n";
                           },
                           [](std::string_view name) -> std::optional<Material> {
                             if (name != "kapton") return std::nullopt;
                             Material m;
                             m.name = "kapton";
                             return m;
                           }};
  return parse_obj(text, "a.obj", sources);
}

std::string complaint(std::string_view text) {
  try {
    parse(text);
    return "";
  } catch (const ConfigError& error) {
    return error.what();
  }
}

const std::string corners =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n";
const std::string faces = "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

double volume_m3(const Mesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    sum += dot(mesh.vertex_m[t.corner[0]],
               cross(mesh.vertex_m[t.corner[1]], mesh.vertex_m[t.corner[2]]));
  return sum / 6;
}

TEST(Obj, ACubeOfQuadsIsTwelveFacetsThatFaceOutwards) {
  const auto model = parse("usemtl kapton\n" + corners + faces);
  EXPECT_EQ(model.mesh.triangles.size(), 12u);
  EXPECT_NEAR(volume_m3(model.mesh), 1.0, 1e-12);
  EXPECT_TRUE(model.notes.empty());
}

TEST(Obj, NegativeNumbersCountBackFromTheLine) {
  const auto a = parse(corners + "usemtl kapton\nf 1 4 3\nf 1 2 4\nf 1 3 2\nf 2 3 4\n");
  const auto b = parse(corners + "usemtl kapton\nf -8 -5 -6\nf -8 -7 -5\nf -8 -6 -7\nf -7 -6 -5\n");
  EXPECT_EQ(a.mesh, b.mesh);
}

TEST(Obj, TakesTextureAndNormalNumbersGroupsAndContinuedLines) {
  const auto model = parse(corners +
                           "vt 0 0\nvn 0 0 1\no cube\ng side top\ns off\nusemtl kapton\n"
                           "f 1/1/1 4//1 \\\n 3/1 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\n"
                           "f 4 1 5 8 # last\n");
  EXPECT_EQ(model.mesh.triangles.size(), 12u);
  EXPECT_NEAR(volume_m3(model.mesh), 1.0, 1e-12);
}

TEST(Obj, WrongWindingOfAClosedSurfaceIsTurnedWithItsLine) {
  const auto inside_out =
      parse("usemtl kapton\n" + corners +
            "f 2 3 4 1\nf 8 7 6 5\nf 5 6 2 1\nf 6 7 3 2\nf 7 8 4 3\nf 8 5 1 4\n");
  EXPECT_NEAR(volume_m3(inside_out.mesh), 1.0, 1e-12);
  EXPECT_EQ(inside_out.notes,
            std::vector<std::string>{
                "a.obj:10: closed surface of 12 facets: turned 12 to face outwards"});
  const auto one_wrong =
      parse("usemtl kapton\n" + corners +
            "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 6 7 3 2\nf 3 4 8 7\nf 4 1 5 8\n");
  EXPECT_NEAR(volume_m3(one_wrong.mesh), 1.0, 1e-12);
  EXPECT_EQ(
      one_wrong.notes,
      std::vector<std::string>{"a.obj:10: closed surface of 12 facets: turned 2 to face outwards"});
}

TEST(Obj, AnOpenSurfaceIsASheetWithABack) {
  const auto model = parse("usemtl kapton\n" + corners + "f 1 2 3 4\n");
  EXPECT_EQ(model.mesh.triangles.size(), 4u);
  EXPECT_EQ(model.notes,
            std::vector<std::string>{"a.obj:10: open surface of 2 facets: a sheet, given a back"});
}

TEST(Obj, AFacetWithoutAreaIsLeftOutWithItsLine) {
  const auto model = parse("usemtl kapton\n" + corners + faces + "f 1 2 2\nf 1 1 1\n");
  EXPECT_EQ(model.mesh.triangles.size(), 12u);
  EXPECT_EQ(model.notes,
            std::vector<std::string>{"a.obj:16: facet without area left out (the first of 2)"});
  EXPECT_EQ(complaint("usemtl kapton\nv 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"),
            "a.obj: has no facet with an area");
}

// An L of six corners: its area is 3, a fan from its first corner would give more.
TEST(Obj, AConcaveFaceKeepsItsArea) {
  const auto model =
      parse("usemtl kapton\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nv 0 0 0\nf 2 3 4 5 6 1\n");
  EXPECT_EQ(model.mesh.triangles.size(), 8u);  // four and their backs
  EXPECT_NEAR(surface_m2(model.mesh), 6.0, 1e-12);
}

TEST(Obj, MaterialsComeFromTheFileThenFromTheLibrary) {
  const auto model = parse("mtllib a.mtl\n" + corners +
                           "usemtl red\nf 1 4 3 2\nusemtl dark side\nf 5 6 7 8\nusemtl kapton\n"
                           "f 1 2 6 5\nusemtl red\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  ASSERT_EQ(model.mesh.materials.size(), 3u);
  EXPECT_EQ(model.mesh.materials[0].name, "red");
  EXPECT_EQ(model.mesh.materials[1].name, "dark side");
  EXPECT_EQ(model.mesh.materials[2].name, "kapton");
  EXPECT_EQ(model.mesh.triangles.back().material, 0u);
}

TEST(Obj, AMissingMaterialIsRefusedAndNoMaterialIsGreyWithANote) {
  EXPECT_EQ(complaint(corners + "usemtl gold\n" + faces),
            "a.obj:9: usemtl: no such material in a material file or in the library, got gold");
  EXPECT_EQ(complaint("mtllib b.mtl\n"), "a.obj:1: mtllib: b.mtl: cannot be read");
  EXPECT_EQ(parse(corners + faces).notes,
            std::vector<std::string>{"a.obj:9: faces before any usemtl are grey, reflectance 0.2"});
}

TEST(Obj, WhatCannotBeUsedPointsAtItsLine) {
  EXPECT_EQ(complaint("v 0 0\n"), "a.obj:1: v: needs 3 numbers");
  EXPECT_EQ(complaint("v 0 0 1e400\n"), "a.obj:1: v: number too large, got 1e400");
  EXPECT_EQ(complaint("v 0 0 inf\n"), "a.obj:1: v: number too large, got inf");
  EXPECT_EQ(complaint("v 0 0 1,5\n"), "a.obj:1: v: must be a number, got 1,5");
  EXPECT_EQ(complaint(corners + "f 1 2\n"), "a.obj:9: f: a face needs three corners");
  EXPECT_EQ(complaint(corners + "f 1 2 9\n"), "a.obj:9: f: no such vertex (8 so far), got 9");
  EXPECT_EQ(complaint(corners + "f 1 2 -9\n"), "a.obj:9: f: no such vertex (8 so far), got -9");
  EXPECT_EQ(complaint(corners + "f 1 2 0\n").substr(0, 26), "a.obj:9: f: corner must be");
  EXPECT_EQ(complaint(corners + "f 1 2 3/a\n").substr(0, 26), "a.obj:9: f: corner must be");
  EXPECT_EQ(complaint("curv 0 1 2\n"),
            "a.obj:1: curv: free-form curves and surfaces cannot be used");
  EXPECT_EQ(complaint("<html>\n"), "a.obj:1: <html>: unknown keyword");
  EXPECT_EQ(complaint(""), "a.obj: has no face");
}

}  // namespace
}  // namespace dmise
