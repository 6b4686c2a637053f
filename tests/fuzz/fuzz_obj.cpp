#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/base/error.h"
#include "core/materials/obj_file.h"
#include "core/materials/panel.h"

using namespace dmise;

// What is read is a mesh that light can be computed with: every facet has three vertices, a
// material and an area, and a panel its own vertices. Everything else is a ConfigError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const ObjSources sources{
      [](const std::string&) { return std::string("newmtl a\nmap_Kd a.png\nbump a.png\n"); },
      [](std::string_view name) -> std::optional<Material> {
        return name == "kapton" ? std::optional<Material>(Material{}) : std::nullopt;
      },
      [](const std::string&, PictureOf) {
        return LinearPicture{2, 1, 1, {0.25f, 0.75f}};
      },
      true};
  try {
    const ObjModel model = parse_obj(text, "fuzz", sources);
    const auto of_panel = panel_vertices(model.mesh);
    for (const auto& t : model.mesh.triangles) {
      for (const auto corner : t.corner)
        if (corner >= of_panel.size() || of_panel[corner] != t.panel) std::abort();
      if (t.material >= model.mesh.materials.size()) std::abort();
      const double area = norm(double_area_m2(model.mesh, t));
      if (!(area > 0) || !std::isfinite(area)) std::abort();
    }
    if (model.mesh.triangles.empty()) std::abort();
  } catch (const ConfigError&) {
  }
  return 0;
}
