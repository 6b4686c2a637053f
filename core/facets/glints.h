#pragma once
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "core/base/numeric/rng.h"
#include "core/effects/effects.h"
#include "core/orbit/attitude.h"

namespace dmise {

/// Rounded edges, tubes and folds along an axis of the body. Their normals are all across it, so
/// that they glint for as long as the bisector of Sun and viewer is, of all objects alike.
struct GlintingEdges {
  Vec<Body> axis{1.0, 0.0, 0.0};  // unit
  double half_width_rad = 0.0;    // glint at half its peak, from the plane across the axis
  double share = 0.0;             // edges' part of the light

  bool operator==(const GlintingEdges&) const = default;
};

/// How the light of an object is shared by small parts of random orientation: wrinkles of foil,
/// cells, antennas. The smooth light of its facets is the mean over objects; of one object it is
/// concentrated in the lobes of its own parts, as the grains of a discrete microfacet surface
/// (Jakob et al. 2014, ACM Trans. Graph. 33, 115). A lobe is about the part's normal, in the
/// direction between Sun and viewer.
struct Glints {
  static constexpr EffectFacts facts{"glints", "small parts of objects glint and fade as they turn",
                                     "0.1 to 0.2 mag within a minute for OneWeb and Iridium NEXT",
                                     "measured light curves (docs/validation.md)"};
  static bool applies(const SceneFacts& scene) { return scene.glints; }

  // Half widths of the lobes at half their peak [rad]. There are lobes of both, and of octaves
  // between.
  double narrowest_rad = 0.0, widest_rad = 0.0;
  double parts_in_view = 0.0;  // mean number of each width whose lobe reaches a viewer
  // Light that parts of either width have, in between by a power of the width.
  double share_of_narrowest = 0.0, share_of_widest = 0.0;
  std::optional<GlintingEdges> edges = {};

  bool operator==(const Glints&) const = default;
};

/// One width of lobe of `Glints`.
struct GlintLobes {
  double half_width_rad = 0.0, share = 0.0;
};
std::vector<GlintLobes> lobes_of(const Glints& glints);

/// The key of an object's parts: every sensor of a run sees the same ones.
RngKey glint_key(std::uint64_t seed, std::string_view name, std::uint32_t catalogue_number);

/// Parts of objects over the sphere of their normals, fixed to the body. They are drawn where they
/// are looked at, cell by cell, so that their number costs nothing.
class GlintField {
 public:
  explicit GlintField(const Glints& glints);

  /// Light of the object whose key it is over its smooth light, 1 on the mean over objects.
  /// Directions are unit vectors.
  double over_smooth(const RngKey& object, const Vec<Body>& to_sun,
                     const Vec<Body>& to_viewer) const;

  /// A turn of the bisector of Sun and viewer over which it changes little.
  double still_rad() const { return still_rad_; }

 private:
  /// Cells of about the reach of a lobe: bands of equal height, each divided evenly by longitude.
  struct Cells {
    double reach_rad = 0.0;
    double reach_versine = 0.0;  // 1 - cos
    double peak = 0.0;           // light of a part over the smooth light
    double parts_per_sr = 0.0;
    double height_rad = 0.0;
    std::vector<std::uint32_t> first;  // cell of each band, and the number of all
  };
  double light_of_edges(const Vec<Body>& at) const;
  double sum_of_lobes(const Cells& cells, std::uint32_t width, const RngKey& object,
                      const Vec<Body>& at) const;

  std::vector<Cells> of_widths_;
  std::optional<GlintingEdges> edges_;
  double edge_reach_versine_ = 0.0, edge_peak_ = 0.0;
  double smooth_share_ = 1.0, still_rad_ = 0.0;
};

/// The direction between both, about which lobes are; zero where they are opposite.
Vec<Body> bisector_of(const Vec<Body>& to_sun, const Vec<Body>& to_viewer);

}  // namespace dmise
