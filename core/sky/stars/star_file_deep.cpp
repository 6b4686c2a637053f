// KStars' binary star files: Tycho-2 in deepstars.dat. A text of 124 bytes, a mark of the byte
// order (int16 0x4B53), a version (int8), the number of fields of a record (int16) and of each its
// name, size, type and scale (char[10], int8, int8, int32); the number of trixels (int32) and of
// each its number, offset and records (3 x int32); the faintest magnitude in hundredths (int16),
// the level of the mesh (int8), the most records of a trixel (int16). Then the records, of one
// trixel after the other, bright to faint.
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <numeric>
#include <string_view>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/sky/stars/star_file.h"

namespace dmise {
namespace {

static_assert(std::endian::native == std::endian::little, "records are read as they lie there");

constexpr std::size_t text_bytes = 124, trixel_bytes = 12, record_bytes = 32;
constexpr std::int16_t byte_order_mark = 0x4B53;
constexpr std::int32_t max_trixels = 8 << 14;

/// A record. Units are by the scales of the fields below.
struct Record {
  std::int32_t ra = 0;      // 1e-6 h
  std::int32_t dec = 0;     // 1e-5 deg
  std::int32_t pm_ra = 0;   // 0.1 mas/yr, times cos Dec
  std::int32_t pm_dec = 0;  // 0.1 mas/yr
  std::int32_t parallax = 0;
  std::int32_t hd = 0;
  std::int16_t vt = 0;     // 0.01 mag
  std::int16_t bt_vt = 0;  // 0.01 mag
  std::array<char, 2> spectral_type{};
  std::uint8_t flags = 0, unused = 0;
};
static_assert(sizeof(Record) == record_bytes);

struct Field {
  std::string_view name;
  std::int8_t size;
  std::int32_t scale;
};
constexpr std::array<Field, 11> fields = {{{"RA", 4, 1'000'000},
                                           {"Dec", 4, 100'000},
                                           {"dRA", 4, 10},
                                           {"dDec", 4, 10},
                                           {"parallax", 4, 10},
                                           {"HD", 4, 10},
                                           {"mag", 2, 100},
                                           {"bv_index", 2, 100},
                                           {"spec_type", 2, 0},
                                           {"flags", 1, 0},
                                           {"unused", 1, 100}}};

/// Goes through a file's bytes; what is wrong is told with the byte at which it stands.
class DeepFile {
 public:
  DeepFile(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  [[noreturn]] void fail(const std::string& why, std::size_t at) const {
    throw ConfigError(name_ + ": byte " + std::to_string(at) + ": " + why);
  }
  template <class T>
  T take() {
    T value;
    need(sizeof value);
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  void need(std::size_t count) const {
    if (bytes_.size() - at_ < count) fail("the file ends before its time", bytes_.size());
  }
  void skip(std::size_t count) { need(count), at_ += count; }
  std::size_t at() const { return at_; }
  std::size_t left() const { return bytes_.size() - at_; }

 private:
  std::string_view bytes_;
  const std::string& name_;
  std::size_t at_ = 0;
};

void check_fields(DeepFile& file) {
  file.skip(text_bytes);
  if (file.take<std::int16_t>() != byte_order_mark) file.fail("is not little-endian", text_bytes);
  file.skip(1);
  const std::size_t counted_at = file.at();
  if (const int count = file.take<std::int16_t>(); count != int(fields.size()))
    file.fail("must have 11 fields a record, has " + std::to_string(count), counted_at);
  for (const Field& field : fields) {
    const std::size_t at = file.at();
    const auto name = file.take<std::array<char, 10>>();
    const auto size = file.take<std::int8_t>();
    file.skip(1);
    const auto scale = file.take<std::int32_t>();
    const std::string_view named(name.data(), strnlen(name.data(), name.size()));
    if (named != field.name || size != field.size || scale != field.scale)
      file.fail("must describe the field " + std::string(field.name), at);
  }
}

/// Numbers of records by trixel; they begin where the file stands then.
std::vector<std::uint32_t> records_of_trixels(DeepFile& file) {
  const std::size_t counted_at = file.at();
  const auto trixels = file.take<std::int32_t>();
  if (trixels < 1 || trixels > max_trixels) file.fail("no such number of trixels", counted_at);
  file.need(std::size_t(trixels) * trixel_bytes);
  constexpr std::size_t after_trixels = 5;
  std::size_t next = file.at() + std::size_t(trixels) * trixel_bytes + after_trixels;
  std::vector<std::uint32_t> records;
  for (std::int32_t k = 0; k < trixels; ++k) {
    const std::size_t at = file.at();
    const auto trixel = file.take<std::int32_t>();
    const auto offset = file.take<std::uint32_t>();
    const auto count = file.take<std::int32_t>();
    if (trixel != k || offset != next || count < 0)
      file.fail("trixel " + std::to_string(k) + " must begin at byte " + std::to_string(next), at);
    records.push_back(std::uint32_t(count));
    next += std::size_t(count) * record_bytes;
  }
  file.skip(after_trixels);
  std::size_t all = 0;
  for (const std::uint32_t count : records) all += count;
  if (all * record_bytes != file.left())
    file.fail("must hold " + std::to_string(all) + " records of 32 bytes, holds " +
                  std::to_string(file.left()) + " bytes",
              file.at());
  return records;
}

/// Whether each record is the first with its content.
std::vector<bool> are_first(const std::vector<Record>& records) {
  std::vector<std::uint32_t> order(records.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto compare = [&](std::uint32_t a, std::uint32_t b) {
    return std::memcmp(&records[a], &records[b], record_bytes);
  };
  std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
    const int by_content = compare(a, b);
    return by_content != 0 ? by_content < 0 : a < b;
  });
  std::vector<bool> first(records.size(), true);
  for (std::size_t i = 1; i < order.size(); ++i)
    if (compare(order[i - 1], order[i]) == 0) first[order[i]] = false;
  return first;
}

/// V and B-V by VT and BT-VT. Source: Hog et al. 2000, Guide to the Tycho-2 Catalogue, section 2;
/// held for BT-VT of -0.2 to 1.8, for which it stands.
StarRecord star_of(const Record& r, std::uint32_t number) {
  const double bt_vt = 0.01 * r.bt_vt;
  StarRecord star{.id = first_deep_star_id + number,
                  .ra_rad = r.ra * 1e-6 * 15 * deg,
                  .dec_rad = r.dec * 1e-5 * deg,
                  .v_mag = 0.01 * r.vt - 0.090 * std::clamp(bt_vt, -0.2, 1.8),
                  .bv = 0.850 * bt_vt};
  if (r.pm_ra != 0 || r.pm_dec != 0) {
    star.pm_ra_cosdec_rad_per_yr = 0.1 * r.pm_ra * mas;
    star.pm_dec_rad_per_yr = 0.1 * r.pm_dec * mas;
  }
  return star;  // without its parallax, whose noise is larger than most parallaxes
}

}  // namespace

StarReading parse_deep_stars(std::string_view bytes, const std::string& name) {
  DeepFile file(bytes, name);
  check_fields(file);
  const std::vector<std::uint32_t> trixels = records_of_trixels(file);
  std::vector<Record> records;
  records.reserve(file.left() / record_bytes);
  for (const std::uint32_t count : trixels)
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::size_t at = file.at();
      const auto record = file.take<Record>();
      if (i > 0 && record.vt < records.back().vt)
        file.fail("the records of a trixel must be sorted from bright to faint", at);
      records.push_back(record);
    }
  const std::vector<bool> first = are_first(records);
  StarReading reading;
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (!first[i]) continue;
    const auto number = std::uint32_t(i + 1);
    if (const char* why = append_star(reading.catalogue, star_of(records[i], number)))
      reading.problems.push_back(name + ": record " + std::to_string(number) + ": " + why);
  }
  return reading;
}

}  // namespace dmise
