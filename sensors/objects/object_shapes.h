#pragma once
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "core/config/objects/object_config.h"
#include "core/facets/facet_light.h"
#include "core/facets/glints.h"
#include "sensors/render/renderer.h"
#include "sensors/scene/view.h"

namespace dmise {

/// Surface of an object in one sensor's band.
struct ObjectShape {
  std::shared_ptr<const FacetLight> at_rest;  // with its panel so
  std::optional<HingedPanel> panel;
  double radius_m = 0.0;       // sphere about its origin that holds it, at any angle of the panel
  double silhouette_m2 = 0.0;  // most: its surface, and the disc of the sphere
  std::shared_ptr<const GlintField> glints = {};  // null: its light is smooth

  /// Its light with the panel turned to the Sun.
  std::shared_ptr<const FacetLight> light(const Vec<Body>& to_sun) const;
};

/// The surface of a geometry whose panel, if it has one, turns.
ObjectShape shape_of(const GeometryConfig& geometry, const std::optional<HingedPanel>& panel,
                     const Band& band, bool emits = true);

/// How a shape is turned and lit at one instant, as the observer sees it.
struct ShapePose {
  Rotation<Gcrs, Body> gcrs_from_body;
  Vec<Body> to_sun, to_viewer;  // unit
  double range_m = 0.0;
  double sun_distance_au = 1.0;
  std::vector<LightSource> secondary;  // light of Earth and Moon, where the effects are on
  RngKey glints = {};                  // draws the glints of this object
};

/// Rings of the Earth's face: for the flux (to 1 % of earthshine) and for pictures (to
/// 10 %).
inline constexpr int earthshine_flux_rings = 8, earthshine_picture_rings = 3;

/// Whether Earth or Moon throw light on objects.
bool has_secondary_light(const View& view);
/// Returns the light of Earth and Moon, those that do, on an object at `position_m`, in any axes
/// `body_from_gcrs`, over the Sun's there.
std::vector<LightSource> secondary_light_on(const View& view, const Vec<Gcrs>& position_m,
                                            const Rotation<Body, Gcrs>& body_from_gcrs,
                                            int rings = earthshine_flux_rings);

/// The objects of a scenario that have a shape or light of their own, for one sensor. The renderer
/// is loaded when the first of them is near enough to show it.
class ObjectShapes {
 public:
  /// `models`: of objects of catalogues.
  ObjectShapes(const std::vector<OwnObject>& objects, const Band& band,
               const EffectSet& effects = {}, const ObjectModels& models = {});

  bool empty() const { return shapes_.empty() && models_.empty(); }
  /// Whether one of them glints.
  bool have_glints() const;
  /// Null for an object without a shape.
  const ObjectShape* of(const ObjectInfo& object) const;
  /// Shape of an object of the scenario's own.
  const ObjectShape* of(std::uint32_t catalogue_number) const;
  const ObjectModels& models() const { return models_; }
  /// Light of an object of the scenario's own as it burns; null: it does not.
  const ReentryLight* reentry_of(std::uint32_t catalogue_number) const;

  /// Throws `Error` where there is no OpenGL.
  Renderer& renderer() const;
  /// Describes the renderer; empty before anything was drawn.
  std::string renderer_description() const;

  /// Photons/s/m2 of the Sun at 1 au in the band.
  double sun_photons() const { return sun_photons_; }

 private:
  std::map<std::uint32_t, ObjectShape> shapes_;      // for the scenario's own objects
  std::set<std::uint32_t> own_;                      // their numbers, also of those without a shape
  std::map<std::uint32_t, ReentryLight> reentries_;  // without a shape
  ObjectModels models_;
  std::map<const ObjectModel*, ObjectShape> of_models_;
  mutable std::unique_ptr<Renderer> renderer_;
  double sun_photons_ = 0.0;
};

/// States in `scene` what shapes there are; null: none.
void tell_shapes(SceneFacts& scene, const ObjectShapes* shapes);

/// Returns the pose at `t`; nothing for an object without an attitude then. With secondary
/// light, the Earth's in `rings`, unless they are 0.
std::optional<ShapePose> shape_pose(const View& view, std::size_t object, SimTime t,
                                    const Vec<Gcrs>& observer_m, int rings = earthshine_flux_rings);

/// Photons/s/m2 above the atmosphere at the observer, in the band: sunlight of which `sunlit`
/// reaches the object, secondary light, and what it emits.
double shape_photons_per_s_m2(const ObjectShapes& shapes, const ObjectShape& shape,
                              const ShapePose& pose, double sunlit);
/// Light of the facets alone, as pictures show them: without glints.
double facet_photons_per_s_m2(const ObjectShapes& shapes, const ObjectShape& shape,
                              const ShapePose& pose, double sunlit);

/// Returns the part of them that is light of Earth and Moon.
double secondary_photons_per_s_m2(const ObjectShapes& shapes, const ObjectShape& shape,
                                  const ShapePose& pose);

/// V magnitude of the reflected light when fully sunlit, with the pose's secondary light;
/// `darkest_mag` at most.
double shape_magnitude(const ObjectShape& shape, const ShapePose& pose);

/// Angle that the object turns by over a part of the exposure [rad], or its panel if that is more,
/// by their rates: whole turns count; 0 without an attitude.
double turn_rad(const View& view, std::size_t object, double begin = 0.0, double end = 1.0);

/// Angle in the object by which the bisector of Sun and observer turns over a part of the exposure
/// [rad]; 0 without an attitude.
double bisector_turn_rad(const View& view, std::size_t object, double begin, double end);

}  // namespace dmise
