#include "core/config/objects/glints_config.h"

#include "core/base/formatted.h"
#include "core/base/units.h"
#include "core/config/yaml/vector_values.h"
#include "core/config/yaml/yaml_reader.h"

namespace dmise {
namespace {

constexpr double narrowest_lobe_deg = 0.05,
                 widest_lobe_deg = 20.0;  // the Sun's disc blurs to 0.13 deg
constexpr double darkest_share = 1e-6;

constexpr double widest_edge_deg = 10.0;  // its reach is 22 deg

const Section& edges_section() {
  static const Section section{
      "edges",
      "Rounded edges, tubes and folds along an axis of the body. They glint while the bisector of "
      "Sun and observer is across it, of all objects alike.",
      {optional("axis", form::direction(), "Axis of the body.",
                "[1, 0, 0], the velocity in nadir attitude"),
       required("half_width_deg", form::number(narrowest_lobe_deg, widest_edge_deg),
                "Half width at half maximum of their glint, of the bisector from the plane across "
                "the axis [deg]."),
       required("share", form::number(0.0, 1.0), "Share of the light that they have.")}};
  return section;
}

GlintingEdges read_edges(const YamlValue& value) {
  YamlMap map(value, edges_section());
  GlintingEdges edges{.half_width_rad = map.number("half_width_deg") * deg,
                      .share = map.number("share")};
  if (const auto axis = map.find("axis")) edges.axis = direction_of<Body>(*axis);
  map.done();
  return edges;
}

}  // namespace

const Section& glints_section() {
  static const Section section{
      "glints",
      "Small parts of random orientation that have a share of the object's light. They are fixed "
      "to its body, and each object has its own.",
      {required("lobe_deg", form::numbers(2, narrowest_lobe_deg, widest_lobe_deg),
                "Half width at half maximum of the narrowest and of the widest lobes, of the "
                "bisector of Sun and observer [deg]. There are lobes of octaves between."),
       required("parts_in_view", form::number(0.001, 1000.0),
                "Mean number of parts of each width whose lobe reaches an observer. Fewer are "
                "brighter."),
       required("share", form::numbers(2, darkest_share, 1.0),
                "Shares of the light that the narrowest and the widest have; those between by a "
                "power of their width. The rest is smooth."),
       optional("edges", form::map(edges_section), "Edges along an axis that glint alike.")}};
  return section;
}

Glints read_glints(const YamlValue& value) {
  YamlMap map(value, glints_section());
  const auto lobes = map.require("lobe_deg"), shares = map.require("share");
  const auto lobe_deg = lobes.numbers(), share = shares.numbers();
  if (lobe_deg[0] > lobe_deg[1])
    lobes.fail("the narrowest must not be wider than the widest", false);
  Glints glints{.narrowest_rad = lobe_deg[0] * deg,
                .widest_rad = lobe_deg[1] * deg,
                .parts_in_view = map.number("parts_in_view"),
                .share_of_narrowest = share[0],
                .share_of_widest = share[1]};
  if (const auto edges = map.find("edges")) glints.edges = read_edges(*edges);
  map.done();
  double all = glints.edges ? glints.edges->share : 0.0;
  for (const auto& lobe : lobes_of(glints)) all += lobe.share;
  if (all > 1.0)
    shares.fail(formatted("the lobes of all widths%s have %.3g of the light; at most 1",
                          glints.edges ? " and edges" : "", all),
                false);
  return glints;
}

}  // namespace dmise
