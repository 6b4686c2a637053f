#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/materials/mesh.h"
#include "core/materials/mtl_file.h"

namespace dmise {

/// A mesh with notes on what was ignored or repaired, one line each.
struct ObjModel {
  Mesh mesh;
  std::vector<std::string> notes;
};

/// Access to the files that an OBJ file names.
struct ObjSources {
  std::function<std::string(const std::string& name)> read_mtl;  // text of a material file
  MaterialByName library;
  std::function<LinearPicture(const std::string& name, PictureOf what)> read_picture;
  /// Whether objects (o) and groups (g) whose names begin with "panel", in any case, are the panel.
  bool names_panel = false;
};

/// Limit on the number of facets.
inline constexpr std::size_t max_facets = 4'000'000;

/// Parses a Wavefront OBJ, lengths in metres: v, vt, f (any number of corners, absolute and
/// negative indices, with and without texture and normal), usemtl, mtllib, o, g, s. Vertex normals
/// are ignored: facets are flat. A material is looked up in the material files, then in the
/// library; facets before any usemtl are grey (Lambert 0.2), with a note. Lines and points are
/// ignored; free-form curves and surfaces are refused. A new object (o) ends the groups (g) before
/// it. A panel gets vertices of its own. The mesh is repaired (mesh_repair.h). Throws `ConfigError`
/// with `file:line`.
ObjModel parse_obj(std::string_view text, const std::string& file, const ObjSources& sources);

/// Reads an OBJ file; material files and pictures are relative to its directory. Material files
/// must be in it or below it.
ObjModel load_obj(const std::string& path, const MaterialByName& library, bool names_panel = false);

}  // namespace dmise
