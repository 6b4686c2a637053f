#include "core/orbit/sp3.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/files/text_fields.h"
#include "core/base/files/text_file.h"
#include "core/base/printable.h"
#include "core/base/units.h"
#include "core/orbit/time_system.h"

namespace dmise {
namespace {

/// Names of time systems in SP3, and what `time_system` calls them. The clocks of Galileo, QZSS and
/// NavIC are kept to those of GPS, GLONASS' to UTC, within a microsecond.
constexpr std::pair<std::string_view, std::string_view> sp3_systems[] = {
    {"GPS", "GPS"}, {"GAL", "GPS"}, {"QZS", "GPS"}, {"IRN", "GPS"},
    {"GLO", "UTC"}, {"UTC", "UTC"}, {"TAI", "TAI"}};
constexpr TimeSystem beidou{33.0};  // UTC of 2006-01-01, counted on without leap seconds

/// Axes that do not turn with the Earth, by how their names begin.
constexpr std::string_view celestial_axes[] = {"ICRF", "GCRF", "J2000", "EME",
                                               "TEME", "TOD",  "MOD"};

constexpr int hermite_degree = 11, hermite_epochs = 6;
constexpr int lagrange_degree = 9, lagrange_epochs = 10;
constexpr double no_value = 999999.999999;  // as of clocks
constexpr double decimetre_per_s = 0.1;
constexpr std::size_t ids_shown = 8;

/// A position of the satellite, and what a V line adds.
struct Sp3State {
  double t_s = 0.0;
  Vec<OemAxes> position_m, velocity_m_per_s;
  bool has_velocity = false;
  bool begins = false;  // nothing joins it to the position before
};

/// Parses one file from top to bottom; the members are the state of the parser.
class Sp3Reader {
 public:
  Sp3Reader(std::string_view text, const std::string& source, const std::string& satellite)
      : lines_(without_byte_order_mark(text)),
        source_(source),
        wanted_(printable(upper_case(satellite))),
        is_named_(!satellite.empty()) {}

  Trajectory read() {
    read_header();
    while (const auto next = lines_.next()) {
      line_ = *next;
      if (trimmed(line_) == "EOF") return finished();
      if (!trimmed(line_).empty()) take_line();
    }
    throw ConfigError(source_ + ": is cut off: the last line must be EOF");
  }

 private:
  [[noreturn]] void fail(int column, const std::string& reason, std::string_view value) const {
    const std::string at = source_ + ":" + std::to_string(lines_.line());
    throw ConfigError(at_line(at, column, reason + got(value)));
  }

  /// Columns `first` to `last`, counted from 1, without blanks around.
  std::string_view columns(std::size_t first, std::size_t last) const {
    if (line_.size() < first) return {};
    return trimmed(line_.substr(first - 1, last - first + 1));
  }

  double number(std::size_t first, std::size_t last) const {
    const std::string_view field = columns(first, last);
    const auto value = parse_real(field);
    if (!value) fail(int(first), "not a number", field);
    return *value;
  }

  void read_header() {
    const auto first = lines_.next();
    if (!first) throw ConfigError(source_ + ": is empty");
    line_ = *first;
    const std::string_view version = line_.substr(0, 2);
    if (version != "#c" && version != "#d")
      fail(1, "not an SP3-c or SP3-d, which begin with #c or #d", line_.substr(0, 10));
    const std::string_view axes = columns(47, 51);
    for (const std::string_view name : celestial_axes)
      if (upper_case(axes).starts_with(name)) fail(47, "axes must turn with the Earth", axes);
    line_ = lines_.next().value_or("");
    if (!line_.starts_with("##"))
      fail(1, "the second line must begin with ##", line_.substr(0, 10));
    interval_s_ = number(25, 38);
    if (!(interval_s_ > 0)) fail(25, "the interval must be > 0", columns(25, 38));
  }

  void take_line() {
    switch (line_.front()) {
      case '*':
        return take_epoch();
      case 'P':
        return take_position();
      case 'V':
        return take_velocity();
      case 'E':  // EP and EV
      case '+':
      case '/':
        return;
      case '%':
        if (line_.starts_with("%c") && !system_) set_system();
        return;
      default:
        fail(1, "not a line of SP3", line_.substr(0, 10));
    }
  }

  void set_system() {
    const std::string_view name = columns(10, 12);
    const auto* known =
        std::ranges::find(sp3_systems, name, [](const auto& system) { return system.first; });
    if (known != std::end(sp3_systems))
      system_ = time_system(known->second);
    else if (name == "BDT")
      system_ = beidou;
    else
      fail(10, "the time system must be GPS, GLO, GAL, QZS, BDT, IRN, TAI or UTC", name);
  }

  /// The epoch of the line in the form of ISO 8601.
  std::string iso_text() const {
    const auto two_digits = [](std::string_view digits) {
      const bool is_short = digits.substr(0, digits.find('.')).size() < 2;
      return (is_short ? "0" : "") + std::string(digits);
    };
    return std::string(columns(4, 7)) + "-" + two_digits(columns(9, 10)) + "-" +
           two_digits(columns(12, 13)) + "T" + two_digits(columns(15, 16)) + ":" +
           two_digits(columns(18, 19)) + ":" + two_digits(columns(21, 31));
  }

