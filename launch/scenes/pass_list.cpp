#include "launch/scenes/pass_list.h"

#include <algorithm>
#include <functional>
#include <span>

#include "core/base/files/json.h"
#include "core/base/files/text_fields.h"
#include "core/base/formatted.h"
#include "core/base/units.h"
#include "core/orbit/sgp4/catalogue_report.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

/// A value of a pass: a text, a number or a flag; empty if there is none.
struct Value {
  std::string text;     // as in CSV, without quotes
  bool quoted = false;  // in JSON
};
Value of(const std::string& text) { return {text, true}; }
Value of(bool flag) { return {flag ? "true" : "false"}; }
Value of(double value, int decimals) { return {formatted("%.*f", decimals, value)}; }

struct PassColumn {
  const char* name;
  std::function<Value(const PassList&, const Pass&)> value;
};

Value utc(const PassList& list, const std::optional<SimTime>& t) {
  return t ? of(format_utc(list.clock.utc(*t), 2)) : Value{};
}
Value azimuth(const PassMoment& m) {
  return m.horizontal ? of(m.horizontal->azimuth_rad / deg, 3) : Value{};
}
Value elevation(const PassMoment& m) {
  return m.horizontal ? of(m.horizontal->elevation_rad / deg, 3) : Value{};
}

std::vector<PassColumn> columns_of(const PassList& list) {
  using L = const PassList&;
  using P = const Pass&;
  std::vector<PassColumn> all = {
      {"sensor", [](L l, P) { return of(l.sensor.name); }},
      {"catalogue_number",
       [](L l, P p) { return of(double(l.elements[p.object].catalogue_number), 0); }},
      {"name", [](L l, P p) { return of(l.elements[p.object].name); }},
      {"orbit", [](L l, P p) { return of(std::string(orbit_class(l.elements[p.object]))); }},
      {"rise_utc", [](L l, P p) { return utc(l, p.rise.time); }},
      {"top_utc", [](L l, P p) { return utc(l, p.top.time); }},
      {"set_utc", [](L l, P p) { return utc(l, p.set.time); }},
      {"open_start", [](L, P p) { return of(p.open_start); }},
      {"open_end", [](L, P p) { return of(p.open_end); }},
      {"rise_azimuth_deg", [](L, P p) { return azimuth(p.rise); }},
      {"rise_elevation_deg", [](L, P p) { return elevation(p.rise); }},
      {"top_azimuth_deg", [](L, P p) { return azimuth(p.top); }},
      {"top_elevation_deg", [](L, P p) { return elevation(p.top); }},
      {"set_azimuth_deg", [](L, P p) { return azimuth(p.set); }},
      {"set_elevation_deg", [](L, P p) { return elevation(p.set); }},
      {"least_range_km", [](L, P p) { return of(p.min_range_m / 1e3, 3); }},
      {"top_rate_deg_per_s", [](L, P p) { return of(p.top.rate_rad_per_s / deg, 6); }},
      {"top_sunlit", [](L, P p) { return of(p.top.sunlit, 3); }},
      {"lit_from_utc", [](L l, P p) { return utc(l, p.lit_from); }},
      {"lit_to_utc", [](L l, P p) { return utc(l, p.lit_to); }},
      {"lit_s", [](L, P p) { return of(p.lit_s, 2); }},
      {"top_sun_elevation_deg",
       [](L, P p) {
         return p.top.sun_elevation_rad ? of(*p.top.sun_elevation_rad / deg, 2) : Value{};
       }},
  };
  if (list.tells_excluded) all.push_back({"excluded", [](L, P p) { return of(p.excluded); }});
  return all;
}

/// hh:mm:ss.s
std::string of_day(const Clock& clock, SimTime t) {
  return format_utc(clock.utc(t), 1).substr(11, 10);
}

/// Whether the object is in shadow between its first and its last sunlit instant.
bool has_shadow_between(const Pass& p) {
  return p.lit_from && p.lit_s < (*p.lit_to - *p.lit_from).seconds() - 2 * event_error_s;
}

