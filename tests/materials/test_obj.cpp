#include "core/materials/obj_file.h"

#include <gtest/gtest.h>

#include <array>

#include "core/base/error.h"
#include "core/base/files/whole_file.h"

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

/// What is wrong with a model in files of its own, with a picture of 2 x 2 pixels beside it.
std::string complaint_of_files(const std::string& mtl) {
  const std::string folder = testing::TempDir() + ".";
  write_picture(folder + "/obj-2x2.png", Picture{2, 2, 1, {0, 255, 128, 7}});
  write_exr(folder + "/obj-bright.exr",
            {.columns = 2, .rows = 1, .channels = {{"Y", std::array{0.0f, 3.5f}.data()}}});
  write_file_whole(folder + "/obj-a.mtl", "newmtl hull\n" + mtl + "\n");
  write_file_whole(folder + "/obj-a.obj",
                   "mtllib obj-a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
                   "usemtl hull\nf 1/1 2/2 3/3\n");
  try {
    const auto model = load_obj(folder + "/obj-a.obj", [](auto) { return std::nullopt; });
    const auto& material = model.mesh.materials.at(0);
    return material.colour_map ? std::to_string(material.colour_map->columns) + " columns" : "none";
  } catch (const ConfigError& error) {
    std::string words = error.what();
    for (auto at = words.find(folder + "/"); at != words.npos; at = words.find(folder + "/"))
      words.erase(at, folder.size() + 1);
    return words;
  }
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

TEST(Obj, AByteOrderMarkIsNoPartOfTheText) {
  EXPECT_EQ(parse("\xef\xbb\xbf" + corners + faces).mesh, parse(corners + faces).mesh);
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
            std::vector<std::string>{"a.obj:16: facet without area dropped (the first of 2)"});
  EXPECT_EQ(complaint("usemtl kapton\nv 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"),
            "a.obj: no facet has an area");
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

// As exporters write them: several files in a line, names with blanks, folders by backslashes.
TEST(Obj, ALineMayNameSeveralMaterialFiles) {
  std::vector<std::string> asked;
  const ObjSources sources{[&](const std::string& name) -> std::string {
                             asked.push_back(name);
                             return "newmtl " + name.substr(name.size() - 5, 1) + "\nKd 0.5 0 0\n";
                           },
                           [](std::string_view) { return std::optional<Material>(); }};
  const auto model = parse_obj("mtllib a.mtl my b.MTL parts\\c.mtl\n" + corners +
                                   "usemtl a\nf 1 4 3 2\nusemtl b\nf 5 6 7 8\nusemtl c\n" + faces,
                               "a.obj", sources);
  EXPECT_EQ(asked, (std::vector<std::string>{"a.mtl", "my b.MTL", "parts/c.mtl"}));
  EXPECT_EQ(model.mesh.materials.size(), 3u);
  EXPECT_EQ(complaint("mtllib\n"), "a.obj:1: mtllib: needs a name");
}

TEST(Obj, MaterialFilesAreInTheModelsFolder) {
  for (const std::string name :
       {"../../../../etc/passwd", "/etc/passwd", "x/../../a.mtl", "..\\a.mtl"})
    EXPECT_EQ(complaint("mtllib " + name + "\n")
                  .rfind("a.obj:1: mtllib: must be in the folder of the model", 0),
              0u)
        << name;
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
  EXPECT_EQ(complaint("v nan 0 0\n"), "a.obj:1: v: must be a number, got nan");
  EXPECT_EQ(complaint("v 0 0 1,5\n"), "a.obj:1: v: must be a number, got 1,5");
  EXPECT_EQ(complaint(corners + "f 1 2\n"), "a.obj:9: f: a face needs at least three corners");
  EXPECT_EQ(complaint(corners + "f 1 2 9\n"), "a.obj:9: f: no such vertex (8 so far), got 9");
  EXPECT_EQ(complaint(corners + "f 1 2 -9\n"), "a.obj:9: f: no such vertex (8 so far), got -9");
  EXPECT_EQ(complaint(corners + "f 1 2 0\n").substr(0, 26), "a.obj:9: f: corner must be");
  EXPECT_EQ(complaint(corners + "f 1 2 3/a\n").substr(0, 26), "a.obj:9: f: corner must be");
  EXPECT_EQ(complaint("curv 0 1 2\n"),
            "a.obj:1: curv: free-form curves and surfaces are not supported");
  EXPECT_EQ(complaint("<html>\n"), "a.obj:1: <html>: unknown keyword");
  EXPECT_EQ(complaint(""), "a.obj: has no face");
}

TEST(Obj, PicturesStandBesideTheModelAndBadOnesPointAtTheirLine) {
  EXPECT_EQ(complaint_of_files("map_Kd obj-2x2.png"), "2 columns");
  EXPECT_EQ(complaint_of_files("Kd 1 1 1\nmap_Kd obj-none.png"),
            "obj-a.mtl:3: map_Kd: obj-none.png: No such file or directory");
  EXPECT_EQ(complaint_of_files("map_Kd obj-a.obj"),
            "obj-a.mtl:2: map_Kd: obj-a.obj: is not a PNG, TIFF, JPEG or EXR file");
  EXPECT_EQ(complaint_of_files("bump ../../dev/zero").substr(0, 17), "obj-a.mtl:2: bump");
  EXPECT_EQ(complaint_of_files("map_Kd obj-bright.exr"),
            "obj-a.mtl:2: map_Kd: values must be from 0 to 1, got 3.500000");
}

// Both sides of a sheet have the picture, each corner its own place.
TEST(Obj, PlacesOnPicturesFollowTheirCorners) {
  const ObjSources sources{
      [](const std::string&) { return std::string("newmtl hull\nmap_Kd a.png\n"); },
      [](std::string_view) { return std::optional<Material>(); },
      [](const std::string&, PictureOf) {
        return LinearPicture{1, 1, 3, {0.5f, 0.5f, 0.5f}};
      }};
  const auto model = parse_obj(
      "mtllib a.mtl\nusemtl hull\n" + corners + "vt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 4/-1\nf 2 3 4\n",
      "a.obj", sources);
  EXPECT_EQ(model.notes.front(),
            "a.obj:15: faces without vt do not use the pictures of their material");
  ASSERT_EQ(model.mesh.triangles.size(), 4u);
  for (const auto& t : model.mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& v = model.mesh.vertex_m[t.corner[i]];
      const bool placed = model.mesh.materials[t.material].colour_map != nullptr;
      EXPECT_EQ(t.place[i], placed ? (TexturePlace{float(v.x), float(v.y)}) : TexturePlace{});
    }
  EXPECT_EQ(complaint(corners + "usemtl kapton\nf 1/1 2/1 3/1\n"),
            "a.obj:10: f: no such vt (0 so far), got 1/1");
}

}  // namespace
}  // namespace dmise
