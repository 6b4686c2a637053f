#pragma once
#include <string>

#include "bench/scene_dice.h"
#include "core/optics/camera.h"

namespace dmise {

/// A preset camera with a small detector of the same pixels, as a scenario's YAML.
struct CroppedCamera {
  std::string name;
  std::string yaml;  // the mapping, in one line
  double pixel_rad = 0.0, fwhm_px = 0.0;
  double read_noise_e = 0.0, dark_e_per_s = 0.0;
  double zero_e_per_s = 0.0;  // a star of V = 0, about
  bool diffraction = false;
};

/// Reads preset `name` and draws what it may have beside: vignetting, ghosts, more wavelengths.
CroppedCamera cropped_camera(const std::string& name, int side_px, SceneDice& dice);

}  // namespace dmise