/// "all", "no", or the first and last sunlit instant, with '~' where a shadow lies between.
std::string light(const PassList& list, const Pass& p) {
  const double length_s = (p.set.time - p.rise.time).seconds();
  if (!p.lit_from) return "no";
  if (p.lit_s >= length_s - 2 * event_error_s) return "all";
  return of_day(list.clock, *p.lit_from).substr(0, 8) + (has_shadow_between(p) ? "~" : "-") +
         of_day(list.clock, *p.lit_to).substr(0, 8);
}

}  // namespace

const char* orbit_class(const MeanElements& elements) {
  switch (regime_of(elements)) {
    case OrbitRegime::low:
      return "LEO";
    case OrbitRegime::medium:
      return "MEO";
    case OrbitRegime::geosynchronous:
      return "GEO";
    case OrbitRegime::highly_elliptic:
      return "HEO";
    case OrbitRegime::beyond:
      break;
  }
  return "far";
}

std::string pass_table(const PassList& list, int rows, bool has_csv) {
  if (list.passes.empty()) return {};
  const bool ground = std::holds_alternative<SiteConfig>(list.sensor.place);
  std::string text =
      ground
          ? "   number  name                      orbit  rise (UTC)               top         set"
            "         highest    azimuth  nearest     rate      sunlit             Sun\n"
          : "   number  name                      orbit  rise (UTC)               nearest     set"
            "         nearest     rate      sunlit\n";
  const std::size_t shown =
      rows > 0 ? std::min(std::size_t(rows), list.passes.size()) : list.passes.size();
  bool shadows_between = false;
  for (const Pass& p : std::span(list.passes).first(shown)) {
    shadows_between |= has_shadow_between(p);
    const MeanElements& e = list.elements[p.object];
    text += formatted("%9u  %-24.24s  %-5s %c%s  %s  %s%c", e.catalogue_number, e.name.c_str(),
                      orbit_class(e), p.open_start ? '<' : ' ',
                      format_utc(list.clock.utc(p.rise.time), 1).substr(0, 21).c_str(),
                      of_day(list.clock, p.top.time).c_str(),
                      of_day(list.clock, p.set.time).c_str(), p.open_end ? '>' : ' ');
    if (p.top.horizontal)
      text += formatted("  %5.1f deg  %5.1f deg", p.top.horizontal->elevation_rad / deg,
                        p.top.horizontal->azimuth_rad / deg);
    text += formatted("  %7.0f km  %5.3f d/s  %-17s", p.min_range_m / 1e3,
                      p.top.rate_rad_per_s / deg, light(list, p).c_str());
    if (p.top.sun_elevation_rad) text += formatted("  %5.1f", *p.top.sun_elevation_rad / deg);
    if (p.excluded) text += "  excluded";
    text += '\n';
  }
  if (shadows_between) text += "  '~' in sunlit: a shadow lies between\n";
  if (list.passes.size() > shown)
    text += "  ... and " + std::to_string(list.passes.size() - shown) +
            " more (--rows 0 shows all" + (has_csv ? "; passes.csv has them" : "") + ")\n";
  return text;
}

std::string pass_csv(const PassList& list, bool with_header) {
  const auto columns = columns_of(list);
  std::string text;
  if (with_header) {
    for (const PassColumn& c : columns) text += (text.empty() ? "" : ",") + std::string(c.name);
    text += '\n';
  }
  for (const Pass& p : list.passes) {
    const char* comma = "";
    for (const PassColumn& c : columns) {
      const Value value = c.value(list, p);
      text += comma + csv_field(value.quoted ? formula_free(value.text) : value.text);
      comma = ",";
    }
    text += '\n';
  }
  return text;
}

std::string pass_jsonl(const PassList& list) {
  const auto columns = columns_of(list);
  std::string text;
  for (const Pass& p : list.passes) {
    JsonWriter w;
    w.begin_object();
    for (const PassColumn& c : columns) {
      const Value v = c.value(list, p);
      w.key(c.name);
      v.quoted ? w.value(v.text) : w.raw(v.text.empty() ? "null" : v.text);
    }
    text += w.end_object().take() + '\n';
  }
  return text;
}

}  // namespace dmise
