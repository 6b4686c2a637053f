#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/sim_time.h"
#include "core/frames/vec.h"
#include "core/products/product_fields.h"

namespace dmise {

enum class TrackStatus : std::uint8_t {
  tentative,  // may be of noise
  confirmed,
  lost,  // ends here
};
inline constexpr std::array track_status_names{"tentative", "confirmed", "lost"};
constexpr std::span<const char* const> names_of(TrackStatus) { return track_status_names; }

/// What is known of one object at a tick, from the detections of all sensors up to it.
struct Track {
  std::uint32_t id = 0;  // in the run, from 1 in the order in which tracks begin
  TrackStatus status = TrackStatus::tentative;
  SimTime time;  // when the state holds: at the tick
  Vec<Gcrs> position_m, velocity_m_per_s;
  // Lower triangle by rows of position and velocity [m^2, m^2/s, m^2/s^2], as in an OEM.
  std::array<double, 21> covariance{};
  // Cd A / m and Cr A / m with their standard deviations; 0 of a scale that is not estimated.
  double drag_m2_per_kg = 0.0, drag_sigma_m2_per_kg = 0.0;
  double srp_m2_per_kg = 0.0, srp_sigma_m2_per_kg = 0.0;
  std::uint32_t catalogue_number = 0;   // object that it is correlated with; 0: in no catalogue
  std::string name;                     // name of that object; may be empty
  double existence = 0.0;               // probability that the object exists, [0, 1]
  std::uint32_t detections = 0;         // taken since it began
  std::vector<std::string> associated;  // ids of the detections that it took at this tick
  // How far the latest detection was off; a track that starts has none.
  double innovation_d2 = 0.0;  // residual' S^-1 residual, 2 degrees of freedom
  SimTime last_seen;           // time of the latest detection
  double magnitude = 0.0;      // mean of its detections, each as if 1000 km away

  bool operator==(const Track&) const = default;
};

template <class V, MaybeConst<Track> T>
void visit_fields(V& v, T& t) {
  v("id", t.id);
  v("status", t.status);
  v("time", t.time);
  v("position_m", t.position_m, "position_gcrs_m");
  v("velocity_m_per_s", t.velocity_m_per_s, "velocity_gcrs_m_per_s");
  v("covariance", t.covariance, "covariance_gcrs");
  v("drag_m2_per_kg", t.drag_m2_per_kg);
  v("drag_sigma_m2_per_kg", t.drag_sigma_m2_per_kg);
  v("srp_m2_per_kg", t.srp_m2_per_kg);
  v("srp_sigma_m2_per_kg", t.srp_sigma_m2_per_kg);
  v("catalogue_number", t.catalogue_number);
  v("name", t.name);
  v("existence", t.existence);
  v("detections", t.detections);
  v("associated", t.associated);
  v("innovation_d2", t.innovation_d2);
  v("last_seen", t.last_seen);
  v("magnitude", t.magnitude);
}

}  // namespace dmise
