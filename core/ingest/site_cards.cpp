#include "core/ingest/site_cards.h"

#include <cmath>

namespace dmise {
namespace {

constexpr double lowest_m = -1000.0, highest_m = 100e3;

std::optional<Site> by_position(const StandardCards& cards) {
  const auto x = cards.number("OBSGEO-X"), y = cards.number("OBSGEO-Y"),
             z = cards.number("OBSGEO-Z");
  if (!x || !y || !z) return std::nullopt;
  const double radius_m = std::hypot(*x, *y, *z);
  if (!(radius_m > 6.3e6 && radius_m < 6.5e6)) {
    cards.reject("OBSGEO-X", "site: is not on the ground");
    return std::nullopt;
  }
  return geodetic_from_itrs({*x, *y, *z});
}

struct Keys {
  const char *latitude, *longitude, *height;
};

std::optional<Site> by_angles(const StandardCards& cards, const Keys& keys) {
  const auto latitude = cards.angle_deg(keys.latitude, false);
  const auto longitude = cards.angle_deg(keys.longitude, false);
  if (!latitude || !longitude) return std::nullopt;
  if (!(std::abs(*latitude) <= 90)) {
    cards.reject(keys.latitude, "site: must be in -90..90 deg");
    return std::nullopt;
  }
  if (!(*longitude >= -180 && *longitude <= 360)) {
    cards.reject(keys.longitude, "site: must be in -180..360 deg");
    return std::nullopt;
  }
  auto height_m = cards.number(keys.height);
  if (height_m && !(*height_m >= lowest_m && *height_m <= highest_m)) {
    cards.reject(keys.height, "site: must be in -1000..100000 m");
    height_m.reset();
  }
  if (!height_m) cards.assumed("site: its height is taken for 0 m");
  return Site{*latitude, *longitude, height_m.value_or(0.0)};
}

}  // namespace

std::optional<Site> site_of(const StandardCards& cards) {
  if (const auto site = by_position(cards)) return site;
  if (const auto site = by_angles(cards, {"OBSGEO-B", "OBSGEO-L", "OBSGEO-H"})) return site;
  for (const Keys& keys :
       {Keys{"SITELAT", "SITELONG", "SITEELEV"}, Keys{"LAT-OBS", "LONG-OBS", "ALT-OBS"},
        Keys{"OBS-LAT", "OBS-LONG", "OBS-ELEV"}, Keys{"SITELAT", "SITELON", "SITEELEV"},
        Keys{"OBSLAT", "OBSLONG", "OBSALT"}, Keys{"OBSLAT", "OBSLON", "OBSALT"},
        Keys{"LATITUDE", "LONGITUD", "ALTITUDE"}, Keys{"GEOLAT", "GEOLON", "GEOELEV"}})
    if (const auto site = by_angles(cards, keys)) {
      cards.assumed(std::string("site: ") + keys.longitude + " is taken as east positive");
      return site;
    }
  cards.missing(
      "site: no OBSGEO-X, OBSGEO-B, SITELAT, LAT-OBS, OBS-LAT, OBSLAT, LATITUDE or GEOLAT");
  return std::nullopt;
}

}  // namespace dmise
