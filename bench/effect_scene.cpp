#include "bench/effect_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "bench/cropped_camera.h"
#include "bench/scene_dice.h"
#include "core/base/units.h"
#include "core/frames/oblate_earth.h"
#include "core/optics/projection.h"

namespace dmise {
namespace {

constexpr int side_px = 256;
constexpr double longest_trail_px = 300.0;
constexpr double sky_turns_rad_per_s = 7.292e-5;
constexpr double fastest_object_m_per_s = 12e3;
constexpr double usual_size_m = 10.0;  // size of the model of a satellite with wings

template <class... Parts>
std::string text_of(const Parts&... parts) {
  std::ostringstream text;
  text.precision(15);
  (text << ... << parts);
  return text.str();
}

template <class F>
std::string list_of(const Vec<F>& v) {
  return text_of("[", v.x, ", ", v.y, ", ", v.z, "]");
}

/// What is drawn of a scene before its sources.
struct Frame {
  SceneDice dice;
  bool on_ground, tracks_object;
  CroppedCamera camera;
  double trail_px;  // trail of stars, on the ground, or of those behind a tracked object
  double exposure_s, tick_s, duration_s;
  std::string start, place, pointing, sky, rest;

  double middle_s() const { return 0.5 + 0.5 * exposure_s; }
};

/// A time of day and year at which a place has night, more often than not.
std::string draw_start(SceneDice& dice, double longitude_deg, double latitude_deg, bool& day) {
  int year = 2020, month = 1, day_of_month = 1;
  double hour = 0.0;
  for (int tries = 0; tries < 5; ++tries) {
    year = 2012 + dice.below(13), month = 1 + dice.below(12), day_of_month = 1 + dice.below(28);
    hour = dice.uniform(0.0, 24.0);
    day = sine_of_sun_altitude(month, day_of_month, hour, longitude_deg, latitude_deg) > 0.0;
    if (!day || dice.chance(0.25)) break;
  }
  char text[96];
  std::snprintf(text, sizeof text, "%04d-%02d-%02dT%02d:%02d:%02dZ", year, month, day_of_month,
                int(hour), int(hour * 60.0) % 60, int(hour * 3600.0) % 60);
  return text;
}

void draw_ground(Frame& f) {
  auto& dice = f.dice;
  const double latitude = dice.uniform(-65.0, 65.0), longitude = dice.uniform(-180.0, 180.0);
  bool day = false;
  f.start = draw_start(dice, longitude, latitude, day);
  f.place = text_of("site: {latitude_deg: ", latitude, ", longitude_deg: ", longitude,
                    ", height_m: ", dice.uniform(0.0, 4000.0), "}");
  const double airmass = 1.0 + 4.0 * std::pow(dice.uniform(), 2.0);
  const bool fixed = dice.chance(0.5);
  if (f.tracks_object || !fixed) {
    f.exposure_s = dice.log_uniform(0.01, 30.0);
    if (!f.tracks_object) f.trail_px = 0.0;
  } else {
    if (f.trail_px == 0.0) f.trail_px = dice.log_uniform(0.01, 3.0);
    f.exposure_s = f.trail_px * f.camera.pixel_rad / sky_turns_rad_per_s / 0.7;
  }
  f.exposure_s = std::clamp(f.exposure_s, 1e-3, day ? 0.1 : 60.0);
  f.pointing = text_of("azimuth_deg: ", dice.uniform(0.0, 360.0),
                       ", elevation_deg: ", std::asin(1.0 / airmass) / deg,
                       ", tracking: ", fixed ? "fixed" : "sidereal");
  static constexpr const char* skies[] = {"dark", "dark", "suburban", "urban"};
  f.sky = skies[dice.below(4)];
  f.rest = text_of(", atmosphere: {extinction: ", dice.uniform(0.08, 0.5), "}");
  if (dice.chance(0.1)) f.rest += text_of(", weather: {clouds: ", dice.uniform(0.2, 1.0), "}");
  if (dice.chance(0.1))
    f.rest += text_of(", weather: {clouds: {cover: ", dice.uniform(0.1, 0.9),
                      ", patch_m: ", dice.log_uniform(100.0, 3e4), "}}");
  if (f.rest.find("weather") != f.rest.rfind("weather")) f.rest.resize(f.rest.rfind(", weather"));
  if (f.camera.diffraction && dice.chance(0.7)) {
    const double r0_m = dice.log_uniform(0.08, 0.3), wind = dice.uniform(2.0, 40.0);
    f.rest += text_of(", seeing: {r0_m: ", r0_m, ", wind_m_per_s: ", wind, "}");
    f.camera.fwhm_px = std::hypot(f.camera.fwhm_px, 0.55e-6 / r0_m / f.camera.pixel_rad);
  }
}

void draw_orbit(Frame& f) {
  auto& dice = f.dice;
  bool ignored = false;
  f.start = draw_start(dice, dice.uniform(-180.0, 180.0), 0.0, ignored);
  const double radius_m = 6378137.0 + (dice.chance(0.7) ? dice.log_uniform(4e5, 2e6) : 35786000.0);
  const auto up = dice.direction<Gcrs>();
  const auto along = unit(cross(up, dice.direction<Gcrs>()));
  const double speed = std::sqrt(3.986004418e14 / radius_m);
  f.place = text_of("platform: carrier");
  f.rest = text_of("  - {name: carrier, motion: {two_body: {position_m: ", list_of(up * radius_m),
                   ", velocity_m_per_s: ", list_of(along * speed), "}}}\n");
  auto boresight = dice.direction<Gcrs>();
  // Mostly past the Earth.
  for (int i = 0; i < 20 && dot(boresight, up) < -0.2; ++i) boresight = dice.direction<Gcrs>();
  const auto [ra, dec] = to_spherical(boresight);
  f.pointing = text_of("ra_deg: ", ra / deg, ", dec_deg: ", dec / deg);
  f.exposure_s = dice.log_uniform(0.02, 10.0);
  if (!f.tracks_object) f.trail_px = 0.0;
  f.sky = "space";
}

Frame draw_frame(std::uint64_t seed, int number) {
  static constexpr const char* ground[] = {"omnissa",      "omnissa-swir", "geo-watch",
                                           "gt-sort",      "raven",        "sst",
                                           "telescope-3m", "telescope-3m", "wide-field-cmos"};
  static constexpr const char* orbit[] = {"hawaii-4rg", "hawaii-4rg-10um", "wide-field-cmos"};
  SceneDice dice(seed, std::uint32_t(number));
  const bool on_ground = dice.chance(0.7);
  const char* name = on_ground ? ground[dice.below(9)] : orbit[dice.below(3)];
  const auto camera = cropped_camera(name, side_px, dice);
  Frame f{.dice = dice, .on_ground = on_ground, .tracks_object = false, .camera = camera};
  f.tracks_object = f.dice.chance(0.25);
  f.trail_px = f.dice.chance(0.35) ? 0.0 : f.dice.uniform(0.0, longest_trail_px);
  on_ground ? draw_ground(f) : draw_orbit(f);
  f.tick_s = f.exposure_s > 10.0 ? 5.0 : 1.0;
  f.duration_s = f.tick_s * std::ceil((f.exposure_s + 0.6) / f.tick_s);
  return f;
}

/// Electrons of a source with a signal to noise ratio.
double signal_e(const Frame& f, double snr, double sky_e) {
  const double spread_px = 2.3 * f.camera.fwhm_px * f.camera.fwhm_px + f.camera.fwhm_px;
  const double noise2 = spread_px * (sky_e + f.camera.dark_e_per_s * f.exposure_s +
                                     f.camera.read_noise_e * f.camera.read_noise_e);
  return 0.5 * (snr * snr + std::sqrt(std::pow(snr, 4.0) + 4.0 * snr * snr * noise2));
}

double magnitude(const Frame& f, double electrons) {
  return -2.5 * std::log10(electrons / (f.camera.zero_e_per_s * f.exposure_s));
}

/// About the sky's electrons in a pixel at night.
double sky_e(const Frame& f) {
  const double mag = f.sky == "urban" ? 18.0 : f.sky == "suburban" ? 20.0 : 21.7;
  const double side_arcsec = f.camera.pixel_rad / arcsec;
  return std::pow(10.0, -0.4 * mag) * side_arcsec * side_arcsec * f.camera.zero_e_per_s *
         f.exposure_s;
}

std::string scenario_text(const Frame& f, const std::string& objects, bool stars, double faintest,
                          bool tracks) {
  std::string text = text_of("simulation: {start: ", f.start, ", duration_s: ", f.duration_s,
                             ", tick_s: ", f.tick_s, ", seed: 1}\n");
  const std::string all = (f.on_ground ? "" : f.rest) + objects;
  if (!all.empty()) text += "objects:\n" + all;
  if (stars) text += text_of("stars: {catalogue: stars.csv, faintest_mag: ", faintest, "}\n");
  text += "detection: off\nsensors:\n  - name: eye\n    " + f.place +
          "\n    camera: " + f.camera.yaml + "\n    pointing: {" +
          (tracks ? std::string("target: object-0") : f.pointing) + "}\n    sky: " + f.sky + "\n";
  text += text_of("    exposure_s: ", f.exposure_s, "\n    cadence_s: ", f.duration_s,
                  "\n    first_exposure_s: 0.5\n");
  if (f.on_ground) {
    // ", key: value" of the mapping becomes lines.
    std::string rest = f.rest;
    for (const char* key : {", atmosphere", ", weather", ", seeing"})
      if (const auto at = rest.find(key); at != std::string::npos) rest.replace(at, 2, "\n    ");
    text += rest.substr(rest.find_first_not_of('\n')) + "\n";
  }
  return text;
}

/// An object of the scenario that crosses the field, on a straight path; nothing where the field
/// shows the ground alone.
std::string draw_object(Frame& f, const View& view, int index) {
  auto& dice = f.dice;
  const bool shaped = dice.chance(0.25), centred = f.tracks_object && index == 0;
  const double size_px = shaped ? dice.log_uniform(0.3, 50.0) : 0.0;
  double wanted_px = centred            ? f.trail_px
                     : dice.chance(0.2) ? 0.0
                                        : dice.uniform(0.0, longest_trail_px);
  const double min_m = f.on_ground ? 2e5 : 1e3, max_m = f.on_ground ? 4e7 : 4e6;
  double range_m = dice.log_uniform(min_m, max_m);
  if (shaped)
    range_m = std::clamp(dice.uniform(1.0, 60.0) / (size_px * f.camera.pixel_rad), 200.0, max_m);
  const double turn = dice.uniform(0.0, 2.0 * pi), centre = 0.5 * (side_px - 1.0);
  const PixelPosition middle{centred ? centre : dice.uniform(20.0, side_px - 20.0),
                             centred ? centre : dice.uniform(20.0, side_px - 20.0)};
  const FrameTimes& t = view.times();
  std::array<Vec<Gcrs>, 3> position_m;
  Vec<Gcrs> velocity, start_m;
  const std::array<SimTime, 3> moments{t.start, t.middle, t.end};
  const auto lay_path = [&] {
    const double trail_px =
        std::min(wanted_px, fastest_object_m_per_s * f.exposure_s / (range_m * f.camera.pixel_rad));
    for (int pass = 0; pass < 5; ++pass) {
      for (std::size_t k = 0; k < 3; ++k) {
        const double along = 0.5 * (double(k) - 1.0) * trail_px;
        const PixelPosition at{middle.x_px + along * std::cos(turn),
                               middle.y_px + along * std::sin(turn)};
        const auto seen = view.camera_from_gcrs(moments[k]).inverse() *
                          *unproject(view.sensor().camera.optics, at);
        const auto observer_m = view.observer(moments[k]).position_m;
        if (pass == 0) position_m[k] = observer_m + seen * range_m;
        const auto place = view.places(moments[k]).satellite(position_m[k], velocity);
        const auto line = unit(position_m[k] - observer_m) + (seen - place.direction);
        position_m[k] = observer_m + unit(line) * range_m;
      }
      velocity = (position_m[2] - position_m[0]) / f.exposure_s;
    }
    start_m = position_m[1] - velocity * f.middle_s();
  };
  const auto is_free = [&] {
    constexpr double min_height_m = 100.0;
    const auto above = [](const Vec<Gcrs>& position_m) {
      return norm(OblateEarth{}.stretched(position_m)) > wgs84.equatorial_radius_m + min_height_m;
    };
    return above(start_m) && above(start_m + velocity * f.duration_s);
  };
  lay_path();
  // Nearer where the line of sight meets the Earth, at last at rest.
  for (; range_m > 300.0 && !is_free(); lay_path()) range_m *= 0.5;
  if (!is_free()) {
    wanted_px = 0.0;
    lay_path();
  }
  if (!is_free()) return "";
  std::string text =
      text_of("  - name: object-", index,
              "\n    motion: {two_body: {gm_m3_per_s2: 1, position_m: ", list_of(start_m),
              ", velocity_m_per_s: ", list_of(velocity), "}}\n");
  if (shaped) {
    const double scale = size_px * f.camera.pixel_rad * range_m / usual_size_m;
    text += text_of("    geometry: {model: box-wing, scale: ", scale, "}\n    attitude: ");
    if (dice.chance(0.5))
      text += "sun_tracking\n";
    else
      text += text_of("{spinning: {axis: ", list_of(dice.direction<Body>()),
                      ", rate_rpm: ", dice.log_uniform(0.01, 3.0), "}}\n");
  } else {
    const double v_mag = magnitude(f, signal_e(f, dice.log_uniform(2.0, 3000.0), sky_e(f)));
    const double share = std::pow(10.0, -0.4 * (v_mag + 26.74));
    text +=
        text_of("    radius_m: ", std::clamp(range_m * std::sqrt(share / 0.04), 1e-3, 1e3), "\n");
  }
  return text;
}

/// Stars in and around the field, also where they will not be seen; returns the faintest's V.
double draw_stars(Frame& f, const View& view, const std::filesystem::path& path) {
  auto& dice = f.dice;
  std::ofstream file(path);
  file.precision(15);
  file << "ra_deg,dec_deg,mag_v,id,bv,pm_ra_mas_per_yr,pm_dec_mas_per_yr,parallax_mas\n";
  const int count = int(dice.log_uniform(1.0, 40.0));
  const ApparentPlaces places = view.places(view.times().middle);
  double faintest = -2.0;
  const double years = std::stod(f.start.substr(0, 4)) + 0.5 - 2000.0;
  for (int i = 0; i < count; ++i) {
    const PixelPosition at{dice.uniform(-20.0, side_px + 20.0),
                           dice.uniform(-20.0, side_px + 20.0)};
    const auto seen = view.camera_from_gcrs(view.times().middle).inverse() *
                      *unproject(view.sensor().camera.optics, at);
    const auto [ra, dec] = to_spherical(places.star_seen_at(seen));
    const double v_mag =
        std::clamp(magnitude(f, signal_e(f, dice.log_uniform(0.05, 3000.0), sky_e(f))), -1.4, 28.0);
    faintest = std::max(faintest, v_mag);
    const double spread = dice.log_uniform(1.0, 1000.0), turn = dice.uniform(0.0, 2.0 * pi);
    const double east = spread * std::cos(turn), north = spread * std::sin(turn);
    file << (ra - east * mas * years / std::max(0.01, std::cos(dec))) / deg << ','
         << (dec - north * mas * years) / deg << ',' << v_mag << ',' << i + 1 << ','
         << dice.uniform(-0.2, 1.8) << ',' << east << ',' << north << ','
         << dice.log_uniform(0.1, 100.0) << '\n';
  }
  return faintest + 0.01;
}

}  // namespace

double sine_of_sun_altitude(int month, int day, double hour, double longitude_deg,
                            double latitude_deg) {
  const double season = 2.0 * pi * ((month - 1) * 30.4 + day + 10.0) / 365.0;
  const double declination = -23.44 * deg * std::cos(season);
  const double angle = ((hour - 12.0) * 15.0 + longitude_deg) * deg, at = latitude_deg * deg;
  return std::sin(at) * std::sin(declination) +
         std::cos(at) * std::cos(declination) * std::cos(angle);
}

EffectScene draw_effect_scene(std::uint64_t seed, int number,
                              const std::filesystem::path& directory, Threads& threads) {
  std::filesystem::create_directories(directory);
  const std::string path = (directory / "scene.yaml").string();
  Frame f = draw_frame(seed, number);
  std::ofstream(path) << scenario_text(f, "", false, 0.0, false);
  std::string objects;
  double faintest = 0.0;
  int count = 0;
  {
    const Scenario empty = load_scenario(path);
    const SceneFrames frames(empty, "eye", 1, threads);
    const View view(frames.sensor(), frames.times(), frames.states());
    count = std::max(int(f.tracks_object), f.dice.below(4));
    for (int i = 0; i < count; ++i) objects += draw_object(f, view, i);
    faintest = draw_stars(f, view, directory / "stars.csv");
  }
  std::ofstream(path) << scenario_text(f, objects, true, faintest, f.tracks_object);
  char what[200];
  std::snprintf(what, sizeof what, "%s %s, %.3g s, stars trail %.0f px%s, %d objects",
                f.on_ground ? "ground" : "orbit", f.camera.name.c_str(), f.exposure_s, f.trail_px,
                f.tracks_object ? " (tracks an object)" : "", count);
  return {number, path, what};
}

}  // namespace dmise
