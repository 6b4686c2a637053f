#include "core/ingest/frame_facts.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/base/version.h"
#include "core/frames/earth_orientation.h"
#include "core/ingest/exposure_times.h"
#include "core/ingest/site_cards.h"
#include "core/ingest/standard_wcs.h"
#include "core/sky/places/sun_moon.h"
#include "core/time/clock.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

constexpr double stand_in_exposure_s = 1.0, stand_in_focal_px = 1e4;

void set_names(const StandardCards& cards, const PlanePlace& place, FrameHeader& header) {
  const auto sensor = cards.first_text({"INSTRUME", "CAMERA", "DETECTOR", "TELESCOP"});
  header.sensor = sensor ? sensor->value : "unknown";
  if (!sensor) cards.missing("sensor: no INSTRUME, CAMERA, DETECTOR or TELESCOP");
  header.software = software_name();
  header.observation.object = cards.text("OBJECT");
  header.observation.telescope = cards.text("TELESCOP");
  header.frame = std::uint32_t(place.plane + 1);
  const double number = cards.number("FRAMENUM").value_or(0.0);
  if (place.planes == 1 && number >= 1 && number < 4e9) header.frame = std::uint32_t(number);
}

void set_times(const StandardCards& cards, const PlanePlace& place, FrameHeader& header) {
  ExposureTimes times = exposure_times(cards);
  if (place.plane > 0 && times.start) {
    if (const auto passed_s = seconds_to_plane(cards, place.plane)) {
      times.start = later(*times.start, *passed_s);
    } else {
      times.start.reset();
      cards.missing("time: of planes after the first: no third axis TIME, and no KCT");
    }
  }
  if (!times.exposure_s) header.unknown.add(FrameFact::exposure);
  header.exposure_s = times.exposure_s.value_or(stand_in_exposure_s);
  header.middle = sim_seconds(header.exposure_s / 2);
  header.end = sim_seconds(header.exposure_s);
  if (!times.start) {
    header.unknown.add(FrameFact::time);
    return;
  }
  // Digits that the header does not know are left out.
  const int decimals =
      times.width_s > 0 ? std::clamp(int(std::ceil(-std::log10(times.width_s))), 0, 9) : 9;
  header.start_utc = format_utc(*times.start, decimals);
  header.middle_utc = format_utc(later(*times.start, header.middle.seconds()), decimals);
  header.end_utc = format_utc(later(*times.start, header.end.seconds()), decimals);
}

void set_site(const StandardCards& cards, FrameHeader& header) {
  const auto site = site_of(cards);
  if (!header.unknown.has(FrameFact::time)) {
    const Clock clock(parse_utc(header.middle_utc));
    header.earth_velocity_m_per_s = solar_system(clock.tt({})).earth_velocity_m_per_s;
    if (site && !header.unknown.has(FrameFact::exposure)) {
      const EarthOrientation earth = earth_orientation(clock, {});
      SitePlace place{site->latitude_deg * deg, site->longitude_deg * deg, site->height_m,
                      itrs_from_geodetic(*site)};
      header.sensor_position_m = earth.itrs_from_gcrs({}).inverse() * place.position_m;
      header.sensor_velocity_m_per_s = earth.velocity_of_fixed_point(place.position_m, {});
      header.site = place;
      cards.assumed("site: UT1 is taken as UTC, up to 420 m; standard air refracts");
    }
  }
  if (header.site) return;
  header.unknown.add(FrameFact::site);
  if (site) cards.missing("site: where it was in space, without a time of mid exposure");
}

void set_photometry(const StandardCards& cards, FrameHeader& header) {
  header.band = {cards.text("FILTER"), 0.55e-6, 0.128e-6, {}};
  if (header.band.name.empty()) {
    header.unknown.add(FrameFact::band);
    cards.missing("band: no FILTER");
  }
  header.unknown.add(FrameFact::zero_point);
  header.unknown.add(FrameFact::extinction);
  cards.missing("zero point: no magnitudes; dmise solve finds it");
}

void set_pointing(const StandardCards& cards, int columns, int rows, FrameHeader& header) {
  if (const auto wcs = wcs_of(cards)) {
    if (const auto view = view_of(*wcs, columns, rows)) {
      cards.assumed("pointing: the WCS is taken as exact");
      header.wcs = *wcs;
      header.projection = wcs->projection;
      header.focal_length_px = view->focal_length_px;
      header.mirrored = view->mirrored;
      header.camera_from_gcrs.fill(quaternion_of(view->camera_from_gcrs));
      return;
    }
    cards.reject("CTYPE1", "pointing: the WCS images no sky in the middle of the frame");
  }
  header.unknown.add(FrameFact::pointing);
  const auto focal_mm = cards.number("FOCALLEN"), pixel_um = cards.number("XPIXSZ");
  const double focal_px = focal_mm && pixel_um && *pixel_um > 0 ? 1e3 * *focal_mm / *pixel_um : 0.0;
  if (focal_px > 1 && focal_px < longest_focal_px) {
    header.focal_length_px = focal_px;
    cards.assumed("focal length: FOCALLEN / XPIXSZ");
  } else {
    header.focal_length_px = stand_in_focal_px;
    header.unknown.add(FrameFact::focal_length);
    cards.missing("focal length: no FOCALLEN and XPIXSZ");
  }
  const double scale_deg = std::atan(1.0 / header.focal_length_px) / deg;
  header.wcs.crpix_x = (columns - 1) / 2.0;
  header.wcs.crpix_y = (rows - 1) / 2.0;
  header.wcs.cd_deg = {scale_deg, 0.0, 0.0, scale_deg};
}

/// Where the header says that it points, without a WCS.
void set_hint(const StandardCards& cards, FrameHeader& header) {
  for (const auto& [ra_key, dec_key] :
       {std::pair{"RA", "DEC"}, {"OBJCTRA", "OBJCTDEC"}, {"CRVAL1", "CRVAL2"}}) {
    const bool hours = cards.text(ra_key).find_first_of(" :hH") != std::string::npos;
    const auto ra = cards.angle_deg(ra_key, hours), dec = cards.angle_deg(dec_key, false);
    if (!ra || !dec || !(std::abs(*ra) <= 360 && std::abs(*dec) <= 90)) continue;
    header.observation.ra_rad = *ra * deg;
    header.observation.dec_rad = *dec * deg;
    return;
  }
}

}  // namespace

void set_facts(const StandardCards& cards, const PlanePlace& place, int columns, int rows,
               FrameHeader& header) {
  set_names(cards, place, header);
  set_times(cards, place, header);
  set_site(cards, header);
  set_photometry(cards, header);
  set_pointing(cards, columns, rows, header);
  set_hint(cards, header);
}

}  // namespace dmise
