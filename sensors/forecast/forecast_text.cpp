#include "sensors/forecast/forecast_text.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "core/base/formatted.h"
#include "core/base/printable.h"
#include "core/base/units.h"
#include "core/detection/pixels/detection_limits.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

using Frames = std::vector<FrameForecast>;

/// Minimum and maximum of a quantity over frames.
struct Range {
  double least = 0.0, most = 0.0;
  bool any = false;

  void add(double value) {
    least = any ? std::min(least, value) : value;
    most = any ? std::max(most, value) : value;
    any = true;
  }
};
template <class T>
Range range_of(const Frames& frames, std::optional<T> FrameForecast::*figure, double unit = 1.0) {
  Range range;
  for (const auto& frame : frames) {
    if (!(frame.*figure)) continue;
    range.add(double(*(frame.*figure)) / unit);
  }
  return range;
}

std::string text_of(const Range& range, const char* format) {
  const std::string least = formatted(format, range.least), most = formatted(format, range.most);
  return least == most ? least : least + " to " + most;
}

/// From the first examined frame to the last, with extremes in between.
std::string course_of(const Frames& frames, std::optional<double> FrameForecast::*figure) {
  const Range range = range_of(frames, figure, deg);
  const double first = (frames.front().*figure).value_or(0.0) / deg;
  const double last = (frames.back().*figure).value_or(0.0) / deg;
  std::string text = formatted("%.1f", first);
  if (formatted("%.1f", last) != text) text += " to " + formatted("%.1f", last);
  if (range.most > std::max(first, last) + 0.05)
    text += " (highest " + formatted("%.1f)", range.most);
  if (range.least < std::min(first, last) - 0.05)
    text += " (lowest " + formatted("%.1f)", range.least);
  return text + " deg";
}

std::size_t count_if(const Frames& frames, const std::function<bool(const FrameForecast&)>& is) {
  return std::size_t(std::count_if(frames.begin(), frames.end(), is));
}

std::string looked_at(const SensorForecast& o) {
  return std::to_string(o.frames.size()) +
         (o.frames.size() == o.frames_in_run ? "" : " of " + std::to_string(o.frames_in_run)) +
         (o.frames_in_run == 1 ? " frame" : " frames");
}

const FrameForecast& middle_of(const SensorForecast& o) { return o.frames[o.frames.size() / 2]; }

std::string field_text(const SensorForecast& o) {
  const auto& c = o.camera;
  const double scale_arcsec = c.pixel_rad / arcsec;
  return formatted(
      "field of view %.4g x %.4g deg, %.4g from corner to corner; %.4g arcsec/px; f/%.3g",
      c.width_rad / deg, c.height_rad / deg, c.diagonal_rad / deg, scale_arcsec, c.f_number);
}

std::string limit_text(const SensorForecast& o) {
  std::string text = limiting_magnitude_text(o);
  if (text.empty()) return "";
  text += " (" + limiting_magnitude_meaning() + ")";
  const FrameForecast& f = *o.mid_run;
  if (f.found_point_v_mag)
    text += formatted("; half of the points of V = %.1f are found beside star trails of %.0f px",
                      *f.found_point_v_mag, f.star_px);
  if (f.streak_limit_v_mag)
    text += formatted(
        "; half of the streaks of V = %.1f are found (%g deg/s, %.0f px, by their whole light)",
        *f.streak_limit_v_mag, f.streak_deg_per_s, f.streak_px);
  return text;
}

/// What a low orbit is out of focus; empty: as sharp as stars.
std::string near_text(const SensorForecast& o) {
  if (!o.mid_run || !o.mid_run->near_limit_v_mag) return "";
  return formatted(
      "out of focus at %g km: a disc of %.3g arcsec (%.3g px), for which the limiting "
      "magnitude is V = %.2f",
      1e-3 * near_range_m, o.mid_run->near_disc_px * o.camera.pixel_rad / arcsec,
      o.mid_run->near_disc_px, *o.mid_run->near_limit_v_mag);
}

std::string thermal_text(const ThermalLimit& t) {
  return formatted(
      "background %.3g e-/s a pixel in mid run, which fills it in %.3g s; noise-equivalent flux "
      "density %.3g W/cm2, %.3g Jy, AB = %.2f",
      t.background_e_per_s, t.fills_in_s, t.nefd_w_per_m2 * 1e-4, t.nefd_jy, t.nefd_ab_mag);
}

std::string frames_of(std::uint32_t count, const SensorForecast& o) {
  std::string text = std::to_string(count) + " of " + std::to_string(o.looked_for_exclusion);
  if (o.looked_for_exclusion < o.frames_in_run)
    text += " (looked at, of " + std::to_string(o.frames_in_run) + ")";
  return text + " frames";
}

