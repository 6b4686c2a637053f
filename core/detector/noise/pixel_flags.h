#pragma once
#include <cstdint>

#include "core/base/image.h"

namespace dmise {

/// Conditions of a pixel, as a sum of bits. The bits are part of the file format.
enum PixelFlag : std::uint8_t {
  flag_full_well = 1,  // reached the full well
  flag_adc_high = 2,   // at the ADC's highest count
  flag_bloomed = 4,    // received charge of a full neighbour
  flag_hot = 8,        // on the sensor's list of hot pixels
  flag_cosmic_ray = 16,
  flag_reference = 32,  // in the border without light
  flag_adc_low = 64,    // at count 0, possibly clipped
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
