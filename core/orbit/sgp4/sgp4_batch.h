#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "core/base/numeric/simd_level.h"
#include "core/base/parallel.h"
#include "core/frames/vec.h"
#include "core/orbit/elements/elements.h"
#include "core/time/julian_date.h"

namespace dmise {

/// Why SGP4 has no state for an object. 1 to 6 are the reference implementation's numbers.
enum class Sgp4Code : std::uint8_t {
  ok = 0,
  eccentricity = 1,            // mean eccentricity >= 1 or < -0.001
  mean_motion = 2,             // mean motion <= 0
  perturbed_eccentricity = 3,  // after the lunar and solar terms: < 0 or > 1
  semilatus_rectum = 4,        // < 0
  decayed = 6,                 // below the Earth's equatorial radius
  // Not in the reference, which reports 0: farther than 2.2 a (1 + e), not finite, or at a time
  // more than 1e8 minutes (190 years) from the epoch.
  absurd = 7,
};

/// Text for a log line, such as "mean eccentricity outside [0, 1)".
std::string_view describe(Sgp4Code code);

struct Sgp4State {
  Vec<Teme> position_m;
  Vec<Teme> velocity_m_per_s;  // the model's; not the derivative of its position
  Sgp4Code code = Sgp4Code::ok;
};

/// SGP4/SDP4 (WGS72, improved mode 'i') for whole catalogues: AIAA 2006-6753, Spacetrack Report 3.
///
/// A state depends on the element set and the time alone, to the bit: not on earlier calls, other
/// objects or threads. Calls are const, allocate nothing and may run concurrently. If `code` is not
/// ok, the state is zeros. Instruction sets differ by less than 1e-8 km.
class Sgp4Batch {
 public:
  /// Element sets that SGP4 cannot initialise get their code; does not throw.
  explicit Sgp4Batch(std::span<const MeanElements> elements, Threads* threads = nullptr,
                     SimdLevel simd = best_simd_level());
  /// Empty batch.
  explicit Sgp4Batch(SimdLevel simd);
  ~Sgp4Batch();

  /// Appends objects, so that a large catalogue need not be in memory beside its terms. The only
  /// call that must not run concurrently with others.
  void append(std::span<const MeanElements> elements, Threads* threads = nullptr);

  std::size_t size() const;

  /// States of all objects at one instant, UTC two-part Julian date `jd1 + jd2` [d], in the order
  /// given to the constructor. `position_m` and `velocity_m_per_s` hold 3 x size(): all x, all y,
  /// all z in TEME; `code` holds size() values of Sgp4Code. Throws `Error` on a wrong size.
  void propagate(double jd1, double jd2, std::span<double> position_m,
                 std::span<double> velocity_m_per_s, std::span<std::uint8_t> code,
                 Threads* threads = nullptr) const;

  /// Propagates to several instants: results of `times[k]` begin at [3 k size()] and [k size()] and
  /// equal those of a separate call to the bit. Cheaper, because a block's terms are read once for
  /// several times.
  void propagate(std::span<const Utc> times, std::span<double> position_m,
                 std::span<double> velocity_m_per_s, std::span<std::uint8_t> code,
                 Threads* threads = nullptr) const;

  /// Propagates some objects: result k is that of object `objects[k]` (any order, repeats
  /// allowed).
  void propagate_some(std::span<const std::uint32_t> objects, double jd1, double jd2,
                      std::span<double> position_m, std::span<double> velocity_m_per_s,
                      std::span<std::uint8_t> code) const;

  /// One object at many times, each in minutes from its own epoch.
  void propagate_times(std::size_t object, std::span<const double> minutes_since_epoch,
                       std::span<double> position_m, std::span<double> velocity_m_per_s,
                       std::span<std::uint8_t> code) const;

  /// One object at one time in minutes from its own epoch.
  Sgp4State propagate_one(std::size_t object, double minutes_since_epoch) const;

  /// Minutes of 60 SI seconds from an object's epoch to `jd1 + jd2` [d, UTC].
  double minutes_since_epoch(std::size_t object, double jd1, double jd2) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace dmise