/// Where a body is beside a camera's limit, in one line.
std::string exclusion_text(const ExcludedFrames& of, const SensorForecast& o) {
  std::string text = std::string("exclusion: ") + of.body->name;
  if (!of.min_rad)
    return text + (o.on_ground ? " is below the horizon in " : " is behind the Earth in ") +
           frames_of(o.looked_for_exclusion, o);
  const std::string nearest = formatted("%.1f deg at the nearest", *of.min_rad / deg);
  if (of.count == 0)
    return text + formatted(" is beyond %g deg in ", of.limit_deg) +
           frames_of(o.looked_for_exclusion, o) + ", " + nearest;
  return text + formatted(" is within %g deg in ", of.limit_deg) + frames_of(of.count, o) +
         formatted(", from frame %u (%.6g s after the start) to %u (%.6g s), ", of.first,
                   of.first_middle.seconds(), of.last, of.last_middle.seconds()) +
         nearest +
         (o.exclusion_action == ExclusionAction::close_shutter ? ": the shutter is closed"
                                                               : ": flagged");
}

}  // namespace

std::string limiting_magnitude_text(const SensorForecast& o) {
  if (!o.mid_run || !o.mid_run->point_limit_v_mag) return "";
  return formatted("limiting magnitude V = %.2f", *o.mid_run->point_limit_v_mag);
}

std::string limiting_magnitude_meaning() {
  return formatted("a point at the detector's threshold, %g times the noise, in mid run",
                   detection_limits::seed_snr);
}

std::vector<std::string> warnings_of(const SensorForecast& o, const std::string& where) {
  std::vector<std::string> warnings;
  const std::size_t looked = o.frames.size();
  if (looked == 0) return warnings;
  const auto warn = [&](const std::string& text) { warnings.push_back(where + ": " + text); };
  const auto of_frames = [&](std::size_t n) {
    return n == looked
               ? "in all " + looked_at(o) + " looked at"
               : "in " + std::to_string(n) + " of " + std::to_string(looked) + " frames looked at";
  };
  if (o.excluded_frames > 0 && o.exclusion_action == ExclusionAction::close_shutter)
    warn("the shutter is closed in " + frames_of(o.excluded_frames, o) +
         ", which are dark: a body is nearer to the axis than camera.exclusion allows");
  if (const auto n = count_if(o.frames, [](auto& f) { return f.target_hidden; }))
    warn("the target " + o.target + " is " +
         (o.on_ground ? "below the horizon " : "behind the Earth ") + of_frames(n));
  else if (const auto m = count_if(o.frames, [](auto& f) { return f.boresight_hidden; }))
    warn(std::string("the camera points ") +
         (o.on_ground ? "below the horizon " : "at the Earth ") + of_frames(m));
  const auto low = [&](const FrameForecast& f) {
    return f.limb_angle_rad && *f.limb_angle_rad < o.min_limb_angle_rad;
  };
  if (const auto n = count_if(o.frames, low)) {
    const Range limb = range_of(o.frames, &FrameForecast::limb_angle_rad, deg);
    warn(formatted("the camera points to within %.1f deg of the Earth's limb, nearer than "
                   "--limb-deg %g, ",
                   limb.least, o.min_limb_angle_rad / deg) +
         of_frames(n));
  }
  if (const auto n = count_if(o.frames, [](auto& f) { return f.sun_in_field; }))
    warn("the Sun is in the field " + of_frames(n));
  // Civil twilight ends at -6 deg: above it no star is visible by eye.
  const auto day = [](const FrameForecast& f) {
    return f.sun_elevation_rad && *f.sun_elevation_rad > -6.0 * deg;
  };
  if (const auto n = count_if(o.frames, day)) {
    const Range sun = range_of(o.frames, &FrameForecast::sun_elevation_rad, deg);
    warn(formatted("it is day or civil twilight (the Sun up to %.1f deg) ", sun.most) +
         of_frames(n));
  }
  const auto full = [](const FrameForecast& f) { return f.background.electrons >= f.full_e; };
  if (const auto n = count_if(o.frames, full)) {
    double max_e = 0.0;
    for (const auto& f : o.frames) max_e = std::max(max_e, f.background.electrons);
    warn(formatted("sky and dark current alone saturate the pixels (%.3g of %.3g e-) ", max_e,
                   middle_of(o).full_e) +
         of_frames(n));
  }
  const Range objects = range_of(o.frames, &FrameForecast::objects);
  if (objects.any && objects.most == 0.0 && !o.cued)
    warn("no lit object is in the field in any of the " + looked_at(o) + " looked at");
  return warnings;
}