  void take_epoch() {
    if (!system_) fail(1, "the time system must be stated before, in a %c line", line_);
    const auto time = tai_of(iso_text(), *system_);
    if (!time) fail(4, "not a time", columns(4, 31));
    if (!reference_) reference_ = time;
    const double t_s = seconds_between(*reference_, *time);
    if (epoch_s_ && t_s <= *epoch_s_) fail(4, "times must increase", columns(4, 31));
    epoch_s_ = t_s;
    last_position_ = nullptr;
    known_at_epoch_ = false;
  }

  /// Whether the line is of the satellite that is read.
  bool is_of_satellite() {
    const std::string id = printable(upper_case(columns(2, 4)));
    if (id.empty()) fail(2, "names no satellite", line_.substr(0, 10));
    ids_.insert(id);
    if (wanted_.empty()) wanted_ = id;
    return id == wanted_;
  }

  /// Three numbers of the line; nothing if they mean that there is no value.
  std::optional<Vec<OemAxes>> vector(double unit) const {
    std::array<double, 3> v{};
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = number(5 + 14 * i, 18 + 14 * i);
    if (std::ranges::any_of(v, [](double x) { return std::abs(x) >= no_value; })) return {};
    if (std::ranges::all_of(v, [](double x) { return x == 0.0; })) return {};
    return Vec<OemAxes>{v[0] * unit, v[1] * unit, v[2] * unit};
  }

  void take_position() {
    if (!epoch_s_) fail(1, "a position before the first epoch", line_.substr(0, 10));
    if (!is_of_satellite()) return;
    if (known_at_epoch_) fail(2, "the satellite has two positions at one epoch", columns(2, 4));
    known_at_epoch_ = true;
    const bool manoeuvre = columns(79, 79) == "M";
    const auto position_m = vector(km);
    if (!position_m) {
      interrupted_ = true;
      return;
    }
    const bool late = !states_.empty() && *epoch_s_ - states_.back().t_s > 1.5 * interval_s_;
    states_.push_back({.t_s = *epoch_s_,
                       .position_m = *position_m,
                       .begins = states_.empty() || interrupted_ || manoeuvre || late});
    interrupted_ = false;
    last_position_ = &states_.back();
  }

  void take_velocity() {
    if (!is_of_satellite()) return;
    if (!known_at_epoch_) fail(1, "a velocity without a position before it", line_.substr(0, 10));
    const auto velocity_m_per_s = vector(decimetre_per_s);
    if (!last_position_ || !velocity_m_per_s) return;
    last_position_->velocity_m_per_s = *velocity_m_per_s;
    last_position_->has_velocity = true;
  }

  std::string shown_ids() const {
    std::string text;
    std::size_t shown = 0;
    for (const auto& id : ids_) {
      if (shown++ == ids_shown) return text + " and others";
      text += (text.empty() ? "" : ", ") + id;
    }
    return text;
  }

  Trajectory finished() {
    if (ids_.empty()) throw ConfigError(source_ + ": contains no position");
    if (!ids_.contains(wanted_))
      throw ConfigError(source_ + ": has no satellite " + wanted_ + ", only " + shown_ids());
    if (!is_named_ && ids_.size() > 1)
      throw ConfigError(source_ + ": is of several satellites, " + shown_ids() + ": name one");
    hermite_ = std::ranges::all_of(states_, [](const Sp3State& s) { return s.has_velocity; });
    trajectory_.source = source_;
    trajectory_.reference = *reference_;
    for (auto first = states_.begin(); first != states_.end();) {
      const auto next =
          std::find_if(first + 1, states_.end(), [](const Sp3State& s) { return s.begins; });
      add_segment({first, next});
      first = next;
    }
    if (trajectory_.segments.empty())
      throw ConfigError(source_ + ": " + wanted_ + " needs " + std::to_string(needed_epochs()) +
                        " positions in a row, an interval apart");
    return std::move(trajectory_);
  }

  int needed_epochs() const { return hermite_ ? hermite_epochs : lagrange_epochs; }

  void add_segment(const std::vector<Sp3State>& states) {
    if (int(states.size()) < needed_epochs()) return;
    OemSegment s{.object_name = wanted_,
                 .frame = OemFrame::itrs,
                 .interpolation = hermite_ ? OemInterpolation::hermite : OemInterpolation::lagrange,
                 .degree = hermite_ ? hermite_degree : lagrange_degree,
                 .usable_start_s = states.front().t_s,
                 .usable_stop_s = states.back().t_s};
    for (const Sp3State& state : states) {
      s.time_s.push_back(state.t_s);
      s.position_m.push_back(state.position_m);
      if (hermite_) s.velocity_m_per_s.push_back(state.velocity_m_per_s);
    }
    trajectory_.segments.push_back(std::move(s));
  }

  LineReader lines_;
  std::string_view line_;
  std::string source_;
  std::string wanted_;  // the satellite
  bool is_named_;       // by the caller; else it is the first of the file
  double interval_s_ = 0.0;
  std::optional<TimeSystem> system_;
  std::optional<Tai> reference_;
  std::optional<double> epoch_s_;  // since the reference
  bool known_at_epoch_ = false;    // the satellite has a position at the epoch
  bool interrupted_ = false;       // since the last position
  Sp3State* last_position_ = nullptr;
  std::vector<Sp3State> states_;
  std::set<std::string> ids_;
  bool hermite_ = false;
  Trajectory trajectory_;
};

}  // namespace

Trajectory parse_sp3(std::string_view text, const std::string& source,
                     const std::string& satellite) {
  return Sp3Reader(text, source, satellite).read();
}

Trajectory read_sp3(const std::string& path, const std::string& satellite) {
  return parse_sp3(read_text_file(path), path, satellite);
}

}  // namespace dmise
