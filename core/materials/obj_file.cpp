#include "core/materials/obj_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>

#include "core/base/error.h"
#include "core/base/files/text_fields.h"
#include "core/base/files/text_file.h"
#include "core/base/nearest_name.h"
#include "core/materials/line_fields.h"
#include "core/materials/mesh_repair.h"
#include "core/materials/panel.h"
#include "core/materials/polygon.h"

namespace dmise {
namespace {

constexpr std::size_t max_corners = 1024;                 // limit for one face
constexpr std::size_t max_texels = std::size_t(1) << 27;  // numbers in all pictures of a model

class Reader {
 public:
  Reader(std::string_view text, const std::string& file, const ObjSources& sources)
      : fields_(text, file), sources_(sources) {
    lines_.file = file;
  }

  ObjModel read() {
    while (fields_.next()) line();
    if (model_.mesh.triangles.empty()) throw ConfigError(fields_.file() + ": has no face");
    separate_panel(model_.mesh);
    const auto repairs = repair(model_.mesh, std::move(lines_));
    model_.notes.insert(model_.notes.end(), repairs.begin(), repairs.end());
    return std::move(model_);
  }

 private:
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  void line() {
    const std::string_view key = fields_.keyword();
    if (key == "v") {
      model_.mesh.vertex_m.push_back({fields_.number(1), fields_.number(2), fields_.number(3)});
      if (model_.mesh.vertex_m.size() > max_facets) fields_.fail("too many vertices");
    } else if (key == "vt") {
      place_.push_back({texture_number(1), fields_.size() > 2 ? texture_number(2) : 0.0f});
      if (place_.size() > max_facets) fields_.fail("too many places on textures");
    } else if (key == "f" || key == "fo") {
      face();
    } else if (key == "usemtl") {
      use(fields_.rest());
    } else if (key == "mtllib") {
      libraries();
    } else if (key == "o" || key == "g") {
      name(key == "o");
    } else if (key == "l" || key == "p") {
      once(left_out_, "lines and points have no area and are ignored");
    } else if (key != "vn" && key != "s" && key != "mg" && key != "bevel" && key != "c_interp" &&
               key != "d_interp" && key != "lod" && key != "usemap" && key != "maplib" &&
               key != "shadow_obj" && key != "trace_obj") {
      refuse(key);
    }
  }

  [[noreturn]] void refuse(std::string_view key) {
    for (const std::string_view known :
         {"vp", "cstype", "deg", "bmat", "step", "curv", "curv2", "surf", "parm", "trim", "hole",
          "scrv", "sp", "end", "con", "ctech", "stech"})
      if (key == known) fields_.fail("free-form curves and surfaces are not supported");
    if (key == "call" || key == "csh") fields_.fail("commands are not supported");
    fields_.fail("unknown keyword");
  }

  void once(bool& noted, const char* what) {
    if (!noted) model_.notes.push_back(fields_.where() + ": " + what);
    noted = true;
  }

  /// An object has one name, which may have blanks; a face may be in several groups.
  void name(bool object) {
    const std::size_t end = object ? std::min<std::size_t>(fields_.size(), 2) : fields_.size();
    bool panel = false;
    for (std::size_t i = 1; i < end; ++i) panel = panel || is_panel(fields_[i]);
    if (object) object_is_panel_ = panel;
    group_is_panel_ = !object && panel;
  }

  static bool is_panel(std::string_view name) {
    return std::ranges::equal(name.substr(0, 5), std::string_view("panel"),
                              [](char a, char b) { return (a | 0x20) == b; });
  }

  float texture_number(std::size_t field) const {
    const double value = fields_.number(field);
    if (!(std::abs(value) <= 1e4)) fields_.fail("must be from -10000 to 10000", fields_[field]);
    return float(value);
  }

  struct Corner {
    std::uint32_t vertex = none, place = none;
  };

  Corner corner(std::string_view text) const {
    const std::string_view whole = text;
    Corner c;
    for (int part = 0; part < 3; ++part) {
      const std::size_t slash = text.find('/');
      const std::string_view number = text.substr(0, slash);
      if (!number.empty() || part == 0) {
        std::int64_t index = 0;
        const auto [end, error] =
            std::from_chars(number.data(), number.data() + number.size(), index);
        if (error != std::errc{} || end != number.data() + number.size() || index == 0)
          fields_.fail("corner must be v, v/vt, v//vn or v/vt/vn with numbers from 1 or below 0",
                       whole);
        if (part == 0) c.vertex = numbered(index, model_.mesh.vertex_m.size(), "vertex", whole);
        if (part == 1) c.place = numbered(index, place_.size(), "vt", whole);
      }
      if (slash == std::string_view::npos) return c;
      text.remove_prefix(slash + 1);
    }
    fields_.fail("corner has more than three parts", whole);
  }

  std::uint32_t numbered(std::int64_t index, std::size_t size, const char* what,
                         std::string_view shown) const {
    const auto count = std::int64_t(size);
    if (index < -count || index > count)
      fields_.fail("no such " + std::string(what) + " (" + std::to_string(count) + " so far)",
                   shown);
    return std::uint32_t(index > 0 ? index - 1 : count + index);
  }