namespace {

/// "Jupiter, V -2.3, a disc of 41 arcsec; Venus, V -4.0, a point" of the first frame with each.
std::string planets_text(const std::vector<FrameForecast>& frames) {
  std::string text;
  std::set<std::string_view> named;
  for (const FrameForecast& frame : frames)
    for (const PlanetForecast& p : frame.planets)
      if (named.insert(p.name).second)
        text += (text.empty() ? "" : "; ") + std::string(p.name) +
                formatted(", V %.1f, ", p.v_mag) +
                (p.is_disc ? formatted("a disc of %.0f arcsec", p.diameter_rad / arcsec)
                           : std::string("a point"));
  return text.empty() ? "" : "planets in the field: " + text;
}

/// A count to two significant digits.
double to_two_digits(double count) {
  const double unit =
      std::pow(10.0, std::max(0.0, std::floor(std::log10(std::max(count, 1.0))) - 1.0));
  return unit * std::round(count / unit);
}

/// " of the catalogue and about 9900 synthetic ones, to V = 17" ...
std::string synthetic_text(const std::vector<FrameForecast>& frames) {
  Range count, limit;
  for (const FrameForecast& frame : frames) {
    if (!frame.synthetic) continue;
    count.add(to_two_digits(frame.synthetic->stars));
    limit.add(frame.synthetic->to_v_mag);
  }
  if (!(count.most >= 0.5)) return "";
  return " of the catalogue and about " + text_of(count, "%.0f") +
         " synthetic ones, to V = " + text_of(limit, "%g");
}

}  // namespace

std::string short_text(const SensorForecast& o) {
  std::string text = field_text(o);
  if (!o.by_node.empty()) text += "; depends on what node " + o.by_node + " moves";
  if (o.frames.empty()) return text;
  if (const std::string limit = limit_text(o); !limit.empty()) text += "; " + limit;
  if (o.on_ground)
    text += "; Sun " + course_of(o.frames, &FrameForecast::sun_elevation_rad) + ", Moon " +
            course_of(o.frames, &FrameForecast::moon_elevation_rad);
  if (o.frames.front().target_elevation_rad)
    text += "; " + printable(o.target) + " at " +
            course_of(o.frames, &FrameForecast::target_elevation_rad);
  if (o.cued) text += "; cued: figures are for its parked position";
  return text;
}

std::vector<std::string> lines_of(const SensorForecast& o) {
  std::vector<std::string> lines;
  const auto say = [&](const std::string& text) { lines.push_back(o.sensor + ": " + text); };
  say(field_text(o));
  if (o.cued) say("is cued by the fusion node; what follows is for its parked position");
  if (!o.by_node.empty())
    say("depends on what node " + o.by_node + " moves: its frames can't be examined beforehand");
  if (o.frames.empty()) return lines;
  if (const std::string limit = limit_text(o); !limit.empty()) say(limit);
  if (const std::string near = near_text(o); !near.empty()) say(near);
  if (o.mid_run && o.mid_run->thermal) say(thermal_text(*o.mid_run->thermal));
  if (o.on_ground) {
    std::string text = "elevation of the boresight " +
                       course_of(o.frames, &FrameForecast::boresight_elevation_rad) + ", the Sun " +
                       course_of(o.frames, &FrameForecast::sun_elevation_rad) + ", the Moon " +
                       course_of(o.frames, &FrameForecast::moon_elevation_rad);
    if (o.frames.front().target_elevation_rad)
      text += ", " + printable(o.target) + " " +
              course_of(o.frames, &FrameForecast::target_elevation_rad);
    say(text);
  }
  if (o.frames.front().limb_angle_rad)
    say("boresight " + course_of(o.frames, &FrameForecast::limb_angle_rad) +
        " above the Earth's limb");
  for (const ExcludedFrames& of : o.excluded) say(exclusion_text(of, o));
  const Range stars = range_of(o.frames, &FrameForecast::stars);
  const Range objects = range_of(o.frames, &FrameForecast::objects);
  std::string text;
  if (stars.any) text = text_of(stars, "%.0f") + " stars" + synthetic_text(o.frames);
  if (objects.any)
    text += (text.empty() ? "" : ", ") + text_of(objects, "%.0f") +
            (objects.most == 1.0 ? " lit object" : " lit objects");
  if (!text.empty()) say(text + " in the field (" + looked_at(o) + " looked at)");
  if (const std::string planets = planets_text(o.frames); !planets.empty()) say(planets);
  if (!o.objects_counted) say("objects in the field are not counted: too many");
  return lines;
}

