#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/base/parallel.h"
#include "core/orbit/elements/elements.h"
#include "core/time/iers.h"
#include "core/time/julian_date.h"

namespace dmise {

/// Axes in which the states of a catalogue are given.
enum class StateAxes { teme, gcrs, itrs };

/// States of a catalogue's objects by SGP4, those of an object one after the other. Where `code` is
/// not `Sgp4Code::ok` numbers are 0.
struct CatalogueStates {
  std::size_t objects = 0, times = 0;
  std::vector<double> position_m;        // objects x times x 3
  std::vector<double> velocity_m_per_s;  // as position_m; with ITRS relative to the turning Earth
  std::vector<std::uint8_t> code;        // objects x times

  std::size_t index(std::size_t object, std::size_t time) const { return object * times + time; }
};

/// `iers`: where the Earth is turned to; null: UT1 equals UTC and there is no polar motion. Throws
/// `Error` for a time before 1972, unless it is in TEME.
CatalogueStates states_of(std::span<const MeanElements> elements, std::span<const Utc> times,
                          StateAxes axes, const std::shared_ptr<const IersTable>& iers,
                          Threads& threads);

}  // namespace dmise
