#pragma once
#include <vector>

#include "core/detection/pixels/components.h"
#include "core/detection/source/scene.h"

namespace dmise {

/// Returns components that may be stars from which the PSF is measured: bright, of a star's extent
/// and whole in the frame; spread over the frame, by falling brightness in each part of it.
std::vector<const Component*> psf_candidates(const Scene& scene,
                                             const std::vector<Component>& components);

/// Where components are, to find those near a place.
class ComponentMap {
 public:
  ComponentMap(const std::vector<Component>& components, int columns, int rows);

  /// Pixels within `reach_px` of a trail that are usable and not of a component other than `own`,
  /// nor next to one; of `every` pixels in x and y one.
  std::vector<FitPixel> pixels_around(const Scene& scene, const Trail& trail, double reach_px,
                                      const Component& own, int every) const;
  /// Whether another component is within `reach_px` of a trail.
  bool is_alone(const Trail& trail, double reach_px, const Component& own) const;

 private:
  struct Box {
    int x0, y0, x1, y1;
  };
  static constexpr int cell_px = 64;
  static Box box_around(const Trail& trail, double reach_px);
  /// Calls `visit` for each other component whose rectangle meets the box.
  template <class Visit>
  void for_others(const Box& box, const Component& own, const Visit& visit) const;

  int columns_, rows_;  // size of the mesh of cells
  std::vector<std::vector<const Component*>> cells_;
};

}  // namespace dmise
