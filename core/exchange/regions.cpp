#include "core/exchange/regions.h"

#include <algorithm>
#include <cmath>

#include "core/base/formatted.h"
#include "core/base/units.h"
#include "core/products/frame_file.h"
#include "core/score/trail.h"
#include "core/wcs/wcs.h"

namespace dmise {
namespace {

/// A text in braces; braces within it, which would end it, become parentheses.
std::string braced(const std::string& text) {
  std::string out = "{";
  for (const char c : text)
    out += c == '{' ? '(' : c == '}' ? ')' : static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  return out + "}";
}

/// One source: its trail, and how it is drawn.
struct Region {
  PixelPosition start, middle, end;
  std::string text, style;
};

/// The shapes of a region in the coordinates that `place` writes; `radius` is the end of a circle.
template <class Place>
std::string shapes(const Region& r, const Place& place, const std::string& radius) {
  const std::string text = " text=" + braced(r.text) + "\n";
  if (r.start == r.end) return "circle(" + place(r.middle) + radius + " # " + r.style + text;
  const std::string plain = " # line=0 0 " + r.style;
  return "line(" + place(r.start) + "," + place(r.middle) + ")" + plain + "\nline(" +
         place(r.middle) + "," + place(r.end) + ")" + plain + text;
}

std::string image_shapes(const Region& r, double radius_px) {
  const auto place = [](PixelPosition p) { return formatted("%.3f,%.3f", p.x_px + 1, p.y_px + 1); };
  return shapes(r, place, formatted(",%.3f)", radius_px));
}

std::string sky_shapes(const Region& r, double radius_px, const Wcs& wcs) {
  const auto place = [&](PixelPosition p) {
    const auto [ra_rad, dec_rad] = to_spherical(wcs_direction(wcs, p));
    return formatted("%.8f,%.8f", ra_rad / deg, dec_rad / deg);
  };
  return shapes(r, place, formatted(",%.3f\")", radius_px * wcs_scale_rad_per_px(wcs) / arcsec));
}

Region region_of(const Truth& t) {
  const auto [start, middle, end] = places_of(t);
  const double length = std::hypot(end.x_px - start.x_px, end.y_px - start.y_px);
  Region r{start, middle, end, t.name, "color=green width=1"};
  if (length < 2.0) r.start = r.end = r.middle;
  return r;
}

Region region_of(const Detection& d) {
  const PixelPosition middle{d.x_px, d.y_px};
  Region r{middle, middle, middle, formatted("mag %.2f SNR %.1f", d.magnitude, d.snr),
           "color=cyan width=1 dash=1"};
  if (d.kind == DetectionKind::streak) {
    r.start = {d.end1_x_px, d.end1_y_px};
    r.end = {d.end2_x_px, d.end2_y_px};
  }
  return r;
}

}  // namespace

std::vector<ExportedFile> region_files(const ExportRequest& request) {
  const RunProducts& run = request.run;
  std::vector<std::vector<Region>> regions(run.frames.size());
  if (request.kind == ProductKind::truth) {
    for (const Truth& t : run.truths)
      if (t.in_frame) regions[run.index_of(t.sensor, t.frame)].push_back(region_of(t));
  } else {
    for (const Detection& d : run.detections)
      regions[run.index_of(d.sensor, d.frame)].push_back(region_of(d));
  }
  const std::string head = "# Region file format: DS9 version 4.1\n# " + run.software +
                           ", scenario " + run.digest + "\nglobal font=\"helvetica 10 normal\"\n";
  std::vector<ExportedFile> files;
  for (std::size_t i = 0; i < run.frames.size(); ++i) {
    const RunFrame& frame = run.frames[i];
    if (run.sensor(frame.sensor).columns == 0) continue;  // no image
    const double radius_px = std::max(4.0, 2.0 * frame.psf_fwhm_px);
    std::string image = head + "image\n", sky = head + "icrs\n";
    for (const Region& r : regions[i]) {
      image += image_shapes(r, radius_px);
      if (frame.wcs) sky += sky_shapes(r, radius_px, *frame.wcs);
    }
    const std::string stem =
        frame.sensor + "/" + frame_file_name(frame.frame, "-") + name_of(request.kind);
    files.push_back({.path = stem + ".image.reg", .content = image, .copy_of = ""});
    if (frame.wcs) files.push_back({.path = stem + ".icrs.reg", .content = sky, .copy_of = ""});
  }
  return files;
}

}  // namespace dmise