  void face() {
    const std::size_t corners = fields_.size() - 1;
    if (corners < 3) fields_.fail("a face needs at least three corners");
    if (corners > max_corners)
      fields_.fail("a face has at most " + std::to_string(max_corners) + " corners");
    std::vector<Corner> of;
    for (std::size_t i = 1; i <= corners; ++i) of.push_back(corner(fields_[i]));
    if (material_ == none) {
      once(grey_, "faces before any usemtl are grey, reflectance 0.2");
      use_material(Material{});
    }
    const bool placed = std::none_of(of.begin(), of.end(), [](auto& c) { return c.place == none; });
    const std::uint32_t material = placed ? material_ : untextured();
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      Mesh::Triangle t{{of[a].vertex, of[b].vertex, of[c].vertex}, material};
      t.panel = sources_.names_panel && (object_is_panel_ || group_is_panel_);
      if (placed) t.place = {place_[of[a].place], place_[of[b].place], place_[of[c].place]};
      model_.mesh.triangles.push_back(t);
      lines_.line.push_back(fields_.line());
    };
    if (corners == 3) {
      add(0, 1, 2);
    } else {
      std::vector<Vec<Body>> places;
      for (const Corner& c : of) places.push_back(model_.mesh.vertex_m[c.vertex]);
      for (const auto& [a, b, c] : triangulate(places)) add(a, b, c);
    }
    if (model_.mesh.triangles.size() > max_facets) fields_.fail("too many facets");
  }

  /// The current material without its pictures, for faces without texture coordinates.
  std::uint32_t untextured() {
    const Material& used = model_.mesh.materials[material_];
    if (!used.colour_map && !used.slope_map) return material_;
    once(no_place_, "faces without vt do not use the pictures of their material");
    const auto [found, is_new] =
        untextured_.try_emplace(material_, std::uint32_t(model_.mesh.materials.size()));
    if (is_new) {
      Material plain = used;
      plain.colour_map = plain.slope_map = nullptr;
      model_.mesh.materials.push_back(std::move(plain));
    }
    return found->second;
  }

  void use(const std::string& name) {
    if (const auto found = used_.find(name); found != used_.end()) {
      material_ = found->second;
      return;
    }
    std::optional<Material> material;
    if (const auto found = defined_.find(name); found != defined_.end())
      material = found->second;
    else
      material = sources_.library(name);
    if (!material) {
      std::vector<std::string> names;
      for (const auto& [known, of] : defined_) names.push_back(known);
      fields_.fail(
          "no such material in a material file or in the library" + did_you_mean(name, names),
          name);
    }
    use_material(*material);
    used_[name] = material_;
  }

  void use_material(Material material) {
    material_ = std::uint32_t(model_.mesh.materials.size());
    for (auto* map : {&material.colour_map, &material.slope_map})
      if (*map) *map = loaded(**map, map == &material.colour_map);
    model_.mesh.materials.push_back(std::move(material));
  }

  std::shared_ptr<const Texture> loaded(const Texture& described, bool colour) {
    try {
      if (!sources_.read_picture) throw Error("pictures are not supported here");
      auto picture =
          sources_.read_picture(described.file, colour ? PictureOf::light : PictureOf::quantity);
      texels_ += picture.pixels.size();
      if (texels_ > max_texels) throw Error("the pictures of the model are too large in total");
      return std::make_shared<const Texture>(colour ? colour_texture(described, std::move(picture))
                                                    : slope_texture(described, picture));
    } catch (const Error& error) {
      throw ConfigError(described.where + ": " + error.what());
    }
  }

  /// Names of material files may have blanks: each ends in .mtl, but for the last.
  void libraries() {
    std::string name;
    for (std::size_t i = 1; i < fields_.size(); ++i) {
      name += (name.empty() ? "" : " ") + std::string(fields_[i]);
      const std::string ending =
          upper_case(name.substr(name.size() - std::min<std::size_t>(4, name.size())));
      if (ending != ".MTL" && i + 1 < fields_.size()) continue;
      std::replace(name.begin(), name.end(), '\\', '/');
      library(name);
      name.clear();
    }
    if (fields_.size() < 2) fields_.fail("needs a name");
  }

  /// A file elsewhere is not a model's, and messages about it would tell what is in it.
  void library(const std::string& name) {
    const auto normal = std::filesystem::path(name).lexically_normal();
    if (normal.is_absolute() || normal.string().starts_with(".."))
      fields_.fail("must be in the folder of the model", name);
    std::string text;
    try {
      text = sources_.read_mtl(name);
    } catch (const Error& error) {
      fields_.fail(error.what());
    }
    // Errors in it name their own file and line.
    const auto path = std::filesystem::path(fields_.file()).parent_path() / name;
    defined_.merge(parse_mtl(text, path.string(), sources_.library, model_.notes));
  }

  LineFields fields_;
  const ObjSources& sources_;
  ObjModel model_;
  MeshLines lines_;
  std::map<std::string, Material> defined_;
  std::map<std::string, std::uint32_t> used_;
  std::uint32_t material_ = none;
  std::map<std::uint32_t, std::uint32_t> untextured_;
  std::vector<TexturePlace> place_;
  std::size_t texels_ = 0;
  bool object_is_panel_ = false, group_is_panel_ = false;
  bool left_out_ = false, grey_ = false, no_place_ = false;
};

}  // namespace

ObjModel parse_obj(std::string_view text, const std::string& file, const ObjSources& sources) {
  return Reader(text, file, sources).read();
}

ObjModel load_obj(const std::string& path, const MaterialByName& library, bool names_panel) {
  const auto folder = std::filesystem::path(path).parent_path();
  const auto read_mtl = [&](const std::string& name) {
    return read_text_file((folder / name).string(), std::size_t(1) << 26);
  };
  const auto read = [&](const std::string& name, PictureOf what) {
    return read_picture((folder / name).string(), what);
  };
  return parse_obj(read_text_file(path), path, {read_mtl, library, read, names_panel});
}

}  // namespace dmise
