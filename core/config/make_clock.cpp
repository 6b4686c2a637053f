#include "core/config/make_clock.h"

#include "core/time/iso8601.h"

namespace dmise {

Clock make_clock(const Scenario& scenario) {
  std::shared_ptr<const IersTable> table;
  if (!scenario.earth_orientation_path.empty())
    table = std::make_shared<const IersTable>(
        IersTable::read_finals2000a(scenario.earth_orientation_path));
  return Clock(parse_utc(scenario.start_utc), std::move(table));
}

}  // namespace dmise
