#pragma once
#include <array>
#include <span>
#include <vector>

namespace dmise {

/// A trail as the chain's detection is expected to meet it.
struct ExpectedTrail {
  double snr = 0.0;         // after the ideal matched filter (`matched_filter_snr`)
  double length_px = 0.0;   // lit part in the frame
  double star_px = 0.0;     // length of a star's trail there
  double unlike_px = 0.0;   // difference of the trail from a star's
  bool star_known = false;  // the catalogue of stars would have a star of its light
};

/// Probability that the chain detects a trail in a frame: share x Q(ln(half / SNR) / spread), where
/// half and spread depend on its length and on what stars look like. Among stars that trail, a
/// second pair depends on how far the trail's shape is from a star's; the lesser Q counts. Between
/// nodes they are interpolated in log2(1 + px), beyond them they are those of the ends.
struct DetectionModel {
  struct Node {
    double px = 0.0;
    double half_snr = 6.0;  // at which half of what nothing hides is found
    double spread = 0.15;   // width in ln(SNR), > 0

    bool operator==(const Node&) const = default;
  };
  using Nodes = std::vector<Node>;  // ascending, at least one
  // Among stars that trail by more than `trailed_px`, by length. No row of stars that trail by more
  // than `long_px` looks like a short trail: there, trails are found as those of `row_px` or more.
  Nodes trailed;
  // Among stars that trail by less than `round_px`: a short trail looks like a few of them in a row
  // unless the catalogue would have such stars. In between both are mixed.
  Nodes round, round_known;
  // Points among stars that trail by more than `far_px`, which are subtracted; none: they are found
  // as trails of `row_px`.
  Nodes far;
  // By `shape_difference_px`, unless the catalogue would have such stars; none: it does not matter.
  Nodes shape;
  // Share of bright sources that are found, (0, 1]: trails of `row_px` or more and points, among
  // stars that trail; points among those of `far_px`; and anything among round ones.
  double share = 1.0, share_points = 1.0, share_far = 1.0, share_round = 1.0;

  static constexpr double round_px = 0.4, trailed_px = 2.4, long_px = 6.0,
                          far_px = 12.0;                  // trails of stars
  static constexpr double point_px = 1.0, row_px = 14.0;  // trails of objects
  /// All nodes.
  std::array<Nodes*, 5> nodes() { return {&trailed, &round, &round_known, &far, &shape}; }
  std::array<const Nodes*, 5> nodes() const {
    return {&trailed, &round, &round_known, &far, &shape};
  }
  std::array<double*, 4> shares() { return {&share, &share_points, &share_far, &share_round}; }
  std::array<const double*, 4> shares() const {
    return {&share, &share_points, &share_far, &share_round};
  }

  bool operator==(const DetectionModel&) const = default;
};

/// The model with what was measured in rendered frames (docs/models/survey.md).
const DetectionModel& measured_detection_model();

/// How far the shape of a trail is from that of a star's: the length of the trail whose second
/// moments are the difference of both (a point's is the star's length), but at most what
/// 1.5 px + 4 (difference of the trails - 1.5 px) gives, as the chain takes what differs by less
/// than `min_difference_px` for a star. >= 0.
double shape_difference_px(const ExpectedTrail& trail);

/// Returns a probability in [0, 1) for any SNR >= 0 and lengths >= 0.
double detection_probability(const DetectionModel& model, const ExpectedTrail& trail);

/// Less is taken for 0.
inline constexpr double min_probability = 1e-6;

/// A source of a rendered frame.
struct DetectionSample {
  ExpectedTrail trail;
  bool found = false;
};

/// Fits `half_snr`, `spread` and all shares of a model with the nodes of `start` to samples by
/// maximum likelihood. A weak prior keeps what samples do not tell as it is in `start`. The result
/// does not depend on the order of samples of equal values.
DetectionModel fitted_detection_model(const DetectionModel& start,
                                      std::span<const DetectionSample> samples);

}  // namespace dmise
