#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/sim_time.h"
#include "core/frames/vec.h"
#include "core/products/product_fields.h"

namespace dmise {

/// Times at which a manoeuvre may have been that are apart from others.
struct KeptManoeuvreMode {
  SimTime time;
  double time_sigma_s = 0.0;
  std::array<double, 3> delta_v_m_per_s{};  // as in KeptManoeuvre
  std::array<double, 6> covariance{};
  double chance = 0.0;  // that the manoeuvre was then, [0, 1]

  bool operator==(const KeptManoeuvreMode&) const = default;
};

/// A manoeuvre that the detections of an object show: its likeliest mode, with the spread of all
/// about it.
struct KeptManoeuvre {
  SimTime time;
  double time_sigma_s = 0.0;
  // Change of velocity along the radius, the motion and the orbit's normal, and the lower triangle
  // of its covariance by rows [m^2/s^2].
  std::array<double, 3> delta_v_m_per_s{};
  std::array<double, 6> covariance{};
  std::vector<KeptManoeuvreMode> modes;  // by falling chance; none where there is one
  SimTime found;                         // the detection by which it was found
  double confidence = 0.0;               // probability that noise would not have shown it, [0, 1]

  bool operator==(const KeptManoeuvre&) const = default;
};

/// The orbit of an object after an arc of its detections, as the fusion node keeps it.
struct KeptOrbit {
  std::string object;                  // number in the catalogue, or "new-N" of one without
  std::uint32_t catalogue_number = 0;  // 0: in no catalogue
  std::string name;                    // may be empty
  std::uint32_t track = 0;             // id of the track that the arc is of
  SimTime kept;                        // the tick that took the arc
  SimTime time;                        // the arc's last detection, to which the state belongs
  Vec<Gcrs> position_m, velocity_m_per_s;
  // Lower triangle by rows of position and velocity [m^2, m^2/s, m^2/s^2], as in an OEM.
  std::array<double, 21> covariance{};
  double drag_m2_per_kg = 0.0, drag_sigma_m2_per_kg = 0.0;
  double srp_m2_per_kg = 0.0, srp_sigma_m2_per_kg = 0.0;
  std::uint32_t arcs = 0;        // taken so far
  std::uint32_t detections = 0;  // in this arc
  std::uint32_t outliers = 0;    // detections that were left out
  // Chi-square of the arc against the orbit before it, with `degrees` if nothing happened; 0 where
  // the arc moves a manoeuvre that was known.
  double innovation_d2 = 0.0;
  std::uint32_t degrees = 0;
  std::optional<KeptManoeuvre> manoeuvre;  // found by this arc
  std::vector<KeptManoeuvre> revised;      // earlier ones, as this arc has them

  bool operator==(const KeptOrbit&) const = default;
};

template <class V, MaybeConst<KeptManoeuvreMode> M>
void visit_fields(V& v, M& m) {
  v("time", m.time);
  v("time_sigma_s", m.time_sigma_s);
  v("delta_v_m_per_s", m.delta_v_m_per_s, "delta_v_rtn_m_per_s");
  v("covariance", m.covariance, "covariance_rtn");
  v("chance", m.chance);
}

template <class V, MaybeConst<KeptManoeuvre> M>
void visit_fields(V& v, M& m) {
  v("time", m.time);
  v("time_sigma_s", m.time_sigma_s);
  v("delta_v_m_per_s", m.delta_v_m_per_s, "delta_v_rtn_m_per_s");
  v("covariance", m.covariance, "covariance_rtn");
  v("found", m.found);
  v("confidence", m.confidence);
  v.absent_unless(!m.modes.empty(), "modes", m.modes);
}

template <class V, MaybeConst<KeptOrbit> K>
void visit_fields(V& v, K& k) {
  v("object", k.object);
  v("catalogue_number", k.catalogue_number);
  v("name", k.name);
  v("track", k.track);
  v("kept", k.kept);
  v("time", k.time);
  v("position_m", k.position_m, "position_gcrs_m");
  v("velocity_m_per_s", k.velocity_m_per_s, "velocity_gcrs_m_per_s");
  v("covariance", k.covariance, "covariance_gcrs");
  v("drag_m2_per_kg", k.drag_m2_per_kg);
  v("drag_sigma_m2_per_kg", k.drag_sigma_m2_per_kg);
  v("srp_m2_per_kg", k.srp_m2_per_kg);
  v("srp_sigma_m2_per_kg", k.srp_sigma_m2_per_kg);
  v("arcs", k.arcs);
  v("detections", k.detections);
  v("outliers", k.outliers);
  v("innovation_d2", k.innovation_d2);
  v("degrees", k.degrees);
  v("manoeuvre", k.manoeuvre);
  v.absent_unless(!k.revised.empty(), "revised", k.revised);
}

}  // namespace dmise
