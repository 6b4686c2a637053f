#pragma once
#include <vector>

namespace dmise {

/// What goes wrong with the devices of a sensor that an observatory's software commands.
enum class MalfunctionKind {
  lost_link,      // they do not answer; what they do goes on
  slow_download,  // images come later
  stuck_shutter,  // it stays closed
  stopped_mount,  // the axis stands still; the telescope tells that it moves
  wrong_gain,     // that is told
};
inline constexpr const char* malfunction_names[] = {"lost_link", "slow_download", "stuck_shutter",
                                                    "stopped_mount", "wrong_gain"};

struct Malfunction {
  MalfunctionKind kind = MalfunctionKind::lost_link;
  double at_s = 0.0, for_s = 0.0;  // after the start of the scenario, and how long
  double download_s = 0.0;         // `slow_download`: between an exposure's end and its image
  double gain_e_per_dn = 0.0;      // that is told
};

/// The first malfunction of a kind that acts at a time; null: none.
inline const Malfunction* acting(const std::vector<Malfunction>& malfunctions, MalfunctionKind kind,
                                 double t_s) {
  for (const Malfunction& m : malfunctions)
    if (m.kind == kind && t_s >= m.at_s && t_s < m.at_s + m.for_s) return &m;
  return nullptr;
}

}  // namespace dmise
