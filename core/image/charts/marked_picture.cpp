#include "core/image/charts/marked_picture.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include "core/base/formatted.h"
#include "core/base/units.h"
#include "core/image/charts/drawing.h"
#include "core/wcs/wcs.h"

namespace dmise {
namespace {

constexpr Colour truth_colour = {60, 220, 90};
constexpr Colour streak_colour = {80, 220, 255};
constexpr Colour point_colour = {255, 220, 60};
constexpr Colour text_colour = {225, 225, 225};
constexpr Colour dim_colour = {150, 150, 150};

void draw_truth(Picture& picture, const Preview& preview, const Truth& truth, int text_scale) {
  const double x1 = preview.place(truth.start_x_px), y1 = preview.place(truth.start_y_px);
  const double xm = preview.place(truth.middle_x_px), ym = preview.place(truth.middle_y_px);
  const double x2 = preview.place(truth.end_x_px), y2 = preview.place(truth.end_y_px);
  const double length = std::hypot(x2 - x1, y2 - y1);
  if (length < 8) {
    draw_circle(picture, xm, ym, 9, truth_colour);
  } else {  // beside the source, not over it
    const double nx = -(y2 - y1) / length * 9, ny = (x2 - x1) / length * 9;
    for (const auto& [x, y] : {std::pair{nx, ny}, {-nx, -ny}}) {
      draw_line(picture, x1 + x, y1 + y, xm + x, ym + y, truth_colour);
      draw_line(picture, xm + x, ym + y, x2 + x, y2 + y, truth_colour);
    }
    draw_circle(picture, x1, y1, 9, truth_colour);  // start of the exposure
  }
  draw_text(picture, int(x1) + 14, int(y1) - 12, truth.name, truth_colour, text_scale);
}

void draw_detection(Picture& picture, const Preview& preview, const Detection& d, int text_scale) {
  const double x = preview.place(d.x_px), y = preview.place(d.y_px);
  const Colour colour = d.kind == DetectionKind::streak ? streak_colour : point_colour;
  if (d.kind == DetectionKind::streak)
    draw_capsule(picture, preview.place(d.end1_x_px), preview.place(d.end1_y_px),
                 preview.place(d.end2_x_px), preview.place(d.end2_y_px), 6, colour);
  else
    draw_circle(picture, x, y, 6, colour);
  draw_text(picture, int(x) + 14, int(y) + 4,
            "#" + std::to_string(d.index) + " " + formatted("%.1f", d.magnitude), colour,
            text_scale);
}

/// Draws the longest of some round lengths [arcsec] that takes at most `room_px` pixels of the
/// picture.
void draw_scale_bar(Picture& picture, int x, int y, double arcsec_per_px, double room_px,
                    int scale) {
  constexpr std::pair<double, const char*> lengths[] = {
      {0.1, "0.1\""},  {1, "1\""},      {5, "5\""},       {10, "10\""},      {30, "30\""},
      {60, "1'"},      {120, "2'"},     {300, "5'"},      {600, "10'"},      {1800, "30'"},
      {3600, "1 deg"}, {7200, "2 deg"}, {18000, "5 deg"}, {36000, "10 deg"}, {72000, "20 deg"}};
  const auto* best = std::begin(lengths);
  for (const auto& length : lengths)
    if (length.first / arcsec_per_px <= room_px) best = &length;
  const double width = std::min(best->first / arcsec_per_px, room_px);
  draw_line(picture, x, y, x + width, y, text_colour);
  draw_line(picture, x, y - 3, x, y + 3, text_colour);
  draw_line(picture, x + width, y - 3, x + width, y + 3, text_colour);
  draw_text(picture, x, y + 7, best->second, text_colour, scale);
}

/// Draws arrows to north and east, as they are at the picture's centre.
void draw_compass(Picture& picture, double x, double y, double radius, const Wcs& wcs,
                  PixelPosition centre, int scale) {
  const Vec<Gcrs> here = wcs_direction(wcs, centre);
  const double step = wcs_scale_rad_per_px(wcs);
  Vec<Gcrs> east = cross(Vec<Gcrs>{0, 0, 1}, here);
  if (norm(east) < 1e-12) return;  // no north at the pole
  east = unit(east);
  const Vec<Gcrs> north = cross(here, east);
  const auto arrow = [&](const Vec<Gcrs>& way, const char* letter) {
    const auto there = wcs_pixel(wcs, here + way * step);
    if (!there) return;
    const PixelPosition d = *there - centre;
    const double length = std::hypot(d.x_px, d.y_px);
    if (!(length > 0)) return;
    const double ux = d.x_px / length, uy = d.y_px / length;
    draw_line(picture, x, y, x + radius * ux, y + radius * uy, text_colour);
    draw_text(picture, int(std::lround(x + (radius + 5.0 * scale) * ux - 2.5 * scale)),
              int(std::lround(y + (radius + 5.0 * scale) * uy - 3.5 * scale)), letter, text_colour,
              scale);
  };
  arrow(north, "N");
  arrow(east, "E");
}

}  // namespace

Picture marked_picture(const Preview& preview, const FrameHeader& header,
                       const std::vector<Truth>& truths, const std::vector<Detection>& detections) {
  const int scale = preview.picture.columns >= 1000 ? 2 : 1;
  const int line = 11 * scale;
  const int strip = 3 * line + 18 * scale, top = preview.picture.rows;
  Picture picture = to_rgb(preview.picture);
  int shown = 0, streaks = 0;
  for (const Truth& truth : truths) {
    if (!truth.in_frame) continue;
    draw_truth(picture, preview, truth, scale);
    ++shown;
  }
  for (const Detection& detection : detections) {
    if (detection.kind == DetectionKind::streak) ++streaks;
    draw_detection(picture, preview, detection, scale);
  }
  picture = to_rgb(picture, strip);

  int x = 6 * scale, y = top + 6 * scale;
  draw_text(picture, x, y,
            header.sensor + "  frame " + std::to_string(header.frame) + "  " +
                header.middle_utc.substr(0, 23) + " UTC (middle)",
            text_colour, scale);
  y += line;
  const double arcsec_per_px = wcs_scale_rad_per_px(header.wcs) / arcsec;
  draw_text(picture, x, y,
            "exposure " + formatted("%.4g", header.exposure_s) + " s  band " + header.band.name +
                "  " + header.mount + "  " + formatted("%.4g", arcsec_per_px) + "\"/px",
            dim_colour, scale);
  y += line;
  const auto legend = [&](const std::string& text, Colour colour) {
    draw_text(picture, x, y, text, colour, scale);
    x += text_width(text, scale) + 10 * scale;
  };
  legend("truth " + std::to_string(shown), truth_colour);
  legend("streaks " + std::to_string(streaks), streak_colour);
  legend("points " + std::to_string(int(detections.size()) - streaks), point_colour);

  const double radius = strip * 0.26;
  const double columns = preview.picture.columns / preview.pixels_per_px;
  const double rows = preview.picture.rows / preview.pixels_per_px;
  draw_compass(picture, picture.columns - 0.5 * strip, top + 0.5 * strip, radius, header.wcs,
               {(columns - 1) / 2, (rows - 1) / 2}, scale);
  draw_scale_bar(picture, picture.columns - strip - 120 * scale, top + strip / 2,
                 arcsec_per_px / preview.pixels_per_px, 100 * scale, scale);
  return picture;
}

}  // namespace dmise
