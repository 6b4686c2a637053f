#include "core/astrometry/solve_frame.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <random>

#include "core/base/error.h"
#include "core/base/numeric/quantile.h"
#include "core/detection/detect.h"
#include "core/frames/quaternion.h"
#include "core/products/unknown_fields.h"
#include "core/sky/air/airmass.h"
#include "core/sky/stars/star_cache.h"
#include "core/time/clock.h"
#include "core/time/iso8601.h"
#include "core/wcs/wcs.h"
#include "tests/support/data.h"
#include "tests/support/simulated_frame.h"

namespace dmise {
namespace {

constexpr int columns = 1400, rows = 1200;
constexpr double zero_point_mag = 19.0, colour_term = 0.1;

const StarMap& stars() {
  static const StarMap map = load_star_map(test::catalogue_path("stars.dat.gz"));
  return map;
}

struct DrawnFrame {
  Frame frame;
  PlateModel truth;
  std::vector<std::pair<PixelPosition, Vec<Gcrs>>> catalogued;  // pixel, direction in ICRS at J2000
};

/// The catalogue's stars in space, drawn one by one by brute force.
DrawnFrame draw(
    double width_deg, const Vec<Gcrs>& axis, unsigned seed,
    const std::function<void(ExpectedElectronImage&, PixelPosition, double)>& add = {}) {
  DrawnFrame d;
  FrameHeader h = simulated::camera_header(
      columns, rows, 0.5 * columns / std::tan(width_deg / 2 * deg), 0.4, 4, false);
  h.zero_point_mag = 0.0;  // not known
  h.sensor_position_m = {7e6, 0, 0};
  h.sensor_velocity_m_per_s = {0, 7.5e3, 0};
  const Vec<Gcrs> x = unit(cross(Vec<Gcrs>{0.1, 0.2, 1}, axis)), y = cross(axis, x);
  d.truth = {.projection = Projection::gnomonic,
             .camera_from_gcrs = {{{{x.x, x.y, x.z}, {y.x, y.y, y.z}, {axis.x, axis.y, axis.z}}}},
             .focal_length_px = h.focal_length_px,
             .centre = {(columns - 1) / 2.0, (rows - 1) / 2.0},
             .unit_px = 900};
  const Tt tt = Clock(parse_utc(h.middle_utc)).tt({});
  const PlateSky sky(stars(), space_observer(h.sensor_position_m, h.sensor_velocity_m_per_s, tt,
                                             solar_system(tt)));
  simulated::SimulatedFrame frame(h, columns, rows, 100, seed);
  for (const SeenStar& s : sky.brightest(axis, width_deg * deg, 4000)) {
    const auto at = d.truth.pixel(s.direction);
    if (!at || at->x_px < -3 || at->y_px < -3 || at->x_px > columns + 2 || at->y_px > rows + 2)
      continue;
    const double mag = s.v_mag - colour_term * (s.bv - ZeroPoint::sunlike_bv);
    const double flux_e = h.exposure_s * std::pow(10, -0.4 * (mag - zero_point_mag));
    if (add)
      add(frame.expected(), *at, flux_e);
    else
      frame.add_point(at->x_px, at->y_px, flux_e);
    d.catalogued.emplace_back(*at, sky.places().star_seen_at(s.direction));
  }
  d.frame = {frame.expose(), h};
  return d;
}

void believe(DrawnFrame& d, const Vec<CameraFrame>& wrong_rad) {
  for (Quaternion& q : d.frame.header.camera_from_gcrs)
    q = quaternion_of(turned(d.truth.camera_from_gcrs, wrong_rad));
}

// Pointing wrong by 2 deg and roll by 5: at least 200 stars with a residual within 0.03 px, and the
// WCS maps the catalogue's directions to the pixels where stars were drawn to 0.01 px.
TEST(SolveFrame, MeasuresPlateWcsAndZeroPoint) {
  DrawnFrame d = draw(14, unit(Vec<Gcrs>{0.2, 0.9, 0.3}), 1);
  believe(d, {1.4 * deg, -1.4 * deg, 5 * deg});
  Threads one(1);
  for (const bool blind : {false, true}) {
    const FrameSolution s = solve_frame(d.frame, stars(), {.blind = blind}, one);
    EXPECT_GE(s.plate.fit.count, 200);
    EXPECT_LE(s.plate.fit.rms_px, 0.03);
    double sum = 0.0;
    for (const auto& [pixel, direction] : d.catalogued) {
      const auto at = wcs_pixel(s.wcs, direction);
      ASSERT_TRUE(at);
      sum += std::pow(at->x_px - pixel.x_px, 2) + std::pow(at->y_px - pixel.y_px, 2);
    }
    EXPECT_LT(std::sqrt(sum / double(d.catalogued.size())), 0.01);
    ASSERT_TRUE(s.zero_point);
    EXPECT_NEAR(s.zero_point->zero_point_mag, zero_point_mag, 0.01);
    EXPECT_NEAR(s.zero_point->colour_term, colour_term, 0.01);
    EXPECT_FALSE(s.zero_point->extinction_fitted);
  }
}

/// Light of a point by the square of the distance from it [px], 1 at the centre.
using Profile = std::function<double(double)>;

Profile moffat(double beta, double fwhm_px) {
  const double alpha_px = fwhm_px / (2 * std::sqrt(std::pow(2.0, 1 / beta) - 1));
  return [=](double r2) { return std::pow(1 + r2 / (alpha_px * alpha_px), -beta); };
}

/// Long exposures: the transform of exp(-3.44 (lambda nu / r0)^(5/3)), Fried 1966, by quadrature.
Profile kolmogorov(double fwhm_px) {
  const double r0_px = fwhm_px / 0.976;  // lambda / r0
  const auto value = [&](double r) {
    double sum = 0.0;
    const double step = 0.002 / r0_px;
    for (double nu = step / 2; r0_px * nu < 3.5; nu += step)
      sum += std::exp(-3.44 * std::pow(r0_px * nu, 5.0 / 3)) *
             std::cyl_bessel_j(0.0, 2 * pi * nu * r) * nu;
    return sum;
  };
  std::vector<double> table;  // by 0.1 px
  for (int k = 0; k <= 420; ++k) table.push_back(value(0.1 * k) / value(0.0));
  return [table](double r2) {
    const double at = 10 * std::sqrt(r2);
    const auto k = std::min(std::size_t(at), table.size() - 2);
    return table[k] + (at - double(k)) * (table[k + 1] - table[k]);
  };
}

/// Light of `flux_e` in all within 25 px: a line of points along a trail, or with coma beside the
/// centre; pixels near the centre are summed over 5 x 5 places.
class Stamp {
 public:
  Stamp(const Profile& profile, PixelPosition trail, double coma_px)
      : profile_(profile), trail_(trail), coma_px_(coma_px) {}

