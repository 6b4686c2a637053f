#include "core/products/product_json.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <type_traits>

#include "core/base/error.h"
#include "core/base/files/json.h"
#include "core/products/unknown_fields.h"

namespace dmise {
namespace {

template <class T>
concept Number = std::same_as<T, double>;
/// Values that are written as they are, whatever the unit.
template <class T>
concept Plain = std::integral<T> || std::same_as<T, std::string>;

class JsonFieldWriter {
 public:
  JsonFieldWriter(const UtcText& utc, const UnknownFacts& unknown) : utc_(utc), unknown_(unknown) {
    json_.begin_object();
  }
  std::string end() { return json_.end_object().take(); }

  template <class T>
  void operator()(const char* name, const T& member, const char* key = nullptr, double unit = 1.0) {
    write(key ? key : name, member, unit);
  }
  void pair(const char*, double x, const char*, double y, const char* key, double unit = 1.0) {
    write(key, std::array{x, y}, unit);
  }
  void pair_or_null(bool is, const char*, double x, const char*, double y, const char* key) {
    is ? write(key, std::array{x, y}, 1.0) : null(key);
  }
  void constant(const char* key, const char* value) { json_.field(key, value); }
  template <class T>
  void null_unless(bool is, const char* name, const T& member) {
    is ? write(name, member, 1.0) : null(name);
  }
  template <class T>
  void absent_unless(bool is, const char* name, const T& member, const char* key = nullptr) {
    if (is) write(key ? key : name, member, 1.0);
  }
  void notes(const char* key, const std::vector<std::string>& texts) {
    if (!texts.empty()) json_.list(key, texts);
  }
  void fits_plane(const char* key, const Projection& projection, bool distorted) {
    json_.field(key, projection.row().fits_code + std::string(distorted ? "-SIP" : ""));
    coefficients(projection);
  }
  void lens(const char* key, const std::optional<Projection>& lens) {
    if (!lens) return;
    json_.field(key, lens->name());
    coefficients(*lens);
  }

 private:
  void write(std::string_view key, Number auto value, double unit) { put(key, value / unit); }
  void write(std::string_view key, const Plain auto& value, double) { put(key, value); }
  void write(std::string_view key, Named auto value, double) { put(key, name_of(value)); }
  void write(const std::string& key, SimTime time, double) {
    put(key + "_ns", time.ns);
    is_unknown(key + "_utc", unknown_) ? null(key + "_utc") : put(key + "_utc", utc_(time));
  }
  template <class F>
  void write(std::string_view key, const Vec<F>& v, double unit) {
    write(key, std::array{v.x, v.y, v.z}, unit);
  }
  void write(std::string_view key, const std::optional<double>& value, double unit) {
    if (value) write(key, *value, unit);
  }
  void write(std::string_view key, const std::optional<Quaternion>& q, double unit) {
    if (q) write(key, std::array{q->w, q->x, q->y, q->z}, unit);
  }
  void write(std::string_view key, const std::vector<std::string>& texts, double) {
    json_.list(key, texts);
  }
  template <class Numbers>
  requires Number<typename Numbers::value_type>
  void write(std::string_view key, const Numbers& numbers, double unit) {
    if (is_unknown(key, unknown_)) return null(key);
    json_.key(key).begin_array();
    for (const double v : numbers) json_.value(v / unit);
    json_.end_array();
  }
  void write(std::string_view key, const Wcs& wcs, double) {
    is_unknown(key, unknown_) ? null(key) : object(key, wcs);
  }
  template <HasFields T>
  void write(std::string_view key, const std::optional<T>& part, double) {
    if (part) object(key, *part);
  }
  template <HasFields T>
  void write(std::string_view key, const std::vector<T>& parts, double) {
    json_.key(key).begin_array();
    for (const T& part : parts) {
      json_.begin_object();
      visit_fields(*this, part);
      json_.end_object();
    }
    json_.end_array();
  }
  template <class T>
  void object(std::string_view key, const T& value) {
    json_.key(key).begin_object();
    visit_fields(*this, value);
    json_.end_object();
  }
  template <class T>
  void put(std::string_view key, const T& value) {
    is_unknown(key, unknown_) ? null(key) : void(json_.field(key, value));
  }
  void null(std::string_view key) { json_.key(key).null(); }
  void coefficients(const Projection& projection) {
    const auto names = projection.row().coefficients;
    for (std::size_t i = 0; i < names.size(); ++i)
      json_.field(names[i].key, projection.coefficients()[i]);
  }

