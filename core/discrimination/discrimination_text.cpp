#include "core/discrimination/discrimination_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/base/error.h"
#include "core/base/files/json.h"
#include "core/base/printable.h"

namespace dmise {
namespace {

template <class... Values>
void add(std::string& text, const char* format, Values... values) {
  char line[512];
  std::snprintf(line, sizeof line, format, values...);
  text += line;
}

std::string seconds_text(const std::optional<double>& seconds) {
  std::string text;
  if (seconds)
    add(text, "%.3g", *seconds);
  else
    text = "never";
  return text;
}

void write_measured(JsonWriter& json, const Measured& m) {
  json.begin_object().field("value", m.value).field("sigma", m.sigma).end_object();
}

void write_seconds(JsonWriter& json, const std::optional<double>& seconds) {
  json.key("exposure_s");
  seconds ? json.value(*seconds) : json.null();
}

void write_points(JsonWriter& json, const char* key, const char* what,
                  const std::vector<DesignPoint>& points) {
  json.key(key).begin_array();
  for (const DesignPoint& p : points) {
    json.begin_object().field(what, p.value);
    write_seconds(json, p.exposure_s);
    json.end_object();
  }
  json.end_array();
}

constexpr Colour blue = {0, 114, 178};

bool was_left_out(const RunSpectra& spectra, const std::string& object) {
  const std::string named = " " + object + ": ";
  return std::any_of(spectra.left_out.begin(), spectra.left_out.end(),
                     [&](const std::string& why) { return why.find(named) != std::string::npos; });
}

}  // namespace

RunDiscrimination discriminate(RunSpectra given, const std::vector<MaterialSignature>& materials,
                               const std::map<std::string, std::string>& known) {
  std::vector<std::string> names;
  for (const auto& m : materials) names.push_back(m.name);
  const std::vector<std::string> objects = objects_of(given);
  for (const auto& [object, material] : known) {
    if (std::find(objects.begin(), objects.end(), object) == objects.end() &&
        !was_left_out(given, object))
      throw Error(object + ": no such object in the run, said to be " + material);
    if (std::find(names.begin(), names.end(), material) == names.end())
      throw Error(object + ": no such material among those compared: " + material);
  }
  RunDiscrimination run{
      .spectra = std::move(given), .materials = materials, .confusion = ConfusionMatrix(names)};
  const RunSpectra& spectra = run.spectra;
  const std::size_t bands = spectra.sensors.size();
  for (const std::string& name : objects) {
    ObjectSignature object{.object = name,
                           .summed = summed_light(spectra, name),
                           .scatter = std::vector<double>(bands - 1),
                           .sample_sigma = std::vector<double>(bands - 1)};
    std::vector<double> sum(bands - 1), square(bands - 1);
    std::size_t with_ratio = 0;
    for (const SpectralSample& sample : spectra.samples) {
      if (sample.object != name) continue;
      ++object.samples;
      std::vector<Measured> light;
      for (const auto& band : sample.bands) light.push_back(band.light);
      if (const auto is = known.find(name); is != known.end())
        run.confusion.add(is->second, compare_materials(light, materials).front().name);
      if (!(light[0].value > 0.0)) continue;
      ++with_ratio;
      for (std::size_t i = 0; i + 1 < bands; ++i) {
        const Measured ratio = flux_ratio(light[i + 1], light[0]);
        sum[i] += ratio.value;
        square[i] += ratio.value * ratio.value;
        object.sample_sigma[i] += ratio.sigma * ratio.sigma;
      }
    }
    for (std::size_t i = 0; i + 1 < bands && with_ratio > 0; ++i) {
      const double mean = sum[i] / double(with_ratio);
      object.sample_sigma[i] = std::sqrt(object.sample_sigma[i] / double(with_ratio));
      if (with_ratio > 1)
        object.scatter[i] =
            std::sqrt(std::max(0.0, square[i] - sum[i] * mean) / double(with_ratio - 1));
    }
    if (object.summed[0].value > 0.0)
      for (std::size_t i = 1; i < bands; ++i)
        object.ratios.push_back(flux_ratio(object.summed[i], object.summed[0]));
    object.fits = compare_materials(object.summed, materials);
    run.objects.push_back(std::move(object));
  }
  return run;
}

std::string discrimination_table(const RunDiscrimination& run) {
  std::string text;
  for (std::size_t i = 1; i < run.spectra.sensors.size(); ++i) {
    add(text, "reflectance in %s over that in %s (%.4g over %.4g um)\n",
        printable(run.spectra.sensors[i].band.name).c_str(),
        printable(run.spectra.sensors[0].band.name).c_str(),
        run.spectra.sensors[i].band.centre_m * 1e6, run.spectra.sensors[0].band.centre_m * 1e6);
    add(text, "%-24s %8s %18s %10s %10s  %s\n", "object", "samples", "ratio of all", "scatter",
        "expected", "material (probability)");
    for (const ObjectSignature& o : run.objects) {
      std::string ratio = "no light";
      if (!o.ratios.empty())
        ratio.clear(), add(ratio, "%.4g +- %.2g", o.ratios[i - 1].value, o.ratios[i - 1].sigma);
      add(text, "%-24s %8zu %18s %10.3g %10.3g  %s (%.3f)\n", printable(o.object).c_str(),
          o.samples, ratio.c_str(), o.scatter[i - 1], o.sample_sigma[i - 1],
          printable(o.fits[0].name).c_str(), o.fits[0].probability);
    }
    text += '\n';
  }
  const auto& names = run.confusion.names();
  bool any = false;
  for (std::size_t a = 0; a < names.size(); ++a) any = any || run.confusion.total(a) > 0;
  if (any) {
    text += "samples by what they are (rows) and what they are found to be\n";
    add(text, "%-18s", "");
    for (const auto& name : names) add(text, " %14.14s", printable(name).c_str());
    text += '\n';
    for (std::size_t a = 0; a < names.size(); ++a) {
      if (run.confusion.total(a) == 0) continue;
      add(text, "%-18.18s", printable(names[a]).c_str());
      for (std::size_t f = 0; f < names.size(); ++f) add(text, " %14zu", run.confusion.count(a, f));
      text += '\n';
    }
    add(text, "right: %.4f\n", run.confusion.accuracy());
  }
  if (!run.spectra.left_out.empty())
    add(text, "left out: %zu, the first: %s\n", run.spectra.left_out.size(),
        printable(run.spectra.left_out[0]).c_str());
  return text;
}

std::string discrimination_json(const RunDiscrimination& run) {
  JsonWriter json;
  json.begin_object().key("bands").begin_array();
  for (const SpectralSensor& s : run.spectra.sensors) {
    json.begin_object().field("sensor", s.name).field("band", s.band.name);
    json.field("centre_m", s.band.centre_m).field("width_m", s.band.width_m);
    json.field("aperture_fraction", s.aperture_fraction).end_object();
  }
  json.end_array().key("materials").begin_array();
  for (const MaterialSignature& m : run.materials) {
    json.begin_object().field("name", m.name).key("reflectance").begin_array();
    for (const double r : m.reflectance) json.value(r);
    json.end_array().end_object();
  }
  json.end_array().key("objects").begin_array();
  for (const ObjectSignature& o : run.objects) {
    json.begin_object().field("object", o.object).field("samples", std::uint64_t(o.samples));
    json.key("ratios").begin_array();
    for (std::size_t i = 0; i < o.ratios.size(); ++i) {
      json.begin_object().key("of_all");
      write_measured(json, o.ratios[i]);
      json.field("scatter", o.scatter[i]).field("expected_scatter", o.sample_sigma[i]).end_object();
    }
    json.end_array().key("light").begin_array();
    for (const Measured& m : o.summed) write_measured(json, m);
    json.end_array().key("materials").begin_array();
    for (const MaterialFit& f : o.fits)
      json.begin_object()
          .field("name", f.name)
          .field("probability", f.probability)
          .field("chi2", f.chi2)
          .end_object();
    json.end_array().end_object();
  }
  json.end_array().key("samples").begin_array();
  for (const SpectralSample& s : run.spectra.samples) {
    json.begin_object()
        .field("object", s.object)
        .field("frame", s.frame)
        .key("bands")
        .begin_array();
    for (const BandMeasurement& b : s.bands) {
      json.begin_object().field("x_px", b.centre.x_px).field("y_px", b.centre.y_px);
      json.field("flux_e", b.flux.flux_e).field("sigma_e", b.flux.sigma_e);
      json.field("background_e", b.flux.background_e).end_object();
    }
    json.end_array().end_object();
  }
  json.end_array().key("confusion").begin_object();
  const auto& names = run.confusion.names();
  for (std::size_t a = 0; a < names.size(); ++a) {
    if (run.confusion.total(a) == 0) continue;
    json.key(names[a]).begin_object();
    for (std::size_t f = 0; f < names.size(); ++f)
      json.field(names[f], std::uint64_t(run.confusion.count(a, f)));
    json.end_object();
  }
  json.end_object().key("left_out").begin_array();
  for (const auto& line : run.spectra.left_out) json.value(line);
  return json.end_array().end_object().take() + "\n";
}

std::string design_table(const DiscriminationDesign& d) {
  std::string text;
  add(text,
      "%s against %s, %.4g and %.4g um: exposure of each band that is right %g %% of the time\n",
      printable(d.materials[0].name).c_str(), printable(d.materials[1].name).c_str(),
      d.bands[0].centre_m * 1e6, d.bands[1].centre_m * 1e6, 100.0 * d.right);
  const auto lines = [&](const char* what, double unit, const std::vector<DesignPoint>& points,
                         std::size_t every) {
    add(text, "\n%-28s %s\n", what, "exposure, s");
    for (std::size_t i = 0; i < points.size(); i += every)
      add(text, "%-28.4g %s\n", points[i].value / unit, seconds_text(points[i].exposure_s).c_str());
  };
  lines("distance, km", 1e3, d.by_range_m, 4);
  lines("diameter of the optics, m", 1.0, d.by_aperture_m, 3);
  lines("photometric radius, px", 1.0, d.by_photometric_radius_px, 2);
  add(text, "\n%-28s %s\n", "bands of 50 nm, um", "exposure, s");
  for (std::size_t i = 0; i < d.pairs.size() && i < 12; ++i)
    add(text, "%.3f and %-18.3f %s\n", d.pairs[i].shorter.centre_m * 1e6,
        d.pairs[i].longer.centre_m * 1e6, seconds_text(d.pairs[i].exposure_s).c_str());
  return text;
}

std::string design_json(const DiscriminationDesign& d) {
  JsonWriter json;
  json.begin_object().key("materials").begin_array();
  for (const Material& m : d.materials) json.value(m.name);
  json.end_array().key("bands_m").begin_array();
  for (const Band& b : d.bands) json.value(b.centre_m);
  json.end_array().field("right", d.right).key("right_by_exposure").begin_array();
  for (const auto& [seconds, right] : d.right_by_exposure)
    json.begin_object().field("exposure_s", seconds).field("right", right).end_object();
  json.end_array();
  write_points(json, "by_range", "range_m", d.by_range_m);
  write_points(json, "by_aperture", "aperture_m", d.by_aperture_m);
  write_points(json, "by_photometric_radius", "radius_px", d.by_photometric_radius_px);
  json.key("pairs").begin_array();
  for (const BandPair& p : d.pairs) {
    json.begin_object().field("shorter_m", p.shorter.centre_m).field("longer_m", p.longer.centre_m);
    write_seconds(json, p.exposure_s);
    json.end_object();
  }
  return json.end_array().end_object().take() + "\n";
}

Chart range_chart(const DiscriminationDesign& d) {
  ChartSeries series{.label = "exposure of each band", .colour = blue, .lines = {{}}};
  double least = 1e9, most = 0.0;
  for (const DesignPoint& p : d.by_range_m)
    if (p.exposure_s) {
      series.lines[0].push_back({p.value / 1e3, *p.exposure_s});
      least = std::min(least, *p.exposure_s);
      most = std::max(most, *p.exposure_s);
    }
  if (series.lines[0].empty()) least = 0.1, most = 1.0;
  return {.title = d.materials[0].name + " against " + d.materials[1].name,
          .subtitle = "exposure that tells them apart",
          .x = logarithmic_axis("distance, km", 100.0, 10000.0),
          .y = logarithmic_axis("exposure, s", 0.8 * least, 1.3 * most),
          .series = {series}};
}

Chart exposure_chart(const DiscriminationDesign& d) {
  ChartSeries series{.label = "right", .colour = blue, .lines = {{}}};
  for (const auto& [seconds, right] : d.right_by_exposure)
    series.lines[0].push_back({seconds, right});
  ChartAxis y{.label = "probability of the right material", .least = 0.5, .most = 1.0, .ticks = {}};
  for (int i = 5; i <= 10; ++i)
    y.ticks.push_back({i / 10.0, i == 10 ? "1" : "0." + std::to_string(i)});
  return {.title = d.materials[0].name + " against " + d.materials[1].name,
          .subtitle = "one exposure of each band",
          .x = logarithmic_axis("exposure, s", 1e-3, 10.0),
          .y = y,
          .series = {series}};
}

}  // namespace dmise
