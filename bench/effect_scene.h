#pragma once
#include <filesystem>
#include <string>

#include "sensors/accuracy/scene_frames.h"

namespace dmise {

/// Sine of the altitude of the Sun over a place, about, by its mean motion. Times are UTC.
double sine_of_sun_altitude(int month, int day, double hour, double longitude_deg,
                            double latitude_deg);

/// A scene that was drawn at random: its scenario and star catalogue are files.
struct EffectScene {
  int number = 0;
  std::string path;  // where the scenario is
  std::string what;  // one line
};

/// Writes scene `number` of `seed` to `directory`: one sensor named `eye` of 256 x 256 pixels, a
/// frame, on the ground or in orbit. The same arguments give the same scene.
EffectScene draw_effect_scene(std::uint64_t seed, int number,
                              const std::filesystem::path& directory, Threads& threads);

}  // namespace dmise