  void add(ExpectedElectronImage& image, PixelPosition at, double flux_e) const {
    const int x0 = int(std::lround(at.x_px)), y0 = int(std::lround(at.y_px));
    std::vector<double> light;
    double sum = 0.0;
    for (int y = y0 - reach_px; y <= y0 + reach_px; ++y)
      for (int x = x0 - reach_px; x <= x0 + reach_px; ++x) {
        light.push_back(pixel(x - at.x_px, y - at.y_px));
        sum += light.back();
      }
    std::size_t k = 0;
    for (int y = y0 - reach_px; y <= y0 + reach_px; ++y)
      for (int x = x0 - reach_px; x <= x0 + reach_px; ++x, ++k)
        if (x >= 0 && y >= 0 && x < image.columns && y < image.rows)
          image.at(x, y) += float(flux_e * light[k] / sum);
  }

 private:
  static constexpr int reach_px = 25;

  double pixel(double dx, double dy) const {
    const int places = dx * dx + dy * dy < 64 ? 5 : 1;
    double sum = 0.0;
    for (int j = 0; j < places; ++j)
      for (int i = 0; i < places; ++i)
        sum += value(dx + (i + 0.5) / places - 0.5, dy + (j + 0.5) / places - 0.5);
    return sum / (places * places);
  }
  double value(double x, double y) const {
    const int points = trail_.x_px != 0 || trail_.y_px != 0 ? 9 : 1;
    double sum = 0.0;
    for (int k = 0; k < points; ++k) {
      const double r = (k + 0.5) / points - 0.5;
      const double px = x - r * trail_.x_px, py = y - r * trail_.y_px;
      sum += profile_(px * px + py * py);
      if (coma_px_ > 0) sum += 0.25 * profile_((std::pow(px - coma_px_, 2) + py * py) / 2.25);
    }
    return sum / points;
  }

