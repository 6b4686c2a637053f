#include "launch/process/status_table.h"

#include <algorithm>

#include "core/base/formatted.h"
#include "core/base/printable.h"

namespace dmise {

std::string status_table(const RunStatus& status) {
  std::string text =
      formatted("run %016llx  %s%s  tick %ld of %ld  %.1f s simulated\n",
                static_cast<unsigned long long>(status.run_id), phase_name(status.phase),
                status.paused ? ", paused" : "", long(status.settled), long(status.last_tick),
                double(std::max<Tick>(status.settled, 0)) * status.tick_length.seconds());
  if (!status.start_utc.empty()) text += "start: " + printable(status.start_utc) + "\n";
  if (!status.cause.empty()) text += "cause: " + printable(status.cause) + "\n";
  if (!status.missing.empty()) text += "missing: " + printable(joined(status.missing)) + "\n";
  if (!status.holding.empty()) text += "waiting for: " + printable(joined(status.holding)) + "\n";
  if (status.pace > 0.0) text += formatted("pace: %g times real time\n", status.pace);
  if (status.overruns > 0)
    text += formatted("overruns: %llu, at most %.2f s late\n",
                      static_cast<unsigned long long>(status.overruns), status.worst_lag_s);
  text += formatted("%-24s %-8s %6s %5s %10s %10s %10s\n", "node", "state", "tick", "start",
                    "compute s", "message s", "wait s");
  for (const auto& node : status.nodes)
    text +=
        formatted("%-24s %-8s %6ld %5llu %10.2f %10.2f %10.2f\n", printable(node.name, 64).c_str(),
                  !node.alive     ? "lost"
                  : node.observer ? "observes"
                                  : "alive",
                  long(node.done), static_cast<unsigned long long>(node.incarnation),
                  node.times.compute_s, node.times.messaging_s, node.times.waiting_s);
  return text;
}

}  // namespace dmise
