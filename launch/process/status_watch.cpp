#include "launch/process/status_watch.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include "core/base/formatted.h"
#include "core/base/printable.h"

namespace dmise {
namespace {

constexpr std::string_view plain = "\x1b[0m", bold = "\x1b[1m", green = "\x1b[32m",
                           yellow = "\x1b[33m", red = "\x1b[31m";

/// `text` in so many characters; UTF-8 is cut between characters.
std::string cut(const std::string& text, std::size_t columns) {
  std::size_t seen = 0, at = 0;
  while (at < text.size()) {
    if ((text[at] & 0xc0) != 0x80 && seen++ == columns) break;
    ++at;
  }
  return text.substr(0, at);
}

std::string padded(const std::string& text, std::size_t columns) {
  std::string out = cut(text, columns);
  std::size_t seen = 0;
  for (const char c : out) seen += (c & 0xc0) != 0x80;
  return out + std::string(columns - seen, ' ');
}

/// "1:02:03.5"
std::string time_text(double seconds) {
  const auto tenths = static_cast<long long>(std::max(0.0, seconds) * 10.0 + 0.5);
  return formatted("%lld:%02lld:%02lld.%lld", tenths / 36000, tenths / 600 % 60, tenths / 10 % 60,
                   tenths % 10);
}

}  // namespace

bool wants_colours(bool terminal, const char* no_color, const char* term) {
  if (!terminal || (no_color && *no_color)) return false;
  return term && *term && std::string_view(term) != "dumb";
}

void StatusWatch::take(const RunStatus& status, double now_s) {
  const double tick_s = status.tick_length.seconds();
  for (const NodeStatus& node : status.nodes) {
    const auto [found, is_new] = nodes_.try_emplace(node.name);
    History& h = found->second;
    if (is_new) h.incarnation = node.incarnation;
    const std::string when = " at " + time_text(double(std::max<Tick>(node.done, 0)) * tick_s);
    if (node.incarnation > h.incarnation) {
      h.gaps += int(node.incarnation - h.incarnation);
      h.last_error = "restarted" + when;
      h.rate.reset();
    } else if (!node.alive && h.alive) {
      ++h.gaps;
      h.last_error = "lost" + when;
    }
    h.incarnation = node.incarnation;
    h.alive = node.alive;
    if (status.paused) h.rate.reset();
    h.rate.take(node.done, now_s);
  }
  status_ = status;
  answered_s_ = now_s;
  silent_s_ = 0.0;
  silence_.clear();
}

void StatusWatch::miss(const std::string& reason, double now_s) {
  silent_s_ = std::max(1e-3, now_s - answered_s_);
  silence_ = reason;
}

std::string StatusWatch::table(const Layout& layout) const {
  const auto columns = std::size_t(std::max(20, layout.columns));
  const double tick_s = status_.tick_length.seconds();
  std::vector<std::string> lines;
  const auto add = [&](const std::string& text, std::string_view colour = {}) {
    std::string line = cut(text, columns);
    if (layout.colours && !colour.empty()) line = std::string(colour) + line + std::string(plain);
    lines.push_back(std::move(line));
  };
  const auto at_s = [&](Tick tick) { return double(std::max<Tick>(tick, 0)) * tick_s; };
  add(formatted("run %016llx  %s%s  ", static_cast<unsigned long long>(status_.run_id),
                phase_name(status_.phase), status_.paused ? ", paused" : "") +
          time_text(at_s(status_.settled)) + " of " + time_text(at_s(status_.last_tick)) +
          formatted("  tick %ld of %ld", long(status_.settled), long(status_.last_tick)),
      bold);
  if (!status_.start_utc.empty()) add("start: " + printable(status_.start_utc));
  if (silent_s_ > 0.0)
    add(formatted("no answer for %.0f s: ", silent_s_) + printable(silence_), yellow);
  if (!status_.cause.empty()) add("cause: " + printable(status_.cause), red);
  if (!status_.missing.empty()) add("missing: " + printable(joined(status_.missing)), yellow);
  if (!status_.holding.empty()) add("waiting for: " + printable(joined(status_.holding)));
  if (status_.pace > 0.0) add(formatted("pace: %g times real time", status_.pace));
  if (status_.overruns > 0)
    add(formatted("overruns: %llu, at most %.2f s late",
                  static_cast<unsigned long long>(status_.overruns), status_.worst_lag_s),
        yellow);
  const std::size_t name_columns = columns >= 100 ? 24 : 16;
  add(padded("node", name_columns) + " state         time     rate      lag  gaps  last error",
      bold);
  Tick first = -1;
  for (const NodeStatus& node : status_.nodes)
    if (node.alive && !node.observer) first = std::max(first, node.done);
  // One line is left for what does not fit, and one for the keys.
  const auto room = std::size_t(std::max(1, layout.rows - 2 - int(lines.size())));
  std::size_t shown = 0;
  for (const NodeStatus& node : status_.nodes) {
    if (shown == room && status_.nodes.size() > room) break;
    ++shown;
    const auto found = nodes_.find(node.name);
    const History none;
    const History& h = found == nodes_.end() ? none : found->second;
    const bool held = std::ranges::find(status_.holding, node.name) != status_.holding.end();
    const char* state = !node.alive     ? "lost"
                        : node.observer ? "observes"
                        : held          ? "awaited"
                                        : "alive";
    const bool keeps_time = node.done >= 0;  // the broker and most observers do no ticks
    const std::string lag =
        keeps_time ? formatted("%.4g s", std::max(0.0, at_s(first) - at_s(node.done))) : "-";
    add(padded(printable(node.name, 64), name_columns) + " " + padded(state, 8) +
            formatted(" %9s %8s %8s %5d  ", time_text(at_s(node.done)).c_str(),
                      keeps_time ? formatted("%.3gx", h.rate.ticks_per_s() * tick_s).c_str() : "-",
                      lag.c_str(), h.gaps) +
            h.last_error,
        !node.alive ? red
        : held      ? yellow
                    : green);
  }
  if (shown < status_.nodes.size())
    add(formatted("and %zu more nodes", status_.nodes.size() - shown));
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

}  // namespace dmise
