#pragma once
#include <optional>

#include "core/frames/geodesy.h"
#include "core/ingest/standard_cards.h"

namespace dmise {

/// The site of a ground sensor: OBSGEO-X, -Y, -Z or OBSGEO-B, -L, -H (FITS Standard 4.0, section
/// 9.5), or SITELAT, SITELONG or SITELON, SITEELEV; LAT-OBS, LONG-OBS, ALT-OBS; OBS-LAT, OBS-LONG,
/// OBS-ELEV; OBSLAT, OBSLONG or OBSLON, OBSALT; LATITUDE, LONGITUD, ALTITUDE; GEOLAT, GEOLON,
/// GEOELEV. Longitudes are east positive, unless they end with W. Empty if the header does not say
/// it, which is noted.
std::optional<Site> site_of(const StandardCards& cards);

}  // namespace dmise