  JsonWriter json_;
  const UtcText& utc_;
  const UnknownFacts unknown_;
};

template <class Product>
std::string line_of(const Product& product, const UtcText& utc, const UnknownFacts& unknown = {}) {
  JsonFieldWriter writer(utc, unknown);
  visit_fields(writer, product);
  return writer.end();
}

/// The names of projections for lenses, or their codes in FITS.
std::vector<std::string> names_of(const char* Projection::Row::*kind) {
  std::vector<std::string> names;
  for (const Projection::Row& row : Projection::rows())
    if (row.*kind) names.emplace_back(row.*kind);
  return names;
}

void check(const JsonRecord& object, const Wcs& wcs) {
  if (wcs.order < 0 || wcs.order > 9) object.fail("order", "must be 0 to 9");
  const auto side = std::size_t(wcs.order + 1), terms = wcs.order > 0 ? side * side : 0;
  for (const auto& [key, polynomial] : {std::pair("a", &wcs.a), std::pair("b", &wcs.b),
                                        std::pair("ap", &wcs.ap), std::pair("bp", &wcs.bp)})
    if (polynomial->size() != terms)
      object.fail(key, "must have " + std::to_string(terms) + " numbers");
  if (wcs.cd_deg[0] * wcs.cd_deg[3] == wcs.cd_deg[1] * wcs.cd_deg[2])
    object.fail("cd_deg_per_px", "has no inverse");
}

void check(const JsonRecord& object, const WcsRefraction& air) {
  if (!(air.focal_length_px > 0.0)) object.fail("focal_length_px", "must be > 0");
}

void check(const JsonRecord& object, const LightCurve& light) {
  for (const auto& [key, list] :
       {std::pair("time_s", &light.time_s), std::pair("light_e", &light.light_e),
        std::pair("sigma_e", &light.sigma_e), std::pair("correlation", &light.correlation)})
    if (list->size() != light.along_px.size() && !list->empty())
      object.fail(key, "must have as many numbers as along_px");
}

void check(const JsonRecord&, const LightPeriod&) {}
void check(const JsonRecord&, const KeptManoeuvre&) {}

class JsonFieldReader {
 public:
  explicit JsonFieldReader(const JsonRecord& record) : record_(record) {}

  template <class T>
  void operator()(const char* name, T& member, const char* key = nullptr, double unit = 1.0) {
    read(key ? key : name, member, unit);
  }
  void pair(const char*, double& x, const char*, double& y, const char* key, double unit = 1.0) {
    const auto v = record_.numbers<2>(key);
    x = v[0] * unit;
    y = v[1] * unit;
  }
  void pair_or_null(bool, const char*, double& x, const char*, double& y, const char* key) {
    if (record_.has(key)) pair("", x, "", y, key);
  }
  void constant(const char*, const char*) {}
  template <class T>
  void null_unless(bool, const char* name, T& member) {
    if (record_.has(name)) read(name, member, 1.0);
  }
  template <class T>
  void absent_unless(bool, const char* name, T& member, const char* key = nullptr) {
    null_unless(true, key ? key : name, member);
  }
  void notes(const char* key, std::vector<std::string>& texts) {
    if (record_.has(key)) texts = record_.texts(key);
  }
  void fits_plane(const char* key, Projection& projection, bool) {
    std::string code = record_.get<std::string>(key);
    if (code.ends_with("-SIP")) code.resize(code.size() - 4);
    const auto index = Projection::index_of_fits_code(code);
    if (!index) record_.fail_as_none_of(names_of(&Projection::Row::fits_code), key, code);
    projection = projection_of(key, *index);
  }
  void lens(const char* key, std::optional<Projection>& lens) {
    if (!record_.has(key)) return;
    const std::string name = record_.get<std::string>(key);
    const auto index = Projection::index_of_name(name);
    if (!index) record_.fail_as_none_of(names_of(&Projection::Row::name), key, name);
    lens = projection_of(key, *index);
  }

