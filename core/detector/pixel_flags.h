#pragma once
#include <cstdint>

#include "core/base/image.h"

namespace dmise {

/// What befell a pixel; its flags are a sum of these. The bits are part of the file format.
enum PixelFlag : std::uint8_t {
  flag_full_well = 1,  // collected all that it holds
  flag_adc_high = 2,   // at the highest count of the ADC
  flag_bloomed = 4,    // charge of a full neighbour ran into it
  flag_hot = 8,        // on the sensor's list of hot pixels
  flag_cosmic_ray = 16,
  flag_reference = 32,  // of the border that sees no light
  flag_adc_low = 64,    // at count 0, where lower signals end up too
};

struct PixelFlagName {
  PixelFlag flag;
  const char* name;
};
inline constexpr PixelFlagName pixel_flag_names[] = {
    {flag_full_well, "full well"}, {flag_adc_high, "highest count"}, {flag_bloomed, "bloomed"},
    {flag_hot, "hot pixel"},       {flag_cosmic_ray, "cosmic ray"},  {flag_reference, "reference"},
    {flag_adc_low, "count 0"}};

/// A sum of `PixelFlag` for every pixel.
using FlagImage = Image<std::uint8_t, struct FlagCarrier>;

}  // namespace dmise
