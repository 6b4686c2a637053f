#include "core/config/objects/panel_config.h"

#include "core/config/yaml/vector_values.h"
#include "core/config/yaml/yaml_reader.h"

namespace dmise {
namespace {

constexpr double min_sine_to_normal = 1e-6;  // between a panel's hinge and its normal
constexpr double farthest_m = 1e5;           // hinge

}  // namespace

const Section& panel_section() {
  static const Section section{
      "panel",
      "The part of the geometry that turns about its hinge to face the Sun: the wings of a "
      "box-wing, the array of a starlink-like satellite, or the objects and groups of an OBJ file "
      "whose names begin with `panel`. Without a geometry it changes no light and is only "
      "published.",
      {optional("hinge", form::direction(),
                "The hinge in body axes; of a starlink-like satellite [1, 0, 0].", "[0, 1, 0]"),
       optional("normal", form::direction(),
                "The normal of the panel at rest, in body axes; of a starlink-like satellite "
                "[0, 1, 0].",
                "[0, 0, 1]"),
       optional("hinge_m", form::numbers(3, -farthest_m, farthest_m),
                "A point of the hinge in body axes [m], not scaled by `scale`; of a starlink-like "
                "satellite by default at the array's edge at the chassis. Needs a geometry.",
                "[0, 0, 0]")}};
  return section;
}

HingedPanel read_panel(const YamlValue& value, const GeometryConfig* geometry) {
  YamlMap map(value, panel_section());
  if (geometry && !has_panel(*geometry->mesh))
    value.fail(
        "the geometry has no panel: a box-wing, a starlink-like and an OBJ with objects or groups "
        "named panel have one",
        false);
  HingedPanel panel = geometry ? geometry->panel : HingedPanel{};
  const auto hinge = map.find("hinge"), normal = map.find("normal"), point = map.find("hinge_m");
  if (hinge) panel.axes.hinge = direction_of<Body>(*hinge);
  if (normal) panel.axes.normal = direction_of<Body>(*normal);
  if (point) {
    if (!geometry) point->fail("needs a geometry", false);
    panel.hinge_m = vector_of<Body>(*point);
  }
  if (norm(cross(panel.axes.hinge, panel.axes.normal)) < min_sine_to_normal)
    value.fail("hinge and normal must not be parallel", false);
  if (geometry && !faces_normal(*geometry->mesh, panel.axes))
    (normal ? *normal : value).fail("no facet of the panel faces its normal to 45 deg", false);
  map.done();
  return panel;
}

}  // namespace dmise
