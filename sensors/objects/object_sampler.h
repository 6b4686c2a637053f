#pragma once
#include <optional>
#include <vector>

#include "core/optics/blur/deposit.h"
#include "core/photometry/diffuse_sphere.h"
#include "core/sky/bodies/shadow.h"
#include "sensors/objects/object_shapes.h"
#include "sensors/scene/spectra.h"
#include "sensors/scene/throughput.h"
#include "sensors/scene/view.h"

namespace dmise {

/// An object at one time of the exposure.
struct ObjectSample {
  std::optional<PixelPosition> pixel;
  double electrons_per_s = 0.0;  // expected at the detector; 0 when dark or hidden
  double sunlit = 0.0;
  std::optional<SpectrumEnds> ends;      // with dispersion, where there is a pixel
  double electrons_per_photon_m2 = 0.0;  // from above the atmosphere; 0 when hidden
};

/// One instant of the exposure with everything that does not depend on the object.
struct ExposureInstant {
  SimTime time;
  ApparentPlaces places;
  Rotation<CameraFrame, Gcrs> camera;
  std::optional<EarthOccultation> earth;
  ObserverState observer;

  ExposureInstant(const View& view, SimTime t)
      : time(t),
        places(view.places(t)),
        camera(view.camera_from_gcrs(t)),
        earth(view.earth_occultation(t)),
        observer(view.observer(t)) {}
};

/// Computes where objects appear in one exposure, and how bright.
class ObjectSampler {
 public:
  ObjectSampler(const View& view, const ObjectShapes* shapes);

  /// Place and light of an object at an instant.
  ObjectSample sample(std::size_t object, const ExposureInstant& at) const;

  Illumination illumination(const Motion& motion, const Vec<Gcrs>& observer_m) const;

  /// Returns V above the atmosphere when fully lit by the Sun, which alone lights it.
  double magnitude(std::size_t object, const Motion& motion, const ExposureInstant& at) const;
  /// Magnitude with the light of Earth and Moon, where the effects are on: V of all light drawn.
  double magnitude_of_all_light(std::size_t object, const Motion& motion,
                                const ExposureInstant& at) const;

  /// Null where light is not spread along the vertical.
  const Spectra* spectra() const { return spectra_ ? &*spectra_ : nullptr; }

  /// Null for an object without a shape.
  const ObjectShape* shape(std::size_t object) const;
  /// Null for an object that has no light of its own at any height.
  const ReentryLight* reentry(std::size_t object) const;
  const ObjectShapes& shapes() const { return *shapes_; }

  /// Photons/s/m2 above the atmosphere of an object with a shape; without light of Earth and Moon,
  /// which changes slowly and costs much, if `rings` of the Earth's face are 0.
  double shape_photons(std::size_t object, const ObjectShape& shape, SimTime t,
                       const ObserverState& observer, double sunlit,
                       int rings = earthshine_flux_rings) const;

 private:
  /// What an object without a shape is, at a time.
  DiffuseSphere sphere(std::size_t object, SimTime t) const;
  /// Light of its own that an object sends to the observer, over that of magnitude 0.
  double reentry_light(std::size_t object, const Motion& motion, const ExposureInstant& at) const;
  double secondary_photons(std::size_t object, const Motion& motion,
                           const ExposureInstant& at) const;

  const View& view_;
  const ObjectShapes* shapes_;
  Throughput throughput_;
  std::optional<EarthShadow> shadow_;
  std::optional<Spectra> spectra_;
  bool with_secondary_;
  double zero_mag_;
};

/// Returns arcs through an odd number of samples at even times: each arc takes three.
std::vector<Arc> arcs_of(const std::vector<ObjectSample>& samples, double seconds);

/// Between two samples in the image; 1e9 where one has no place there.
double distance_px(const ObjectSample& a, const ObjectSample& b);

}  // namespace dmise