  const Profile& profile_;
  PixelPosition trail_;
  double coma_px_;
};

// A Gaussian misses 8 to 19 % of the light of such stars. The stars drawn have all their light
// within 25 px, so that the zero point and a detection's magnitude are those of all of it.
TEST(SolveFrame, ZeroPointsOfStarsWithWingsAreOfAllTheirLight) {
  struct Case {
    const char* name;
    Profile profile;
    double coma_px = 0.0;
    PixelPosition trail{};
  };
  Threads one(1);
  unsigned seed = 20;
  constexpr double object_e = 2e4;
  for (const Case& c :
       {Case{"Moffat 2.5", moffat(2.5, 2.2)}, Case{"Moffat 3.5", moffat(3.5, 2.2)},
        Case{"Moffat 4.5", moffat(4.5, 2.2)}, Case{"Kolmogorov", kolmogorov(2.2)},
        Case{"coma", moffat(3.5, 2.0), 1.2}, Case{"trail", moffat(3.5, 2.2), 0.0, {6.0, 0.0}}}) {
    const Stamp stamp(c.profile, c.trail, c.coma_px), point(c.profile, {}, c.coma_px);
    std::vector<PixelPosition> objects;  // that are points among trails
    DrawnFrame d = draw(14, unit(Vec<Gcrs>{0.2, 0.9, 0.3}), ++seed,
                        [&](ExpectedElectronImage& image, PixelPosition at, double flux_e) {
                          if (objects.empty() && c.trail.x_px > 0)
                            for (int i = 0; i < 30; ++i) {
                              objects.push_back({130.3 + 230 * (i % 6), 140.7 + 230 * (i / 6)});
                              point.add(image, objects.back(), object_e);
                            }
                          stamp.add(image, at, flux_e);
                        });
    believe(d, {1.4 * deg, -1.4 * deg, 0.0});
    for (const std::size_t end : {std::size_t{0}, std::size_t{2}}) {
      Quaternion& q = d.frame.header.camera_from_gcrs[end];
      const double turn_rad = (double(end) - 1) * 0.5 * c.trail.x_px / d.truth.focal_length_px;
      q = quaternion_of(turned(rotation_of<CameraFrame, Gcrs>(q), {0.0, turn_rad, 0.0}));
    }
    const FrameSolution s = solve_frame(d.frame, stars(), {}, one);
    ASSERT_TRUE(s.zero_point) << c.name;
    EXPECT_NEAR(s.zero_point->zero_point_mag, zero_point_mag, 0.02) << c.name;
    EXPECT_LT(std::abs(s.zero_point->zero_point_mag - zero_point_mag), 3 * s.zero_point->sigma(0))
        << c.name;
    EXPECT_LT(s.zero_point->sigma(0), 0.02) << c.name;
    std::printf("%s: zero point %+.3f +- %.3f mag\n", c.name,
                s.zero_point->zero_point_mag - zero_point_mag, s.zero_point->sigma(0));
    if (objects.empty()) continue;
    std::vector<double> off_mag;
    const double true_mag = zero_point_mag - 2.5 * std::log10(object_e / d.frame.header.exposure_s);
    for (const Detection& found :
         detect(d.frame.counts, solved_header(d.frame.header, s), nullptr, one).detections)
      for (const PixelPosition& at : objects)
        if (std::hypot(found.x_px - at.x_px, found.y_px - at.y_px) < 1.5)
          off_mag.push_back(found.magnitude - true_mag);
    ASSERT_GT(off_mag.size(), 20u) << c.name;
    EXPECT_NEAR(median_of(off_mag), 0.0, 0.03) << c.name;
  }
}

TEST(SolveFrame, TheSolvedHeaderIsReadBackAndNeedsNoHint) {
  DrawnFrame d = draw(20, unit(Vec<Gcrs>{-0.5, 0.1, 0.8}), 2);
  believe(d, {-1 * deg, -1.5 * deg, -5 * deg});
  Threads one(1);
  const FrameSolution s = solve_frame(d.frame, stars(), {}, one);
  const std::string bytes = encode_frame(d.frame.counts, solved_header(d.frame.header, s));
  const Frame back = decode_frame(bytes, "solved.fits");
  EXPECT_EQ(back.counts.pixels, d.frame.counts.pixels);
  const auto by = rotation_of<CameraFrame, Gcrs>(back.header.camera_from_gcrs[1]) *
                  d.truth.camera_from_gcrs.inverse();
  EXPECT_LT(std::hypot(by.m[0][1], by.m[0][2], by.m[1][2]) * d.truth.focal_length_px, 0.1);
  EXPECT_NEAR(back.header.zero_point_mag, zero_point_mag, 0.01);
  EXPECT_TRUE(to_json(s, d.frame.header).find("\"matched\":") != std::string::npos);
}

// RA and DEC 1.5 deg beside the frame's centre, of any roll: fewer candidates than in the whole
// sky. A target elsewhere costs time, not the solution.
TEST(SolveFrame, StartsFromADirectionWithoutARoll) {
  const Vec<Gcrs> axis = unit(Vec<Gcrs>{0.2, 0.9, 0.3});
  DrawnFrame d = draw(14, axis, 1);
  FrameHeader& h = d.frame.header;
  h.unknown.add(FrameFact::pointing);
  h.camera_from_gcrs.fill({});
  Threads one(1);
  const FrameSolution whole = solve_frame(d.frame, stars(), {}, one);
  const auto [ra_rad, dec_rad] = to_spherical(axis);
  for (const double off_rad : {1.5 * deg, 40 * deg})
    for (const bool elsewhere : {false, true}) {
      h.observation.ra_rad = ra_rad;
      h.observation.dec_rad = dec_rad + off_rad;
      if (off_rad > 5 * deg && !elsewhere) {
        EXPECT_THROW(solve_frame(d.frame, stars(), {.elsewhere = elsewhere}, one), Error);
        continue;
      }
      const FrameSolution s = solve_frame(d.frame, stars(), {.elsewhere = elsewhere}, one);
      EXPECT_LE(s.plate.fit.rms_px, 0.03);
      EXPECT_LT(angle_rad(s.plate.fit.model.axis(), axis), arcsec);
      if (off_rad < 5 * deg) {
        EXPECT_LE(s.plate.tried, whole.plate.tried);
      }
    }
}

/// The sky above a site by a fisheye lens of 150 deg, whose pixels of 14 arcmin are crowded: the
/// stars through air that dims them and makes them scintillate by 4 % at the zenith. `lens`: its
/// relative illumination by the angle from the axis [deg].
Frame draw_all_sky(double ra_rad, double dec_rad, double extinction, unsigned seed,
                   const MonotoneCubic& lens = {}) {
  constexpr int wide = 640, high = 480;
  constexpr double scintillation2 = 0.002, true_zero_point_mag = 12.0;
  FrameHeader h =
      simulated::camera_header(wide, high, 0.5 * wide / (75 * deg), dec_rad, 5, false, ra_rad);
  h.projection = Projection::equidistant;
  h.wcs.projection = Projection::equidistant;
  h.zero_point_mag = 0.0;  // not known
  h.extinction_mag_per_airmass = extinction;
  h.illumination = lens;
  h.psf_fwhm_px = 1.7;
  const Vec<Gcrs> zenith = from_spherical<Gcrs>(ra_rad, dec_rad);
  h.sensor_position_m = zenith * 6.378e6;
  h.site = SitePlace{};
  h.air = Weather{.pressure_hpa = 0.0};
  const Tt tt = Clock(parse_utc(h.middle_utc)).tt({});
  Observer observer = space_observer(h.sensor_position_m, {}, tt, solar_system(tt));
  observer.air = Air{zenith, Refraction()};
  const PlateSky sky(stars(), observer);
  const PlateModel model{.projection = h.projection,
                         .camera_from_gcrs = rotation_of<CameraFrame, Gcrs>(h.camera_from_gcrs[1]),
                         .focal_length_px = h.focal_length_px,
                         .centre = {(wide - 1) / 2.0, (high - 1) / 2.0}};
  simulated::SimulatedFrame frame(h, wide, high, 600, seed);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  for (const SeenStar& s : sky.brightest(zenith, 85 * deg, 100000)) {
    const auto at = model.pixel(s.direction);
    if (!at || at->x_px < -3 || at->y_px < -3 || at->x_px > wide + 2 || at->y_px > high + 2)
      continue;
    const double x = airmass(std::asin(dot(s.direction, zenith)));
    const double variance = std::log1p(scintillation2 * x * x * x);
    const double light = lens.empty() ? 1.0 : lens(angle_rad(s.direction, model.axis()) / deg);
    const double factor = light * std::exp(std::sqrt(variance) * normal(random) - 0.5 * variance);
    frame.add_point(at->x_px, at->y_px,
                    h.exposure_s * factor *
                        std::pow(10, 0.4 * (true_zero_point_mag - s.v_mag - extinction * x)));
  }
  return {frame.expose(), h};
}

// Faint stars are in blends, and are found where noise or scintillation makes them bright.
TEST(SolveFrame, ZeroPointsOfAllSkyFramesAreRight) {
  Threads one(1);
  unsigned seed = 0;
  for (const double ra_rad : {0.3, 3.0})
    for (const double extinction : {0.17, 0.5}) {
      Frame frame = draw_all_sky(ra_rad, 0.59, extinction, ++seed);
      const FrameSolution s = solve_frame(frame, stars(), {}, one);
      ASSERT_TRUE(s.zero_point);
      const ZeroPoint& z = *s.zero_point;
      EXPECT_NEAR(z.zero_point_mag, 12.0, 0.03) << ra_rad << " " << extinction;
      EXPECT_NEAR(z.zero_point_mag, 12.0, 3 * z.sigma(0)) << ra_rad << " " << extinction;
      frame.header.unknown.add(FrameFact::extinction);
      frame.header.extinction_mag_per_airmass = 0.0;
      const FrameSolution free = solve_frame(frame, stars(), {}, one);
      ASSERT_TRUE(free.zero_point && free.zero_point->extinction_fitted);
      EXPECT_NEAR(free.zero_point->extinction_mag_per_airmass, extinction,
                  3 * free.zero_point->sigma(2));
      EXPECT_FALSE(solved_header(frame.header, free).unknown.has(FrameFact::extinction));
    }
}

// A lens that loses six tenths of the light at 75 deg from its axis.
TEST(SolveFrame, ZeroPointsAreWithoutTheLensThatTheHeaderHas) {
  Threads one(1);
  Frame frame =
      draw_all_sky(0.3, 0.59, 0.17, 5, MonotoneCubic({0, 30, 60, 90}, {1, 0.9, 0.6, 0.2}));
  const FrameSolution s = solve_frame(frame, stars(), {}, one);
  ASSERT_TRUE(s.zero_point);
  EXPECT_NEAR(s.zero_point->zero_point_mag, 12.0, 0.03);
  EXPECT_NEAR(s.zero_point->zero_point_mag, 12.0, 3 * s.zero_point->sigma(0));
  frame.header.illumination = {};
  const FrameSolution lens = solve_frame(frame, stars(), {}, one);
  ASSERT_TRUE(lens.zero_point);
  EXPECT_GT(std::abs(lens.zero_point->zero_point_mag - 12.0), 0.1);  // taken for extinction
}

// The zero point of a frame of 14 deg near the zenith holds the air.
TEST(SolveFrame, ExtinctionThatIsNotFittedStaysUnknown) {
  FrameHeader h;
  h.unknown.add(FrameFact::extinction);
  h.unknown.add(FrameFact::zero_point);
  FrameSolution s;
  s.plate.fit.model.camera_from_gcrs = rotation_of<CameraFrame, Gcrs>({});
  s.zero_point = ZeroPoint{.zero_point_mag = 18.0};
  const FrameHeader solved = solved_header(h, s);
  EXPECT_TRUE(solved.unknown.has(FrameFact::extinction));
  EXPECT_FALSE(solved.unknown.has(FrameFact::zero_point));
  EXPECT_FALSE(is_unknown("magnitude", solved.unknown));
}

TEST(SolveFrame, SolvesAMirroredFrame) {
  DrawnFrame d = draw(14, unit(Vec<Gcrs>{0.2, 0.9, 0.3}), 3);
  CountImage& counts = d.frame.counts;
  for (int y = 0; y < rows / 2; ++y)
    std::swap_ranges(counts.row(y), counts.row(y) + columns, counts.row(rows - 1 - y));
  Threads one(1);
  const FrameSolution s = solve_frame(d.frame, stars(), {.blind = true}, one);
  EXPECT_TRUE(s.plate.fit.model.mirrored());
  for (const auto& [pixel, direction] : d.catalogued) {
    const auto at = wcs_pixel(s.wcs, direction);
    ASSERT_TRUE(at);
    EXPECT_NEAR(at->x_px, pixel.x_px, 0.05);
    EXPECT_NEAR(at->y_px, rows - 1 - pixel.y_px, 0.05);
  }
}

// The field is at the site's nadir: a wrong site or time, not a wrong lens.
TEST(SolveFrame, SaysThatTheFieldIsBelowTheHorizon) {
  const Vec<Gcrs> axis = unit(Vec<Gcrs>{0.2, 0.9, 0.3});
  DrawnFrame d = draw(14, axis, 1);
  believe(d, {0.0, 0.0, 0.0});
  d.frame.header.site = SitePlace{};
  d.frame.header.sensor_position_m = axis * -6.378e6;
  Threads one(1);
  try {
    solve_frame(d.frame, stars(), {}, one);
    ADD_FAILURE() << "solved";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("the header's site and time put the middle of its field "
                                         "90.0 deg below the horizon"),
              std::string::npos)
        << e.what();
  }
}

TEST(SolveFrame, SaysWhyThereIsNoSolution) {
  DrawnFrame d = draw(14, unit(Vec<Gcrs>{0.2, 0.9, 0.3}), 1);
  Threads one(1);
  for (const std::uint16_t level : {0, 300, 65535}) {
    std::fill(d.frame.counts.pixels.begin(), d.frame.counts.pixels.end(), level);
    try {
      solve_frame(d.frame, stars(), {}, one);
      ADD_FAILURE() << level;
    } catch (const Error& e) {
      EXPECT_EQ(std::string(e.what()).rfind("no plate solution: 3 sources are needed, got ", 0), 0u)
          << e.what();
    }
  }
}

// Aberration of another date moves all stars alike.
TEST(SolveFrame, AFrameWithoutATimeIsSolvedAtJ2000) {
  DrawnFrame d = draw(14, unit(Vec<Gcrs>{0.2, 0.9, 0.3}), 1);
  FrameHeader& h = d.frame.header;
  h.unknown.add(FrameFact::time);
  h.start_utc = h.middle_utc = h.end_utc = "";
  h.sensor_position_m = h.sensor_velocity_m_per_s = h.earth_velocity_m_per_s = {};
  Threads one(1);
  const FrameSolution s = solve_frame(d.frame, stars(), {.blind = true}, one);
  ASSERT_EQ(s.notes.assumed.size(), 1u);
  EXPECT_EQ(s.notes.assumed[0].rfind("time: stars are taken where they were in 2000", 0), 0u);
  EXPECT_NE(to_json(s, h).find(s.notes.assumed[0]), std::string::npos);
  double sum = 0.0;
  for (const auto& [pixel, direction] : d.catalogued) {
    const auto at = wcs_pixel(s.wcs, direction);
    ASSERT_TRUE(at);
    sum += std::pow(at->x_px - pixel.x_px, 2) + std::pow(at->y_px - pixel.y_px, 2);
  }
  EXPECT_LT(std::sqrt(sum / double(d.catalogued.size())), 0.05);
}

TEST(SolveFrame, AWrongFocalLengthOfTheHeaderIsNamed) {
  DrawnFrame d = draw(14, unit(Vec<Gcrs>{0.2, 0.9, 0.3}), 1);
  FrameHeader& h = d.frame.header;
  h.unknown.add(FrameFact::pointing);
  h.focal_length_px *= 1.4;
  Threads one(1);
  try {
    solve_frame(d.frame, stars(), {}, one);
    ADD_FAILURE();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("FOCALLEN / XPIXSZ: --blind tries all"), std::string::npos)
        << e.what();
  }
}

}  // namespace
}  // namespace dmise
