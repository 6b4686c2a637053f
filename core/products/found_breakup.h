#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/sim_time.h"
#include "core/frames/vec.h"
#include "core/products/product_fields.h"

namespace dmise {

/// Several objects in no catalogue whose orbits passed through one point at one time, as the fusion
/// node announces them: when they are found, and again when there are more of them.
struct FoundBreakup {
  std::uint32_t breakup = 0;  // counts from 1; the last line of a number is what is known of it
  SimTime announced;          // the tick
  SimTime time;               // when they were at one point
  double time_sigma_s = 0.0;
  Vec<Gcrs> position_m;
  std::array<double, 6> covariance{};  // lower triangle of the place's by rows [m^2]
  std::string parent;                  // number of the object that passed there; empty: none did
  std::string parent_name;             // may be empty
  std::vector<std::string> members;    // "new-N", as in KeptOrbit
  double chi_square = 0.0;             // by their places about the point
  std::uint32_t degrees = 0;
  double confidence = 0.0;  // that neither chance nor another time explains it, [0, 1]

  bool operator==(const FoundBreakup&) const = default;
};

template <class V, MaybeConst<FoundBreakup> B>
void visit_fields(V& v, B& b) {
  v("breakup", b.breakup);
  v("announced", b.announced);
  v("time", b.time);
  v("time_sigma_s", b.time_sigma_s);
  v("position_m", b.position_m, "position_gcrs_m");
  v("covariance", b.covariance, "covariance_gcrs");
  v.absent_unless(!b.parent.empty(), "parent", b.parent);
  v.absent_unless(!b.parent_name.empty(), "parent_name", b.parent_name);
  v("members", b.members);
  v("chi_square", b.chi_square);
  v("degrees", b.degrees);
  v("confidence", b.confidence);
}

}  // namespace dmise