void write_json(JsonWriter& json, const SensorForecast& o, const Clock& clock) {
  json.begin_object().field("name", o.sensor);
  json.field("field_width_deg", o.camera.width_rad / deg);
  json.field("field_height_deg", o.camera.height_rad / deg);
  json.field("field_diagonal_deg", o.camera.diagonal_rad / deg);
  json.field("pixel_scale_arcsec", o.camera.pixel_rad / arcsec);
  json.field("f_number", o.camera.f_number);
  json.field("frames_in_run", std::int64_t(o.frames_in_run));
  json.field("point_limit_snr", detection_limits::seed_snr);
  json.field("streak_limit_snr", streak_limit_snr);
  if (o.mid_run) json.field("limiting_magnitude", o.mid_run->point_limit_v_mag);
  if (o.mid_run && o.mid_run->near_limit_v_mag) {
    json.key("out_of_focus").begin_object().field("range_m", near_range_m);
    json.field("disc_px", o.mid_run->near_disc_px);
    json.field("limiting_magnitude", o.mid_run->near_limit_v_mag).end_object();
  }
  if (!o.target.empty()) json.field("target", o.target);
  if (o.cued) json.field("cued", true);
  if (!o.excluded.empty()) {
    json.key("exclusion").begin_object();
    json.field("action", exclusion_action_names[std::size_t(o.exclusion_action)]);
    json.field("frames_looked_at", std::int64_t(o.looked_for_exclusion));
    json.field("frames_excluded", std::int64_t(o.excluded_frames));
    for (const ExcludedFrames& of : o.excluded) {
      json.key(of.body->key).begin_object().field("limit_deg", of.limit_deg);
      if (of.min_rad) json.field("least_deg", *of.min_rad / deg);
      json.field("frames", std::int64_t(of.count));
      if (of.count > 0) {
        json.field("first_frame", std::int64_t(of.first))
            .field("last_frame", std::int64_t(of.last));
        json.field("first_middle_utc", format_utc(clock.utc(of.first_middle), 3));
        json.field("last_middle_utc", format_utc(clock.utc(of.last_middle), 3));
      }
      json.end_object();
    }
    json.end_object();
  }
  json.key("frames").begin_array();
  for (const auto& f : o.frames) {
    const auto angle = [&](const char* key, const std::optional<double>& rad) {
      if (rad) json.field(key, *rad / deg);
    };
    json.begin_object().field("frame", std::int64_t(f.frame));
    json.field("middle_utc", format_utc(clock.utc(f.middle), 3));
    angle("boresight_elevation_deg", f.boresight_elevation_rad);
    angle("sun_elevation_deg", f.sun_elevation_rad);
    angle("moon_elevation_deg", f.moon_elevation_rad);
    angle("target_elevation_deg", f.target_elevation_rad);
    angle("limb_angle_deg", f.limb_angle_rad);
    json.field("boresight_hidden", f.boresight_hidden).field("target_hidden", f.target_hidden);
    json.field("sun_in_field", f.sun_in_field);
    if (!f.planets.empty()) {
      json.key("planets").begin_array();
      for (const PlanetForecast& planet : f.planets)
        json.begin_object()
            .field("name", std::string(planet.name))
            .field("v_mag", planet.v_mag)
            .field("diameter_arcsec", planet.diameter_rad / arcsec)
            .field("is_disc", planet.is_disc)
            .end_object();
      json.end_array();
    }
    if (f.shutter_closed) json.field("shutter_closed", true);
    json.field("background_e", f.background.electrons).field("noise_e", f.background.noise_e);
    if (f.thermal) {
      json.key("thermal").begin_object();
      json.field("background_e_per_s", f.thermal->background_e_per_s);
      json.field("fills_in_s", f.thermal->fills_in_s);
      json.field("nefd_w_per_m2", f.thermal->nefd_w_per_m2);
      json.field("nefd_jy", f.thermal->nefd_jy);
      json.field("nefd_ab_mag", f.thermal->nefd_ab_mag).end_object();
    }
    json.field("saturates_at_e", f.full_e).field("extinction_mag", f.extinction_mag);
    if (f.point_limit_v_mag) json.field("point_limit_v_mag", *f.point_limit_v_mag);
    json.field("streak_deg_per_s", f.streak_deg_per_s).field("streak_px", f.streak_px);
    if (f.found_point_v_mag) json.field("found_point_v_mag", *f.found_point_v_mag);
    json.field("star_px", f.star_px);
    if (f.streak_limit_v_mag) json.field("streak_limit_v_mag", *f.streak_limit_v_mag);
    if (f.stars) json.field("stars", std::int64_t(*f.stars));
    if (f.synthetic)
      json.key("synthetic_stars")
          .begin_object()
          .field("expected", f.synthetic->stars)
          .field("to_v_mag", f.synthetic->to_v_mag)
          .end_object();
    if (f.objects) json.field("objects", std::int64_t(*f.objects));
    json.end_object();
  }
  json.end_array().key("warnings").begin_array();
  for (const auto& warning : o.warnings) json.value(warning);
  json.end_array().end_object();
}

}  // namespace dmise
