#pragma once
#include <optional>

#include "core/ingest/standard_cards.h"
#include "core/time/julian_date.h"

namespace dmise {

/// When a frame was exposed, as far as its header says.
struct ExposureTimes {
  std::optional<Utc> start;
  std::optional<double> exposure_s;  // > 0
  // Unit of the last digit that tells the start; 0: it is known as well as its text says.
  double width_s = 0.0;
};

/// EXPTIME, EXPOSURE or XPOSURE; DATE-BEG, -AVG, -OBS or -END with a date and time of day, or
/// MJD-BEG, -AVG, -OBS, -END, in the time scale TIMESYS (FITS Standard 4.0, section 9). The time of
/// day may stand in a card of its own (TIME-OBS, UT, TAIHMS, ..) and have an offset to UTC; the
/// date may be DD/MM/YY. DATE-OBS and MJD-OBS are taken for the start, which is noted.
ExposureTimes exposure_times(const StandardCards& cards);

/// Time from the start of a cube's first plane to that of another, from 0 [s]: by a third axis
/// TIME, or by KCT, the kinetic cycle time of Andor's cameras. Empty if the header does not say it.
std::optional<double> seconds_to_plane(const StandardCards& cards, int plane);

/// `by_s` later.
Utc later(const Utc& time, double by_s);

}  // namespace dmise