 private:
  void read(const char* key, double& value, double unit) { value = record_.number(key) * unit; }
  template <Plain T>
  void read(const char* key, T& value, double) {
    value = record_.get<T>(key);
  }
  template <Named E>
  void read(const char* key, E& value, double) {
    const std::string name = record_.get<std::string>(key);
    const auto names = names_of(value);
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) record_.fail_as_none_of({names.begin(), names.end()}, key, name);
    value = E(found - names.begin());
  }
  void read(const char* key, SimTime& time, double) {
    time = record_.time((std::string(key) + "_ns").c_str());
  }
  template <class F>
  void read(const char* key, Vec<F>& vector, double) {
    const auto v = record_.numbers<3>(key);
    vector = {v[0], v[1], v[2]};
  }
  void read(const char* key, std::optional<double>& value, double unit) {
    if (record_.has(key)) value = record_.number(key) * unit;
  }
  void read(const char* key, std::optional<Quaternion>& value, double) {
    if (!record_.has(key)) return;
    const auto q = record_.numbers<4>(key);
    value = Quaternion{q[0], q[1], q[2], q[3]};
  }
  void read(const char* key, std::vector<std::string>& texts, double) {
    texts = record_.texts(key);
  }
  template <std::size_t N>
  void read(const char* key, std::array<double, N>& numbers, double unit) {
    numbers = record_.numbers<N>(key);
    for (double& value : numbers) value *= unit;
  }
  void read(const char* key, std::vector<double>& numbers, double) {
    numbers = record_.number_list(key);
  }
  void read(const char* key, Wcs& wcs, double) {
    const JsonRecord object = record_.object(key);
    JsonFieldReader reader(object);
    visit_fields(reader, wcs);
    if (wcs != Wcs{}) check(object, wcs);  // a sensor without pixels has none
  }
  template <HasFields T>
  void read(const char* key, std::optional<T>& part, double) {
    if (!record_.has(key)) return;
    const JsonRecord object = record_.object(key);
    JsonFieldReader reader(object);
    visit_fields(reader, part.emplace());
    check(object, *part);
  }
  template <HasFields T>
  void read(const char* key, std::vector<T>& parts, double) {
    for (const JsonRecord& object : record_.objects(key)) {
      JsonFieldReader reader(object);
      visit_fields(reader, parts.emplace_back());
    }
  }
  Projection projection_of(const char* key, std::size_t index) const {
    std::vector<double> coefficients;
    for (const ProjectionCoefficient& c : Projection::rows()[index].coefficients)
      coefficients.push_back(record_.number(c.key));
    try {
      return Projection::make(index, coefficients);
    } catch (const Error& error) {
      record_.fail(key, error.what());
    }
  }

  const JsonRecord& record_;
};

template <class Product>
Product read_product(const JsonRecord& record) {
  Product product;
  JsonFieldReader reader(record);
  visit_fields(reader, product);
  return product;
}

}  // namespace

std::string to_json(const Detection& d, const UtcText& utc, const UnknownFacts& unknown) {
  return line_of(d, utc, unknown);
}
std::string to_json(const FrameReport& r, const UtcText& utc, const UnknownFacts& unknown) {
  return line_of(r, utc, unknown);
}
std::string to_json(const Truth& t, const UtcText& utc) { return line_of(t, utc); }
std::string to_json(const Track& t, const UtcText& utc) { return line_of(t, utc); }
std::string to_json(const Task& t, const UtcText& utc) { return line_of(t, utc); }
std::string to_json(const KeptOrbit& k, const UtcText& utc) { return line_of(k, utc); }
std::string to_json(const FoundBreakup& b, const UtcText& utc) { return line_of(b, utc); }

Detection detection_of(const JsonRecord& line) {
  const auto d = read_product<Detection>(line);
  if (d.range_m.has_value() != d.range_sigma_m.has_value())
    line.fail("range_m", "goes with range_sigma_m");
  if (d.range_rate_m_per_s.has_value() != d.range_rate_sigma_m_per_s.has_value())
    line.fail("range_rate_m_per_s", "goes with range_rate_sigma_m_per_s");
  return d;
}

FrameReport report_of(const JsonRecord& line) { return read_product<FrameReport>(line); }
Truth truth_of(const JsonRecord& line) { return read_product<Truth>(line); }
Track track_of(const JsonRecord& line) { return read_product<Track>(line); }
Task task_of(const JsonRecord& line) { return read_product<Task>(line); }
KeptOrbit kept_orbit_of(const JsonRecord& line) { return read_product<KeptOrbit>(line); }
FoundBreakup found_breakup_of(const JsonRecord& line) { return read_product<FoundBreakup>(line); }

Wcs wcs_of(const JsonRecord& object) {
  const auto wcs = read_product<Wcs>(object);
  check(object, wcs);
  return wcs;
}

}  // namespace dmise
